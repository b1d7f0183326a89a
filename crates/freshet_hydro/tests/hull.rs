//! Hulls against Archimedes and naval architecture, and motion against the formulas of falling, bobbing and drifting bodies.
use freshet_hydro::{
    hull::{Hull, HullDrag, HullPoint, VISCOSITY, friction_coefficient},
    load::{BodyState, Fluid, Inertia, Load, Motion, Pose, Surface, Wrench},
    waves::{GRAVITY, WATER_DENSITY},
};
use glam::{DVec3, EulerRot, Mat3, Quat, Vec2, Vec3, vec2, vec3};
use proptest::prelude::*;
use std::f32::consts::{PI, TAU};

/// Weight of a cubic metre of water, N.
const WEIGHT: f32 = WATER_DENSITY * GRAVITY;

/// No resistance at all.
const SLICK: HullDrag = HullDrag { friction: 0.0, bluff: 0.0, fair: 0.0, radiation: 0.0 };

const STILL: Surface = Surface { height: 0.0, slope: Vec2::ZERO, velocity: Vec3::ZERO };

/// A homogeneous body that moves by the water alone.
#[derive(Clone)]
struct Body {
    hull: Hull,
    points: Vec<HullPoint>,
    mass: f32,
    centre: Vec3,
    rotation: Quat,
    motion: Motion,
    submerged: f32,
    drag: HullDrag,
    /// Whether it cannot turn.
    upright: bool,
}

impl Body {
    /// At rest, with its centre at this height.
    fn new(hull: Hull, density: f32, height: f32) -> Self {
        Self {
            mass: density * hull.volume(),
            hull,
            points: Vec::new(),
            centre: vec3(0.0, height, 0.0),
            rotation: Quat::IDENTITY,
            motion: Motion::default(),
            submerged: 1.0,
            drag: HullDrag::default(),
            upright: false,
        }
    }

    fn pose(&self) -> Pose {
        Pose { position: self.centre - self.rotation * self.hull.centroid(), rotation: self.rotation }
    }

    fn inertia(&self) -> Mat3 {
        let turn = Mat3::from_quat(self.rotation);
        turn * (self.hull.unit_inertia() * self.mass) * turn.transpose()
    }

    fn load(&mut self, water: Surface) -> Load {
        let state = BodyState { pose: self.pose(), centre: self.centre, motion: self.motion };
        let at = |place: Vec2| Some(Surface { height: water.height + water.slope.dot(place), ..water });
        self.hull.load(&state, &Fluid::default(), &self.drag, &mut self.points, at)
    }

    /// A step as a rigid-body solver takes it: velocity first, then place.
    fn step(&mut self, water: Surface, dt: f32) {
        let mut load = self.load(water);
        let share = load.submerged_volume / self.hull.volume();
        load.entering = if share > self.submerged { 1.0 - self.submerged / share } else { 0.0 };
        self.submerged = share;
        let inverse_inertia = if self.upright { Mat3::ZERO } else { self.inertia().inverse() };
        let inertia = Inertia { inverse_mass: Vec3::splat(self.mass.recip()), inverse_inertia };
        let weight = Wrench { force: Vec3::NEG_Y * (self.mass * GRAVITY), torque: Vec3::ZERO };
        let wrench = load.over_step(&self.motion, &inertia, weight, dt);
        self.motion.linear += (wrench.force + weight.force) / self.mass * dt;
        self.motion.angular += inertia.inverse_inertia * wrench.torque * dt;
        self.centre += self.motion.linear * dt;
        self.rotation = (Quat::from_scaled_axis(self.motion.angular * dt) * self.rotation).normalize();
    }

