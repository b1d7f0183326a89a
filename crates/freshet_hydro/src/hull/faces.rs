//! What the water does to faces that are wholly under it, eight at a time.
use super::{flotation::Waterplane, load::HullPoint, resistance::FaceDrag};
use crate::{
    lanes::{LANES, Lanes, Vectors},
    load::{Load, Motion, Spatial, Wrench},
};
use glam::{Mat3, Vec2, Vec3};

/// Wet triangles, of which eight are worked on at a time.
pub(super) struct Faces {
    count: usize,
    corners: [Vectors; 3],
    depths: [Lanes; 3],
    /// Velocity of the water, the sum of the corners'.
    water: Vectors,
    /// −1 for those that are to be taken away.
    signs: Lanes,
    motion: Motion,
    /// Depth that is left out of the pressure, m: over a closed surface it adds nothing but rounding.
    base: f32,
    drag: FaceDrag,
    sums: Sums,
}

impl Faces {
    pub fn new(motion: Motion, base: f32, drag: FaceDrag) -> Self {
        Self {
            count: 0,
            corners: [Vectors::ZERO; 3],
            depths: [Lanes::ZERO; 3],
            water: Vectors::ZERO,
            signs: Lanes::ZERO,
            motion,
            base,
            drag,
            sums: Sums::ZERO,
        }
    }

    #[inline(always)]
    pub fn push(&mut self, corners: [&HullPoint; 3], sign: f32) {
        let lane = self.count;
        for (k, corner) in corners.into_iter().enumerate() {
            self.corners[k].set(lane, corner.arm);
            self.depths[k].0[lane] = corner.depth;
        }
        self.water.set(lane, corners[0].velocity + corners[1].velocity + corners[2].velocity);
        self.signs.0[lane] = sign;
        self.count += 1;
        if self.count == LANES {
            self.work();
        }
    }

    /// The sums over all faces.
    #[inline(always)]
    pub fn finish(mut self) -> Sums {
        if self.count > 0 {
            self.work();
        }
        self.sums
    }

    /// Adds the faces at hand to the sums. Lanes without a face have no area.
    #[inline(always)]
    fn work(&mut self) {
        let [a, b, c] = self.corners;
        let [da, db, dc] = self.depths;
        let (e, f) = (b - a, c - a);
        let vector = e.cross(f) * Lanes::splat(0.5);
        let third = Lanes::splat(1.0 / 3.0);
        let middle = (a + b + c) * third;
        let depth = da + db + dc;
        self.sums.add_pressure(vector, [a, b, c], [da, db, dc].map(|depth| depth - Lanes::splat(self.base)));
        self.sums.add_waterplane(-vector.y, [a, b, c], middle);

        let area = vector.dot(vector).sqrt();
        let normal = vector * (Lanes::splat(1.0) / area.at_least(1e-30));
        let water = self.water * third;
        let turned = Vectors::splat(self.motion.angular).cross(middle);
        let relative = water - Vectors::splat(self.motion.linear) - turned;
        let [tangential, along] = self.drag.at(normal, depth * third, relative);
        let area = area * self.signs;
        self.sums.add_resistance(normal, middle, water, along * area, tangential * area);
        self.sums.area += area;
        self.sums.water += water * area;
        self.count = 0;
        self.corners = [Vectors::ZERO; 3];
        self.depths = [Lanes::ZERO; 3];
    }
}

/// A symmetric matrix: xx, yy, zz, xy, yz, zx.
type Symmetric = [Lanes; 6];

/// What faces add up to.
pub(super) struct Sums {
    /// Of the pressure, over ρ g.
    push: Vectors,
    push_torque: Vectors,
    /// Depth over the submerged volume, m⁴.
    depths: Lanes,
    /// The waterplane's area, its first moments, and ∫ x², ∫ z², ∫ x z.
    plane: Lanes,
    plane_first: [Lanes; 2],
    plane_second: [Lanes; 3],
    /// Resistance along the normals: Σ k n nᵀ, Σ k l nᵀ (by columns) and Σ k l lᵀ with the levers l = r × n.
    linear: Symmetric,
    coupling: [Vectors; 3],
    angular: Symmetric,
    /// Resistance in every direction: Σ k, Σ k r and Σ k r rᵀ.
    friction: Lanes,
    friction_first: Vectors,
    friction_second: Symmetric,
    /// Of the moving water on a body held still.
    stream: Vectors,
    stream_torque: Vectors,
    area: Lanes,
    /// Velocity of the water times area.
    water: Vectors,
}

