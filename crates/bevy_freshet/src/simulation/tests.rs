//! The stages on a GPU against their twins in `freshet_hydro`, and against theory.
#[expect(dead_code, reason = "made for pictures; only a part is needed here")]
#[path = "../../../../tests/stage.rs"]
pub(super) mod stage;

pub(super) mod readback;

use super::*;
use crate::{
    body::{ResolvedWater, Water, WaterBed, WaterFlow, WaterFoam, WaterInteraction, WaterWaves, Wave},
    surface::WaterSurface,
};
use freshet_hydro::{
    fields::{
        Cells,
        foam::{self, FoamSources, Stir},
        rings::{RingStep, Rings},
        transport::{Stream, Transport, TransportStep},
    },
    grid::Grid,
};
use stage::Stage;

/// A water whose fields are measured.
struct Basin {
    stage: Stage,
    water: Entity,
}

/// What acts on the water, instead of what is in the scene.
#[derive(Resource, Default)]
struct Given(Deposits);

fn give(given: Res<Given>, mut waters: Query<&mut Deposits>) {
    waters.iter_mut().for_each(|mut deposits| *deposits = given.0.clone());
}

impl Basin {
    fn new(size: Vec2, bed: Option<WaterBed>, settings: impl Bundle) -> Self {
        let mut stage = Stage::new();
        stage.app.init_resource::<Given>();
        stage.app.add_systems(PostUpdate, give.after(FieldSystems::Deposit).before(FieldSystems::Step));
        if let Some(bed) = bed {
            stage.spawn(bed);
        }
        let surface = WaterSurface { ripples: 0.0, ..default() };
        let water = stage.spawn((Water::new(size), surface));
        stage.app.world_mut().entity_mut(water).insert(settings);
        stage.settle();
        Self { stage, water }
    }

    fn get<C: Component>(&self) -> &C {
        self.stage.app.world().get(self.water).unwrap()
    }

    /// A frame of 1/60 s with `deposits`.
    fn frame(&mut self, deposits: Deposits) {
        self.stage.app.insert_resource(Given(deposits));
        self.stage.run(1.0 / 60.0);
        self.stage.app.insert_resource(Given::default());
    }

    fn cells(&self) -> Cells {
        let window = self.get::<FieldWindow>();
        Cells { size: window.size, side: window.cell }
    }

    /// Local xz of the middle of a cell, m.
    fn place(&self, at: IVec2) -> Vec2 {
        let window = self.get::<FieldWindow>();
        window.origin() + (at.as_vec2() + 0.5) * window.cell
    }

    fn read(&mut self, picture: Handle<Image>) -> Vec<Vec4> {
        let size = self.cells().size;
        let data = readback::read(&mut self.stage, &picture);
        readback::texels(&data, size, 8).map(readback::halves).collect()
    }

    fn rings(&mut self) -> Vec<Vec4> {
        self.read(self.get::<FieldPictures>().rings.clone().unwrap())
    }

    fn matter(&mut self) -> Vec<Vec4> {
        self.read(self.get::<FieldPictures>().matter.clone().unwrap())
    }
}

fn stroke(place: Vec2, radius: f32) -> Stroke {
    Stroke { place, radius, volume: 0.0, foam: 0.0, dye: Vec3::ZERO }
}

fn strokes(strokes: Vec<Stroke>) -> Deposits {
    Deposits { strokes, ..default() }
}

fn gaussian(away: Vec2, radius: f32) -> f32 {
    (-0.5 * away.length_squared() / (radius * radius)).exp() / (core::f32::consts::TAU * radius * radius)
}

/// A body that moves east over four cells, the last of them covered by half.
fn body(frame: u32) -> Vec<SilhouetteCell> {
    let cell = |n: u32| SilhouetteCell {
        cell: uvec2(20 + frame / 12 + n % 2, 30 + n / 2),
        cover: if n == 3 { 0.5 } else { 1.0 },
        draft: 0.1 + 0.004 * frame as f32,
        velocity: vec2(1.2, 0.3),
    };
    (0..4).map(cell).collect()
}

/// The same on the CPU, from what the water says of itself.
struct Twin {
    rings: Rings,
    transport: Transport,
    drafts: Vec<f32>,
}

