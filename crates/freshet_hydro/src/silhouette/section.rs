//! The cut of a closed mesh with the water surface.
use glam::{Vec2, Vec3};

/// The section of one or several closed meshes with the plane y = 0, and what lies below it.
///
/// The outline runs so that solid lies to its left in a picture with x to the right and z *up*: around a solid counter-
/// clockwise, around a hole clockwise. Concave bodies, holes and several shells need no further care; where shells of one
/// body overlap, they count twice, in the area as in the volume.
///
/// A vertex at exactly y = 0 counts as above, so that a mesh that merely touches the surface from above has no section.
#[derive(Clone, Debug, Default)]
pub struct Section {
    /// Directed pieces of the outline, from first to second, xz, m; in no order.
    outline: Vec<[Vec2; 2]>,
    volume: f64,
    lowest: f32,
}

impl Section {
    /// Forgets everything, and keeps the memory.
    pub fn clear(&mut self) {
        self.outline.clear();
        (self.volume, self.lowest) = (0.0, 0.0);
    }

    /// Adds a mesh of `vertices` (surface coordinates, m) and `triangles`.
    ///
    /// Triangles with a vertex that is not finite or does not exist are left out. They open the mesh, and so does a mesh
    /// that was open: where it is open at the waterline, [`Section::cover`] drops the rows in question; where it is open
    /// below, [`Section::volume`] is off by the volume between the opening and the surface.
    pub fn add(&mut self, vertices: &[Vec3], triangles: impl IntoIterator<Item = [u32; 3]>) {
        for triangle in triangles {
            let [Some(&a), Some(&b), Some(&c)] = triangle.map(|index| vertices.get(index as usize)) else { continue };
            // Most triangles are wholly above, and this is the quickest way past them.
            if a.y >= 0.0 && b.y >= 0.0 && c.y >= 0.0 {
                continue;
            }
            if a.is_finite() && b.is_finite() && c.is_finite() {
                self.add_triangle([a, b, c]);
            }
        }
    }

    fn add_triangle(&mut self, [a, b, c]: [Vec3; 3]) {
        let below = [a, b, c].map(|vertex| vertex.y < 0.0);
        // Turned, with the order kept, so that the one that is alone on its side of the surface comes first.
        let ([alone, next, last], alone_is_below) = match below {
            [false, false, false] => return,
            [true, true, true] => return self.add_wetted(a, b, c),
            [x, y, z] if y == z => ([a, b, c], x),
            [x, y, z] if x == z => ([b, c, a], y),
            [_, _, z] => ([c, a, b], z),
        };
        // Seen from outside, the outline enters a triangle where its edge rises and leaves where it falls.
        if alone_is_below {
            let (enter, leave) = (waterline(alone, next), waterline(alone, last));
            self.outline.push([xz(enter), xz(leave)]);
            self.add_wetted(alone, enter, leave);
        } else {
            let (enter, leave) = (waterline(last, alone), waterline(next, alone));
            self.outline.push([xz(enter), xz(leave)]);
            self.add_wetted(leave, next, last);
            self.add_wetted(leave, last, enter);
        }
    }

    /// Counts a wetted triangle into the volume. The field (0, y, 0) has divergence one, so the volume is its flux out
    /// through the wetted surface (Gauss); through the section it is zero. Through a triangle the flux is the mean of y,
    /// times the area of the projection to xz, which is negative where the triangle looks down.
    fn add_wetted(&mut self, a: Vec3, b: Vec3, c: Vec3) {
        let projection = 0.5 * (b - a).cross(c - a).y;
        let flux = f64::from((a.y + b.y + c.y) / 3.0) * f64::from(projection);
        if flux.is_finite() {
            self.volume += flux;
        }
        self.lowest = self.lowest.min(a.y).min(b.y).min(c.y);
    }

    /// Directed pieces of the outline (xz, m), in no order; empty for a body wholly above or wholly under water.
    pub fn outline(&self) -> &[[Vec2; 2]] {
        &self.outline
    }

    /// Displaced volume, m³: of the closed mesh below the surface.
    pub fn volume(&self) -> f32 {
        self.volume as f32
    }

    /// Depth of the lowest vertex under the surface, m, ≥ 0.
    pub fn depth(&self) -> f32 {
        -self.lowest
    }

    /// Area (m²) and centroid (xz, m) of the section; `None` without one.
    ///
    /// `A = ½ Σ a × b`, `c = Σ (a + b)(a × b) / 6A` over the directed pieces from a to b (Green), about a point of the
    /// outline, so that bodies far from the origin lose no digits.
    pub fn area_and_centroid(&self) -> Option<(f32, Vec2)> {
        let origin = self.outline.first()?[0];
        let (mut twice_area, mut moment) = (0.0, Vec2::ZERO);
        for [a, b] in &self.outline {
            let (a, b) = (a - origin, b - origin);
            let cross = a.perp_dot(b);
            twice_area += cross;
            moment += (a + b) * cross;
        }
        let centroid = origin + moment / (3.0 * twice_area);
        (twice_area > 0.0 && centroid.is_finite()).then_some((0.5 * twice_area, centroid))
    }
}

/// Where the edge from a vertex `below` the surface to one that is not crosses it. The neighbour across the edge computes
/// the same bits, so outlines close exactly.
fn waterline(below: Vec3, above: Vec3) -> Vec3 {
    below.lerp(above, below.y / (below.y - above.y)).with_y(0.0)
}

fn xz(point: Vec3) -> Vec2 {
    Vec2::new(point.x, point.z)
}
