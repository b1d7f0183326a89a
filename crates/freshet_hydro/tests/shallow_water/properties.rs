//! What holds for any bed and any water.
use freshet_hydro::{grid::Grid, shallow_water::ShallowWater};
use glam::{UVec2, Vec2};
use proptest::prelude::*;

/// Columns and rows, and for every cell its bed (m), a depth (m) or less than zero for dry, and a velocity (m/s).
fn ponds() -> impl Strategy<Value = (UVec2, Vec<(f32, f32, f32, f32)>)> {
    (1_u32..24, 1_u32..24).prop_flat_map(|(columns, rows)| {
        let cell = (-5.0_f32..5.0, -2.0_f32..4.0, -5.0_f32..5.0, -5.0_f32..5.0);
        let cells = prop::collection::vec(cell, (columns * rows) as usize);
        (Just(UVec2::new(columns, rows)), cells)
    })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 64, failure_persistence: None, ..ProptestConfig::default() })]

    /// Between walls or wrapped around, the volume stays the same, and every number finite.
    #[test]
    fn any_water_on_any_bed_stays(
        pond in ponds(), manning in 0.0_f32..0.1, periodic: bool, cell_size in 0.1_f32..50.0,
    ) {
        let (size, cells) = pond;
        let bed = Grid::new(size, cell_size, cells.iter().map(|cell| cell.0).collect()).expect("a valid shape");
        let mut water = ShallowWater::new(&bed).expect("a finite bed");
        water.set_manning(manning).expect("a sane roughness");
        water.set_periodic(periodic, periodic);
        let mut next = cells.iter();
        water
            .set_water(|_, _| {
                let &(_, depth, u, v) = next.next().expect("a value for every cell");
                (depth.max(0.0), Vec2::new(u, v))
            })
            .expect("a sane state");
        let before = water.volume();
        let advance = water.advance(1e9, 50);
        prop_assert_eq!(advance.steps, 50);
        let finite = |index: usize| water.depths()[index].is_finite() && water.velocity(index).is_finite();
        prop_assert!((0..water.depths().len()).all(finite));
        prop_assert!(water.depths().iter().all(|depth| *depth >= 0.0));
        prop_assert!((water.volume() - before).abs() <= 1e-6 * before, "{} {before}", water.volume());
    }
}
