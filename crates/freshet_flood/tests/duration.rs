//! Durations as people write them.

use freshet_flood::duration::seconds;

#[test]
fn durations_have_a_unit_or_are_seconds() {
    for (text, expected) in [
        ("0", 0.0),
        ("90", 90.0),
        ("90s", 90.0),
        ("30min", 1800.0),
        ("30 Minutes", 1800.0),
        ("1.5h", 5400.0),
        ("1,5 h", 5400.0),
        (" 1d ", 86_400.0),
        ("1e3", 1000.0),
    ] {
        assert_eq!(seconds(text), Ok(expected), "{text}");
    }
}

#[test]
fn what_is_no_duration_is_named() {
    for text in ["", "min", "1 week", "-1h", "nan", "inf", "1h30", "1e400"] {
        let message = seconds(text).unwrap_err().to_string();
        assert_eq!(message, format!("expected a duration such as 90, 90s, 30min, 1.5h or 1d, found “{text}”"));
    }
}
