//! Lines of a header, word by word.

use std::io::Read;

use crate::text::{Fault, ParseError, Words, float, quote};

/// More words than any line of a header has.
const MOST_WORDS: usize = 100;

/// A line with at least one word.
pub(super) struct Line {
    words: Vec<Word>,
}

pub(super) struct Word {
    pub(super) text: String,
    line: usize,
    column: usize,
}

impl Line {
    /// Reads the next line that is not blank. `expected` is for the message if there is none.
    pub(super) fn read<R: Read>(words: &mut Words<R>, expected: &str) -> Result<Self, Fault> {
        if words.peek()?.is_none() {
            return Err(words.unexpected(expected, "the end of the file"));
        }
        let line = words.line();
        let mut read = Vec::new();
        while let Some(word) = words.next_on(line)? {
            let text = String::from_utf8_lossy(word).into_owned();
            read.push(Word { text, line, column: words.column() });
            if read.len() > MOST_WORDS {
                return Err(words.unexpected(expected, format!("a line of more than {MOST_WORDS} words")));
            }
        }
        Ok(Self { words: read })
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
        let [first, ..] = self.words.as_slice() else {
            return Word { text: String::new(), line: 1, column: 1 }.unexpected(expected);
        };
        let texts: Vec<&str> = self.words.iter().map(|word| word.text.as_str()).collect();
        let found = quote(texts.join(" ").as_bytes());
        Fault::Parse(ParseError { line: first.line, column: first.column, expected: expected.into(), found })
    }
}

impl Word {
    /// That another word should stand here.
    pub(super) fn unexpected(&self, expected: impl Into<String>) -> Fault {
        let Self { line, column, .. } = *self;
        Fault::Parse(ParseError { line, column, expected: expected.into(), found: quote(self.text.as_bytes()) })
    }
}
