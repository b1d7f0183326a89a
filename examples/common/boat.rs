//! A motor boat: its hull, and what propeller and rudder do to it. The bow points to −z.
use bevy::prelude::*;
use bevy_freshet::prelude::*;
use bevy_rapier3d::prelude::*;
use std::f32::consts::PI;

/// Length of the hull, m.
pub const LENGTH: f32 = 5.6;
/// Sections of the hull from the stern to the bow.
pub const SECTIONS: usize = 17;
/// Where the centre of mass is, m: engine and ballast lie low and aft of the middle.
const CENTER_OF_MASS: Vec3 = vec3(0.0, -0.1, 0.72);
const MASS: f32 = 950.0;

/// Where the propeller is, m: below the stern, on the keel's line.
pub const PROPELLER: Vec3 = vec3(0.0, -0.42, 2.85);
/// Thrust with full throttle, N.
pub const THRUST: f32 = 3600.0;
/// Most of it astern: blades are made to go ahead.
const ASTERN: f32 = 0.5;
/// Area of the propeller's disc, m²: 40 cm across.
const DISC: f32 = 0.126;

/// Where the pressure on the rudder acts, m: right behind the propeller.
pub const RUDDER: Vec3 = vec3(0.0, -0.4, 3.0);
/// Side area of the rudder, m², and its height² over that.
const RUDDER_AREA: f32 = 0.05;
const ASPECT: f32 = 1.5;
/// Angle of the rudder when it is hard over, rad.
pub const HARD_OVER: f32 = 25.0 * PI / 180.0;
/// Angles of attack between which the flow comes off the rudder, rad.
const STALL: [f32; 2] = [22.0 * PI / 180.0, 32.0 * PI / 180.0];

/// Density of water, kg/m³.
const DENSITY: f32 = 998.0;

/// How the boat is steered.
#[derive(Component, Clone, Copy, Debug, Default, PartialEq)]
#[require(ExternalForce, Velocity)]
pub struct Helm {
    /// −1 full astern … 1 full ahead; astern only half the thrust.
    pub throttle: f32,
    /// −1 hard to port … 1 hard to starboard.
    pub rudder: f32,
}

/// The boat as the physics sees it.
pub fn boat(pose: Transform) -> impl Bundle {
    let points: Vec<Vec3> = (0..SECTIONS).flat_map(section).flat_map(|p| [p, p * vec3(-1.0, 1.0, 1.0)]).collect();
    (
        Helm::default(),
        RigidBody::Dynamic,
        Collider::convex_hull(&points).unwrap_or_else(|| Collider::cuboid(1.0, 0.4, 0.5 * LENGTH)),
        Floating {
            center_of_mass: Some(CENTER_OF_MASS),
            // A well-formed hull leaves few eddies behind.
            fair_drag: 0.25,
            ..Floating::with_mass(MASS)
        },
        pose,
    )
}

/// Keel, chine, rail and sheer (the edge of the deck) of the `k`-th section from the stern, on the starboard side, m.
pub fn section(k: usize) -> [Vec3; 4] {
    let along = k as f32 / (SECTIONS - 1) as f32;
    // Nearly as wide at the stern as in the middle, and closing to the bow.
    let (aft, fore) = ((1.0 - along / 0.4).max(0.0), ((along - 0.4) / 0.6).max(0.0));
    let fullness = (1.0 - 0.1 * aft * aft - fore.powf(2.4)).max(0.02);
    let at = |half_beam: f32, height: f32| vec3(half_beam * fullness, height, LENGTH * (0.5 - along));
    let keel = at(0.0, -0.42 + 0.7 * fore.powi(3));
    let chine = at(0.85 - 0.25 * fore, -0.17 + 0.34 * fore.powi(2));
    let sheer = at(1.05, 0.42 + 0.2 * along);
    [keel, chine, chine.lerp(sheer, 0.75).with_y(sheer.y - 0.14), sheer]
}

