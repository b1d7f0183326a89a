//! The words of a stream one after the other, and where each stands.

use std::io::{self, ErrorKind, Read};
use std::ops::Range;

use super::{Fault, Place, quote};

/// How much of a stream is held at once, in bytes; also the longest word there can be.
const BUFFER: usize = 1 << 17;

const BYTE_ORDER_MARK: &[u8] = "\u{feff}".as_bytes();

/// The words of a text between its blanks and line ends, of any system.
pub(crate) struct Words<R> {
    source: R,
    buffer: Box<[u8]>,
    /// What of the buffer was read from the stream and is not yet behind us.
    rest: Range<usize>,
    /// The last word found, at the start of `rest` or just before it.
    word: Range<usize>,
    /// Whether the last word found is still to be handed out.
    is_waiting: bool,
    /// The line of `rest.start`, counted from 1.
    line: usize,
    /// Where that line begins, measured from the start of the buffer: below zero once that has been dropped.
    line_start: isize,
    /// The last byte between words, for line ends of two.
    last_blank: u8,
}

impl<R: Read> Words<R> {
    pub(crate) fn new(source: R) -> Self {
        Self {
            source,
            buffer: vec![0; BUFFER].into_boxed_slice(),
            rest: 0..0,
            word: 0..0,
            is_waiting: false,
            line: 0,
            line_start: 0,
            last_blank: b' ',
        }
    }

    /// The next word, which is then behind us, or none at the end of the text.
    #[inline]
    pub(crate) fn next(&mut self) -> Result<Option<&[u8]>, Fault> {
        if !self.is_waiting && !self.find()? {
            return Ok(None);
        }
        self.take();
        Ok(Some(&self.buffer[self.word.clone()]))
    }

    /// The next word, which stays the next, or none at the end of the text.
    #[inline]
    pub(crate) fn peek(&mut self) -> Result<Option<&[u8]>, Fault> {
        let is_found = self.is_waiting || self.find()?;
        Ok(is_found.then(|| &self.buffer[self.word.clone()]))
    }

    /// The next word if it stands on line `line`, which is then behind us.
    #[inline]
    pub(crate) fn next_on(&mut self, line: usize) -> Result<Option<&[u8]>, Fault> {
        if !(self.is_waiting || self.find()?) || self.line != line {
            return Ok(None);
        }
        self.take();
        Ok(Some(&self.buffer[self.word.clone()]))
    }

    /// The word that was found last, whether it is behind us or next.
    pub(crate) fn last(&self) -> &[u8] {
        &self.buffer[self.word.clone()]
    }

    /// The line of the last word that was found, counted from 1.
    pub(crate) fn line(&self) -> usize {
        self.line.max(1)
    }

    /// Where the last word that was found starts.
    #[inline]
    pub(crate) fn place(&self) -> Place {
        // Lines that began before the buffer have a start below zero.
        Place { line: self.line(), column: self.word.start.saturating_add_signed(1 - self.line_start) }
    }

    /// That something else should stand where the last word was found.
    pub(crate) fn unexpected(&self, expected: impl Into<String>, found: impl Into<String>) -> Fault {
        self.place().unexpected(expected, found)
    }

    /// That another word should stand in the place of the last one found.
    pub(crate) fn unexpected_word(&self, expected: impl Into<String>) -> Fault {
        self.unexpected(expected, quote(self.last()))
    }

    fn take(&mut self) {
        self.rest.start = self.word.end;
        self.is_waiting = false;
    }

    /// Looks for the next word. Without one, the place is that of the end of the text.
    fn find(&mut self) -> Result<bool, Fault> {
        if self.line == 0 {
            self.skip_byte_order_mark()?;
        }
        while !self.skip_blanks() {
            if !self.fill()? {
                self.word = self.rest.clone();
                return Ok(false);
            }
        }
        let mut length = 1;
        loop {
            let rest = &self.buffer[self.rest.start + length..self.rest.end];
            if let Some(more) = rest.iter().position(is_blank) {
                length += more;
                break;
            }
            length = self.rest.len();
            if !self.fill()? {
                break;
            }
        }
        self.word = self.rest.start..self.rest.start + length;
        self.is_waiting = true;
        Ok(true)
    }

    /// Goes to the next byte of the buffer that is no blank, and says whether there is one.
    fn skip_blanks(&mut self) -> bool {
        while let Some(&byte) = self.buffer[self.rest.clone()].first() {
            if !is_blank(&byte) {
                return true;
            }
            self.rest.start += 1;
            if byte == b'\n' || byte == b'\r' {
                let start = self.rest.start as isize;
                // A carriage return and a line feed right behind it are one line end.
                let is_second = byte == b'\n' && self.last_blank == b'\r' && start == self.line_start + 1;
                self.line += usize::from(!is_second);
                self.line_start = start;
            }
            self.last_blank = byte;
        }
        false
    }

    fn skip_byte_order_mark(&mut self) -> Result<(), Fault> {
        self.line = 1;
        while self.rest.len() < BYTE_ORDER_MARK.len() && self.fill()? {}
        if self.buffer[self.rest.clone()].starts_with(BYTE_ORDER_MARK) {
            self.rest.start += BYTE_ORDER_MARK.len();
            self.line_start = self.rest.start as isize;
        }
        Ok(())
    }

    /// Reads more of the stream behind what is left, and says whether there was more.
    #[cold]
    fn fill(&mut self) -> Result<bool, Fault> {
        self.line_start -= self.rest.start as isize;
        self.buffer.copy_within(self.rest.clone(), 0);
        self.rest = 0..self.rest.len();
        self.word = self.rest.clone();
        if self.rest.end == self.buffer.len() {
            return Err(self.unexpected_word(format!("words of less than {BUFFER} bytes")));
        }
        loop {
            match self.source.read(&mut self.buffer[self.rest.end..]) {
                Err(error) if error.kind() == ErrorKind::Interrupted => {}
                Err(error) => return Err(io::Error::into(error)),
                Ok(length) => {
                    self.rest.end += length;
                    return Ok(length > 0);
                }
            }
        }
    }
}

#[inline]
fn is_blank(byte: &u8) -> bool {
    byte.is_ascii_whitespace()
}
