//! A square picture in linear light, and its way into a PNG file.

use anyhow::{Context, Result};
use image::{
    ExtendedColorType, ImageEncoder,
    codecs::png::{CompressionType, FilterType, PngEncoder},
};

use super::colour::{self, Colour};

/// One texel: what it reflects, and its alpha (height of ground, or coverage of a leaf).
#[derive(Clone, Copy)]
pub struct Texel {
    /// Share of light reflected per channel, linear, 0 to 1.
    pub albedo: Colour,
    /// 0 to 1, stored linearly.
    pub alpha: f64,
}

/// What the alpha of a picture means.
#[derive(Clone, Copy, PartialEq)]
pub enum Alpha {
    /// Height of the ground.
    Height,
    /// How much of a texel a leaf covers; what lies beyond has no colour.
    Coverage,
}

/// A square of texels in rows from the top.
pub struct Picture {
    /// Texels along each side.
    pub side: usize,
    /// `side` × `side` texels, row by row.
    pub texels: Vec<Texel>,
    /// What each texel's alpha means.
    pub alpha: Alpha,
}

impl Picture {
    /// Ground: evaluates `texel` at the middle of each texel; both coordinates run from 0 to 1, y downwards.
    pub fn from_fn(side: usize, mut texel: impl FnMut([f64; 2]) -> Texel) -> Self {
        let middle = |index: usize| (index as f64 + 0.5) / side as f64;
        let texels = (0..side * side).map(|index| texel([middle(index % side), middle(index / side)])).collect();
        Self { side, texels, alpha: Alpha::Height }
    }

    /// How much a texel's colour counts.
    fn weight(&self, texel: &Texel) -> f64 {
        match self.alpha {
            Alpha::Height => 1.0,
            Alpha::Coverage => texel.alpha,
        }
    }

    /// Half the side, each texel the mean of four: what smooths the edges of a picture made twice too large.
    pub fn halved(&self) -> Self {
        let side = self.side / 2;
        let texels = (0..side * side)
            .map(|index| {
                let corner = index / side * 2 * self.side + index % side * 2;
                let four = [0, 1, self.side, self.side + 1].map(|step| self.texels[corner + step]);
                let weight = four.iter().map(|texel| self.weight(texel)).sum::<f64>().max(f64::MIN_POSITIVE);
                let share = |texel: &Texel| self.weight(texel) / weight;
                Texel {
                    albedo: std::array::from_fn(|c| four.iter().map(|t| share(t) * t.albedo[c]).sum()),
                    alpha: four.iter().map(|texel| texel.alpha).sum::<f64>() / 4.0,
                }
            })
            .collect();
        Self { side, texels, alpha: self.alpha }
    }

    /// Scales each channel so that the picture reflects `mean` on average.
    pub fn with_mean_albedo(mut self, mean: Colour) -> Self {
        let sum = |value: &dyn Fn(&Texel) -> f64| -> f64 { self.texels.iter().map(value).sum() };
        let weight = sum(&|texel| self.weight(texel));
        let gain: Colour =
            std::array::from_fn(|c| mean[c] * weight / sum(&|texel| self.weight(texel) * texel.albedo[c]));
        for texel in &mut self.texels {
            texel.albedo = std::array::from_fn(|c| (gain[c] * texel.albedo[c]).clamp(0.0, 1.0));
        }
        self
    }

    /// Stretches alpha, a height of any unit, to 0 to 1.
    pub fn with_full_height(mut self) -> Self {
        let heights = || self.texels.iter().map(|texel| texel.alpha);
        let lowest = heights().fold(f64::INFINITY, f64::min);
        let range = heights().fold(f64::NEG_INFINITY, f64::max) - lowest;
        for texel in &mut self.texels {
            texel.alpha = (texel.alpha - lowest) / range;
        }
        self
    }

    /// Gives transparent texels the mean colour of their nearest opaque neighbours, so that no foreign colour
    /// shows as a halo when the picture is filtered.
    pub fn with_colour_spread(mut self) -> Self {
        let mut known: Vec<bool> = self.texels.iter().map(|texel| texel.alpha > 0.0).collect();
        while known.contains(&false) && known.contains(&true) {
            let filled: Vec<(usize, Colour)> = (0..self.texels.len())
                .filter(|&index| !known[index])
                .filter_map(|index| Some((index, self.mean_of_known_neighbours(index, &known)?)))
                .collect();
            for (index, albedo) in filled {
                self.texels[index].albedo = albedo;
                known[index] = true;
            }
        }
        self
    }

    fn mean_of_known_neighbours(&self, index: usize, known: &[bool]) -> Option<Colour> {
        let (column, row) = (index % self.side, index / self.side);
        let near = |middle: usize| middle.saturating_sub(1)..=(middle + 1).min(self.side - 1);
        let neighbours: Vec<usize> = near(row)
            .flat_map(|row| near(column).map(move |column| row * self.side + column))
            .filter(|&neighbour| known[neighbour])
            .collect();
        let share = 1.0 / neighbours.len() as f64;
        let mean =
            std::array::from_fn(|c| neighbours.iter().map(|&neighbour| share * self.texels[neighbour].albedo[c]).sum());
        (!neighbours.is_empty()).then_some(mean)
    }

    /// Eight bits per channel: sRGB colour and linear alpha, rounded to multiples of `step` to keep files small.
    /// A fully covered or empty texel stays so.
    pub fn to_rgba(&self, step: u8) -> Vec<u8> {
        let rounded = |value: f64| {
            let step = f64::from(step);
            ((255.0 * value / step).round() * step).min(255.0) as u8
        };
        let bytes = |texel: &Texel| {
            let [red, green, blue] = texel.albedo.map(|channel| rounded(colour::to_srgb(channel)));
            let alpha = if texel.alpha >= 1.0 { 255 } else { rounded(texel.alpha) };
            [red, green, blue, alpha]
        };
        self.texels.iter().flat_map(bytes).collect()
    }
}

/// `rgba`, a square of `side` texels a side, as a PNG file of the smallest size.
pub fn encode_png(side: usize, rgba: &[u8]) -> Result<Vec<u8>> {
    let side = u32::try_from(side).context("the side of a picture")?;
    let mut png = Vec::new();
    PngEncoder::new_with_quality(&mut png, CompressionType::Best, FilterType::Adaptive)
        .write_image(rgba, side, side, ExtendedColorType::Rgba8)
        .context("encoding a PNG file")?;
    Ok(png)
}
