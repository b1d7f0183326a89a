//! The flow of the project's real river: assets/terrain/tidal_river_2m.asc under a level of 0.8 m.

#![expect(clippy::unwrap_used, reason = "a test ends where something is wrong")]

use std::path::Path;

use approx::assert_relative_eq;
use freshet_flood::esri_ascii::EsriGrid;
use freshet_flood::flow_map::{Defaults, FlowMap};
use freshet_hydro::flow::{FlowField, MINIMUM_DEPTH, Reach, Section, discharge_across, steady_flow};
use freshet_hydro::grid::Grid;
use glam::{Vec2, vec2};

/// Water level in metres above mean sea level.
const LEVEL: f32 = 0.8;
/// Discharge in m³/s at which the wide lower river runs at about 1 m/s.
const DISCHARGE: f32 = 25.0;
/// Where the water enters, below the confluence of the two upper arms, in local metres from west to east.
const INFLOW: Section = Section { from: vec2(-56.0, -88.0), to: vec2(-28.0, -88.0) };
/// Where it leaves, on the southern edge of the terrain, in local metres from west to east.
const OUTFLOW: Section = Section { from: vec2(-24.0, 452.0), to: vec2(20.0, 452.0) };

fn assets() -> std::path::PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../assets/terrain")
}

fn river() -> (Grid<f32>, FlowField) {
    let bed = EsriGrid::read(assets().join("tidal_river_2m.asc")).unwrap().grid;
    let flow = steady_flow(&bed, LEVEL, &Reach::new(INFLOW, OUTFLOW, DISCHARGE)).unwrap();
    (bed, flow)
}

/// Sections straight along the grid's axes, as someone picks them on the map: they cut the channel at any angle.
const PICKED: [(Vec2, Vec2); 6] = [
    (vec2(-66.0, -30.0), vec2(-12.0, -30.0)),
    (vec2(0.0, 20.0), vec2(28.0, 20.0)),
    (vec2(-60.0, 80.0), vec2(-60.0, 115.0)),
    (vec2(-118.0, 190.0), vec2(-84.0, 190.0)),
    (vec2(224.0, 335.0), vec2(256.0, 335.0)),
    (vec2(90.0, 324.0), vec2(90.0, 356.0)),
];

#[test]
fn discharge_is_the_same_all_along_the_river() {
    let (bed, flow) = river();
    let sections = flow.sections(24);
    assert!(sections.len() >= 20);
    let picked = PICKED.map(|(from, to)| Section::new(from, to));
    for section in sections.iter().chain(&picked) {
        let faces = flow.discharge_through(section).abs();
        assert_relative_eq!(faces, DISCHARGE, max_relative = 1e-5);
        // What shaders and floating bodies see: the bilinear velocity times depth.
        let seen = discharge_across(flow.velocity(), &bed, LEVEL, section).abs();
        assert_relative_eq!(seen, DISCHARGE, max_relative = 0.05);
    }
    assert_relative_eq!(flow.discharge_through(&INFLOW), DISCHARGE, max_relative = 1e-5);
    assert_relative_eq!(flow.discharge_through(&OUTFLOW), DISCHARGE, max_relative = 1e-5);
}

#[test]
fn land_and_creeks_stay_still_and_banks_slow_the_water() {
    let (bed, flow) = river();
    let max_speed = flow.max_speed();
    for (cell, velocity) in flow.velocity().iter() {
        assert!(velocity.is_finite());
        let depth = LEVEL - bed.get(cell).unwrap();
        if depth.is_nan() || depth <= MINIMUM_DEPTH {
            assert_eq!(*velocity, Vec2::ZERO, "{cell}");
        }
        // No wild speeds where the water is thin.
        assert!(depth.is_nan() || depth > 0.3 || velocity.length() < 0.6 * max_speed, "{cell}");
    }
    // A creek that comes in from the north at the top of the great bend, and the arms above the inflow.
    let creek = flow.velocity().sample(vec2(61.0, 140.0));
    assert!(creek.length() < 0.01 * max_speed, "{creek}");
    assert_eq!(flow.velocity().sample(vec2(-46.0, -100.0)), Vec2::ZERO);
    assert!((0.8..1.2).contains(&flow.velocity().sample(vec2(35.0, 190.0)).length()));
    assert!(flow.head_drop() < 0.6);
}

#[test]
fn the_flow_map_in_the_assets_is_this_flow() {
    let (bed, flow) = river();
    let map = FlowMap::read(assets().join("tidal_river_flow.png"), Defaults::default()).unwrap();
    assert_eq!(map.level, Some(LEVEL));
    assert_eq!((map.velocity.size(), map.velocity.cell_size()), (bed.size(), bed.cell_size()));
    for (map, flow) in map.velocity.values().iter().zip(flow.velocity().values()) {
        assert!(map.abs_diff_eq(*flow, 1e-3), "{map} {flow}");
    }
}