impl Twin {
    fn stream(basin: &Basin, at: IVec2, bodies: &[SilhouetteCell]) -> Stream {
        let (water, foam) = (basin.get::<ResolvedWater>(), basin.get::<WaterFoam>());
        let (place, side) = (basin.place(at), basin.cells().side);
        let depth = if water.covers(place) { water.still_depth(place) } else { -1e6 };
        let current = water.current(place);
        let along =
            |axis: Vec2| (water.current(place + axis * side) - water.current(place - axis * side)) / (2.0 * side);
        let cover = |at: IVec2| bodies.iter().find(|one| one.cell.as_ivec2() == at);
        let around = (0..9).filter_map(|i| cover(at + ivec2(i % 3, i / 3) - 1));
        let nearest = around.fold(
            None,
            |most: Option<&SilhouetteCell>, one| {
                if most.is_none_or(|most| one.cover > most.cover) { Some(one) } else { most }
            },
        );
        let own = cover(at).map_or((Vec2::ZERO, 0.0), |one| (one.velocity, one.cover));
        let sources = FoamSources {
            shore: foam.shore,
            shore_depth: foam.shore_depth,
            shear: foam.shear,
            shear_threshold: foam.shear_threshold,
            breaking: foam.breaking,
            breaking_threshold: foam.breaking_threshold,
            speed: foam.speed,
            speed_threshold: foam.speed_threshold,
            bodies: foam.bodies,
        };
        let stir = Stir {
            depth,
            crest: water.waves.particle(place, 1.0).displacement.y,
            shear: foam::shear(along(Vec2::X), along(Vec2::Y)),
            convergence: foam::convergence(along(Vec2::X), along(Vec2::Y)),
            speed: current.length(),
            rim: nearest.map_or(0.0, |one| one.cover * (1.0 - own.1)),
            slip: nearest.map_or(0.0, |one| one.velocity.distance(current)),
        };
        Stream { velocity: current.lerp(own.0, own.1), depth, birth: sources.birth(&stir) }
    }

    fn new(basin: &Basin) -> Self {
        let (cells, settings) = (basin.cells(), basin.get::<WaterInteraction>());
        let water = basin.get::<ResolvedWater>();
        let still = |at| Self::stream(basin, at, &[]);
        Self {
            rings: Rings::new(cells, settings.wavelength, |at| still(at).depth, |at| water.current(basin.place(at))),
            transport: Transport::new(cells, basin.get::<WaterFoam>().life, still),
            drafts: vec![0.0; cells.count()],
        }
    }

    fn frame(&mut self, basin: &Basin, deposits: &Deposits) {
        let (cells, settings) = (basin.cells(), basin.get::<WaterInteraction>());
        let mut drafts = vec![0.0; cells.count()];
        for one in &deposits.silhouettes {
            drafts[cells.index(one.cell.as_ivec2()).unwrap()] = one.draft;
        }
        let raised: Vec<f32> = drafts.iter().zip(&self.drafts).map(|(now, before)| now - before).collect();
        self.drafts = drafts;
        self.rings.raise(&raised);
        for (i, at) in cells.iter().enumerate().filter(|(i, _)| self.rings.celerity_squared[*i] > 0.0) {
            for stroke in &deposits.strokes {
                let density = gaussian(basin.place(at) - stroke.place, stroke.radius);
                self.rings.waves[i].x += stroke.volume * density;
                self.transport.matter[i] += Vec4::from((stroke.foam, stroke.dye)) * density;
            }
        }
        self.rings.step(&RingStep { dt: 1.0 / 60.0, decay: settings.decay, absorbs: [false; 4] });
        self.transport.stream = cells.iter().map(|at| Self::stream(basin, at, &deposits.silhouettes)).collect();
        self.transport.step(&TransportStep {
            dt: 1.0 / 60.0,
            spreading: settings.spreading,
            dye_life: settings.dye_life,
            foam_life: basin.get::<WaterFoam>().life,
        });
    }
}

/// Panics unless `gpu` is `cpu` to the accuracy of its 16-bit floats, where it is wet.
fn assert_same(
    what: &str,
    cells: &Cells,
    gpu: impl Fn(usize) -> f32,
    cpu: impl Fn(usize) -> f32,
    wet: impl Fn(usize) -> bool,
) {
    let largest = (0..cells.count()).map(|i| cpu(i).abs()).fold(0.0, f32::max);
    assert!(largest > 1e-4, "there is {what} to compare: {largest}");
    for (i, at) in cells.iter().enumerate().filter(|(i, _)| wet(*i)) {
        let (a, b) = (gpu(i), cpu(i));
        assert!((a - b).abs() < 1e-3 * b.abs() + 1e-3 * largest, "{what} at {at}: {a} on the GPU, {b} on the CPU");
    }
}