    /// Energy at the present place: kinetic, of the body and of the water that moves with it; potential, of the body, and of the water
    /// that it displaces, which has been lifted from its depth to the surface. J.
    ///
    /// A solver's step gives the velocity with which it comes here; `next` is that with which it leaves, and the present one is their
    /// mean.
    fn energy(&mut self, next: &Motion) -> f64 {
        let load = self.load(STILL);
        let now = Motion {
            linear: 0.5 * (self.motion.linear + next.linear),
            angular: 0.5 * (self.motion.angular + next.angular),
        };
        let turned = now.angular.dot(self.inertia() * now.angular);
        let added = load.added_mass.times(&now);
        let water = added.force.dot(now.linear) + added.torque.dot(now.angular);
        let kinetic = 0.5 * f64::from(self.mass * now.linear.length_squared() + turned + water);
        let placed: Vec<Vec3> =
            self.hull.points().iter().map(|p| self.rotation * (*p - self.hull.centroid())).collect();
        let (volume, centroid) = below_plane(&placed, self.hull.triangles(), |p| -(p.y + self.centre.y));
        let lifted = f64::from(WEIGHT) * volume * -(centroid.y + f64::from(self.centre.y));
        kinetic + f64::from(self.mass * GRAVITY * self.centre.y) + lifted
    }
}

/// A ring with a square section: concave, with a hole.
fn ring(radius: f32, half: f32) -> Hull {
    let sectors = 24;
    let mut points = Vec::new();
    for k in 0..sectors {
        let (sin, cos) = (k as f32 / sectors as f32 * 2.0 * PI).sin_cos();
        for (r, y) in [(radius - half, -half), (radius + half, -half), (radius + half, half), (radius - half, half)] {
            points.push(vec3(r * cos, y, r * sin));
        }
    }
    let mut triangles = Vec::new();
    for k in 0..sectors {
        let next = (k + 1) % sectors;
        for side in 0..4 {
            let [a, b] = [4 * k + side, 4 * k + (side + 1) % 4];
            let [c, d] = [4 * next + (side + 1) % 4, 4 * next + side];
            triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
    Hull::new(&points, &triangles).expect("a hull")
}

fn shapes() -> Vec<(&'static str, Hull)> {
    vec![
        ("ball", Hull::ball(0.6).expect("a hull")),
        ("cuboid", Hull::cuboid(vec3(0.5, 0.3, 0.8)).expect("a hull")),
        ("cylinder", Hull::cylinder(0.7, 0.4).expect("a hull")),
        ("capsule", Hull::capsule(0.5, 0.3).expect("a hull")),
        ("cone", Hull::cone(0.5, 0.5).expect("a hull")),
        ("ring", ring(0.8, 0.2)),
    ]
}

/// Volume and centroid of what is below a plane of which `depth` gives the depth of a point: signed tetrahedra from a point of the
/// plane, so that the cut itself adds nothing.
fn below_plane(points: &[Vec3], triangles: &[[u32; 3]], depth: impl Fn(Vec3) -> f32) -> (f64, DVec3) {
    let apex = vec3(0.0, depth(Vec3::ZERO), 0.0).as_dvec3();
    let mut volume = 0.0;
    let mut moment = DVec3::ZERO;
    let mut add = |a: DVec3, b: DVec3, c: DVec3| {
        let part = (a - apex).dot((b - apex).cross(c - apex)) / 6.0;
        volume += part;
        moment += part * (a + b + c + apex) / 4.0;
    };
    for triangle in triangles {
        let corners = triangle.map(|index| points[index as usize]);
        let depths = corners.map(&depth);
        let mut polygon = Vec::new();
        for k in 0..3 {
            let (p, q) = (corners[k].as_dvec3(), corners[(k + 1) % 3].as_dvec3());
            let (dp, dq) = (f64::from(depths[k]), f64::from(depths[(k + 1) % 3]));
            if dp > 0.0 {
                polygon.push(p);
            }
            if (dp > 0.0) != (dq > 0.0) {
                polygon.push(p + (q - p) * (dp / (dp - dq)));
            }
        }
        for k in 2..polygon.len() {
            add(polygon[0], polygon[k - 1], polygon[k]);
        }
    }
    (volume, if volume.abs() > 0.0 { moment / volume } else { apex })
}

fn rotations() -> impl Strategy<Value = Quat> {
    (0.0..TAU, 0.0..PI, 0.0..TAU).prop_map(|(a, b, c)| Quat::from_euler(EulerRot::YXY, a, b, c))
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, failure_persistence: None, ..ProptestConfig::default() })]

    /// Under any plane the force on any hull is ρ g V (−∂η/∂x, 1, −∂η/∂z), through the centroid of the displaced water.
    #[test]
    fn the_force_is_the_weight_of_the_displaced_water(
        which in 0..6_usize, rotation in rotations(), height in -1.0..1.0_f32,
        slope in (-0.4..0.4_f32, -0.4..0.4_f32), scale in 0.01..100.0_f32,
    ) {
        let hull = shapes().swap_remove(which).1.scaled(Vec3::splat(scale)).expect("a hull");
        let mut body = Body::new(hull, 500.0, 0.0);
        body.rotation = rotation;
        let slope = vec2(slope.0, slope.1);
        let load = body.load(Surface { height: height * scale, slope, velocity: Vec3::ZERO });
        let placed: Vec<Vec3> = body.hull.points().iter().map(|p| rotation * (*p - body.hull.centroid())).collect();
        let depth = |p: Vec3| height * scale + slope.dot(vec2(p.x, p.z)) - p.y;
        let (volume, centroid) = below_plane(&placed, body.hull.triangles(), depth);
        let (volume, centroid) = (volume as f32, centroid.as_vec3());
        prop_assume!(volume > 0.02 * body.hull.volume());
        let expected = vec3(-slope.x, 1.0, -slope.y) * (WEIGHT * volume);
        let off = (load.pressure.force - expected).length() / expected.length();
        prop_assert!(off < 1e-4, "force off by {off}");
        let torque = centroid.cross(expected);
        let off = (load.pressure.torque - torque).length() / (expected.length() * body.hull.length());
        prop_assert!(off < 1e-4, "torque off by {off}");
        prop_assert!((load.submerged_volume / volume - 1.0).abs() < 1e-4);
    }
}