/// Propeller and rudder push the boat at their places, as long as these are under water.
pub fn drive(mut boats: Query<(&Helm, &Transform, &Velocity, &mut ExternalForce)>, water: WaterQuery) {
    for (helm, pose, velocity, mut force) in &mut boats {
        let center = pose.transform_point(CENTER_OF_MASS);
        // Velocity of the water past a place of the boat, in the boat's frame, where aft is +z; none in the air.
        let stream = |place: Vec3| {
            let point = pose.transform_point(place);
            let water = water.sample(point).filter(|water| water.height > point.y)?;
            let past = water.velocity - velocity.linear_velocity_at_point(point, center);
            Some(pose.rotation.inverse() * past)
        };
        let at = |place: Vec3, push: Vec3| {
            ExternalForce::at_point(pose.rotation * push, pose.transform_point(place), center)
        };
        let mut sum = ExternalForce::default();
        let mut wash = 0.0;
        if let Some(stream) = stream(PROPELLER) {
            let thrust = THRUST * helm.throttle.clamp(-ASTERN, 1.0);
            sum += at(PROPELLER, Vec3::NEG_Z * thrust);
            wash = wash_of(stream.z, thrust);
        }
        if let Some(stream) = stream(RUDDER) {
            let angle = HARD_OVER * helm.rudder.clamp(-1.0, 1.0);
            sum += at(RUDDER, rudder_force(angle, stream + Vec3::Z * wash));
        }
        *force = sum;
    }
}

/// By how much a propeller with this thrust (N) makes water faster that comes with `speed`, m/s. Its disc gives momentum to all that
/// passes: T = ½ ρ A (v_s² − v²) (Rankine 1865, Froude 1889). Astern the wash goes forward, away from the rudder.
fn wash_of(speed: f32, thrust: f32) -> f32 {
    let speed = speed.max(0.0);
    (speed * speed + 2.0 * thrust.max(0.0) / (DENSITY * DISC)).sqrt() - speed
}

/// Force on the rudder, turned by `angle` with its trailing edge to starboard, in this stream; both in the boat's frame, N and m/s.
fn rudder_force(angle: f32, stream: Vec3) -> Vec3 {
    let speed = stream.xz().length();
    // Ahead the stream comes from −z. Going astern it comes from the trailing edge: the same blade, met from behind.
    let attack = angle - (stream.x / stream.z.abs().max(1e-3)).atan() * stream.z.signum();
    let [lift, drag] = foil(if stream.z < 0.0 { -attack } else { attack });
    let along = stream.with_y(0.0).normalize_or_zero();
    let across = along.cross(Vec3::Y);
    0.5 * DENSITY * RUDDER_AREA * speed * speed * (lift * across + drag * along)
}

/// Coefficients of lift and drag of a thin foil of low aspect ratio Λ at an angle of attack α:
/// C_L = 2π Λ (Λ + 0.7)/(Λ + 1.7)² sin α + sin α |sin α| cos α and C_D = C_L²/(π Λ) + |sin α|³ (Söding, in Brix (ed.), *Manoeuvring
/// Technical Manual*, 1993). Where the flow has come off it is a flat plate with a normal force of 1.17 sin α (Hoerner,
/// *Fluid-Dynamic Drag*, 1965).
fn foil(attack: f32) -> [f32; 2] {
    let (sin, cos) = attack.sin_cos();
    let slope = 2.0 * PI * ASPECT * (ASPECT + 0.7) / (ASPECT + 1.7).powi(2);
    let lift = slope * sin + sin * sin.abs() * cos;
    let drag = lift * lift / (PI * ASPECT) + sin.abs().powi(3);
    let normal = 1.17 * sin;
    let stalled = ((attack.abs() - STALL[0]) / (STALL[1] - STALL[0])).clamp(0.0, 1.0);
    [lift.lerp(normal * cos, stalled), drag.lerp(normal * sin, stalled)]
}

/// The helm of a run without a helmsman, `time` s after the start: full ahead, hard to starboard, then to port.
pub fn script(time: f32) -> Helm {
    // The rudder takes half a second from one side to the other.
    let over = |from: f32| ((time - from) / 0.25).clamp(0.0, 1.0);
    Helm { throttle: 1.0, rudder: over(2.5) - 2.0 * over(6.5) }
}
