//! Lines of a header, word by word.

use std::io::Read;

use crate::text::{Fault, Place, Words, float, quote};

/// More words than any line of a header has.
const MOST_WORDS: usize = 100;

/// A line with at least one word.
pub(super) struct Line {
    place: Place,
    words: Vec<Word>,
}

pub(super) struct Word {
    pub(super) text: String,
    place: Place,
}

impl Line {
    /// Reads the next line that is not blank. `expected` is for the message if there is none.
    pub(super) fn read<R: Read>(words: &mut Words<R>, expected: &str) -> Result<Self, Fault> {
        if words.peek()?.is_none() {
            return Err(words.unexpected(expected, "the end of the file"));
        }
        let place = words.place();
        let mut read = Vec::new();
        while let Some(word) = words.next_on(place.line)? {
            let text = String::from_utf8_lossy(word).into_owned();
            read.push(Word { text, place: words.place() });
            if read.len() > MOST_WORDS {
                return Err(words.unexpected(expected, format!("a line of more than {MOST_WORDS} words")));
            }
        }
        Ok(Self { place, words: read })
    }

    pub(super) fn words(&self) -> &[Word] {
        &self.words
    }

    /// Whether the line begins with these words, which are in upper case here and in any case there.
    pub(super) fn begins(&self, beginning: &[&str]) -> bool {
        self.words.len() >= beginning.len()
            && self.words.iter().zip(beginning).all(|(word, begin)| word.text.eq_ignore_ascii_case(begin))
    }

    /// The line as numbers alone.
    pub(super) fn numbers(&self, expected: &str) -> Result<Vec<f64>, Fault> {
        let number = |word: &Word| {
            let number = float::<f64>(word.text.as_bytes()).filter(|number| number.is_finite());
            number.ok_or_else(|| word.unexpected(expected))
        };
        self.words.iter().map(number).collect()
    }

    /// That the line should have been something else.
    pub(super) fn unexpected(&self, expected: impl Into<String>) -> Fault {
        let texts: Vec<&str> = self.words.iter().map(|word| word.text.as_str()).collect();
        self.place.unexpected(expected, quote(texts.join(" ").as_bytes()))
    }
}

impl Word {
    /// That another word should stand here.
    pub(super) fn unexpected(&self, expected: impl Into<String>) -> Fault {
        self.place.unexpected(expected, quote(self.text.as_bytes()))
    }
}
