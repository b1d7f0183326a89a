//! `cargo xtask assets`: paints the textures of the river banks, the same bytes on every machine.

mod bark;
mod colour;
mod grass;
mod leaves;
mod mud;
mod periodic;
mod picture;
mod reed;
mod ribbon;
mod sand;

use std::{fs, path::PathBuf};

use anyhow::{Context, Result};

use crate::command;

use self::picture::{Picture, encode_png};

/// The side of a ground texture while it is painted: twice that of the file, to be halved for smooth edges.
const SUPERSAMPLED: usize = 1024;

/// A texture and its file in `assets/textures`.
struct Texture {
    file: &'static str,
    paint: fn() -> Picture,
    /// Rounding of its eight-bit values: noise costs file size, and nobody sees its last bits.
    step: u8,
}

const TEXTURES: [Texture; 6] = [
    Texture { file: "bark.png", paint: bark::bark, step: 3 },
    Texture { file: "grass.png", paint: grass::grass, step: 4 },
    Texture { file: "leaves.png", paint: leaves::leaves, step: 1 },
    Texture { file: "mud.png", paint: mud::mud, step: 3 },
    Texture { file: "reed.png", paint: reed::reed, step: 1 },
    Texture { file: "sand.png", paint: sand::sand, step: 3 },
];

impl Texture {
    fn path(&self) -> PathBuf {
        command::workspace().join("assets/textures").join(self.file)
    }
}

/// Paints every texture and writes its file.
pub fn write_all() -> Result<()> {
    for texture in TEXTURES {
        let path = texture.path();
        let picture = (texture.paint)();
        let png = encode_png(picture.side, &picture.to_rgba(texture.step))?;
        println!("{} ({} KiB)", path.display(), png.len().div_ceil(1024));
        fs::write(&path, png).with_context(|| format!("writing {}", path.display()))?;
    }
    Ok(())
}

#[cfg(test)]
mod tests;
