//! The pictures of simulated waters: what the CPU has come to is written into them, and coarser levels are made of what is new,
//! whoever has drawn the finest.
use super::{
    frame::{ShallowFrame, ShallowWork},
    played::Played,
    stages::Stages,
};
use bevy::{
    prelude::*,
    render::{
        render_asset::RenderAssets,
        render_resource::{
            BindGroup, BindGroupEntries, ComputePassDescriptor, Extent3d, PipelineCache, TexelCopyBufferLayout,
            TextureId, TextureView, TextureViewDescriptor,
        },
        renderer::{RenderContext, RenderDevice, RenderQueue},
        texture::GpuImage,
    },
};
use freshet_hydro::shallow_water::{Field, WET};
use std::{ops::Range, sync::Arc};

/// The coarser levels of a water's pictures.
#[derive(Component)]
pub(super) struct Levels {
    /// The pictures that they belong to.
    textures: [TextureId; 2],
    /// Each after the one that it is made from.
    levels: Vec<Level>,
    /// What the CPU has drawn, if it was the last to draw.
    drawn: Option<Arc<Field>>,
    /// Whether the finest has been drawn since they were made.
    is_old: bool,
}

struct Level {
    group: BindGroup,
    workgroups: UVec2,
}

/// One level of a picture.
pub(super) fn level_of(picture: &GpuImage, level: u32) -> TextureView {
    picture.texture.create_view(&TextureViewDescriptor {
        label: Some("water_simulated_level"),
        base_mip_level: level,
        mip_level_count: Some(1),
        ..default()
    })
}

/// Draws the pictures of those waters whose cells the CPU has, and plans the coarser levels of what is new.
pub(super) fn draw_pictures(
    mut commands: Commands,
    stages: Res<Stages>,
    cache: Res<PipelineCache>,
    device: Res<RenderDevice>,
    queue: Res<RenderQueue>,
    images: Res<RenderAssets<GpuImage>>,
    mut waters: Query<(Entity, &ShallowFrame, Option<&mut Levels>, Option<&Played>)>,
    orphans: Query<Entity, (With<Levels>, Without<ShallowFrame>)>,
) {
    for entity in &orphans {
        commands.entity(entity).remove::<Levels>();
    }
    for (entity, frame, levels, played) in &mut waters {
        let [Some(cells), Some(slopes)] = frame.pictures.map(|picture| images.get(picture)) else { continue };
        let pictures = [cells, slopes];
        let textures = pictures.map(|picture| picture.texture.id());
        let mut made = None;
        let levels = match levels.filter(|levels| levels.textures == textures) {
            Some(levels) => levels.into_inner(),
            None => made.insert(Levels {
                textures,
                levels: levels_of(pictures, &stages, &cache, &device),
                drawn: None,
                is_old: false,
            }),
        };
        match &frame.work {
            ShallowWork::Gpu(work) => {
                levels.drawn = None;
                levels.is_old |= work.steps > 0;
            }
            ShallowWork::Played(..) => {
                levels.drawn = None;
                levels.is_old |= played.is_some_and(Played::is_new);
            }
            ShallowWork::Cpu(field) if levels.drawn.as_ref().is_some_and(|drawn| Arc::ptr_eq(drawn, field)) => {}
            ShallowWork::Cpu(field) => {
                draw(field, levels.drawn.as_deref(), pictures, &queue);
                levels.drawn = Some(field.clone());
                levels.is_old = true;
            }
        }
        if let Some(levels) = made {
            commands.entity(entity).insert(levels);
        }
    }
}

fn levels_of(pictures: [&GpuImage; 2], stages: &Stages, cache: &PipelineCache, device: &RenderDevice) -> Vec<Level> {
    let layout = cache.get_bind_group_layout(&stages.coarsen_layout);
    let coarser = |level: u32| {
        let [finer, finer_slopes] = pictures.map(|picture| level_of(picture, level - 1));
        let [coarser, coarser_slopes] = pictures.map(|picture| level_of(picture, level));
        let entries = BindGroupEntries::sequential((&finer, &finer_slopes, &coarser, &coarser_slopes));
        let size = pictures[0].texture_descriptor.size;
        Level {
            group: device.create_bind_group("water_shallow_coarsen", &layout, &entries),
            workgroups: uvec2((size.width >> level).div_ceil(8), (size.height >> level).div_ceil(8)),
        }
    };
    (1..pictures[0].texture.mip_level_count()).map(coarser).collect()
}