/// Runs a body for some seconds at this rate.
fn run(body: &mut Body, water: Surface, seconds: f32, rate: f32) {
    for _ in 0..(seconds * rate) as usize {
        body.step(water, rate.recip());
    }
}

#[test]
fn bodies_rest_at_their_analytic_draft() {
    println!("shape      density  draft m   analytic  off %");
    let mut worst = 0.0_f32;
    for density in [50.0, 200.0, 350.0, 500.0, 650.0, 800.0, 950.0] {
        let s = density / WATER_DENSITY;
        let cap = 1.0 + 2.0 * (((1.0 - 2.0 * s).acos() + 4.0 * PI) / 3.0).cos();
        let cases = [
            ("ball", Hull::ball(0.5).expect("a hull"), 0.5, 0.5 * cap),
            ("cuboid", Hull::cuboid(vec3(0.6, 0.25, 0.5)).expect("a hull"), 0.25, 0.5 * s),
            ("cylinder", Hull::cylinder(0.25, 0.6).expect("a hull"), 0.25, 0.5 * s),
            ("cone", Hull::cone(0.3, 0.6).expect("a hull"), 0.15, 0.6 * (1.0 - (1.0 - s).cbrt())),
        ];
        for (name, hull, lowest, analytic) in cases {
            let mut body = Body::new(hull, density, 0.0);
            body.upright = true;
            run(&mut body, STILL, 90.0, 60.0);
            // Of the smooth shape, whose lowest point is that far below its centroid.
            let found = lowest - body.centre.y;
            let off = 100.0 * (found / analytic - 1.0);
            println!("{name:<10} {density:>6}  {found:>8.5}  {analytic:>8.5}  {off:>6.3}");
            worst = worst.max(off.abs());
            assert!(body.motion.linear.length() < 1e-3, "{name} of {density} is at rest");
        }
    }
    assert!(worst < 0.5, "{worst} %");
}

