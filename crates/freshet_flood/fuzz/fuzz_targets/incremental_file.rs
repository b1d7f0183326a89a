//! What is read as an incremental file has steps whose times grow and whose rasters fit; anything else is an error.

#![no_main]

use freshet_flood::incremental::Incremental;
use freshet_flood::step::Quantity;
use libfuzzer_sys::fuzz_target;

/// Larger domains are valid, but they make fuzzing slow.
const MOST_CELLS: u32 = 10_000;

fuzz_target!(|text: &[u8]| {
    let Ok(steps) = Incremental::new(text) else { return };
    let size = steps.header().georeference.size;
    if size.x.saturating_mul(size.y) > MOST_CELLS {
        return;
    }
    let mut last = f64::NEG_INFINITY;
    let mut failed = false;
    for step in steps {
        assert!(!failed, "nothing comes after an error");
        let Ok(step) = step else {
            failed = true;
            continue;
        };
        assert!(step.time > last);
        last = step.time;
        let rasters = Quantity::ALL.into_iter().filter_map(|quantity| step.get(quantity));
        assert!(rasters.inspect(|raster| assert_eq!(raster.size(), size)).count() <= Quantity::ALL.len());
    }
});
