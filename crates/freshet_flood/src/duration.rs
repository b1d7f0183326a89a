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

/// The longest duration that is read, s: about thirty years.
pub const LONGEST: f64 = 1e9;

/// That a text is no duration.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
pub enum DurationError {
    /// It is no number with a unit, or below zero.
    #[error("expected a duration such as 90, 90s, 30min, 1.5h or 1d, found “{0}”")]
    Unreadable(String),
    /// It is longer than [`LONGEST`].
    #[error("expected a duration of at most 1e9 s, about thirty years, found “{0}”")]
    TooLong(String),
}

/// The seconds that a text stands for: a number not below zero, in seconds or with a unit from seconds to days, such as
/// `90`, `90s`, `30min`, `1.5h` or `1 day`; at most [`LONGEST`].
///
/// # Errors
/// [`DurationError`] if there is no such number, no such unit, or it is too long.
pub fn seconds(text: &str) -> Result<f64, DurationError> {
    let text = text.trim();
    let (number, unit) = text.split_at(text.trim_end_matches(char::is_alphabetic).len());
    let unit = unit.to_ascii_lowercase();
    UNITS
        .iter()
        .find(|(names, _)| names.contains(&unit.as_str()))
        .zip(float::<f64>(number.trim_end().as_bytes()))
        .map(|((_, seconds), number)| number * seconds)
        .filter(|seconds| *seconds >= 0.0)
        .ok_or_else(|| DurationError::Unreadable(text.into()))
        .and_then(|seconds| if seconds <= LONGEST { Ok(seconds) } else { Err(DurationError::TooLong(text.into())) })
}

/// The time that a text stands for, s: a duration as for [`seconds`], also one before the beginning, as in `-30min`.
///
/// # Errors
/// As for [`seconds`].
pub fn time(text: &str) -> Result<f64, DurationError> {
    match text.trim().strip_prefix('-') {
        Some(before) if !before.starts_with(char::is_whitespace) => seconds(before).map(|time| -time),
        _ => seconds(text),
    }
}

/// Seconds as hours, minutes and whole seconds: `1:02:03`, `-0:30:00`.
pub fn clock(seconds: f64) -> String {
    let whole = seconds.abs().round() as u64;
    let sign = if seconds < 0.0 && whole > 0 { "-" } else { "" };
    format!("{sign}{}:{:02}:{:02}", whole / 3600, whole / 60 % 60, whole % 60)
}
