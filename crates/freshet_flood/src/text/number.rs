//! Numbers as the many writers of these files spell them.

use std::str::FromStr;

use fast_float2::FastFloat;

/// The longest word that is looked at as a number with a decimal comma, in bytes.
const LONGEST: usize = 64;

/// A number with point or comma, with or without exponent; NaN also as C runtimes print it.
#[inline]
pub(crate) fn float<T: FastFloat + FromStr>(word: &[u8]) -> Option<T> {
    fast_float2::parse(word).ok().or_else(|| with_comma(word)).or_else(|| unusual(word))
}

/// A number whose decimals stand behind a comma.
fn with_comma<T: FastFloat>(word: &[u8]) -> Option<T> {
    let comma = word.iter().position(|byte| *byte == b',')?;
    let mut buffer = [0; LONGEST];
    let number = buffer.get_mut(..word.len())?;
    number.copy_from_slice(word);
    number[comma] = b'.';
    fast_float2::parse(number).ok()
}

/// NaN with a sign or a reason.
#[cold]
fn unusual<T: FromStr>(word: &[u8]) -> Option<T> {
    let text = std::str::from_utf8(word).ok()?.trim_start_matches(['-', '+']);
    let is_nan = ["nan", "nan(ind)", "1.#qnan", "1.#ind"].iter().any(|name| text.eq_ignore_ascii_case(name));
    is_nan.then(|| "nan".parse().ok()).flatten()
}

/// A natural number or zero, in digits alone.
#[inline]
pub(crate) fn natural(word: &[u8]) -> Option<u32> {
    // Nine digits always fit.
    if word.is_empty() || word.len() > 9 {
        return None;
    }
    word.iter().try_fold(0, |number, byte| byte.is_ascii_digit().then(|| 10 * number + u32::from(byte - b'0')))
}