#[test]
fn the_stages_do_what_their_twins_do() {
    compare_with_twins(true);
}

#[test]
fn the_stages_do_what_their_twins_do_where_there_is_no_dye() {
    compare_with_twins(false);
}

fn compare_with_twins(dyed: bool) {
    // A shoal in a current that is faster in the middle; 65 × 45 cells, no multiple of a workgroup.
    let bed = WaterBed::from_fn(uvec2(40, 30), 0.5, |p| 0.14 * (p.y.abs() - 4.9) + 0.2 * (p.x * 0.9).sin()).unwrap();
    let current =
        Grid::from_fn(uvec2(20, 14), 1.0, |cell: UVec2| vec2(1.5 - 0.03 * (cell.y as f32 - 6.5).powi(2), 0.1));
    let flow = WaterFlow { uniform: vec2(0.05, -0.1), ..WaterFlow::from_map(current.unwrap()) };
    let train = Wave { direction: vec2(0.3, 1.0), wavelength: 3.0, steepness: 0.3, phase: 0.4 };
    let waves = WaterWaves { trains: vec![train], ..WaterWaves::still() };
    let foam = WaterFoam { shear_threshold: 0.05, breaking_threshold: 0.02, ..default() };
    let mut basin = Basin::new(vec2(16.2, 11.2), Some(bed), (flow, waves, foam));
    let mut twin = Twin::new(&basin);
    let cells = basin.cells();
    assert_eq!(cells.size, uvec2(66, 46));
    for frame in 0..50 {
        let dye = if dyed { vec3(0.3, 0.1, 0.02) } else { Vec3::ZERO };
        let touch = Stroke { volume: 0.01, foam: 0.05, dye, ..stroke(vec2(-3.0, 0.4), 0.4) };
        let spill = Stroke { dye: 2.0 * dye, ..stroke(vec2(2.0, -1.1), 0.3) };
        let strokes = match frame {
            5 => vec![touch, spill],
            20 => vec![spill],
            _ => Vec::new(),
        };
        let silhouettes = if frame == 0 { Vec::new() } else { body(frame) };
        let deposits = Deposits { silhouettes, strokes };
        basin.frame(deposits.clone());
        twin.frame(&basin, &deposits);
    }
    let (rings, matter) = (basin.rings(), basin.matter());
    let stream = &twin.transport.stream;
    let wet = |i: usize| stream[i].depth > 0.0;
    let dry = (0..cells.count()).filter(|i| !wet(*i)).count();
    assert!(dry > 300 && dry < cells.count() / 2, "there are banks: {dry} dry cells");
    assert_same("height", &cells, |i| rings[i].z, |i| twin.rings.waves[i].x, wet);
    assert_same("foam", &cells, |i| matter[i].x, |i| twin.transport.matter[i].x.clamp(0.0, 1.0), wet);
    for channel in [1, 2, 3].into_iter().filter(|_| dyed) {
        let absorption = |i: usize| twin.transport.matter[i][channel] / stream[i].depth.clamp(0.05, 2.0);
        assert_same("dye", &cells, |i| matter[i][channel], absorption, wet);
    }
    let covered: f32 = rings.iter().map(|texel| texel.w).sum();
    assert_eq!(covered, 3.5);
}

/// What is left is counted in lives and not in seconds of the life that was set when it came.
#[test]
fn dye_and_rings_whose_life_is_prolonged_are_not_forgotten() {
    let mut basin = pond(4.0);
    let set = |basin: &mut Basin, decay, dye_life| {
        let mut water = basin.stage.app.world_mut().entity_mut(basin.water);
        let mut settings = water.get_mut::<WaterInteraction>().unwrap();
        (settings.decay, settings.dye_life) = (decay, dye_life);
    };
    set(&mut basin, 0.2, 0.2);
    let touch = Stroke { volume: 0.01, dye: Vec3::ONE, ..stroke(vec2(0.3, 0.1), 0.4) };
    basin.frame(strokes(vec![touch]));
    set(&mut basin, 1e3, 1e6);
    let sum = |matter: Vec<Vec4>| matter.iter().map(|texel| texel.y).sum::<f32>();
    let before = sum(basin.matter());
    // Ten of the first lives and a little.
    basin.stage.run(2.2);
    let (first, dye) = (basin.rings(), sum(basin.matter()));
    basin.stage.run(0.1);
    let moved = first.iter().zip(basin.rings()).map(|(a, b)| (a.z - b.z).abs()).fold(0.0, f32::max);
    assert!(before > 0.1 && (dye / before - 1.0).abs() < 0.01, "{dye} of {before} is left");
    assert!(moved > 1e-5, "rings go on: {moved}");
}

