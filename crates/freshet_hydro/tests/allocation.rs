//! Steps of water and the loads of bodies take no memory: with a counting allocator, which is why this is a binary of its own.
#![expect(unsafe_code, reason = "an allocator is unsafe by its trait")]

use freshet_hydro::{
    grid::Grid,
    hull::{Hull, HullDrag},
    load::{BodyState, Fluid, Pose, Surface},
    shallow_water::{DomainSide, Edge, EdgePart, PointSource, Series, ShallowWater},
};
use glam::{Quat, UVec2, Vec2, Vec3};
use std::{
    alloc::{GlobalAlloc, Layout, System},
    cell::Cell,
};

/// The system's allocator, counting.
struct Counting;

thread_local! {
    /// How often this thread asked for memory: the test harness has threads of its own.
    static COUNT: Cell<usize> = const { Cell::new(0) };
}

// SAFETY: every call goes to the system's allocator unchanged.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        COUNT.set(COUNT.get() + 1);
        // SAFETY: as the caller promised.
        unsafe { System.alloc(layout) }
    }

    unsafe fn realloc(&self, memory: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        COUNT.set(COUNT.get() + 1);
        // SAFETY: as the caller promised.
        unsafe { System.realloc(memory, layout, size) }
    }

    unsafe fn dealloc(&self, memory: *mut u8, layout: Layout) {
        // SAFETY: as the caller promised.
        unsafe { System.dealloc(memory, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// Water with everything that a step has to look at, on several bands and strips.
fn water() -> ShallowWater {
    let bed = Grid::from_fn(UVec2::new(600, 200), 1.0, |cell| 0.01 * cell.x as f32 - 0.02 * cell.y as f32);
    let mut water = ShallowWater::new(&bed.expect("a valid shape")).expect("a finite bed");
    water.fill(0.5).expect("a sane level");
    water.set_manning(0.03).expect("a sane roughness");
    water.set_rain(1e-5).expect("a sane rain");
    let tide = Series::Tide { mean: 0.4, amplitude: 0.2, period: 600.0, high_water: 0.0 };
    for (side, edge) in [
        (DomainSide::West, Edge::Discharge(Series::Table(vec![(0.0, 1.0), (60.0, 9.0)]))),
        (DomainSide::East, Edge::Open),
        (DomainSide::North, Edge::Still(0.5.into())),
        (DomainSide::South, Edge::Level(tide)),
    ] {
        water.set_edge(side, EdgePart::All, edge).expect("a sane edge");
    }
    water.set_sources(vec![PointSource { at: Vec2::ZERO, radius: 8.0, rate: 2.0.into() }]).expect("sane sources");
    water.set_wall(UVec2::new(300, 100), DomainSide::East, 0.4).expect("a cell of the domain");
    water
}

/// After the first steps, a hundred more ask for no memory.
#[test]
fn a_step_takes_no_memory() {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a thread");
    let taken = pool.install(|| {
        let mut water = water();
        water.advance(1e9, 20);
        let before = COUNT.get();
        let advance = water.advance(1e9, 100);
        let taken = COUNT.get() - before;
        assert_eq!(advance.steps, 100);
        taken
    });
    println!("100 steps asked {taken} times for memory");
    assert_eq!(taken, 0);
}

/// A hull that bobs and turns asks for memory in its first step only.
#[test]
fn a_load_takes_no_memory() {
    let hull = Hull::capsule(0.5, 0.3).expect("a capsule");
    let mut points = Vec::new();
    let mut load = |k: u16| {
        let angle = 0.1 * f32::from(k);
        let pose = Pose { position: Vec3::Y * (0.4 * angle.sin()), rotation: Quat::from_rotation_z(angle) };
        let surface = |place: Vec2| Some(Surface { height: 0.1 * place.x, ..Surface::default() });
        let body = BodyState { pose, centre: pose.position, ..BodyState::default() };
        hull.load(&body, &Fluid::default(), &HullDrag::default(), &mut points, surface).submerged_volume
    };
    load(0);
    let before = COUNT.get();
    let volume: f32 = (1..100).map(load).sum();
    let taken = COUNT.get() - before;
    println!("99 loads asked {taken} times for memory, {volume} m³ in all");
    assert_eq!(taken, 0);
}