/// Writes what the CPU has come to into the pictures: the rows that differ from those that were drawn `before`.
fn draw(field: &Field, before: Option<&Field>, [level, slopes]: [&GpuImage; 2], queue: &RenderQueue) {
    let columns = field.size().x;
    let rows = changed_rows(field, before);
    if rows.is_empty() {
        return;
    }
    let extent = Extent3d { width: columns, height: rows.len() as u32, depth_or_array_layers: 1 };
    let write = |image: &GpuImage, bytes: &[u8], texel: u32| {
        let layout = TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(columns * texel), rows_per_image: None };
        let mut place = image.texture.as_image_copy();
        place.origin.y = rows.start as u32;
        queue.write_texture(place, bytes, layout, extent);
    };
    let indices = rows.start * columns as usize..rows.end * columns as usize;
    let cells = indices.clone().map(|index| texel(field, index).to_array());
    let cells: Vec<u8> = cells.flatten().flat_map(f32::to_le_bytes).collect();
    write(level, &cells, 16);
    let half = |index: usize| {
        let slope = field.slopes()[index];
        let [east, south] = field.walls().get(index).copied().unwrap_or_default().map(f32::from);
        [slope.x, slope.y, east, south].map(half::f16::from_f32).map(half::f16::to_le_bytes).concat()
    };
    let steep: Vec<u8> = indices.flat_map(half).collect();
    write(slopes, &steep, 8);
}

/// The rows from the first to the last in which a texel may differ from `before`.
fn changed_rows(field: &Field, before: Option<&Field>) -> Range<usize> {
    let (columns, rows) = (field.size().x as usize, field.size().y as usize);
    let Some(before) = before.filter(|before| before.size() == field.size() && before.walls() == field.walls()) else {
        return 0..rows;
    };
    let differs = |row: &usize| {
        let row = row * columns..(row + 1) * columns;
        field.cells()[row.clone()] != before.cells()[row]
    };
    // Slopes, and the levels of dry cells, know the rows beside them.
    let first = (0..rows).find(differs).unwrap_or(rows).saturating_sub(1);
    let last = (0..rows).rfind(differs).map_or(0, |last| (last + 2).min(rows));
    first..last
}

/// A cell in the picture. A dry one has the level of the wet cells around it, and 1 if there are any: `dry` in `show.wgsl`.
fn texel(field: &Field, index: usize) -> Vec4 {
    let cell = field.cells()[index];
    if cell.y > WET {
        return cell;
    }
    let columns = field.size().x as i32;
    let at = IVec2::new(index as i32 % columns, index as i32 / columns);
    let mut level = 0.0;
    let mut count = 0.0_f32;
    for there in (0..9).map(|k| at + IVec2::new(k % 3, k / 3) - 1) {
        let is_inside = there.cmpge(IVec2::ZERO).all() && there.cmplt(field.size().as_ivec2()).all();
        let beside = is_inside.then(|| field.cells()[(there.y * columns + there.x) as usize]);
        if let Some(beside) = beside.filter(|beside| beside.y > WET) {
            level += beside.x;
            count += 1.0;
        }
    }
    Vec4::new(cell.x, cell.y, level / count.max(1.0), count.min(1.0))
}

/// Makes the levels.
pub(super) fn run_levels(
    mut context: RenderContext,
    stages: Res<Stages>,
    cache: Res<PipelineCache>,
    mut waters: Query<&mut Levels>,
) {
    let Some(pipeline) = cache.get_compute_pipeline(stages.coarsen) else { return };
    let mut old = waters.iter_mut().filter(|levels| levels.is_old).peekable();
    if old.peek().is_none() {
        return;
    }
    let descriptor = ComputePassDescriptor { label: Some("water_shallow_coarsen"), ..default() };
    let mut pass = context.command_encoder().begin_compute_pass(&descriptor);
    pass.set_pipeline(pipeline);
    for mut levels in old {
        for level in &levels.levels {
            pass.set_bind_group(0, &level.group, &[]);
            pass.dispatch_workgroups(level.workgroups.x, level.workgroups.y, 1);
        }
        levels.is_old = false;
    }
}