/// Deep still water without foam.
fn pond(size: f32) -> Basin {
    let foam = WaterFoam { shore: 0.0, ..default() };
    let settings = WaterInteraction { decay: 1e3, dye_life: 1e6, ..default() };
    Basin::new(Vec2::splat(size), None, (WaterWaves::still(), foam, settings))
}

#[test]
fn a_ring_grows_with_its_celerity() {
    let mut basin = pond(30.0);
    let middle = basin.place(IVec2::splat(60));
    basin.frame(strokes(vec![Stroke { volume: 0.1, ..stroke(middle, 0.75) }]));
    let crest = |basin: &mut Basin, seconds: f64| {
        basin.stage.run(seconds);
        let rings = basin.rings();
        let height = |n: usize| rings[60 * 120 + 60 + n].z;
        let top = (4..58).max_by(|a, b| height(*a).total_cmp(&height(*b))).unwrap();
        let (a, b, c) = (height(top - 1), height(top), height(top + 1));
        (top as f32 + 0.5 * (a - c) / (a - 2.0 * b + c)) * 0.25
    };
    let (first, second) = (crest(&mut basin, 3.0), crest(&mut basin, 5.0));
    let expected = (9.81 * 1.2 / core::f32::consts::TAU).sqrt();
    let speed = (second - first) / 5.0;
    println!("{speed} m/s, expected {expected}");
    assert!((speed / expected - 1.0).abs() < 0.03, "{speed} m/s, not {expected}");
}

#[test]
fn dye_is_kept_and_stays_where_it_is_while_the_window_moves() {
    let settings = WaterInteraction { cells: 96, dye_life: 1e6, spreading: 0.01, ..default() };
    let drift = vec2(0.5, -0.25);
    let bed = WaterBed::from_fn(uvec2(60, 60), 2.0, |_| -1.0).unwrap();
    let mut basin =
        Basin::new(Vec2::splat(110.0), Some(bed), (WaterWaves::still(), settings, WaterFlow::uniform(drift)));
    let pose = Transform::from_xyz(0.0, 8.0, 0.0).looking_to(vec3(0.0, -1.0, -0.1), Vec3::NEG_Z);
    let camera = basin.stage.camera(PerspectiveProjection::default(), pose);
    basin.stage.settle();
    let measure = |basin: &mut Basin| {
        let matter = basin.matter();
        let sum = |sum: (Vec2, f32), (i, at)| {
            let dye: f32 = matter[i as usize].y;
            (sum.0 + dye * basin.place(at), sum.1 + dye)
        };
        let (sum, total) = basin.cells().iter().enumerate().map(|(i, at)| (i as u32, at)).fold((Vec2::ZERO, 0.0), sum);
        (sum / total, total * basin.cells().area())
    };
    basin.frame(strokes(vec![Stroke { dye: vec3(2.0, 1.0, 0.5), ..stroke(vec2(1.0, 0.5), 0.6) }]));
    let (from, before) = measure(&mut basin);
    assert!((before - 2.0).abs() < 0.004, "{before} is spilled");
    let mut windows = vec![*basin.get::<FieldWindow>()];
    for step in 0..6 {
        let mut pose = basin.stage.app.world_mut().get_mut::<Transform>(camera).unwrap();
        pose.translation += vec3(1.3, 0.0, if step % 2 == 0 { 1.9 } else { -1.1 });
        basin.stage.run(0.5);
        windows.push(*basin.get::<FieldWindow>());
    }
    windows.dedup();
    assert!(windows.len() > 3, "the window moves: {windows:?}");
    let (to, after) = measure(&mut basin);
    println!("{after} of {before} is left, moved {}", to - from);
    assert!((after / before - 1.0).abs() < 2e-3, "{after} of {before} is left");
    assert!(
        (to - from).distance(drift * 3.0) < 0.01 * 3.0 * drift.length(),
        "moved {}, not {}",
        to - from,
        drift * 3.0
    );
}

