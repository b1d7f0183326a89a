//! One picture, or a numbered picture for each frame.
use super::{Sink, folder_of, named};
use image::RgbImage;
use std::path::{Path, PathBuf};

/// Pictures in files of their own.
pub struct Pictures {
    name: Name,
    frames: usize,
}

enum Name {
    /// The same for all.
    One(PathBuf),
    /// With a place for the number.
    Pattern(String),
}

impl Pictures {
    /// A single picture.
    pub fn one(path: &Path) -> Self {
        Self { name: Name::One(path.into()), frames: 0 }
    }

    /// Pictures whose number stands in place of `%05d` in their names.
    ///
    /// # Errors
    /// Why their folder cannot be made.
    pub fn numbered(pattern: &str) -> Result<Self, String> {
        folder_of(Path::new(pattern))?;
        Ok(Self { name: Name::Pattern(pattern.into()), frames: 0 })
    }
}

impl Sink for Pictures {
    fn add(&mut self, picture: &RgbImage) -> Result<(), String> {
        let path = match &self.name {
            Name::One(path) => path.clone(),
            Name::Pattern(pattern) => numbered(pattern, self.frames).ok_or("there is no place for the number")?.into(),
        };
        self.frames += 1;
        picture.save(&path).map_err(|problem| named(&path)(&problem))
    }

    fn finish(self: Box<Self>) -> Result<(), String> {
        Ok(())
    }
}

/// The name of a frame; `None` if the pattern has no place for its number.
pub fn numbered(pattern: &str, frame: usize) -> Option<String> {
    let (before, rest) = pattern.rsplit_once('%')?;
    let (digits, after) = rest.split_once('d')?;
    let width = if digits.is_empty() { 0 } else { digits.parse::<usize>().ok().filter(|width| *width < 20)? };
    Some(format!("{before}{frame:0width$}{after}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_are_numbered_as_the_pattern_says() {
        assert_eq!(numbered("film/%05d.png", 42).as_deref(), Some("film/00042.png"));
        assert_eq!(numbered("%d.png", 42).as_deref(), Some("42.png"));
        assert_eq!(numbered("%3d dry.png", 1234).as_deref(), Some("1234 dry.png"));
        for pattern in ["film.png", "film%.png", "%xd.png", "%99d.png"] {
            assert_eq!(numbered(pattern, 0), None, "{pattern}");
        }
    }
}
