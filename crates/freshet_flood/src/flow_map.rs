//! Flow maps: velocities of water stored as a picture.
//!
//! One pixel is one cell, the top row is north. Colours are plain numbers, not sRGB:
//!
//! | channel | meaning | below half | half | above half |
//! |---|---|---|---|---|
//! | red | velocity to the east | flows **west** (left in the picture) | still | flows **east** (right in the picture) |
//! | green | velocity to the south | flows **north** (up in the picture) | still | flows **south** (down in the picture) |
//! | blue | nothing; written as half | | | |
//! | alpha | none, or: fully transparent pixels are still | | | |
//!
//! Many normal and flow maps of other programs take green upwards: turn theirs over.
//!
//! Half is 128 in 8 bits and 32768 in 16 bits, so still water is exactly still. The velocity is scale · (b − 128) / 127,
//! not below −scale, and scale · (w − 32768) / 32767 likewise; a 16-bit map errs by less than scale / 60 000.
//!
//! Scale, cell size and water level stand in the file itself, in the `tEXt` chunks [`SCALE_KEY`], [`CELL_SIZE_KEY`] and
//! [`LEVEL_KEY`]. A painted map has none, so whoever loads it gives them as [`Defaults`].

use std::collections::BTreeMap;
use std::fs;
use std::io::{self, Cursor};
use std::path::{Path, PathBuf};

use freshet_hydro::grid::{Grid, GridError};
use glam::{IVec2, UVec2, Vec2};
use png::{BitDepth, ColorType, Transformations};
use thiserror::Error;

/// Key of the `tEXt` chunk with the speed in m/s that the full range of a channel stands for, above zero.
pub const SCALE_KEY: &str = "freshet scale m/s";
/// Key of the `tEXt` chunk with the side of a cell in metres, above zero.
pub const CELL_SIZE_KEY: &str = "freshet cell size m";
/// Key of the `tEXt` chunk with the water level that the flow belongs to, in metres above the terrain's datum.
pub const LEVEL_KEY: &str = "freshet level m";

/// The most columns or rows of a flow map: what every graphics device takes as a texture.
pub const MOST_CELLS: u32 = 8192;

/// A raster of velocities that can be stored as a picture.
#[derive(Clone, Debug, PartialEq)]
pub struct FlowMap {
    /// Velocity (east, south) at cell centres in m/s. Components beyond ± the scale are stored as that, NaN as still.
    pub velocity: Grid<Vec2>,
    /// Speed in m/s that the full range of a channel stands for, above zero.
    pub scale: f32,
    /// Water level that the flow belongs to in metres above the terrain's datum, if known.
    pub level: Option<f32>,
}

/// What a picture without description, as from a painter, is to be taken as. What a file says itself has precedence.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Defaults {
    /// Speed in m/s that the full range of a channel stands for, above zero. Default: none, so the file must say.
    pub scale: Option<f32>,
    /// Side of a cell in metres, above zero. Default: none, so the file must say.
    pub cell_size: Option<f32>,
}