#[test]
fn a_body_that_falls_in_raises_what_it_displaces() {
    let mut basin = pond(10.0);
    basin.frame(Deposits::default());
    let draft = |frame: u32| Deposits { silhouettes: body(frame), ..default() };
    (1..4).for_each(|_| basin.frame(draft(3)));
    let area = basin.cells().area();
    let volume: f32 = basin.rings().iter().map(|texel| texel.z).sum::<f32>() * area;
    let displaced = body(3).iter().map(|one| one.draft).sum::<f32>() * area;
    assert!((volume / displaced - 1.0).abs() < 2e-3, "{volume} m³ of {displaced}");
    // It leaves again, and so does what it raised.
    basin.frame(Deposits::default());
    let left: f32 = basin.rings().iter().map(|texel| texel.z).sum::<f32>() * area;
    assert!(left.abs() < 2e-3 * displaced, "{left} m³ is left");
}

#[test]
fn rings_have_one_speed_on_coarse_and_fine_cells() {
    let height_at = |cell: f32| {
        let mut basin = pond(24.0);
        basin.stage.app.world_mut().get_mut::<WaterInteraction>(basin.water).unwrap().cell = cell;
        basin.stage.settle();
        basin.frame(strokes(vec![Stroke { volume: 0.2, ..stroke(Vec2::ZERO, 1.2) }]));
        basin.stage.run(4.0);
        let rings = basin.rings();
        let size = basin.cells().size.x as usize;
        let row: Vec<f32> = (size / 2..size - 2).map(|column| rings[size / 2 * size + column].z).collect();
        let top = (1..row.len() - 1).max_by(|a, b| row[*a].total_cmp(&row[*b])).unwrap();
        let (a, b, c) = (row[top - 1], row[top], row[top + 1]);
        (top as f32 + 0.5 + 0.5 * (a - c) / (a - 2.0 * b + c)) * cell
    };
    let (fine, coarse) = (height_at(0.2), height_at(0.4));
    assert!((coarse / fine - 1.0).abs() < 0.03, "crest at {fine} m on fine cells, at {coarse} m on coarse ones");
}

/// `cargo test --lib costs_of_a_frame -- --ignored --nocapture`
#[test]
#[ignore = "prints costs"]
fn costs_of_a_frame() {
    for size in [256_u32, 512] {
        let bed = || {
            WaterBed::from_fn(uvec2(64, 64), size as f32 / 256.0, |p| 0.1 * (p.x.abs() - 0.08 * size as f32)).unwrap()
        };
        let half = size as f32 / 8.0;
        for (what, flow, deposits) in [
            ("foam on still water", WaterFlow::default(), false),
            ("foam and rings on still water", WaterFlow::default(), true),
            ("foam and rings in a current", WaterFlow::uniform(vec2(0.1, 0.6)), true),
        ] {
            let mut basin = Basin::new(Vec2::splat(half * 2.0), Some(bed()), flow);
            assert_eq!(basin.cells().size, UVec2::splat(size));
            let mut times = Vec::new();
            for idle in [false, true] {
                if idle {
                    basin.stage.app.world_mut().resource_mut::<Time<Virtual>>().pause();
                }
                let mut frames: Vec<f64> = (0..30)
                    .map(|_| {
                        let silhouettes = if deposits { body(3) } else { Vec::new() };
                        let start = std::time::Instant::now();
                        basin.frame(Deposits { silhouettes, ..default() });
                        start.elapsed().as_secs_f64() * 1e3
                    })
                    .collect();
                frames.sort_by(f64::total_cmp);
                times.push(frames[frames.len() / 2]);
            }
            println!("{size} × {size}, {what}: {:.2} ms a frame (idle {:.2} ms)", times[0] - times[1], times[1]);
        }
    }
}

#[test]
fn every_stage_compiles() {
    use bevy::render::render_resource::{CachedPipelineState, PipelineCache};
    let mut stage = Stage::new();
    stage.spawn(Water::new(Vec2::splat(10.0)));
    (0..30).for_each(|_| stage.app.update());
    let cache = stage.app.sub_app(RenderApp).world().resource::<PipelineCache>();
    let failed: Vec<String> = cache
        .pipelines()
        .filter_map(
            |one| if let CachedPipelineState::Err(error) = &one.state { Some(format!("{error}")) } else { None },
        )
        .collect();
    assert!(failed.is_empty(), "{failed:#?}");
    assert!(stages_are_ready(&stage), "all stages are made");
}

fn stages_are_ready(stage: &Stage) -> bool {
    use bevy::render::render_resource::PipelineCache;
    let world = stage.app.sub_app(RenderApp).world();
    world.resource::<stages::Stages>().are_ready(world.resource::<PipelineCache>())
}