/// A cube floats upright if it is lighter than 0.211 or heavier than 0.789 of the water; between them it tips over.
#[test]
fn a_cube_stands_only_if_it_is_light_or_heavy() {
    for (s, stands) in [(0.15, true), (0.2, true), (0.23, false), (0.5, false), (0.77, false), (0.8, true), (0.9, true)]
    {
        let mut body = Body::new(Hull::cuboid(Vec3::splat(0.5)).expect("a hull"), s * WATER_DENSITY, 0.5 - s);
        body.rotation = Quat::from_euler(EulerRot::XYZ, 0.01, 0.0, 0.006);
        run(&mut body, STILL, 60.0, 60.0);
        let up = Mat3::from_quat(body.rotation).transpose() * Vec3::Y;
        let lean = up.abs().max_element().clamp(0.0, 1.0).acos().to_degrees();
        println!("density {s}: leans by {lean:.2}° after a minute");
        assert_eq!(lean < 1.0, stands, "{lean}");
    }
}

/// Time between the first and the last rising zero crossing over their number.
fn period(values: &[f32], dt: f32) -> f32 {
    let crossings: Vec<f32> = values
        .windows(2)
        .enumerate()
        .filter(|(_, pair)| pair[0] < 0.0 && pair[1] >= 0.0)
        .map(|(k, pair)| (k as f32 + pair[0] / (pair[0] - pair[1])) * dt)
        .collect();
    (crossings[crossings.len() - 1] - crossings[0]) / (crossings.len() - 1) as f32
}

/// T = 2π √((m + a)/(ρ g A)) and 2π √((I + a′)/(m g GM)), with the added mass that the hull has.
#[test]
fn boxes_heave_and_roll_with_the_periods_of_naval_architecture() {
    println!("beam m  load  heave s  theory   off %   roll s  theory   off %");
    for (beam, s) in [(1.5, 0.3), (2.0, 0.3), (2.0, 0.5), (2.0, 0.7), (3.0, 0.5), (4.0, 0.4)] {
        let height = 0.8;
        let make = || {
            let hull = Hull::cuboid(vec3(0.5 * beam, 0.5 * height, 3.0)).expect("a hull");
            let mut body = Body::new(hull, s * WATER_DENSITY, height * (0.5 - s));
            body.drag = SLICK;
            body
        };
        let dt = 1.0 / 120.0;
        let rest = make().load(STILL);
        let mass = make().mass;
        let heave_theory = 2.0 * PI * ((mass + rest.added_mass.linear.y_axis.y) / (WEIGHT * beam * 6.0)).sqrt();
        let depth = s * height;
        let metacentre = 0.5 * depth + beam * beam / (12.0 * depth) - 0.5 * height;
        let inertia = make().inertia().z_axis.z + rest.added_mass.angular.z_axis.z;
        let roll_theory = 2.0 * PI * (inertia / (mass * GRAVITY * metacentre)).sqrt();
        let mut heaving = make();
        heaving.centre.y += 0.01;
        let mut rolling = make();
        rolling.rotation = Quat::from_rotation_z(0.02);
        let (mut heights, mut angles) = (Vec::new(), Vec::new());
        for _ in 0..(20.0 / dt) as usize {
            heaving.submerged = 1.0;
            rolling.submerged = 1.0;
            heaving.step(STILL, dt);
            rolling.step(STILL, dt);
            heights.push(heaving.centre.y - height * (0.5 - s));
            angles.push(rolling.rotation.to_scaled_axis().z);
        }
        let (heave, roll) = (period(&heights, dt), period(&angles, dt));
        let off = [heave / heave_theory, roll / roll_theory].map(|ratio| 100.0 * (ratio - 1.0));
        println!(
            "{beam:>5}  {s:>5}  {heave:>7.4}  {heave_theory:>7.4}  {:>5.2}  {roll:>7.4}  {roll_theory:>7.4}  {:>5.2}",
            off[0], off[1]
        );
        assert!(off[0].abs() < 3.0 && off[1].abs() < 3.0, "{off:?}");
    }
}