/// Adds `k` v vᵀ.
#[inline(always)]
fn add_square(sum: &mut Symmetric, k: Lanes, v: Vectors) {
    let scaled = v * k;
    let products = [scaled.x * v.x, scaled.y * v.y, scaled.z * v.z, scaled.x * v.y, scaled.y * v.z, scaled.z * v.x];
    for (sum, product) in sum.iter_mut().zip(products) {
        *sum += product;
    }
}

fn matrix(of: &Symmetric) -> Mat3 {
    let [xx, yy, zz, xy, yz, zx] = of.map(Lanes::sum);
    Mat3::from_cols(Vec3::new(xx, xy, zx), Vec3::new(xy, yy, yz), Vec3::new(zx, yz, zz))
}

impl Sums {
    const ZERO: Self = Self {
        push: Vectors::ZERO,
        push_torque: Vectors::ZERO,
        depths: Lanes::ZERO,
        plane: Lanes::ZERO,
        plane_first: [Lanes::ZERO; 2],
        plane_second: [Lanes::ZERO; 3],
        linear: [Lanes::ZERO; 6],
        coupling: [Vectors::ZERO; 3],
        angular: [Lanes::ZERO; 6],
        friction: Lanes::ZERO,
        friction_first: Vectors::ZERO,
        friction_second: [Lanes::ZERO; 6],
        stream: Vectors::ZERO,
        stream_torque: Vectors::ZERO,
        area: Lanes::ZERO,
        water: Vectors::ZERO,
    };

    /// **F**/(ρ g) = −(S/3) **A** at Σ p_i (d_i + S)/(4 S), and ∫ d dV = −∮ ½ d² n_y dA with ∫ d² dA = A (Σ d_i² + S²)/12.
    #[inline(always)]
    fn add_pressure(&mut self, vector: Vectors, [a, b, c]: [Vectors; 3], [da, db, dc]: [Lanes; 3]) {
        let depth = da + db + dc;
        let push = vector * (depth * (-1.0 / 3.0));
        let weighted = a * (da + depth) + b * (db + depth) + c * (dc + depth);
        let centre = weighted * (Lanes::splat(0.25) / depth.at_least(1e-30));
        self.push += push;
        self.push_torque += centre.cross(push);
        let squares = da * da + db * db + dc * dc + depth * depth;
        self.depths += vector.y * squares * (-1.0 / 24.0);
    }

    /// ∫ x x dA = A (Σ x_i² + 9 x_m²)/12 over a triangle with the middle x_m.
    #[inline(always)]
    fn add_waterplane(&mut self, area: Lanes, [a, b, c]: [Vectors; 3], middle: Vectors) {
        let twelfth = area * (1.0 / 12.0);
        let mean = |p: Lanes, q: Lanes, r: Lanes, m: Lanes| (p + q + r + m * 9.0) * twelfth;
        self.plane += area;
        self.plane_first[0] += area * middle.x;
        self.plane_first[1] += area * middle.z;
        self.plane_second[0] += mean(a.x * a.x, b.x * b.x, c.x * c.x, middle.x * middle.x);
        self.plane_second[1] += mean(a.z * a.z, b.z * b.z, c.z * c.z, middle.z * middle.z);
        self.plane_second[2] += mean(a.x * a.z, b.x * b.z, c.x * c.z, middle.x * middle.z);
    }

