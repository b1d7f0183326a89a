//! Durations as people write them.

use freshet_flood::duration::{seconds, time};

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
    for text in ["", "min", "1 week", "-1h", "nan", "1h30"] {
        let message = seconds(text).unwrap_err().to_string();
        assert_eq!(message, format!("expected a duration such as 90, 90s, 30min, 1.5h or 1d, found “{text}”"));
    }
}

#[test]
fn longer_than_thirty_years_is_too_long() {
    assert_eq!(seconds("11574d"), Ok(11_574.0 * 86_400.0));
    for text in ["1e308", "11575d", "inf", "1e400"] {
        let message = seconds(text).unwrap_err().to_string();
        assert!(message.contains("at most 1e9 s") || text.starts_with("inf"), "{text}: {message}");
    }
}

#[test]
fn a_time_may_lie_before_the_beginning() {
    assert_eq!([time("-30min"), time("1.5h"), time("-0")], [Ok(-1800.0), Ok(5400.0), Ok(0.0)]);
    for text in ["--1", "- 1", "-", "-week"] {
        assert!(time(text).is_err(), "{text}");
    }
}
