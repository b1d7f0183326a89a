//! World files: six numbers that say where a picture lies on the map.
use bevy::math::{DVec2, UVec2, dvec2};
use freshet_flood::georeference::Georeference;
use std::path::{Path, PathBuf};

/// Where a picture lies on the map.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place {
    /// North-western corner of the picture: (easting, northing).
    pub north_west: DVec2,
    /// Sides of a pixel, above zero.
    pub pixel: DVec2,
}

/// Endings of world files, by those of pictures.
const ENDINGS: [(&str, &[&str]); 3] =
    [("png", &["pgw", "pngw", "wld"]), ("jpg", &["jgw", "jpgw", "wld"]), ("jpeg", &["jgw", "jpegw", "wld"])];

impl Place {
    /// All of a raster, for a picture of `size` pixels.
    pub fn over(map: &Georeference, size: UVec2) -> Self {
        let extent = map.size.as_dvec2() * map.cell_size;
        Self { north_west: map.corner + dvec2(0.0, extent.y), pixel: extent / size.as_dvec2() }
    }

    /// The world file beside a picture, if there is one.
    pub fn file(picture: &Path) -> Option<PathBuf> {
        let ending = picture.extension()?.to_str()?.to_ascii_lowercase();
        let (_, worlds) = ENDINGS.iter().find(|(picture, _)| *picture == ending)?;
        let files = worlds.iter().flat_map(|world| [world.to_string(), world.to_ascii_uppercase()]);
        files.map(|world| picture.with_extension(world)).find(|file| file.is_file())
    }

    /// Reads a world file:
    /// ```text
    /// A, D, B, E   x = A column + B row + C
    /// C, F         y = D column + E row + F,   from the middle of the north-western pixel on
    /// ```
    ///
    /// # Errors
    /// What was expected and found.
    pub fn parse(text: &str) -> Result<Self, String> {
        let numbers: Vec<&str> = text.split_whitespace().collect();
        let parsed = numbers.iter().map(|word| {
            let number = word.replace(',', ".").parse::<f64>().ok().filter(|number| number.is_finite());
            number.ok_or_else(|| format!("expected a number, found {word:?}"))
        });
        let parsed = parsed.collect::<Result<Vec<f64>, _>>()?;
        let [a, d, b, e, c, f] = parsed[..] else {
            return Err(format!("expected 6 numbers, found {}", parsed.len()));
        };
        if (d, b) != (0.0, 0.0) {
            return Err(format!("expected no rotation (0 and 0 on the second and third line), found {d} and {b}"));
        }
        if !(a > 0.0 && e < 0.0) {
            return Err(format!(
                "expected a picture with north at its top (a width above 0 and a height below 0 on the first and fourth line), \
                 found {a} and {e}"
            ));
        }
        let pixel = dvec2(a, -e);
        Ok(Self { north_west: dvec2(c, f) + pixel * dvec2(-0.5, 0.5), pixel })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_those_of_the_middle_of_the_first_pixel() {
        let place = Place::parse("0.5\n0.0\n0\n-0.5\n105000.25\n530999.75\n").unwrap();
        assert_eq!(place, Place { north_west: dvec2(105_000.0, 531_000.0), pixel: dvec2(0.5, 0.5) });
        // As written where a comma parts whole numbers from fractions.
        assert_eq!(Place::parse("0,5 0 0 -0,5 105000,25 530999,75"), Ok(place));
    }

    #[test]
    fn what_cannot_be_drawn_is_said() {
        for (text, expected) in [
            ("", "expected 6 numbers, found 0"),
            ("1 0 0 -1 5", "expected 6 numbers, found 5"),
            ("1 0 0 -1 5 5 5", "found 7"),
            ("1 0 0 -1 five 5", "expected a number, found \"five\""),
            ("1 0 0 -1 nan 5", "expected a number, found \"nan\""),
            ("1 0.1 -0.1 -1 5 5", "expected no rotation (0 and 0 on the second and third line), found 0.1 and -0.1"),
            ("1 0 0 1 5 5", "north at its top"),
            ("0 0 0 -1 5 5", "north at its top"),
        ] {
            let problem = Place::parse(text).unwrap_err();
            assert!(problem.contains(expected), "{text:?}: {problem}");
        }
    }

    #[test]
    fn without_a_world_file_a_picture_lies_over_everything() {
        let map = Georeference { corner: dvec2(100.0, 50.0), cell_size: 2.0, size: UVec2::new(30, 20) };
        let place = Place::over(&map, UVec2::new(120, 40));
        assert_eq!(place, Place { north_west: dvec2(100.0, 90.0), pixel: dvec2(0.5, 1.0) });
    }
}
