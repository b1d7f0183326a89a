//! River flow against solutions in closed form: η = a·s(x, z) with depths that vary only across the flow.

#![expect(clippy::unwrap_used, reason = "a test ends where something is wrong")]

use std::f32::consts::{FRAC_PI_4, FRAC_PI_6};

use approx::assert_relative_eq;
use freshet_hydro::flow::{End, FlowError, FlowField, MINIMUM_DEPTH, Reach, Section, discharge_across, steady_flow};
use freshet_hydro::grid::Grid;
use glam::{UVec2, Vec2, uvec2, vec2};

/// Land, in metres above the water, which lies at 0 in all tests.
const LAND: f32 = 1.0;
const DISCHARGE: f32 = 40.0;

fn terrain(size: UVec2, cell_size: f32, bed: impl Fn(Vec2) -> f32) -> Grid<f32> {
    let grid = Grid::from_fn(size, cell_size, |_| ()).unwrap();
    Grid::from_fn(size, cell_size, |cell| bed(grid.position(cell))).unwrap()
}

fn section(from: Vec2, to: Vec2) -> Section {
    Section::new(from, to)
}

/// A section across x: its discharge is positive to the east.
fn across_x(x: f32) -> Section {
    section(vec2(x, 1e3), vec2(x, -1e3))
}

fn flow(bed: &Grid<f32>, inflow: Section, outflow: Section) -> FlowField {
    steady_flow(bed, 0.0, &Reach::new(inflow, outflow, DISCHARGE)).unwrap()
}

/// ∫ f over [from, to] by the midpoint rule.
fn integral(from: f32, to: f32, f: impl Fn(f32) -> f32) -> f32 {
    let steps = 1000;
    let width = (to - from) / steps as f32;
    (0..steps).map(|step| f(from + (step as f32 + 0.5) * width) * width).sum()
}

#[test]
fn uniform_flow_in_a_rectangular_channel_obeys_manning() {
    let (depth, width, length) = (2.5_f32, 20.0, 160.0);
    let bed = terrain(uvec2(80, 30), 2.0, |p| if p.y.abs() < width / 2.0 { -depth } else { LAND });
    // On the western and eastern edges of the grid.
    let field = flow(&bed, across_x(-80.0), across_x(80.0));
    let slope = field.head_drop() / length;
    let speed = depth.powf(2.0 / 3.0) * slope.sqrt() / Reach::NATURAL_CHANNEL;
    assert_relative_eq!(speed * width * depth, DISCHARGE, max_relative = 1e-4);
    for (cell, &velocity) in field.velocity().iter() {
        let wet = bed.get(cell).unwrap() < &0.0;
        let expected = if wet { vec2(speed, 0.0) } else { Vec2::ZERO };
        assert!(velocity.abs_diff_eq(expected, 1e-4 * speed), "{cell}: {velocity}");
    }
    assert_relative_eq!(field.max_speed(), speed, max_relative = 1e-4);
    assert_relative_eq!(field.mean_speed(), speed, max_relative = 1e-4);
    assert_relative_eq!(field.area(), width * length);
    // Head falls linearly, and half a cell beside the inflow it is 1/160 below that of the section.
    let first = field.head().sample(vec2(-79.0, 0.0));
    assert_relative_eq!(first / field.head_drop(), 1.0 - 1.0 / length, max_relative = 1e-4);
    assert!(field.head().sample(vec2(0.0, 20.0)).is_nan());
}

#[test]
fn speed_varies_with_the_two_thirds_power_of_depth_across_a_trapezoid() {
    let depth = |z: f32| (0.4 * (12.0 - z.abs())).min(2.0);
    let bed = terrain(uvec2(60, 32), 1.0, |p| -depth(p.y));
    let field = flow(&bed, across_x(-25.0), across_x(25.0));
    let slope = field.head_drop() / 50.0;
    for z in [-11.5_f32, -9.5, -7.5, -0.5, 4.5, 10.5] {
        let velocity = field.velocity().sample(vec2(3.0, z));
        let expected = depth(z).powf(2.0 / 3.0) * slope.sqrt() / Reach::NATURAL_CHANNEL;
        assert_relative_eq!(velocity.x, expected, max_relative = 1e-3);
        assert!(velocity.y.abs() < 1e-4 * expected);
    }
    // Beyond the sections the water stands still.
    assert_eq!(field.velocity().sample(vec2(-27.0, 0.0)), Vec2::ZERO);
    assert_eq!(field.velocity().sample(vec2(27.0, 0.0)), Vec2::ZERO);
}

