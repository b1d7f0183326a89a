//! Pictures and films without a window: what is drawn, and the files that it goes to.
mod av1;
mod gif;
mod mp4;
mod png;
mod run;
mod whole;
mod yuv;

use bevy::math::UVec2;
use image::RgbImage;
use std::path::{Path, PathBuf};

#[cfg(test)]
pub use run::show;
pub use run::{Plan, run};

/// Where frames go.
#[derive(Clone, Debug)]
pub enum Output {
    /// One picture.
    Picture(PathBuf),
    /// A picture for each frame; `%05d` in the name stands for its number, from 0.
    Pictures(String),
    /// An animated picture.
    Gif(PathBuf),
    /// A video.
    Mp4(PathBuf),
}

/// What is known of a film before its first frame.
#[derive(Clone, Copy, Debug)]
pub struct Clip {
    /// Width and height of a frame, px.
    pub size: UVec2,
    /// Frames in a second.
    pub fps: u32,
    /// How many frames there are.
    pub frames: usize,
}

/// Takes the frames of a film one after the other.
pub trait Sink {
    /// # Errors
    /// Why the frame cannot be written.
    fn add(&mut self, picture: &RgbImage) -> Result<(), String>;

    /// Ends the film; without it there is none.
    ///
    /// # Errors
    /// Why there is none.
    fn finish(self: Box<Self>) -> Result<(), String>;
}

impl Output {
    /// The output that the name of a film asks for.
    ///
    /// # Errors
    /// What the name must be.
    pub fn film(name: &str) -> Result<Self, String> {
        let path = PathBuf::from(name);
        let ends_in = |wanted: &str| path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case(wanted));
        match () {
            () if ends_in("mp4") => Ok(Self::Mp4(path)),
            () if ends_in("gif") => Ok(Self::Gif(path)),
            () if ends_in("png") && png::numbered(name, 0).is_some() => Ok(Self::Pictures(name.into())),
            () => Err(format!("expected a name like film.mp4, film.gif or film/%05d.png, found {name:?}")),
        }
    }

    /// Begins to write.
    ///
    /// # Errors
    /// Why nothing can be written there.
    fn open(&self, clip: Clip) -> Result<Box<dyn Sink>, String> {
        Ok(match self {
            Self::Picture(path) => Box::new(png::Pictures::one(path)),
            Self::Pictures(pattern) => Box::new(png::Pictures::numbered(pattern)?),
            Self::Gif(path) => Box::new(gif::Gif::create(path, clip)?),
            Self::Mp4(path) => Box::new(mp4::Mp4::create(path, clip)?),
        })
    }
}

/// A problem with a file, in one line.
fn named(path: &Path) -> impl Fn(&dyn core::fmt::Display) -> String + '_ {
    move |problem| format!("{}: {problem}", path.display())
}

/// Makes the folder of a file, if it is not there, and tells it.
fn folder_of(path: &Path) -> Result<&Path, String> {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(".".as_ref());
    std::fs::create_dir_all(folder).map_err(|problem| named(folder)(&problem))?;
    Ok(folder)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_name_of_a_film_tells_what_it_is() {
        assert!(matches!(Output::film("a/film.MP4"), Ok(Output::Mp4(_))));
        assert!(matches!(Output::film("film.gif"), Ok(Output::Gif(_))));
        assert!(matches!(Output::film("film/%05d.png"), Ok(Output::Pictures(_))));
        for name in ["film", "film.png", "film/%x.png", "film.avi", "film/%99d.png"] {
            assert!(Output::film(name).is_err_and(|problem| problem.contains(name)), "{name}");
        }
    }
}
