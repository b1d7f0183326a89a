//! Blades, leaves and stems: ribbons along curves, drawn with depth into a picture.

use super::{
    colour::{Colour, mix},
    picture::{Alpha, Picture, Texel},
};

/// x and y as shares of the picture, y downwards; z towards the viewer.
pub type Point = [f64; 3];

/// A quadratic Bézier curve: root, control point and tip.
#[derive(Clone, Copy)]
pub struct Curve(pub [Point; 3]);

impl Curve {
    /// The point at a share of the way from root to tip.
    pub fn at(&self, along: f64) -> Point {
        let [root, control, tip] = self.0;
        mix(mix(root, control, along), mix(control, tip, along), along)
    }

    /// The direction there, in the plane of the picture, of length 1.
    fn heading(&self, along: f64) -> [f64; 2] {
        let [root, control, tip] = self.0;
        let [x, y, _] = std::array::from_fn(|i| (1.0 - along) * (control[i] - root[i]) + along * (tip[i] - control[i]));
        let length = (x * x + y * y).sqrt().max(f64::MIN_POSITIVE);
        [x / length, y / length]
    }

    /// An upper bound of the length in the plane of the picture.
    fn length(&self) -> f64 {
        let [root, control, tip] = self.0;
        let distance = |from: Point, to: Point| {
            let (x, y) = (to[0] - from[0], to[1] - from[1]);
            (x * x + y * y).sqrt()
        };
        distance(root, control) + distance(control, tip)
    }
}

/// A flat strip along a curve.
#[derive(Clone, Copy)]
pub struct Ribbon {
    /// Its middle line.
    pub curve: Curve,
    /// Greatest width, as a share of the picture.
    pub width: f64,
    /// Share of `width` at a share of the way from root to tip.
    pub outline: fn(f64) -> f64,
}

/// A place on a ribbon.
#[derive(Clone, Copy)]
pub struct Place {
    /// 0 at the root, 1 at the tip.
    pub along: f64,
    /// −1 at the left edge, 1 at the right.
    pub across: f64,
    /// Towards the viewer.
    pub z: f64,
}

impl Place {
    /// Brightness of a blade folded along its middle: `vein` on the fold, lighter by `fold` on the right.
    pub fn folded(&self, vein: f64, fold: f64) -> f64 {
        let on_vein = if self.across.abs() < 0.16 { vein } else { 1.0 };
        on_vein * (1.0 + fold * self.across.signum())
    }
}

/// A picture being drawn; its alpha is the z of what has been drawn, or −∞.
pub struct Canvas(Picture);

impl Canvas {
    /// An empty canvas of `side` × `side` texels, for a cut-out; ribbons end at its edges.
    pub fn clear(side: usize) -> Self {
        let nothing = Texel { albedo: [0.0; 3], alpha: f64::NEG_INFINITY };
        Self(Picture { side, texels: vec![nothing; side * side], alpha: Alpha::Coverage })
    }

    /// Starts from a tile of ground; ribbons that leave it come in again on the other side.
    pub fn over(ground: Picture) -> Self {
        Self(ground)
    }

    /// Draws a ribbon where nothing nearer to the viewer has been drawn, coloured by `shade`.
    pub fn draw(&mut self, ribbon: &Ribbon, shade: impl Fn(Place) -> Colour) {
        // Points half a texel apart leave no holes.
        let density = 2.0 * self.0.side as f64;
        let steps = (ribbon.curve.length() * density).ceil().max(1.0) as usize;
        for step in 0..=steps {
            let along = step as f64 / steps as f64;
            let [middle_x, middle_y, z] = ribbon.curve.at(along);
            let [heading_x, heading_y] = ribbon.curve.heading(along);
            let half = 0.5 * ribbon.width * (ribbon.outline)(along);
            let side_steps = (2.0 * half * density).ceil() as usize;
            for side_step in 0..=side_steps {
                let across = if side_steps == 0 { 0.0 } else { 2.0 * side_step as f64 / side_steps as f64 - 1.0 };
                let (x, y) = (middle_x - heading_y * half * across, middle_y + heading_x * half * across);
                let place = Place { along, across, z };
                if let Some(texel) = self.texel(x, y)
                    && texel.alpha < place.z
                {
                    *texel = Texel { albedo: shade(place), alpha: place.z };
                }
            }
        }
    }

    fn texel(&mut self, x: f64, y: f64) -> Option<&mut Texel> {
        let side = self.0.side as isize;
        let [column, row] = [x, y].map(|share| (share * side as f64).floor() as isize);
        let inside = (0..side).contains(&column) && (0..side).contains(&row);
        if self.0.alpha == Alpha::Coverage && !inside {
            return None;
        }
        let index = row.rem_euclid(side) * side + column.rem_euclid(side);
        self.0.texels.get_mut(index as usize)
    }

    /// The picture; of a cut-out, all that was drawn is covered.
    pub fn finish(self) -> Picture {
        let mut picture = self.0;
        if picture.alpha == Alpha::Coverage {
            for texel in &mut picture.texels {
                texel.alpha = if texel.alpha.is_finite() { 1.0 } else { 0.0 };
            }
        }
        picture
    }
}
