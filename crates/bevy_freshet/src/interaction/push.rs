//! How bodies push simulated water.
use crate::simulation::SilhouetteCell;
use bevy::prelude::*;
use freshet_hydro::shallow_water::{Push, spread};

/// Adds what a body does to the water of a simulation of `size` cells: the drag of its silhouette's `cells`, whose `area` is that of
/// the whole section (m²), with this drag `coefficient`.
pub(super) fn push(
    cells: impl Iterator<Item = SilhouetteCell>,
    coefficient: f32,
    area: f32,
    size: UVec2,
    pushes: &mut Vec<Push>,
) {
    // s = ½ C D/L with the length of a square of the same area.
    let per_draft = 0.5 * coefficient / area.sqrt();
    for silhouette in cells {
        let strength = per_draft * silhouette.draft;
        for (offset, share) in spread() {
            let cell = silhouette.cell.as_ivec2() + offset;
            if cell.cmpge(IVec2::ZERO).all() && cell.cmplt(size.as_ivec2()).all() {
                let strength = share * strength;
                pushes.push(Push { cell: cell.as_uvec2(), strength, velocity: silhouette.velocity, force: Vec2::ZERO });
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_push_is_spread_and_its_sum_kept() {
        let mut pushes = Vec::new();
        let silhouette = SilhouetteCell { cell: uvec2(3, 4), cover: 1.0, draft: 0.8, velocity: Vec2::X };
        push([silhouette].into_iter(), 2.0, 4.0, uvec2(8, 8), &mut pushes);
        let sum: f32 = pushes.iter().map(|push| push.strength).sum();
        assert!(pushes.len() == 9 && (sum - 0.5 * 2.0 * 0.8 / 2.0).abs() < 1e-6, "{sum}");
        assert!(pushes.iter().all(|push| push.velocity == Vec2::X));
        let middle = pushes.iter().find(|push| push.cell == uvec2(3, 4)).expect("the middle is pushed");
        assert!((middle.strength / sum - 0.25).abs() < 1e-6);
        // A corner has three neighbours.
        pushes.clear();
        push([SilhouetteCell { cell: UVec2::ZERO, ..silhouette }].into_iter(), 1.0, 1.0, uvec2(4, 4), &mut pushes);
        assert_eq!(pushes.len(), 4);
    }
}
