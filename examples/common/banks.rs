//! Dresses the banks of a river: reeds along the waterline, tussocks and bushes above, stones, willows and alders.
//!
//! Everything is scattered from a seed, so it is the same in every run. A few meshes and five materials are shared, so
//! that Bevy draws many plants at once.

#[path = "banks_places.rs"]
mod places;
#[path = "banks_plants.rs"]
mod plants;
#[path = "banks_shape.rs"]
mod shape;
#[path = "banks_stones.rs"]
mod stones;

use bevy::{
    camera::visibility::VisibilityRange,
    image::{ImageAddressMode, ImageLoaderSettings, ImageSampler, ImageSamplerDescriptor},
    light::NotShadowCaster,
    prelude::*,
};
use places::Habitat;
pub use places::Site;
use shape::{Shape, between};

const REEDS: Habitat =
    Habitat { elevation: [-0.25, 0.30], slope: [0.0, 0.6], spacing: 0.75, patches: (0.40, 14.0), most: 900 };
const TUSSOCKS: Habitat =
    Habitat { elevation: [0.05, 1.20], slope: [0.0, 0.8], spacing: 0.6, patches: (0.25, 8.0), most: 1000 };
const STONES: Habitat =
    Habitat { elevation: [-0.45, 0.35], slope: [0.0, 1.5], spacing: 0.7, patches: (0.22, 7.0), most: 180 };
const BUSHES: Habitat =
    Habitat { elevation: [0.30, 3.00], slope: [0.0, 0.5], spacing: 5.0, patches: (0.25, 20.0), most: 14 };
const TREES: Habitat =
    Habitat { elevation: [0.45, 9.00], slope: [0.0, 0.4], spacing: 6.0, patches: (0.28, 35.0), most: 22 };

/// Spawns everything under one entity, which is returned. Despawn that to clear the bank.
pub fn spawn_banks(
    commands: &mut Commands,
    assets: &AssetServer,
    meshes: &mut Assets<Mesh>,
    materials: &mut Assets<StandardMaterial>,
    site: &Site,
) -> Entity {
    let root = (Name::new("Banks"), Transform::default(), Visibility::default());
    let root = commands.spawn(root).id();
    let mut random = fastrand::Rng::with_seed(site.seed);
    let looks = Looks::new(assets, materials);
    let kinds = Kinds::new(meshes, &mut random);
    // Grass and reeds cast no shadows, and vanish where they are too small to be seen.
    let small = |far: f32| (NotShadowCaster, seen_within(far));

    for place in site.scatter(&REEDS, 1) {
        let size = between(&mut random, 0.75, 1.15);
        let pose = place.upright(&mut random, size);
        let reed = looks.reeds.dress(random.choice(&kinds.reeds), pose, root);
        commands.spawn((reed, small(140.0)));
    }
    for place in site.scatter(&TUSSOCKS, 2) {
        let size = between(&mut random, 0.9, 1.6);
        let pose = place.upright(&mut random, size);
        let tussock = looks.grass.dress(random.choice(&kinds.tussocks), pose, root);
        commands.spawn((tussock, small(70.0)));
    }
    for place in site.scatter(&STONES, 3) {
        // Small ones are common, large ones rare.
        let size = 0.15 + 1.05 * random.f32().powi(3);
        let pose = place.half_sunk(&mut random, size);
        commands.spawn(looks.stone.dress(random.choice(&kinds.stones), pose, root));
    }
    for place in site.scatter(&BUSHES, 4) {
        let size = between(&mut random, 0.8, 1.3);
        let pose = place.upright(&mut random, size);
        commands.spawn(looks.leaves.dress(random.choice(&kinds.bushes), pose, root));
    }
    for place in site.scatter(&TREES, 5) {
        let size = between(&mut random, 0.7, 1.15);
        let pose = place.upright(&mut random, size);
        let tree = random.usize(..kinds.trees.len());
        let [wood, leaves] = &kinds.trees[tree];
        commands.spawn(looks.bark.dress(Some(wood), pose, root));
        commands.spawn(looks.leaves.dress(Some(leaves), pose, root));
    }
    root
}

fn seen_within(far: f32) -> VisibilityRange {
    // Without a cross-fade, which needs the same dither in the depth prepass that water asks for.
    VisibilityRange::abrupt(0.0, far)
}

/// The meshes: a few of each sort, which stand again and again.
struct Kinds {
    reeds: Vec<Handle<Mesh>>,
    tussocks: Vec<Handle<Mesh>>,
    stones: Vec<Handle<Mesh>>,
    bushes: Vec<Handle<Mesh>>,
    /// Wood and leaves.
    trees: Vec<[Handle<Mesh>; 2]>,
}

impl Kinds {
    fn new(meshes: &mut Assets<Mesh>, random: &mut fastrand::Rng) -> Self {
        let mut add = |shape: Shape| meshes.add(shape.into_mesh());
        Self {
            reeds: (0..4).map(|_| add(plants::reed_clump(random))).collect(),
            tussocks: (0..4).map(|_| add(plants::tussock(random))).collect(),
            stones: [3, 2, 2, 2, 1]
                .into_iter()
                .zip(0..)
                .map(|(detail, seed)| add(stones::stone(seed, detail)))
                .collect(),
            bushes: (0..2).map(|_| add(plants::bush(random))).collect(),
            trees: [plants::WILLOW, plants::ALDER]
                .iter()
                .cycle()
                .take(6)
                .map(|kind| plants::tree(random, kind))
                .map(|(wood, leaves)| [add(wood), add(leaves)])
                .collect(),
        }
    }
}

/// A material, put on a mesh.
struct Look(Handle<StandardMaterial>);

impl Look {
    fn dress(&self, mesh: Option<&Handle<Mesh>>, pose: Transform, root: Entity) -> impl Bundle {
        let mesh = mesh.cloned().unwrap_or_default();
        (Mesh3d(mesh), MeshMaterial3d(self.0.clone()), pose, ChildOf(root))
    }
}

/// The materials.
struct Looks {
    reeds: Look,
    grass: Look,
    stone: Look,
    leaves: Look,
    bark: Look,
}

impl Looks {
    fn new(assets: &AssetServer, materials: &mut Assets<StandardMaterial>) -> Self {
        // Not `double_sided`: that would turn the normals of the far side down, away from the sky.
        let leafy = StandardMaterial {
            perceptual_roughness: 0.75,
            reflectance: 0.25,
            cull_mode: None,
            diffuse_transmission: 0.35,
            ..default()
        };
        let cut_out = |texture: &'static str| StandardMaterial {
            base_color_texture: Some(assets.load(texture)),
            alpha_mode: AlphaMode::Mask(0.4),
            ..leafy.clone()
        };
        let repeated = |settings: &mut ImageLoaderSettings| {
            settings.sampler = ImageSampler::Descriptor(ImageSamplerDescriptor {
                address_mode_u: ImageAddressMode::Repeat,
                address_mode_v: ImageAddressMode::Repeat,
                ..ImageSamplerDescriptor::linear()
            });
        };
        let bark = assets.load_builder().with_settings(repeated).load("textures/bark.png");
        let mut look = |material| Look(materials.add(material));
        Self {
            reeds: look(cut_out("textures/reed.png")),
            leaves: look(cut_out("textures/leaves.png")),
            grass: look(leafy.clone()),
            stone: look(StandardMaterial { perceptual_roughness: 0.9, reflectance: 0.3, ..default() }),
            bark: look(StandardMaterial { base_color_texture: Some(bark), perceptual_roughness: 0.95, ..default() }),
        }
    }
}
