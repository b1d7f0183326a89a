//! The series of all gauges as a table.
use super::Gauge;
use std::fmt::Write;

/// A line of names, and one for each step: its time in seconds, and the depth at each gauge in metres. Cells of a gauge that cannot be read are empty.
pub fn table(times: &[f64], gauges: &[Gauge]) -> String {
    let mut text = String::from("time s");
    for gauge in gauges {
        _ = write!(text, ",depth m at E {} N {}", gauge.place.x, gauge.place.y);
    }
    text.push('\n');
    for (step, time) in times.iter().enumerate() {
        _ = write!(text, "{time}");
        for gauge in gauges {
            match gauge.series().and_then(|series| series.depths.get(step)) {
                Some(depth) => _ = write!(text, ",{depth:.4}"),
                None => text.push(','),
            }
        }
        text.push('\n');
    }
    text
}
