//! The passes themselves.
use super::{
    pipeline::StarPipeline,
    prepare::{StarPasses, StarPipelines, StarUniforms},
};
use bevy::{
    prelude::*,
    render::{
        camera::ExtractedCamera,
        diagnostic::RecordDiagnostics,
        render_resource::{
            BindGroup, BindGroupEntries, LoadOp, Operations, PipelineCache, RenderPassColorAttachment,
            RenderPassDescriptor, RenderPipeline, StoreOp, TextureView,
        },
        renderer::{RenderContext, ViewQuery},
        view::ViewTarget,
    },
};

/// Picks what is bright, draws every arm, and adds the stars to the picture.
pub(super) fn star_filter(
    view: ViewQuery<(&ExtractedCamera, &ViewTarget, &StarPasses, &StarPipelines)>,
    cache: Res<PipelineCache>,
    pipeline: Res<StarPipeline>,
    uniforms: Res<StarUniforms>,
    mut ctx: RenderContext,
) {
    let (camera, target, passes, ids) = view.into_inner();
    let get = |id| cache.get_render_pipeline(id);
    let (Some(bright), Some(streak), Some(composite)) = (get(ids.bright), get(ids.streak), get(ids.composite)) else {
        return;
    };
    let Some(numbers) = uniforms.0.binding() else { return };
    let layout = cache.get_bind_group_layout(&pipeline.layout);
    let device = ctx.render_device().clone();
    let reading = |input: &TextureView| {
        let entries = BindGroupEntries::sequential((input, &pipeline.sampler, numbers.clone()));
        device.create_bind_group("star_filter", &layout, &entries)
    };
    let diagnostics = ctx.diagnostic_recorder();
    let diagnostics = diagnostics.as_deref();
    let span = diagnostics.time_span(ctx.command_encoder(), "star_filter");

    draw(&mut ctx, bright, &reading(target.main_texture_view()), passes.bright_offset, onto(&passes.bright, true));
    let from_bright = reading(&passes.bright);
    let from_arm = passes.arm.each_ref().map(reading);
    for (arm, offsets) in passes.arm_offsets.iter().enumerate() {
        for (p, offset) in offsets.iter().enumerate() {
            let input = if p == 0 { &from_bright } else { &from_arm[(p + 1) % 2] };
            let output =
                if p + 1 == offsets.len() { onto(&passes.stars, arm == 0) } else { onto(&passes.arm[p % 2], true) };
            draw(&mut ctx, streak, input, *offset, output);
        }
    }

    let stars = reading(&passes.stars);
    let mut pass = ctx.command_encoder().begin_render_pass(&RenderPassDescriptor {
        label: Some("star_filter_composite"),
        color_attachments: &[Some(target.get_unsampled_color_attachment())],
        ..default()
    });
    if let Some(viewport) = &camera.viewport {
        let (position, size) = (viewport.physical_position.as_vec2(), viewport.physical_size.as_vec2());
        pass.set_viewport(position.x, position.y, size.x, size.y, 0.0, 1.0);
    }
    pass.set_pipeline(composite);
    pass.set_bind_group(0, &stars, &[passes.composite_offset]);
    pass.draw(0..3, 0..1);
    drop(pass);
    span.end(ctx.command_encoder());
}

/// A texture to draw to, from black or on top of what it holds.
fn onto(view: &TextureView, from_black: bool) -> RenderPassColorAttachment<'_> {
    let load = if from_black { LoadOp::Clear(default()) } else { LoadOp::Load };
    RenderPassColorAttachment {
        view,
        depth_slice: None,
        resolve_target: None,
        ops: Operations { load, store: StoreOp::Store },
    }
}

fn draw(
    ctx: &mut RenderContext,
    pipeline: &RenderPipeline,
    input: &BindGroup,
    offset: u32,
    output: RenderPassColorAttachment,
) {
    let mut pass = ctx.command_encoder().begin_render_pass(&RenderPassDescriptor {
        label: Some("star_filter"),
        color_attachments: &[Some(output)],
        ..default()
    });
    pass.set_pipeline(pipeline);
    pass.set_bind_group(0, input, &[offset]);
    pass.draw(0..3, 0..1);
}
