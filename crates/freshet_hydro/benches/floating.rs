//! How exact the models of floating bodies are, and what they cost. `cargo bench -p freshet_hydro --bench floating`.
use freshet_hydro::{
    hull::{Hull, HullDrag, HullPoint},
    load::{BodyState, Fluid, Load, Motion, Pose, Surface},
    samples::SampleHull,
    voxels::{Drag, VoxelHull},
    waves::{GRAVITY, WATER_DENSITY},
};
use glam::{DVec3, EulerRot, Quat, Vec2, Vec3, vec3};
use std::{hint::black_box, time::Instant};

/// Half the size of the box that is measured, m.
const HALF: Vec3 = vec3(1.0, 0.3, 0.5);
/// Poses of a table.
const POSES: usize = 500;
/// Measurements of which the best counts.
const RUNS: u32 = 5;

const STILL: Surface = Surface { height: 0.0, slope: Vec2::ZERO, velocity: Vec3::ZERO };

/// A body in one of the models.
enum Model {
    Hull(Hull, Vec<HullPoint>),
    Voxels(VoxelHull),
    Samples(SampleHull),
}

impl Model {
    fn load(&mut self, pose: &Pose) -> Load {
        let motion = Motion { linear: vec3(0.3, -0.2, 0.1), angular: vec3(0.1, 0.2, 0.0) };
        let body = BodyState { pose: *pose, centre: pose.position, motion };
        let (fluid, surface) = (Fluid::default(), |_| Some(STILL));
        match self {
            Self::Hull(hull, points) => hull.load(&body, &fluid, &HullDrag::default(), points, surface),
            Self::Voxels(voxels) => voxels.load(&body, &fluid, &Drag::default(), surface),
            Self::Samples(samples) => samples.load(&body, &fluid, &Drag::default(), surface),
        }
    }
}

fn main() {
    let hull = Hull::cuboid(HALF).expect("a box");
    // 300 triangles, as a ship's hull may have.
    let fine = hull.clone().refined(0.26, 300);
    let voxels = |n| VoxelHull::new([-HALF, HALF], n, |_| f32::NEG_INFINITY).expect("a box");
    let mut models = vec![
        ("Hull, 12 triangles".to_string(), Model::Hull(hull.clone(), Vec::new())),
        (format!("Hull, {} triangles", fine.triangles().len()), Model::Hull(fine.clone(), Vec::new())),
    ];
    models.extend([2, 4, 8, 16].map(|n| (format!("Voxels {n}³"), Model::Voxels(voxels(n)))));
    models.extend([0.4, 0.2, 0.1, 0.05].map(|spacing| {
        let samples = SampleHull::new(&hull, spacing);
        (format!("Samples, {spacing} m ({})", samples.points().len()), Model::Samples(samples))
    }));
    let poses: Vec<Pose> = (0..POSES).map(pose).collect();
    let exact: Vec<(DVec3, DVec3)> = poses.iter().map(|pose| exact(&hull, pose)).collect();
    let unit = cost(&mut Model::Voxels(voxels(4)), &poses);
    println!(
        "| model of a box of 2 × 0.6 × 1 m | force, RMS of ρ g V | moment, RMS of ρ g V L | ns per body | of Voxels 4³ |"
    );
    println!("|---|---|---|---|---|");
    for (name, model) in &mut models {
        let [force, moment] = errors(model, &poses, &exact);
        let nanoseconds = cost(model, &poses);
        println!("| {name} | {force:.1e} | {moment:.1e} | {nanoseconds:.0} | {:.2} |", nanoseconds / unit);
    }
    println!("\n| bodies, hulls of 300 triangles | ns per body |\n|---|---|");
    for count in [1, 10, 100, 1000, 2000] {
        let mut bodies: Vec<Model> = (0..count).map(|_| Model::Hull(fine.clone(), Vec::new())).collect();
        println!("| {count} | {:.0} |", cost_of_many(&mut bodies, &poses));
    }
}

