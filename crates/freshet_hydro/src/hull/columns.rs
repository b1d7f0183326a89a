//! The room that a hull takes up in the water, cell by cell of a raster.
//!
//! The column of displaced water in a cell is the integral over the cell of the depth d of the hull's underside less that of its upper
//! side, both counted from the surface. Every wet triangle adds the integral of d over its projection, positive if it looks down and
//! negative if it looks up; projections are cut along the lines of the raster, and d is linear over each piece, so nothing is
//! approximated. What parts of a union have in common is wound the other way round, and comes out right by itself.
use super::Hull;
use crate::grid::Raster;
use glam::{Affine3A, IVec2, UVec2, Vec2, Vec3};

/// A plane surface: its height at x = z = 0 (m), and its slope along x and z.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct SurfacePlane {
    /// Height at x = z = 0, m.
    pub height: f32,
    /// Slope along x and z.
    pub slope: Vec2,
}

impl SurfacePlane {
    /// Height at (x, z), m.
    pub fn at(&self, place: Vec2) -> f32 {
        self.height + self.slope.dot(place)
    }
}

/// What a hull displaces in every cell of a raster, by [`Columns::rasterise`]. It keeps its room from one time to the next.
#[derive(Debug, Clone, Default)]
pub struct Columns {
    /// First cell of the window that the hull is in, and how many there are.
    first: UVec2,
    size: UVec2,
    /// Displaced volume of every cell of the window, m³.
    volumes: Vec<f64>,
    /// Points of the hull: x and z from the window's corner in cells, and between them the depth below the surface, m.
    points: Vec<Vec3>,
}

impl Columns {
    /// Cuts what lies under the `surface` of `hull`, whose pose is `from_body` in the frame of `raster`, into columns.
    ///
    /// What lies outside the raster is left out. A pose that is not finite leaves nothing.
    pub fn rasterise(&mut self, hull: &Hull, from_body: Affine3A, surface: &SurfacePlane, raster: &Raster) {
        self.clear();
        self.points.extend(hull.points.iter().map(|point| {
            let point = from_body.transform_point3(*point);
            let place = Vec2::new(point.x, point.z);
            let at = (place - raster.origin) / raster.cell;
            Vec3::new(at.x, surface.at(place) - point.y, at.y)
        }));
        if !self.points.iter().all(|point| point.is_finite()) {
            return;
        }
        self.choose_window(raster.size);
        if self.volumes.is_empty() {
            return;
        }
        let corner = Vec3::new(self.first.x as f32, 0.0, self.first.y as f32);
        self.points.iter_mut().for_each(|point| *point -= corner);
        let area = f64::from(raster.cell) * f64::from(raster.cell);
        for triangle in &hull.triangles {
            self.add(triangle.map(|point| self.points[point as usize]), area);
        }
    }

    /// Forgets all columns.
    pub fn clear(&mut self) {
        self.points.clear();
        self.volumes.clear();
        self.size = UVec2::ZERO;
    }

    /// The window of cells that the hull is in, if any of it is wet.
    fn choose_window(&mut self, raster: UVec2) {
        let places = || self.points.iter().map(|point| Vec2::new(point.x, point.z));
        let least = places().fold(Vec2::INFINITY, Vec2::min).max(Vec2::ZERO);
        let most = places().fold(Vec2::NEG_INFINITY, Vec2::max).min(raster.as_vec2());
        if least.cmplt(most).all() && self.points.iter().any(|point| point.y > 0.0) {
            self.first = least.floor().as_uvec2().min(raster - 1);
            self.size = most.ceil().as_uvec2().clamp(self.first + 1, raster) - self.first;
            self.volumes.resize((self.size.x * self.size.y) as usize, 0.0);
        }
    }

    fn add(&mut self, triangle: [Vec3; 3], area: f64) {
        if triangle.iter().all(|point| point.y <= 0.0) {
            return;
        }
        let mut wet = Polygon::from(triangle);
        if triangle.iter().any(|point| point.y < 0.0) {
            wet = wet.split(1, 0.0).1;
        }
        let (least, most) = wet.cells();
        let last = self.size.as_ivec2() - 1;
        let (least, most) = (least.max(IVec2::ZERO), most.min(last));
        if least == most && wet.cells() == (least, most) {
            self.put(least, wet.integral() * area);
            return;
        }
        let mut rest = if wet.cells().0.y < 0 { wet.split(2, 0.0).1 } else { wet };
        for row in least.y..=most.y {
            let (slab, beyond) = rest.split(2, (row + 1) as f32);
            rest = beyond;
            let mut slab = if slab.cells().0.x < 0 { slab.split(0, 0.0).1 } else { slab };
            for column in least.x..=most.x {
                let (piece, beyond) = slab.split(0, (column + 1) as f32);
                slab = beyond;
                self.put(IVec2::new(column, row), piece.integral() * area);
            }
        }
    }

