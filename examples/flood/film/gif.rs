//! Films as animated pictures.
use super::{Clip, Sink, named, whole::Whole};
use image::RgbImage;
use std::path::{Path, PathBuf};

/// Most frames in a second: browsers show shorter ones than 2/100 s for a tenth.
const FASTEST: u32 = 50;

/// A GIF that is written frame by frame.
pub struct Gif {
    path: PathBuf,
    fps: u32,
    encoder: gif::Encoder<Whole>,
    frames: u32,
}

impl Gif {
    /// # Errors
    /// Why it cannot be written there.
    pub fn create(path: &Path, clip: Clip) -> Result<Self, String> {
        if clip.fps > FASTEST {
            let problem = format!("expected at most {FASTEST} frames a second of a GIF, found {}", clip.fps);
            return Err(named(path)(&problem));
        }
        let [width, height] = clip.size.to_array().map(|side| side as u16);
        let file = Whole::create(path)?;
        let encoder = gif::Encoder::new(file, width, height, &[]).and_then(|mut encoder| {
            encoder.set_repeat(gif::Repeat::Infinite)?;
            Ok(encoder)
        });
        let encoder = encoder.map_err(|problem| named(path)(&problem))?;
        Ok(Self { path: path.into(), fps: clip.fps, encoder, frames: 0 })
    }
}

impl Sink for Gif {
    fn add(&mut self, picture: &RgbImage) -> Result<(), String> {
        let [width, height] = [picture.width(), picture.height()].map(|side| side as u16);
        let mut frame = gif::Frame::from_rgb_speed(width, height, picture, 10);
        // Hundredths of a second, so that their sum is right.
        let ends = [self.frames, self.frames + 1].map(|frame| frame * 100 / self.fps);
        frame.delay = (ends[1] - ends[0]) as u16;
        self.frames += 1;
        self.encoder.write_frame(&frame).map_err(|problem| named(&self.path)(&problem))
    }

    fn finish(self: Box<Self>) -> Result<(), String> {
        self.encoder.into_inner().map_err(|problem| named(&self.path)(&problem))?.keep()
    }
}