/// √(2 |m − ρ V| g/(ρ C_d A)), with the 0.47 of a ball.
#[test]
fn balls_sink_and_rise_at_their_terminal_velocity() {
    for density in [2000.0, 500.0] {
        for radius in [0.05, 0.3] {
            let mut body = Body::new(Hull::ball(radius).expect("a hull"), density, -500.0);
            run(&mut body, STILL, 20.0, 60.0);
            let net = (density - WATER_DENSITY).abs() * body.hull.volume() * GRAVITY;
            let terminal = (2.0 * net / (WATER_DENSITY * 0.47 * PI * radius * radius)).sqrt();
            let speed = body.motion.linear.y.abs();
            println!("density {density}, radius {radius} m: {speed:.4} m/s, {terminal:.4} m/s expected");
            assert!((speed / terminal - 1.0).abs() < 0.05, "{speed} {terminal}");
        }
    }
}

#[test]
fn a_stream_carries_bodies_at_its_speed() {
    for (name, hull) in shapes() {
        let mut body = Body::new(hull, 400.0, 0.0);
        let stream = Surface { velocity: vec3(1.5, 0.0, 0.0), ..STILL };
        run(&mut body, stream, 60.0, 60.0);
        println!("{name}: {} m/s after a minute", body.motion.linear.x);
        assert!((body.motion.linear.x / 1.5 - 1.0).abs() < 0.01, "{name}");
    }
}

/// A plank towed along its length, deep under water: skin friction on its four long sides, pressure on its ends.
#[test]
fn a_towed_plank_is_resisted_as_its_formula_says() {
    let half = vec3(0.05, 0.15, 3.0);
    for speed in [0.5, 2.0, 6.0] {
        let mut body = Body::new(Hull::cuboid(half).expect("a hull"), 500.0, -50.0);
        body.motion.linear = Vec3::Z * speed;
        let load = body.load(STILL);
        let resistance = -(load.stream + load.resistance.times(&body.motion) * -1.0).force.z;
        let sides = 8.0 * half.z * (half.x + half.y);
        let length = body.hull.length();
        let friction = 0.5 * WATER_DENSITY * friction_coefficient(speed * length / VISCOSITY) * sides * speed * speed;
        let form = 0.5 * WATER_DENSITY * 1.05 * 4.0 * half.x * half.y * speed * speed;
        println!("{speed} m/s: {resistance:.3} N, friction {friction:.3} N and form {form:.3} N");
        assert!((resistance / (friction + form) - 1.0).abs() < 1e-3);
    }
}

/// The energy of a body that bobs in still water does not rise by more than 0.5 % of what it loses: added mass changes with the pose,
/// and what that does to the motion is left out.
#[test]
fn bobbing_bodies_never_gain_energy() {
    for density in [100.0, 500.0, 900.0] {
        for (name, hull) in shapes() {
            let mut body = Body::new(hull, density, 0.2);
            body.rotation = Quat::from_euler(EulerRot::XYZ, 0.3, 0.2, 0.4);
            let mut next = body.clone();
            next.step(STILL, 1.0 / 60.0);
            let first = body.energy(&next.motion);
            let (mut least, mut gained) = (first, 0.0_f64);
            for _ in 0..1200 {
                body = next.clone();
                next.step(STILL, 1.0 / 60.0);
                let energy = body.energy(&next.motion);
                gained = gained.max(energy - least);
                least = least.min(energy);
            }
            let swing = (first - least).max(1e-9);
            println!(
                "{name} of {density}: loses {swing:.1} J in 20 s, gains {:.3} % of it at most",
                100.0 * gained / swing
            );
            assert!(gained < 5e-3 * swing, "{name} gains {gained} J");
        }
    }
}

