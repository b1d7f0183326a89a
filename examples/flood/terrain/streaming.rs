//! Builds tiles in the background as the camera moves, and shows those that are there.
use super::{
    mesh,
    selection::{Eye, Selection, select},
    tree::{Tile, Tree},
};
use crate::paint::TerrainMaterial;
use bevy::{
    platform::collections::{HashMap, HashSet},
    prelude::*,
    tasks::{AsyncComputeTaskPool, ComputeTaskPool, Task, block_on},
};
use std::sync::Arc;

/// Most tiles that are drawn: eight million triangles.
const MOST_DRAWN: usize = 1024;
/// Most tiles that are kept, if no more are wanted.
const MOST_KEPT: usize = 1536;
/// Tiles that are built at once: few, so that what is wanted by then comes next.
const AT_ONCE: usize = 32;

/// The drawn terrain.
#[derive(Resource)]
pub struct Ground {
    tree: Arc<Tree>,
    /// Whose scale is the exaggeration.
    parent: Entity,
    material: Handle<TerrainMaterial>,
    /// Most pixels by which it may be off.
    tolerance: f32,
    built: HashMap<Tile, Built>,
    building: HashMap<Tile, Task<Mesh>>,
    wanted: Selection,
    shown: HashSet<Tile>,
    frame: u32,
}

struct Built {
    entity: Entity,
    /// Last frame in which it was wanted.
    wanted: u32,
}

/// What tiles are made with.
pub struct Workshop<'a, 'w, 's> {
    pub commands: &'a mut Commands<'w, 's>,
    pub meshes: &'a mut Assets<Mesh>,
}

impl Ground {
    /// A terrain of which nothing is drawn yet, at `parent`.
    pub fn new(tree: Tree, parent: Entity, material: Handle<TerrainMaterial>, tolerance: f32) -> Self {
        Self {
            tree: Arc::new(tree),
            parent,
            material,
            tolerance,
            built: HashMap::default(),
            building: HashMap::default(),
            wanted: Selection::default(),
            shown: HashSet::default(),
            frame: 0,
        }
    }

    /// Triangles that are drawn, skirts not counted.
    fn triangles(&self) -> u32 {
        let quads = |tile: &Tile| {
            let [first, last] = self.tree.vertices(*tile);
            (last - first).element_product()
        };
        2 * self.shown.iter().map(quads).sum::<u32>()
    }

    /// Shows what is seen best from `eye`: if it `waits` then in this frame, so that the picture is the same whatever was shown before.
    pub fn show(&mut self, eye: &Eye, waits: bool, workshop: &mut Workshop) {
        self.frame += 1;
        self.receive(workshop);
        let before = if waits { HashSet::default() } else { core::mem::take(&mut self.wanted.split) };
        self.wanted = select(&self.tree, eye, self.tolerance, MOST_DRAWN, &before);
        for tile in self.wanted.leaves.iter().chain(&self.wanted.split) {
            if let Some(built) = self.built.get_mut(tile) {
                built.wanted = self.frame;
            }
        }
        // What all others can fall back to.
        self.build_now([self.tree.root()], workshop);
        if waits {
            self.build_now(self.wanted.leaves.clone(), workshop);
        } else {
            self.build_ahead(eye);
        }
        let mut shown = Vec::new();
        self.cover(self.tree.root(), &mut shown);
        self.put(shown.into_iter().collect(), workshop.commands);
        self.forget(workshop.commands);
    }

    /// Takes what has been built.
    fn receive(&mut self, workshop: &mut Workshop) {
        let done: Vec<_> = self.building.extract_if(|_, task| task.is_finished()).collect();
        for (tile, task) in done {
            self.add(tile, block_on(task), workshop);
        }
    }

    /// Builds what is missing before it returns.
    fn build_now(&mut self, tiles: impl IntoIterator<Item = Tile>, workshop: &mut Workshop) {
        let missing: Vec<_> = tiles.into_iter().filter(|tile| !self.built.contains_key(tile)).collect();
        let tree = &self.tree;
        let meshes = ComputeTaskPool::get().scope(|scope| {
            for tile in missing {
                scope.spawn(async move { (tile, mesh::mesh(tree, tile)) });
            }
        });
        for (tile, mesh) in meshes {
            self.building.remove(&tile);
            self.add(tile, mesh, workshop);
        }
    }

    /// Begins to build what is missing, coarse tiles first, then those that are off the most.
    fn build_ahead(&mut self, eye: &Eye) {
        let wanted = self.wanted.leaves.iter().chain(&self.wanted.split);
        let is_missing = |tile: &&Tile| !self.built.contains_key(*tile) && !self.building.contains_key(*tile);
        let mut missing: Vec<Tile> = wanted.filter(is_missing).copied().collect();
        missing.sort_by(|a, b| {
            b.level.cmp(&a.level).then(eye.error(&self.tree, *b).total_cmp(&eye.error(&self.tree, *a)))
        });
        for tile in missing.into_iter().take(AT_ONCE.saturating_sub(self.building.len())) {
            let tree = self.tree.clone();
            self.building.insert(tile, AsyncComputeTaskPool::get().spawn(async move { mesh::mesh(&tree, tile) }));
        }
    }

    fn add(&mut self, tile: Tile, mesh: Mesh, workshop: &mut Workshop) {
        let bundle = (
            Mesh3d(workshop.meshes.add(mesh)),
            MeshMaterial3d(self.material.clone()),
            mesh::bounds(&self.tree, tile),
            Visibility::Hidden,
            ChildOf(self.parent),
        );
        let entity = workshop.commands.spawn(bundle).id();
        self.built.insert(tile, Built { entity, wanted: self.frame });
    }

    /// Adds the built tiles that cover the area of `tile` and are nearest to what is wanted; `false` if there are none.
    fn cover(&self, tile: Tile, shown: &mut Vec<Tile>) -> bool {
        let is_built = self.built.contains_key(&tile);
        // Finer tiles than wanted stay until the wanted one is there.
        let is_split = self.wanted.split.contains(&tile) || !is_built;
        if is_split && tile.level > 0 {
            let before = shown.len();
            if self.tree.children(tile).all(|child| self.cover(child, shown)) {
                return true;
            }
            shown.truncate(before);
        }
        if is_built {
            shown.push(tile);
        }
        is_built
    }

    fn put(&mut self, shown: HashSet<Tile>, commands: &mut Commands) {
        for (tiles, visibility) in [
            (self.shown.difference(&shown), Visibility::Hidden),
            (shown.difference(&self.shown), Visibility::Inherited),
        ] {
            for built in tiles.filter_map(|tile| self.built.get(tile)) {
                commands.entity(built.entity).insert(visibility);
            }
        }
        if self.shown != shown {
            self.shown = shown;
            debug!("{} tiles of {} triangles, {} kept", self.shown.len(), self.triangles(), self.built.len());
        }
    }

    /// Drops the tiles that were not wanted for the longest time, if there are too many.
    fn forget(&mut self, commands: &mut Commands) {
        let excess = self.built.len().saturating_sub(MOST_KEPT);
        if excess == 0 {
            return;
        }
        let is_idle = |(tile, built): &(&Tile, &Built)| built.wanted < self.frame && !self.shown.contains(*tile);
        let mut idle: Vec<_> = self.built.iter().filter(is_idle).map(|(tile, built)| (built.wanted, *tile)).collect();
        idle.sort_by_key(|(wanted, tile)| (*wanted, tile.number()));
        for (_, tile) in idle.into_iter().take(excess) {
            if let Some(built) = self.built.remove(&tile) {
                commands.entity(built.entity).despawn();
            }
        }
    }
}
