//! What is read as an ESRI ASCII grid is written and read back alike; anything else is an error.

#![no_main]

use freshet_flood::esri_ascii::EsriGrid;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|text: &[u8]| {
    if let Ok(esri) = EsriGrid::parse(text) {
        let written = esri.to_string();
        let again = EsriGrid::parse(written.as_bytes()).expect("what was written is read");
        assert_eq!(again.to_string(), written);
    }
});