/// Light and heavy, small and large, in fast and in slow steps: they stay at the surface.
#[test]
fn bodies_of_every_size_come_to_rest() {
    for (name, hull) in shapes() {
        for (density, size, rate) in [
            (5.0, 0.02, 60.0),
            (5.0, 0.02, 20.0),
            (100.0, 1.0, 60.0),
            (500.0, 1.0, 20.0),
            (900.0, 30.0, 20.0),
            (5.0, 100.0, 20.0),
        ] {
            let hull = hull.clone().scaled(Vec3::splat(size)).expect("a hull");
            let mut body = Body::new(hull, density, 2.0 * size);
            body.rotation = Quat::from_euler(EulerRot::XYZ, 0.4, 0.2, 0.7);
            run(&mut body, STILL, 30.0 * size.max(1.0).sqrt(), rate);
            let (height, speed) = (body.centre.y.abs() / size, body.motion.linear.length() / (GRAVITY * size).sqrt());
            println!("{name} of {density} kg/m³ × {size} at {rate} Hz: height {height:.3}, speed {speed:.1e} √(g L)");
            assert!(height < 1.0 && speed < 0.02, "{name}");
        }
    }
}

/// A body dropped from 100 m enters without being thrown back, and loses speed only.
#[test]
fn a_fall_from_a_hundred_metres_ends_in_the_water() {
    for (name, hull) in shapes() {
        for rate in [60.0, 20.0] {
            let mut body = Body::new(hull.clone(), 300.0, 100.0);
            body.submerged = 0.0;
            let mut highest_after = f32::NEG_INFINITY;
            let mut has_entered = false;
            for _ in 0..(40.0 * rate) as usize {
                body.step(STILL, 1.0 / rate);
                has_entered |= body.centre.y < 0.0;
                if has_entered {
                    highest_after = highest_after.max(body.centre.y);
                }
                assert!(body.motion.linear.length() < 46.0 && body.centre.is_finite(), "{name}");
            }
            println!(
                "{name} at {rate} Hz: rises to {highest_after:.2} m after its fall, then rests at {:.3} m",
                body.centre.y
            );
            assert!(has_entered && highest_after < 2.0 && body.centre.y.abs() < 1.0, "{name}: {highest_after}");
        }
    }
}

/// A cork of 2 cm and a beach ball of 10 kg/m³ lie still.
#[test]
fn light_things_do_not_jitter() {
    for (name, hull, density) in [
        ("cork", Hull::cylinder(0.01, 0.008).expect("a hull"), 200.0),
        ("beach ball", Hull::ball(0.2).expect("a hull"), 10.0),
    ] {
        let mut body = Body::new(hull, density, 0.01);
        body.rotation = Quat::from_rotation_z(0.3);
        run(&mut body, STILL, 10.0, 60.0);
        let mut sum = 0.0;
        for _ in 0..60 {
            body.step(STILL, 1.0 / 60.0);
            sum += body.motion.linear.y.powi(2);
        }
        let jitter = (sum / 60.0).sqrt();
        println!("{name}: {jitter:.2e} m/s RMS after 10 s");
        assert!(jitter < 1e-3, "{name}: {jitter}");
    }
}

/// Logarithmic decrement of a half-submerged ball that bobs by a millimetre: as a share of critical damping.
#[test]
fn the_heave_of_a_ball_dies_out_by_its_radiation() {
    let mut body = Body::new(Hull::ball(0.5).expect("a hull"), 0.5 * WATER_DENSITY, 0.001);
    body.drag = HullDrag { radiation: HullDrag::default().radiation, ..SLICK };
    let mut crests = Vec::new();
    let [mut before, mut last] = [0.0, body.centre.y];
    for _ in 0..1200 {
        body.submerged = 1.0;
        body.step(STILL, 1.0 / 120.0);
        if last > before && last > body.centre.y {
            crests.push(last);
        }
        (before, last) = (last, body.centre.y);
    }
    let decrement = (crests[0] / crests[2]).ln() / 2.0;
    let share = decrement / (4.0 * PI * PI + decrement * decrement).sqrt();
    println!("heave of a ball: {share:.4} of critical damping");
    assert!((0.05..0.2).contains(&share), "{share}");
}