    fn put(&mut self, cell: IVec2, volume: f64) {
        self.volumes[cell.y as usize * self.size.x as usize + cell.x as usize] += volume;
    }

    /// Cells of the raster with what is displaced in them, m³, row by row. A hull that is closed displaces nothing negative but for
    /// rounding, which is left out.
    pub fn cells(&self) -> impl Iterator<Item = (UVec2, f32)> {
        let width = self.size.x.max(1) as usize;
        let cells = self.volumes.iter().enumerate();
        cells.filter(|(_, volume)| **volume > 0.0).map(move |(i, &volume)| {
            let within = UVec2::new((i % width) as u32, (i / width) as u32);
            (self.first + within, volume as f32)
        })
    }

    /// All that is displaced within the raster, m³.
    pub fn volume(&self) -> f64 {
        self.volumes.iter().sum()
    }
}

/// Most corners of a piece: a triangle that has been cut by the surface and four lines.
const MOST: usize = 8;

/// A piece of a triangle.
#[derive(Clone, Copy)]
struct Polygon {
    corners: [Vec3; MOST],
    count: usize,
}

impl From<[Vec3; 3]> for Polygon {
    fn from([a, b, c]: [Vec3; 3]) -> Self {
        let mut polygon = Self { corners: [Vec3::ZERO; MOST], count: 3 };
        polygon.corners[..3].copy_from_slice(&[a, b, c]);
        polygon
    }
}

impl Polygon {
    fn corners(&self) -> &[Vec3] {
        &self.corners[..self.count]
    }

    fn push(&mut self, corner: Vec3) {
        if self.count < MOST {
            self.corners[self.count] = corner;
            self.count += 1;
        }
    }

    /// The parts on which this coordinate is below and above `at`.
    fn split(&self, axis: usize, at: f32) -> (Self, Self) {
        let none = Self { corners: [Vec3::ZERO; MOST], count: 0 };
        let (mut below, mut above) = (none, none);
        for (i, &from) in self.corners().iter().enumerate() {
            let to = self.corners[(i + 1) % self.count];
            let (near, far) = (from[axis] - at, to[axis] - at);
            if near <= 0.0 {
                below.push(from);
            }
            if near >= 0.0 {
                above.push(from);
            }
            if near * far < 0.0 {
                let mut crossing = from.lerp(to, near / (near - far));
                crossing[axis] = at;
                below.push(crossing);
                above.push(crossing);
            }
        }
        (below, above)
    }

    /// First and last cell that it may be in. What only touches the next cell is not in it.
    fn cells(&self) -> (IVec2, IVec2) {
        let place = |point: &Vec3| Vec2::new(point.x, point.z);
        let least = self.corners().iter().map(place).fold(Vec2::INFINITY, Vec2::min).floor().as_ivec2();
        let most = self
            .corners()
            .iter()
            .map(place)
            .fold(Vec2::NEG_INFINITY, Vec2::max)
            .ceil()
            .as_ivec2()
            .saturating_sub(IVec2::ONE);
        (least, most.max(least))
    }

