//! Pictures as video has them: brightness and two differences of colour, after ITU-R BT.709 (2015), table 3 and 4.
//!
//! With R′, G′ and B′ from 0 to 1, E′_Y = 0.2126 R′ + 0.7152 G′ + 0.0722 B′, E′_CB = (B′ − E′_Y) / 1.8556 and
//! E′_CR = (R′ − E′_Y) / 1.5748; as 8 bits in the limited range D′_Y = 219 E′_Y + 16 and D′_C = 224 E′_C + 128.
use image::RgbImage;

/// A picture in three planes, row by row; the last two have half as many columns and rows, rounded up.
#[derive(Debug, PartialEq, Eq)]
pub struct Yuv {
    pub planes: [Vec<u8>; 3],
    /// Columns of each plane.
    pub widths: [usize; 3],
}

impl Yuv {
    /// The planes of a picture in sRGB. Differences of colour lie on every second column, between two rows.
    pub fn new(picture: &RgbImage) -> Self {
        let (width, height) = (picture.width() as usize, picture.height() as usize);
        let pixels: Vec<[f32; 3]> = picture.pixels().map(|pixel| differences(pixel.0)).collect();
        let brightness = pixels.iter().map(|[y, ..]| (219.0 * y + 16.5) as u8).collect();
        let half = (width.div_ceil(2), height.div_ceil(2));
        let plane = |channel: usize| {
            let places = (0..half.1).flat_map(|row| (0..half.0).map(move |column| (2 * column, 2 * row)));
            let value = |(x, y): (usize, usize)| {
                // On the column of the sample, with half of its neighbours; over its two rows. The rim goes on.
                let columns = [(x.saturating_sub(1), 0.125), (x, 0.25), ((x + 1).min(width - 1), 0.125)];
                let rows = [y, (y + 1).min(height - 1)];
                let parts =
                    rows.into_iter().flat_map(|y| columns.map(|(x, share)| share * pixels[y * width + x][channel]));
                (224.0 * parts.sum::<f32>() + 128.5) as u8
            };
            places.map(value).collect()
        };
        Self { planes: [brightness, plane(1), plane(2)], widths: [width, half.0, half.0] }
    }
}

/// E′_Y (0…1), E′_CB and E′_CR (−½…½).
fn differences(pixel: [u8; 3]) -> [f32; 3] {
    let [r, g, b] = pixel.map(|channel| f32::from(channel) / 255.0);
    let y = 0.2126 * r + 0.7152 * g + 0.0722 * b;
    [y, (b - y) / 1.8556, (r - y) / 1.5748]
}

#[cfg(test)]
mod tests {
    use super::*;
    use image::Rgb;

    #[test]
    fn colour_bars_are_those_of_the_standard() {
        // 100 % bars in 8 bits, rounded from the formulas of BT.709.
        let bars = [
            ([255, 255, 255], [235, 128, 128]),
            ([0, 0, 0], [16, 128, 128]),
            ([255, 0, 0], [63, 102, 240]),
            ([0, 255, 0], [173, 42, 26]),
            ([0, 0, 255], [32, 240, 118]),
            ([255, 255, 0], [219, 16, 138]),
        ];
        for (color, expected) in bars {
            let yuv = Yuv::new(&RgbImage::from_pixel(4, 4, Rgb(color)));
            for (plane, value) in yuv.planes.iter().zip(expected) {
                assert!(plane.iter().all(|found| *found == value), "{color:?}: {plane:?}, expected {value}");
            }
        }
    }

    #[test]
    fn odd_sizes_have_colour_up_to_their_rims() {
        let yuv = Yuv::new(&RgbImage::from_pixel(5, 3, Rgb([255, 0, 0])));
        assert_eq!(yuv.widths, [5, 3, 3]);
        assert_eq!(yuv.planes.each_ref().map(Vec::len), [15, 6, 6]);
        assert!(yuv.planes[2].iter().all(|red| *red == 240));
    }

    #[test]
    fn colour_lies_on_every_second_column() {
        // One red column; the samples on both sides of it have a quarter each if it lies between them, one has a half on it.
        let column = |at: u32| RgbImage::from_fn(8, 2, |x, _| Rgb(if x == at { [255, 0, 0] } else { [0, 0, 0] }));
        assert_eq!(Yuv::new(&column(4)).planes[2], [128, 128, 184, 128]);
        assert_eq!(Yuv::new(&column(3)).planes[2], [128, 156, 156, 128]);
    }
}