/// A pose of a box that the surface cuts.
fn pose(k: usize) -> Pose {
    let at = |step: f64| (0.5 + step * k as f64).fract() as f32;
    let angles = [at(0.8191725134), at(0.6710436067), at(0.5497004779)].map(|share| share * std::f32::consts::TAU);
    Pose {
        position: vec3(0.0, at(0.7548776662) - 0.5, 0.0),
        rotation: Quat::from_euler(EulerRot::YXZ, angles[0], angles[1], angles[2]),
    }
}

/// Force and moment by signed tetrahedra of what is under water, in 64 bits.
fn exact(hull: &Hull, pose: &Pose) -> (DVec3, DVec3) {
    let apex = DVec3::new(0.0, f64::from(-pose.position.y), 0.0);
    let (mut volume, mut moment) = (0.0, DVec3::ZERO);
    for triangle in hull.triangles() {
        let corners = triangle.map(|point| pose.rotation.as_dquat() * hull.points()[point as usize].as_dvec3());
        let depths = corners.map(|corner| -(corner.y + f64::from(pose.position.y)));
        let mut polygon = Vec::new();
        for k in 0..3 {
            let next = (k + 1) % 3;
            if depths[k] > 0.0 {
                polygon.push(corners[k]);
            }
            if (depths[k] > 0.0) != (depths[next] > 0.0) {
                polygon.push(corners[k].lerp(corners[next], depths[k] / (depths[k] - depths[next])));
            }
        }
        for k in 2..polygon.len() {
            let (a, b, c) = (polygon[0], polygon[k - 1], polygon[k]);
            let part = (a - apex).dot((b - apex).cross(c - apex)) / 6.0;
            volume += part;
            moment += part * (a + b + c + apex) / 4.0;
        }
    }
    let weight = f64::from(WATER_DENSITY * GRAVITY);
    (DVec3::Y * volume * weight, moment.cross(DVec3::Y) * weight)
}

/// RMS errors of force and moment, of the whole body's weight in water and of that times its length.
fn errors(model: &mut Model, poses: &[Pose], exact: &[(DVec3, DVec3)]) -> [f64; 2] {
    let whole = f64::from(WATER_DENSITY * GRAVITY * 8.0 * HALF.element_product());
    let length = f64::from(8.0 * HALF.element_product()).cbrt();
    let (mut force, mut moment) = (0.0, 0.0);
    for (pose, (exact_force, exact_moment)) in poses.iter().zip(exact) {
        let pressure = model.load(pose).pressure;
        force += (pressure.force.as_dvec3() - exact_force).length_squared();
        moment += (pressure.torque.as_dvec3() - exact_moment).length_squared();
    }
    let mean = |sum: f64| (sum / poses.len() as f64).sqrt() / whole;
    [mean(force), mean(moment) / length]
}

/// Nanoseconds per load.
fn cost(model: &mut Model, poses: &[Pose]) -> f64 {
    let mut best = f64::INFINITY;
    for _ in 0..RUNS {
        let start = Instant::now();
        for pose in poses {
            black_box(model.load(black_box(pose)));
        }
        best = best.min(start.elapsed().as_secs_f64());
    }
    best / poses.len() as f64 * 1e9
}

/// Nanoseconds per load where every body is another one.
fn cost_of_many(bodies: &mut [Model], poses: &[Pose]) -> f64 {
    let rounds = (20_000 / bodies.len()).max(1);
    let mut best = f64::INFINITY;
    for _ in 0..RUNS {
        let start = Instant::now();
        for round in 0..rounds {
            for (k, body) in bodies.iter_mut().enumerate() {
                black_box(body.load(black_box(&poses[(round + k) % poses.len()])));
            }
        }
        best = best.min(start.elapsed().as_secs_f64());
    }
    best / (rounds * bodies.len()) as f64 * 1e9
}