#[test]
fn roughness_changes_the_head_and_discharge_scales_the_speed() {
    let bed = terrain(uvec2(30, 10), 1.0, |p| 0.5 * p.y.abs() - 2.0);
    let reach = Reach::new(across_x(-15.0), across_x(15.0), 5.0);
    let base = steady_flow(&bed, 0.0, &reach).unwrap();
    let rough = steady_flow(&bed, 0.0, &Reach { manning: 0.06, ..reach }).unwrap();
    let double = steady_flow(&bed, 0.0, &Reach { discharge: 10.0, ..reach }).unwrap();
    assert_relative_eq!(rough.head_drop(), 4.0 * base.head_drop(), max_relative = 1e-5);
    assert_relative_eq!(double.head_drop(), 4.0 * base.head_drop(), max_relative = 1e-5);
    assert_relative_eq!(rough.max_speed(), base.max_speed(), max_relative = 1e-5);
    assert_relative_eq!(double.max_speed(), 2.0 * base.max_speed(), max_relative = 1e-5);
}

#[test]
fn a_channel_askew_to_the_grid_flows_as_a_straight_one() {
    let (sin, cos) = FRAC_PI_6.sin_cos();
    let (along, across) = (vec2(cos, sin), vec2(-sin, cos));
    let depth = |offset: f32| 3.0 * (1.0 - offset * offset / 144.0);
    let at = |s: f32| section(along * s + across * 15.0, along * s - across * 15.0);
    let conveyance = integral(-12.0, 12.0, |offset| depth(offset).powf(5.0 / 3.0));
    // The error must fall with the square of the cell size.
    for (cell_size, tolerance) in [(2.0, 0.016), (1.0, 0.004)] {
        let size = (vec2(200.0, 140.0) / cell_size).as_uvec2();
        let bed = terrain(size, cell_size, |p| (-depth(p.dot(across))).min(LAND));
        let field = flow(&bed, at(-60.0), at(60.0));
        for s in [-30.0, -7.0, 0.0, 11.0, 30.0] {
            for offset in [-7.0, -5.0, 0.0, 3.3, 6.0] {
                let velocity = field.velocity().sample(along * s + across * offset);
                let expected = DISCHARGE * depth(offset).powf(2.0 / 3.0) / conveyance * along;
                assert!(
                    velocity.abs_diff_eq(expected, tolerance * expected.length()),
                    "{s} {offset}: {velocity} instead of {expected}"
                );
            }
            assert_relative_eq!(field.discharge_through(&at(s)), DISCHARGE, max_relative = 1e-5);
            let seen = discharge_across(field.velocity(), &bed, 0.0, &at(s));
            assert_relative_eq!(seen, DISCHARGE, max_relative = tolerance);
        }
    }
}

#[test]
fn in_a_bend_the_inner_thread_is_the_faster() {
    // η falls with the angle, so |∇η| = a / r and u = d^(2/3) √(a / r) / n.
    let (inner, outer) = (30.0, 54.0);
    let depth = |r: f32| 0.02 * (r - inner) * (outer - r);
    let centre = vec2(-30.0, -30.0);
    let bed = terrain(uvec2(70, 70), 1.0, |p| (-depth(p.distance(centre))).min(LAND));
    let ray = |angle: f32| {
        let direction = Vec2::from_angle(angle);
        section(centre + direction * (inner - 3.0), centre + direction * (outer + 3.0))
    };
    let field = flow(&bed, ray(0.02), ray(1.55));
    let conveyance = integral(inner, outer, |r| depth(r).powf(5.0 / 3.0) / r.sqrt());
    for angle in [0.4, FRAC_PI_4, 1.0] {
        let direction = Vec2::from_angle(angle);
        for r in [34.0_f32, 38.0, 42.0, 46.0, 50.0] {
            let velocity = field.velocity().sample(centre + direction * r);
            let speed = DISCHARGE * depth(r).powf(2.0 / 3.0) / r.sqrt() / conveyance;
            let expected = speed * direction.perp();
            assert!(velocity.abs_diff_eq(expected, 0.05 * speed), "{angle} {r}: {velocity} instead of {expected}");
        }
        assert_relative_eq!(field.discharge_through(&ray(angle)), DISCHARGE, max_relative = 1e-5);
        let seen = discharge_across(field.velocity(), &bed, 0.0, &ray(angle));
        assert_relative_eq!(seen, DISCHARGE, max_relative = 0.03);
    }
}