/// Why a flow map cannot be read or written.
#[derive(Debug, Error)]
pub enum FlowMapError {
    /// The file cannot be opened, read or written.
    #[error("{}: {source}", .path.display())]
    Io {
        /// The file.
        path: PathBuf,
        /// What the system reported.
        source: io::Error,
    },
    /// The file is no flow map.
    #[error("{}: {source}", .path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        source: Box<FlowMapError>,
    },
    /// The bytes are not an intact PNG picture.
    #[error("not an intact PNG picture: {0}")]
    Decoding(#[from] png::DecodingError),
    /// The picture cannot be encoded.
    #[error("the picture cannot be encoded: {0}")]
    Encoding(#[from] png::EncodingError),
    /// The picture is grey.
    #[error("a flow map needs red and green, but the picture is grey")]
    Grey,
    /// The picture has too many columns or rows.
    #[error("{0} × {1} cells are too many: a flow map has at most {MOST_CELLS} columns and rows")]
    TooLarge(u32, u32),
    /// A number in the file's description or in the [`Defaults`] is missing or out of range.
    #[error("the flow map's “{key}” must be {expected}, not {found}")]
    Description {
        /// The key of the `tEXt` chunk.
        key: &'static str,
        /// What is allowed.
        expected: &'static str,
        /// What was found.
        found: String,
    },
    /// The picture has no cells.
    #[error(transparent)]
    Grid(#[from] GridError),
}

impl FlowMap {
    /// A map of `velocity` (m/s) with the least scale that holds every component, for water at `level` metres.
    pub fn new(velocity: Grid<Vec2>, level: Option<f32>) -> Self {
        let finite = velocity.values().iter().filter(|velocity| velocity.is_finite());
        let most = finite.fold(0.0_f32, |most, velocity| most.max(velocity.abs().max_element()));
        // Still water has no scale of its own.
        let scale = if most > 0.0 { most } else { 1.0 };
        Self { velocity, scale, level }
    }

    /// Reads a PNG file.
    ///
    /// # Errors
    /// [`FlowMapError::Io`] or [`FlowMapError::File`], with the file's name, as for [`FlowMap::decode`].
    pub fn read(path: impl AsRef<Path>, defaults: Defaults) -> Result<Self, FlowMapError> {
        let path = path.as_ref().to_path_buf();
        match fs::read(&path) {
            Err(source) => Err(FlowMapError::Io { path, source }),
            Ok(bytes) => {
                Self::decode(&bytes, defaults).map_err(|source| FlowMapError::File { path, source: Box::new(source) })
            }
        }
    }

    /// Reads the bytes of a PNG file: RGB, RGBA or palette, of up to 16 bits, interlaced or not.
    ///
    /// # Errors
    /// [`FlowMapError`] if the bytes are not an intact PNG picture, it is grey or larger than [`MOST_CELLS`], or neither
    /// the file nor `defaults` give a valid scale and cell size.
    pub fn decode(bytes: &[u8], defaults: Defaults) -> Result<Self, FlowMapError> {
        let mut decoder = png::Decoder::new(Cursor::new(bytes));
        decoder.set_transformations(Transformations::EXPAND);
        let UVec2 { x, y } = UVec2::from(decoder.read_header_info()?.size());
        if x.max(y) > MOST_CELLS {
            return Err(FlowMapError::TooLarge(x, y));
        }
        let mut reader = decoder.read_info()?;
        let (color, depth) = reader.output_color_type();
        let channels = match color {
            ColorType::Grayscale | ColorType::GrayscaleAlpha => return Err(FlowMapError::Grey),
            color => color.samples(),
        };
        let mut samples = vec![0; reader.output_buffer_size().unwrap_or_default()];
        reader.next_frame(&mut samples)?;
        // Programs may put their description behind the picture.
        reader.finish()?;

        let chunks = &reader.info().uncompressed_latin1_text;
        let text: BTreeMap<&str, &str> =
            chunks.iter().map(|chunk| (chunk.keyword.as_str(), chunk.text.as_str())).collect();
        let scale = positive(SCALE_KEY, &text, defaults.scale)?;
        let cell_size = positive(CELL_SIZE_KEY, &text, defaults.cell_size)?;
        let level = text.get(LEVEL_KEY).map(|text| level(text)).transpose()?;
        let units = match depth {
            BitDepth::Sixteen => units_of_16_bits(&samples, channels),
            _ => units_of_8_bits(&samples, channels),
        };
        let values = units.into_iter().map(|unit| unit * scale).collect();
        let velocity = Grid::new(UVec2::new(x, y), cell_size, values)?;
        Ok(Self { velocity, scale, level })
    }

    /// Writes a PNG file of 16 bits per channel that describes itself.
    ///
    /// # Errors
    /// [`FlowMapError::Io`] or [`FlowMapError::File`], with the file's name, as for [`FlowMap::encode`].
    pub fn write(&self, path: impl AsRef<Path>) -> Result<(), FlowMapError> {
        let path = path.as_ref().to_path_buf();
        match self.encode() {
            Ok(bytes) => fs::write(&path, bytes).map_err(|source| FlowMapError::Io { path, source }),
            Err(source) => Err(FlowMapError::File { path, source: Box::new(source) }),
        }
    }

    /// The bytes of a PNG file of 16 bits per channel that describes itself.
    ///
    /// # Errors
    /// [`FlowMapError`] if the grid is larger than [`MOST_CELLS`], or the scale or the level is out of range.
    pub fn encode(&self) -> Result<Vec<u8>, FlowMapError> {
        let UVec2 { x, y } = self.velocity.size();
        if x.max(y) > MOST_CELLS {
            return Err(FlowMapError::TooLarge(x, y));
        }
        let scale = positive(SCALE_KEY, &BTreeMap::new(), Some(self.scale))?;
        let mut bytes = Vec::new();
        let mut encoder = png::Encoder::new(&mut bytes, x, y);
        encoder.set_color(ColorType::Rgb);
        encoder.set_depth(BitDepth::Sixteen);
        encoder.set_compression(png::Compression::High);
        let mut describe = |key: &str, text: String| encoder.add_text_chunk(key.into(), text);
        describe(SCALE_KEY, scale.to_string())?;
        describe(CELL_SIZE_KEY, self.velocity.cell_size().to_string())?;
        if let Some(metres) = self.level {
            describe(LEVEL_KEY, level(&metres.to_string())?.to_string())?;
        }
        describe("Comment", "Red above half flows east, green above half flows south.".into())?;

        let samples = self.velocity.values().iter().flat_map(|&velocity| {
            let still = velocity.is_nan();
            let unit = if still { Vec2::ZERO } else { velocity / scale };
            let steps = (unit.clamp(Vec2::NEG_ONE, Vec2::ONE) * 32767.0).round();
            let IVec2 { x, y } = steps.as_ivec2();
            [x, y, 0].map(|steps| (steps + 32768) as u16)
        });
        let samples: Vec<u8> = samples.flat_map(u16::to_be_bytes).collect();
        let mut writer = encoder.write_header()?;
        writer.write_image_data(&samples)?;
        writer.finish()?;
        Ok(bytes)
    }
}

/// The number above zero that the file gives for `key`, or else its default.
fn positive(key: &'static str, text: &BTreeMap<&str, &str>, default: Option<f32>) -> Result<f32, FlowMapError> {
    let given = match text.get(key) {
        Some(text) => text.trim().parse().ok(),
        None => default,
    };
    given.filter(|value| value.is_finite() && *value > 0.0).ok_or_else(|| {
        let found = text.get(key).map(|text| format!("“{text}”"));
        FlowMapError::Description {
            key,
            expected: "a number above zero, in the file or given with it",
            found: found.or(default.map(|value| value.to_string())).unwrap_or("missing".into()),
        }
    })
}

/// The water level in metres that `text` gives.
fn level(text: &str) -> Result<f32, FlowMapError> {
    let level: Option<f32> = text.trim().parse().ok();
    level.filter(|level| level.is_finite()).ok_or_else(|| FlowMapError::Description {
        key: LEVEL_KEY,
        expected: "a finite number",
        found: format!("“{text}”"),
    })
}

/// Velocities as shares of the scale. `channels` is 3 or 4.
fn units_of_8_bits(samples: &[u8], channels: usize) -> Vec<Vec2> {
    let unit = |byte: u8| ((f32::from(byte) - 128.0) / 127.0).max(-1.0);
    let pixels = samples.chunks_exact(channels);
    let units = pixels.map(|pixel| match pixel {
        [_, _, _, 0] => Vec2::ZERO,
        pixel => Vec2::new(unit(pixel[0]), unit(pixel[1])),
    });
    units.collect()
}

/// Velocities as shares of the scale. `channels` is 3 or 4.
fn units_of_16_bits(samples: &[u8], channels: usize) -> Vec<Vec2> {
    let unit = |high: u8, low: u8| ((f32::from(u16::from_be_bytes([high, low])) - 32768.0) / 32767.0).max(-1.0);
    let pixels = samples.chunks_exact(2 * channels);
    let units = pixels.map(|pixel| match pixel {
        [_, _, _, _, _, _, 0, 0] => Vec2::ZERO,
        pixel => Vec2::new(unit(pixel[0], pixel[1]), unit(pixel[2], pixel[3])),
    });
    units.collect()
}