    /// Faces that answer their velocity with `along` of it along their normal, and with `tangential` of it in every direction.
    #[inline(always)]
    fn add_resistance(&mut self, normal: Vectors, middle: Vectors, water: Vectors, along: Lanes, tangential: Lanes) {
        let lever = middle.cross(normal);
        add_square(&mut self.linear, along, normal);
        add_square(&mut self.angular, along, lever);
        let scaled = lever * along;
        self.coupling[0] += scaled * normal.x;
        self.coupling[1] += scaled * normal.y;
        self.coupling[2] += scaled * normal.z;
        self.friction += tangential;
        self.friction_first += middle * tangential;
        add_square(&mut self.friction_second, tangential, middle);
        let met = normal.dot(water);
        self.stream += normal * (along * met) + water * tangential;
        self.stream_torque += scaled * met + middle.cross(water) * tangential;
    }

    /// Force and torque of the pressure over ρ g, m³ and m⁴.
    pub fn push(&self) -> (Vec3, Vec3) {
        (self.push.sum(), self.push_torque.sum())
    }

    /// Depth integrated over the submerged volume, m⁴, if `base` (m) was left out of it.
    pub fn depths(&self, base: f32) -> f32 {
        self.depths.sum() + base * self.push.y.sum()
    }

    /// The load that they make, without added mass.
    pub fn load(&self, weight: f32) -> Load {
        let area = self.area.sum();
        let (force, torque) = self.push();
        let mut load = Load {
            pressure: Wrench { force, torque } * weight,
            stream: Wrench { force: self.stream.sum(), torque: self.stream_torque.sum() },
            resistance: self.resistance(),
            // The pressure's push is ρ g V upwards under any surface.
            submerged_volume: force.y.max(0.0),
            wetted_area: area,
            water_velocity: self.water.sum() / area.max(1e-30),
            ..Load::default()
        };
        self.add_stiffness(&mut load, weight);
        load
    }

    /// With Σ k (1, \[r\], \[r\] \[r\]ᵀ) for what answers in every direction, where \[r\] \[r\]ᵀ = |r|² − r rᵀ.
    fn resistance(&self) -> Spatial {
        let (sum, r, second) = (self.friction.sum(), self.friction_first.sum(), matrix(&self.friction_second));
        let trace = second.x_axis.x + second.y_axis.y + second.z_axis.z;
        let cross = Mat3::from_cols(Vec3::new(0.0, r.z, -r.y), Vec3::new(-r.z, 0.0, r.x), Vec3::new(r.y, -r.x, 0.0));
        let [x, y, z] = self.coupling.map(Vectors::sum);
        Spatial {
            linear: matrix(&self.linear) + Mat3::from_diagonal(Vec3::splat(sum)),
            coupling: Mat3::from_cols(x, y, z) + cross,
            angular: matrix(&self.angular) + Mat3::from_diagonal(Vec3::splat(trace)) - second,
        }
    }

    /// The area in which the surface cuts the hull, seen from the centre of mass: what the wet faces, seen from above, lack to a closed
    /// surface. None for hulls that are wholly submerged.
    pub fn waterplane(&self) -> Option<Waterplane> {
        let area = self.plane.sum();
        // Wholly submerged hulls have none but what rounding leaves.
        if area <= 1e-5 * self.area.sum() {
            return None;
        }
        let centre = Vec2::from_array(self.plane_first.map(Lanes::sum)) / area;
        let [xx, zz, xz] = self.plane_second.map(Lanes::sum);
        // About the middle of the waterplane, and never less than none.
        let xx = (xx - area * centre.x * centre.x).max(0.0);
        let zz = (zz - area * centre.y * centre.y).max(0.0);
        let most = (xx * zz).sqrt();
        let xz = (xz - area * centre.x * centre.y).clamp(-most, most);
        Some(Waterplane { area, centre, second_moments: [xx, zz, xz] })
    }

    /// A point of the waterplane at (x, z) answers y with −ρ g y, at the lever r × ŷ = (−z, 0, x).
    fn add_stiffness(&self, load: &mut Load, weight: f32) {
        let Some(Waterplane { area, centre, second_moments: [xx, zz, xz] }) = self.waterplane() else { return };
        load.waterplane_area = area;
        load.stiffness.add_along(weight * area, Vec3::Y, Vec3::new(centre.x, 0.0, centre.y));
        let turned = Mat3::from_cols(Vec3::new(zz, 0.0, -xz), Vec3::ZERO, Vec3::new(-xz, 0.0, xx));
        load.stiffness.angular += turned * weight;
    }
}
