//! Cases with a known answer, for any backend.

pub mod basin;
pub mod dam_break;
pub mod displaced;
pub mod edges;
pub mod order;
pub mod push;
pub mod rest;
pub mod steady;
pub mod symmetry;
pub mod terrain;
pub mod volume;
pub mod walls;

use freshet_hydro::{grid::Grid, shallow_water::ShallowWater};
use glam::{UVec2, Vec2};

/// Hands the names of all cases to the macro `$on`, but for the one whose steps are counted.
macro_rules! every_case {
    ($on:ident) => {
        $on! {
            basin { planar }
            dam_break { ritter_and_stoker }
            displaced {
                a_body_that_is_lowered_raises_the_level
                a_resting_body_leaves_still_water_still
                a_body_that_drifts_leaves_no_trace
                a_ring_holds_what_was_displaced
                what_pushes_the_body_pushes_the_water_back
                mirrored_bodies_make_mirrored_waves
            }
            edges {
                reflect
                a_ring_leaves
                a_stream_passes
                a_tide_is_followed
                a_discharge_enters_dry_land
                no_more_is_taken_than_there_is
                a_part_of_a_side
            }
            order { of_a_smooth_wave }
            push { by_the_drag_of_a_body a_bow_wave_and_a_trough a_body_that_drifts_leaves_no_trace }
            rest { over_bumps over_terrain }
            steady {
                over_a_bump
                a_jump_stands_still_on_any_grid
                a_jump_stays_straight
                uniform
                a_sheet_on_a_slope
                uniform_to_an_open_edge
            }
            symmetry { a_round_dam times_do_not_depend_on_the_grid }
            volume { with_inflow_tide_and_rain a_poisoned_cell_infects_nobody }
            walls {
                a_closed_wall_leaks_nothing
                a_weir_holds_what_is_below_its_crest
                flow_over_a_weir
                flow_over_a_dike
                an_open_gate_leaves_no_trace
                a_moving_bed_keeps_the_volume
            }
        }
    };
}
pub(crate) use every_case;

/// Simulates the water for a duration, s.
pub type Run<'a> = &'a mut dyn FnMut(&mut ShallowWater, f64);

/// Dry land of columns and rows, whose bed (m) is a function of local (x, z).
pub fn land(columns: u32, rows: u32, cell_size: f32, bed: impl Fn(f64, f64) -> f64) -> ShallowWater {
    ShallowWater::new(&bed_grid(columns, rows, cell_size, bed)).expect("a finite bed")
}

/// The bed of [`land`].
pub fn bed_grid(columns: u32, rows: u32, cell_size: f32, bed: impl Fn(f64, f64) -> f64) -> Grid<f32> {
    let empty =
        Grid::new(UVec2::new(columns, rows), cell_size, vec![(); (columns * rows) as usize]).expect("a valid shape");
    let value = |cell| {
        let at = centre(&empty, cell);
        bed(at[0], at[1]) as f32
    };
    Grid::from_fn(empty.size(), cell_size, value).expect("a valid shape")
}

fn centre<T>(grid: &Grid<T>, cell: UVec2) -> [f64; 2] {
    let middle = [grid.size().x, grid.size().y].map(|count| f64::from(count) / 2.0);
    let size = f64::from(grid.cell_size());
    [(f64::from(cell.x) + 0.5 - middle[0]) * size, (f64::from(cell.y) + 0.5 - middle[1]) * size]
}

/// Local (x, z) of the middle of cell `index`, m.
pub fn place(water: &ShallowWater, index: usize) -> [f64; 2] {
    let size = water.size();
    let cell = [index as u32 % size.x, index as u32 / size.x];
    let middle = [size.x, size.y].map(|count| f64::from(count) / 2.0);
    let side = f64::from(water.cell_size());
    [(f64::from(cell[0]) + 0.5 - middle[0]) * side, (f64::from(cell[1]) + 0.5 - middle[1]) * side]
}

/// Largest speed of any cell, m/s.
pub fn fastest(water: &ShallowWater) -> f32 {
    (0..water.depths().len()).map(|index| water.velocity(index).length()).fold(0.0, f32::max)
}

/// Still water where x and z are in metres.
pub fn still(depth: f64) -> (f32, Vec2) {
    (depth as f32, Vec2::ZERO)
}