/// A ball that spins has nothing but its skin to resist it: ∫ ½ ρ C_f |ω × r|² r sin θ dA = ½ ρ C_f ω² π² · ¾ R⁵.
#[test]
fn a_spinning_ball_is_resisted_by_its_skin() {
    let (radius, turn) = (0.3_f32, 2.0_f32);
    let mut body = Body::new(Hull::ball(radius).expect("a hull"), 900.0, -20.0);
    body.motion.angular = Vec3::Y * turn;
    let load = body.load(STILL);
    let torque = load.resistance.times(&body.motion).torque;
    let speed = 0.5 * body.hull.length() * turn;
    let coefficient = friction_coefficient(speed * body.hull.length() / VISCOSITY);
    let skin = 0.5 * WATER_DENSITY * coefficient * turn * turn * 0.75 * PI * PI * radius.powi(5);
    println!("a ball that spins: {} N m, {skin} N m by its skin", torque.y);
    assert!((torque.y / skin - 1.0).abs() < 0.1 && torque.x.abs() + torque.z.abs() < 0.01 * torque.y);
}

/// Without gravity nothing floats, and yet the water is there.
#[test]
fn water_resists_without_gravity() {
    let body = Body::new(Hull::ball(0.5).expect("a hull"), 500.0, -2.0);
    let motion = Motion { linear: Vec3::X, angular: Vec3::ZERO };
    let state = BodyState { pose: body.pose(), centre: body.centre, motion };
    let fluid = Fluid { gravity: 0.0, ..Fluid::default() };
    let load = body.hull.load(&state, &fluid, &body.drag, &mut Vec::new(), |_| Some(STILL));
    assert_eq!(load.pressure.force, Vec3::ZERO);
    assert!((load.submerged_volume / body.hull.volume() - 1.0).abs() < 1e-5);
    let force = load.resistance.times(&motion).force.x;
    let drag = 0.5 * WATER_DENSITY * 0.47 * PI * 0.25;
    assert!((force / drag - 1.0).abs() < 0.05, "{force} {drag}");
}

/// Where some of a hull's points have no water the forces are finite, and what acts there acts within the hull.
#[test]
fn a_hull_half_over_a_shore_is_pushed_within_itself() {
    for (name, hull) in shapes() {
        let mut body = Body::new(hull, 500.0, 0.0);
        for k in 0..40 {
            body.rotation = Quat::from_euler(EulerRot::YXZ, 0.3 * k as f32, 0.2 * k as f32, 0.5 * k as f32);
            let shore = 0.05 * k as f32 - 1.0;
            let state = BodyState { pose: body.pose(), centre: body.centre, motion: body.motion };
            let water = |place: Vec2| (place.x < shore).then_some(STILL);
            let load = body.hull.load(&state, &Fluid::default(), &body.drag, &mut body.points, water);
            let mass = load.added_mass;
            let reach = body.hull.points().iter().map(|p| p.distance(body.hull.centroid())).fold(0.0, f32::max);
            let most = mass.linear.x_axis.x.max(mass.linear.y_axis.y).max(mass.linear.z_axis.z);
            assert!(load.pressure.is_finite() && mass.angular.is_finite(), "{name} {k}");
            let turned = mass.angular.x_axis.x.max(mass.angular.y_axis.y).max(mass.angular.z_axis.z);
            assert!(turned <= 7.0 * most * reach * reach, "{name} {k}: {turned} {most}");
        }
    }
}
