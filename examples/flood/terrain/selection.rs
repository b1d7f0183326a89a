//! Which tiles are drawn from a place: as few as keep the error on the screen below a number of pixels.
use super::tree::{Tile, Tree};
use bevy::{
    camera::primitives::{Aabb, Frustum},
    platform::collections::HashSet,
    prelude::*,
};
use std::{cmp::Ordering, collections::BinaryHeap};

/// Share of the tolerance below which a tile that was split is whole again, so that a camera that trembles changes nothing.
const CALM: f32 = 0.7;

/// How much less an error counts beside the picture: there tiles only cast shadows, and wait for a turn of the camera.
const BESIDE: f32 = 0.25;

/// From where the terrain is seen.
#[derive(Clone, Copy, Debug)]
pub struct Eye {
    /// Place in the frame of the terrain, heights exaggerated.
    pub place: Vec3,
    /// Pixels of a length of 1 m at a distance of 1 m.
    pub pixels: f32,
    pub exaggeration: f32,
    /// What of it is in the picture; all, if nothing is told.
    pub frustum: Option<Frustum>,
}

impl Eye {
    /// The error of a tile on the screen, pixels: e h / (2 r tan(φ/2)) for its error e in the nearest distance r, and less
    /// of it beside the picture.
    pub fn error(&self, tree: &Tree, tile: Tile) -> f32 {
        let bounds = tree.bounds(tile);
        let ([low, high], heights) = (tree.area(tile), bounds.heights * self.exaggeration);
        let [low, high] = [vec3(low.x, heights.x, low.y), vec3(high.x, heights.y, high.y)];
        if bounds.error == 0.0 {
            return 0.0;
        }
        let is_seen = |frustum: &Frustum| frustum.intersects_obb_identity(&Aabb::from_min_max(low, high));
        let weight = if self.frustum.as_ref().is_none_or(is_seen) { 1.0 } else { BESIDE };
        let nearest = self.place.clamp(low, high);
        weight * bounds.error * self.exaggeration * self.pixels / self.place.distance(nearest)
    }
}

/// What is to be drawn.
#[derive(Clone, Debug, Default)]
pub struct Selection {
    /// Tiles that cover the terrain once.
    pub leaves: HashSet<Tile>,
    /// Those above them.
    pub split: HashSet<Tile>,
}

/// The tiles whose error is below `tolerance` (pixels), but at most `most` of them; then the worst errors are the smallest
/// possible. With what was `split` before, changes have some slack.
pub fn select(tree: &Tree, eye: &Eye, tolerance: f32, most: usize, split: &HashSet<Tile>) -> Selection {
    let mut selection = Selection::default();
    let mut open = BinaryHeap::from([Candidate::new(tree, eye, tree.root())]);
    let mut count = 1;
    while let Some(Candidate { error, tile }) = open.pop() {
        let limit = if split.contains(&tile) { CALM * tolerance } else { tolerance };
        let children = tree.children(tile).count();
        if children == 0 || error <= limit || count + children - 1 > most {
            selection.leaves.insert(tile);
            continue;
        }
        count += children - 1;
        selection.split.insert(tile);
        open.extend(tree.children(tile).map(|child| Candidate::new(tree, eye, child)));
    }
    selection
}

/// A tile, in the order of its error.
struct Candidate {
    error: f32,
    tile: Tile,
}

impl Candidate {
    fn new(tree: &Tree, eye: &Eye, tile: Tile) -> Self {
        Self { error: eye.error(tree, tile), tile }
    }
}

impl Ord for Candidate {
    fn cmp(&self, other: &Self) -> Ordering {
        self.error.total_cmp(&other.error).then(self.tile.number().cmp(&other.tile.number()))
    }
}

impl PartialOrd for Candidate {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Candidate {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for Candidate {}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::terrain::tree::tests::tree;

    fn eye(place: Vec3) -> Eye {
        Eye { place, pixels: 650.0, exaggeration: 2.0, frustum: None }
    }

    /// Eyes above, beside and in the terrain.
    const PLACES: [Vec3; 4] =
        [vec3(100.0, 30.0, -200.0), vec3(0.0, 2000.0, 0.0), vec3(-900.0, 5.0, 900.0), vec3(0.0, 0.0, 0.0)];

    #[test]
    fn a_selection_covers_the_terrain_exactly_once() {
        let tree = tree(uvec2(700, 430));
        for place in PLACES {
            let chosen = select(&tree, &eye(place), 1.0, 1000, &HashSet::default());
            let area = |tile: &Tile| (tree.area(*tile)[1] - tree.area(*tile)[0]).element_product();
            let sum: f32 = chosen.leaves.iter().map(area).sum();
            assert!((sum - 1400.0 * 860.0).abs() < 1.0, "{place}: {sum} m²");
            // Equal areas without a tile above another: no overlap.
            assert!(chosen.leaves.iter().all(|tile| !chosen.split.contains(tile)));
        }
    }

    #[test]
    fn errors_are_within_the_tolerance_and_near_tiles_are_finer() {
        let tree = tree(uvec2(700, 430));
        let eye = eye(vec3(-690.0, 20.0, -400.0));
        let chosen = select(&tree, &eye, 1.5, 1000, &HashSet::default());
        assert!(chosen.leaves.iter().all(|tile| tile.level == 0 || eye.error(&tree, *tile) <= 1.5));
        assert!(chosen.leaves.contains(&Tile { level: 0, at: UVec2::ZERO }));
        let far = select(&tree, &Eye { place: vec3(0.0, 1e5, 0.0), ..eye }, 1.5, 1000, &HashSet::default());
        assert_eq!(far.leaves, HashSet::from_iter([tree.root()]));
    }

    #[test]
    fn what_is_not_in_the_picture_is_coarser() {
        let tree = tree(uvec2(700, 430));
        let pose = Transform::from_xyz(0.0, 20.0, 0.0).looking_to(Vec3::X, Vec3::Y);
        let clip_from_view = Mat4::perspective_infinite_reverse_rh(0.8, 1.8, 0.1);
        let all = eye(pose.translation);
        let ahead = Eye { frustum: Some(super::super::frustum(clip_from_view, &pose)), ..all };
        let [all, ahead] = [all, ahead].map(|eye| select(&tree, &eye, 60.0, 1000, &HashSet::default()).leaves);
        assert!(ahead.len() < all.len());
        let is_seen = |tile: &&Tile| tree.area(**tile)[0].x > 0.0 && tree.area(**tile)[0].y.abs() < 1.0;
        let seen = |tiles: &HashSet<Tile>| tiles.iter().filter(is_seen).copied().collect::<HashSet<_>>();
        assert_eq!(seen(&ahead), seen(&all));
    }

    #[test]
    fn there_are_no_more_tiles_than_allowed() {
        let tree = tree(uvec2(700, 430));
        for most in [1, 5, 20] {
            let chosen = select(&tree, &eye(Vec3::ZERO), 0.0, most, &HashSet::default());
            assert!(chosen.leaves.len() <= most && chosen.leaves.len() + 3 > most, "{}", chosen.leaves.len());
        }
    }

    #[test]
    fn a_camera_that_trembles_changes_nothing() {
        let tree = tree(uvec2(700, 430));
        let at = |height: f32| eye(vec3(0.0, height, 0.0));
        let first = select(&tree, &at(600.0), 1.0, 1000, &HashSet::default());
        let mut now = first.clone();
        for height in [610.0, 605.0, 612.0, 600.0] {
            now = select(&tree, &at(height), 1.0, 1000, &now.split);
            assert_eq!(now.leaves, first.leaves);
        }
    }
}