    /// Integral of the depth over the projection to x and z, in m times cells; positive if the outside is below.
    fn integral(&self) -> f64 {
        let Some((&a, rest)) = self.corners().split_first() else { return 0.0 };
        let fan = rest.windows(2).map(|pair| {
            let (b, c) = (pair[0] - a, pair[1] - a);
            f64::from(b.x * c.z - b.z * c.x) * f64::from(a.y + (b.y + c.y) / 3.0)
        });
        0.5 * fan.sum::<f64>()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::load::{BodyState, Fluid, Pose, Surface};
    use glam::Quat;
    use proptest::prelude::*;

    const RASTER: Raster = Raster { origin: Vec2::new(-4.0, -3.0), cell: 0.25, size: UVec2::new(32, 24) };

    fn columns(hull: &Hull, turn: Quat, at: Vec3, surface: SurfacePlane) -> Columns {
        let mut columns = Columns::default();
        columns.rasterise(hull, Affine3A::from_rotation_translation(turn, at), &surface, &RASTER);
        columns
    }

    #[test]
    fn a_box_stands_in_its_cells_as_deep_as_it_is_drawn() {
        let hull = Hull::cuboid(Vec3::new(0.5, 0.4, 0.3)).unwrap();
        // Its sides are at −0.5, 0.5 and −0.3, 0.3; its keel 0.25 m under the surface.
        let columns = columns(&hull, Quat::IDENTITY, Vec3::new(0.0, 0.15, 0.0), SurfacePlane::default());
        let mut count = 0;
        for (cell, volume) in columns.cells() {
            count += 1;
            let north = RASTER.origin.y + 0.25 * cell.y as f32;
            let wide = (north + 0.25).min(0.3) - north.max(-0.3);
            assert!((volume - 0.25 * 0.25 * wide).abs() < 1e-7, "{cell}: {volume}");
        }
        assert_eq!(count, 4 * 4);
        assert!((columns.volume() - 0.25 * 0.6).abs() < 1e-7);
    }

    #[test]
    fn a_diving_body_leaves_its_upper_side_out() {
        let hull = Hull::ball(0.6).unwrap();
        let columns = columns(&hull, Quat::IDENTITY, Vec3::new(0.3, -2.0, 0.1), SurfacePlane::default());
        assert!((columns.volume() / f64::from(hull.volume()) - 1.0).abs() < 1e-6);
        let deepest = columns.cells().map(|(_, volume)| volume).fold(0.0, f32::max) / 0.0625;
        assert!(deepest < 1.21 && deepest > 1.1, "{deepest}");
    }

    #[test]
    fn what_is_outside_the_raster_or_above_the_water_is_left_out() {
        let hull = Hull::cuboid(Vec3::splat(0.5)).unwrap();
        let half_out = columns(&hull, Quat::IDENTITY, Vec3::new(4.0, 0.0, 0.1), SurfacePlane::default());
        assert!((half_out.volume() - 0.25).abs() < 1e-6, "{}", half_out.volume());
        let corner = columns(&hull, Quat::IDENTITY, Vec3::new(-4.1, 0.0, -3.2), SurfacePlane::default());
        assert!((corner.volume() - 0.5 * 0.4 * 0.3).abs() < 1e-6, "{}", corner.volume());
        for at in [Vec3::new(0.0, 0.6, 0.0), Vec3::new(9.0, 0.0, 0.0), Vec3::new(0.0, f32::NAN, 0.0)] {
            let none = columns(&hull, Quat::IDENTITY, at, SurfacePlane::default());
            assert_eq!((none.cells().count(), none.volume()), (0, 0.0));
        }
    }

    proptest! {
        /// Against the pressure over the hull, which is ρ g V.
        #[test]
        fn columns_hold_what_the_pressure_carries(
            turn in prop::array::uniform4(-1.0_f32..1.0),
            at in prop::array::uniform3(-1.0_f32..1.0),
            slope in prop::array::uniform2(-0.2_f32..0.2),
        ) {
            let turn = Quat::from_array(turn);
            prop_assume!(turn.length() > 0.1);
            let (turn, at) = (turn.normalize(), Vec3::from_array(at));
            let capsule = Hull::capsule(0.3, 0.4).unwrap();
            let hull = Hull::union(vec![Hull::cuboid(Vec3::new(0.7, 0.3, 0.4)).unwrap(), capsule]).unwrap().hull;
            let surface = SurfacePlane { height: 0.1, slope: Vec2::from_array(slope) };
            let columns = columns(&hull, turn, at, surface);
            let body = BodyState { pose: Pose { position: at, rotation: turn }, centre: at, ..BodyState::default() };
            let water = |place| Some(Surface { height: surface.at(place), slope: surface.slope, velocity: Vec3::ZERO });
            let load = hull.load(&body, &Fluid::default(), &super::super::HullDrag::default(), &mut Vec::new(), water);
            let expected = f64::from(load.submerged_volume);
            prop_assert!((columns.volume() - expected).abs() < 2e-6, "{} for {expected}", columns.volume());
        }
    }
}
