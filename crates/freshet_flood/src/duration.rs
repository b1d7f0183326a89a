//! Durations as people write and read them.

use thiserror::Error;

use crate::text::float;

/// Units by the names they go by, in lower case, with their length in seconds.
const UNITS: [(&[&str], f64); 4] = [
    (&["", "s", "sec", "secs", "second", "seconds"], 1.0),
    (&["m", "min", "mins", "minute", "minutes"], 60.0),
    (&["h", "hr", "hrs", "hour", "hours"], 3600.0),
    (&["d", "day", "days"], 86_400.0),
];

/// That a text is no duration.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[error("expected a duration such as 90, 90s, 30min, 1.5h or 1d, found “{0}”")]
pub struct DurationError(pub String);

/// The seconds that a text stands for: a number not below zero, in seconds or with a unit from seconds to days, such as
/// `90`, `90s`, `30min`, `1.5h` or `1 day`.
///
/// # Errors
/// [`DurationError`] if there is no such number, or no such unit.
pub fn seconds(text: &str) -> Result<f64, DurationError> {
    let text = text.trim();
    let (number, unit) = text.split_at(text.trim_end_matches(char::is_alphabetic).len());
    let unit = unit.to_ascii_lowercase();
    UNITS
        .iter()
        .find(|(names, _)| names.contains(&unit.as_str()))
        .zip(float::<f64>(number.trim_end().as_bytes()))
        .map(|((_, seconds), number)| number * seconds)
        .filter(|seconds| seconds.is_finite() && *seconds >= 0.0)
        .ok_or_else(|| DurationError(text.into()))
}

/// Seconds as hours, minutes and whole seconds: `1:02:03`, `-0:30:00`.
pub fn clock(seconds: f64) -> String {
    let whole = seconds.abs().round() as u64;
    let sign = if seconds < 0.0 && whole > 0 { "-" } else { "" };
    format!("{sign}{}:{:02}:{:02}", whole / 3600, whole / 60 % 60, whole % 60)
}