#[test]
fn an_island_parts_the_discharge_and_a_dead_end_carries_none() {
    // The southern arm is twice as wide as the northern one and a creek leads north from that.
    let bed = terrain(uvec2(120, 60), 1.0, |p| {
        let channel = (-12.0..18.0).contains(&p.y);
        let island = p.x.abs() < 40.0 && (-6.0..6.0).contains(&p.y);
        let creek = (0.0..3.0).contains(&p.x) && p.y < 0.0;
        if (channel || creek) && !island { -2.0 } else { LAND }
    });
    let field = flow(&bed, across_x(-60.0), across_x(60.0));
    let north = field.discharge_through(&section(vec2(20.0, 0.0), vec2(20.0, -30.0)));
    let south = field.discharge_through(&section(vec2(20.0, 30.0), vec2(20.0, 0.0)));
    assert_relative_eq!(north + south, DISCHARGE, max_relative = 1e-5);
    assert_relative_eq!(south / north, 2.0, max_relative = 0.06);
    let creek = field.discharge_through(&section(vec2(-1.0, -20.0), vec2(4.0, -20.0)));
    assert!(creek.abs() < 1e-5 * DISCHARGE);
    assert!(field.velocity().sample(vec2(1.5, -20.0)).length() < 1e-3 * field.max_speed());
    // A ring around the fork lets out what comes in.
    let corners = [vec2(-50.0, -25.0), vec2(-20.0, -25.0), vec2(-20.0, 25.0), vec2(-50.0, 25.0)];
    let sum: f32 = (0..4).map(|side| field.discharge_through(&section(corners[side], corners[(side + 1) % 4]))).sum();
    assert!(sum.abs() < 1e-5 * DISCHARGE);
}

#[test]
fn sections_cross_the_river_evenly() {
    let bed = terrain(uvec2(80, 30), 1.0, |p| 0.3 * p.y.abs() - 3.0);
    let field = flow(&bed, across_x(-40.0), across_x(40.0));
    let sections = field.sections(8);
    assert_eq!(sections.len(), 8);
    for (index, found) in sections.iter().enumerate() {
        let middle = -40.0 + 10.0 * (index as f32 + 0.5);
        assert!((found.from.x - middle).abs() <= 5.0);
        assert!(found.normal().abs_diff_eq(Vec2::X, 1e-3));
        assert!(found.length() > 19.0);
        assert_relative_eq!(field.discharge_through(found), DISCHARGE, max_relative = 1e-5);
    }
}

#[test]
fn depth_without_data_or_below_the_minimum_is_land() {
    let bed = terrain(uvec2(20, 6), 1.0, |p| match p.y {
        -3.0..-2.0 => f32::NAN,
        -2.0..-1.0 => -0.9 * MINIMUM_DEPTH,
        _ => -1.0,
    });
    let field = flow(&bed, across_x(-10.0), across_x(10.0));
    assert_relative_eq!(field.area(), 80.0);
    assert_eq!(field.velocity().sample(vec2(0.5, -2.5)), Vec2::ZERO);
    assert_eq!(field.velocity().sample(vec2(0.5, -1.5)), Vec2::ZERO);
    let seen = discharge_across(field.velocity(), &bed, 0.0, &across_x(0.0));
    assert!(seen > 0.0 && seen < 1.1 * DISCHARGE, "{seen}");
}

#[test]
fn errors_name_what_is_wrong() {
    let bed = terrain(uvec2(40, 20), 1.0, |p| if p.y.abs() < 4.0 && p.x != 0.5 { -1.0 } else { LAND });
    let (west, east) = (across_x(-15.0), across_x(-5.0));
    let run = |level, reach: Reach| steady_flow(&bed, level, &reach).unwrap_err();
    let reach = Reach::new(west, east, 1.0);

    assert_eq!(run(f32::INFINITY, reach), FlowError::Level(f32::INFINITY));
    assert_eq!(run(0.0, Reach { discharge: 0.0, ..reach }), FlowError::Discharge(0.0));
    assert_eq!(run(0.0, Reach { manning: -0.1, ..reach }), FlowError::Manning(-0.1));
    assert_eq!(run(-2.0, reach), FlowError::Dry(-2.0));
    // A dam stands across x = 0.5.
    let beyond = Reach { outflow: across_x(10.0), ..reach };
    assert_eq!(run(0.0, beyond), FlowError::NotConnected);
    let short = Reach { outflow: section(vec2(-5.0, -9.0), vec2(-5.0, 2.0)), ..reach };
    assert_eq!(run(0.0, short), FlowError::PassedRound(End::Outflow));
    let off = section(vec2(-15.0, 6.0), vec2(-15.0, 9.0));
    let message = run(0.0, Reach { inflow: off, ..reach }).to_string();
    assert_eq!(
        message,
        "the inflow section from (-15, 6) to (-15, 9) crosses no water; \
         the grid reaches from (-20, -10) to (20, 10)"
    );
}
