//! Paints the wet cells of the terrain in the colours of the colouring.
use crate::{
    texture,
    viewer::{Coloring, Viewer},
};
use bevy::prelude::*;
use bevy_freshet::flood::FloodState;

/// A picture of the terrain that is drawn as it is, pixel by cell.
#[derive(Resource)]
pub struct Painting {
    /// The colour of every cell where it is dry, sRGB.
    dry: Vec<[u8; 4]>,
    picture: Handle<Image>,
    material: Option<Handle<StandardMaterial>>,
    /// What was painted.
    painted: Option<(f64, Coloring)>,
}

impl Painting {
    /// Nothing is painted until a colouring is chosen. `dry` has the colours of all cells without water.
    pub fn new(dry: Vec<[u8; 4]>) -> Self {
        Self { dry, picture: default(), material: None, painted: None }
    }

    /// What the terrain is drawn with under the colouring, if there is one and it has been painted.
    pub fn material(&self, viewer: &Viewer) -> Option<&Handle<StandardMaterial>> {
        self.material.as_ref().filter(|_| viewer.coloring != Coloring::Water)
    }
}

/// Paints the flood's time, unless that is painted already.
pub fn paint(
    viewer: Res<Viewer>,
    mut painting: ResMut<Painting>,
    mut images: ResMut<Assets<Image>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
    state: Single<&FloodState>,
) {
    let (Some(field), Some(time)) = (state.field(), state.time()) else { return };
    if viewer.coloring == Coloring::Water || painting.painted == Some((time, viewer.coloring)) {
        return;
    }
    let size = viewer.terrain.size();
    if painting.material.is_none() {
        painting.picture = images.add(texture::cells(size, &painting.dry));
        let picture = Some(painting.picture.clone());
        let material = StandardMaterial { base_color_texture: picture, unlit: true, fog_enabled: false, ..default() };
        painting.material = Some(materials.add(material));
    }
    let cells = field.cells().iter().zip(&painting.dry).enumerate();
    let pixels = cells.flat_map(|(index, (cell, dry))| {
        let wet = (cell.y > 0.0).then(|| viewer.color(index, cell.y / viewer.exaggeration, cell.zw().length()));
        wet.flatten().map_or(*dry, |color| Srgba::from(color).to_u8_array())
    });
    let data = pixels.collect();
    if let Some(mut picture) = images.get_mut(&painting.picture) {
        picture.data = Some(data);
    }
    // A new texture wants a new bind group.
    if let Some(material) = &painting.material
        && let Some(mut material) = materials.get_mut(material)
    {
        material.base_color_texture = Some(painting.picture.clone());
    }
    painting.painted = Some((time, viewer.coloring));
}
