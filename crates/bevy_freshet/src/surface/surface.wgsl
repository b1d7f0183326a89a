// The water surface: displaced, and coloured by what it reflects, lets through and scatters.
#import bevy_pbr::mesh_view_bindings::view
#import freshet::surface::beam::Place
#import freshet::surface::bindings::surface
#import freshet::surface::detail
#import freshet::surface::field
#import freshet::surface::flow
#import freshet::surface::foam
#import freshet::surface::frozen
#import freshet::surface::ice
#import freshet::surface::light
#import freshet::surface::mesh
#import freshet::surface::mirror
#import freshet::surface::optics
#import freshet::surface::refraction
#import freshet::surface::scene
#import freshet::surface::types
#import freshet::surface::views
#import freshet::surface::water
#import freshet::surface::waves

#ifdef TONEMAP_IN_SHADER
#import bevy_core_pipeline::tonemapping::tone_mapping
#endif

// Deeper than this below ground there is no bed, but a cell without data.
const NO_DATA_DEPTH: f32 = -1e4;

struct Vertex {
    @location(0) position: vec3<f32>,
}

struct Fragment {
    @builtin(position) position: vec4<f32>,
    @location(0) world: vec3<f32>,
    @location(1) rest: vec2<f32>, // local xz of the particle at rest
    // Of the mesh at one vertex of the triangle, units: m.
    @location(2) @interpolate(flat) spacing: f32,
}

@vertex
fn vertex(in: Vertex) -> Fragment {
    let rest = clamp(surface.mesh_center + in.position.xz, -surface.half_size, surface.half_size);
    let spacing = mesh::spacing_at(rest - surface.mesh_center);
    water::spacing = spacing;
    let still = water::at(rest);
    let felt = frozen::felt(rest);
    let fade = waves::shallow_fade(still.depth) * felt.open;
    let moved = waves::displacement(rest, fade, spacing);
    let xz = surface.world_from_local * (rest + moved.xz) + surface.world_origin;
    let world = vec3(xz.x, surface.level + still.risen - ice::drop(felt.thickness) + moved.y, xz.y);
    return Fragment(view.clip_from_world * vec4(world, 1.0), world, rest, spacing);
}

// The surface as far as a pixel resolves it.
struct Facet {
    slope: vec2<f32>,   // ∂height/∂xz, world
    across: vec2<f32>,  // change of the slope to the next pixel of the row
    down: vec2<f32>,    // change of the slope to the next pixel of the column
    hidden: f32,        // slope variance that a pixel hides
}

// `open` is the share of the surface that is free to move.
fn facet(
    rest: vec2<f32>,
    depth: f32,
    drift: flow::Drift,
    footprint: flow::Footprint,
    rings: vec2<f32>,
    open: f32,
) -> Facet {
    let spacing = max(length(footprint.x), length(footprint.y));
    let swell = waves::slope(rest, waves::shallow_fade(depth) * open, spacing);
    let ripples = detail::slope(drift, footprint);
    let flowing = water::simulated_slope(rest);
    let slope = surface.world_from_local * (swell.slope + flowing + (ripples.slope + rings) * open);
    return Facet(slope, dpdx(slope), dpdy(slope), swell.variance + ripples.variance * open * open);
}

fn normal_of(slope: vec2<f32>) -> vec3<f32> {
    return normalize(vec3(-slope.x, 1.0, -slope.y));
}

@fragment
fn fragment(in: Fragment, @builtin(front_facing) from_above: bool) -> @location(0) vec4<f32> {
    let pixel = in.position.xy;
    let footprint = flow::Footprint(dpdx(in.rest), dpdy(in.rest));
    let pixel_size = max(length(footprint.x), length(footprint.y));
    // Far away a pixel may show less than a triangle: its shore is that of the pixel.
    water::spacing = min(in.spacing, pixel_size);
    let still = water::at(in.rest);
    let fields = field::at(in.rest);
    let drift = flow::drift(in.rest, still.current);
    let felt = frozen::felt(in.rest);
    let facet = facet(in.rest, still.depth, drift, footprint, fields.slope, felt.open);
    let sheet = ice::sheet(in.rest, felt, footprint);
    let normal = normal_of(facet.slope);
    let to_eye = scene::direction_to_eye(in.world);
    optics::dye = fields.dye;
    let behind = scene::behind(pixel);
    // Where the bed has no data there is no water.
    if still.depth < NO_DATA_DEPTH || !still.is_wet {
        discard;
    }
    if !from_above {
        return finish(seen_from_below(in, normal, to_eye));
    }

    let fog = scene::fog_to(in.world, pixel);
    // A facet that leans away from the eye is hidden by the one before it: count it as seen edge-on.
    let cos_eye = max(dot(normal, to_eye), 0.02);
    let share = optics::reflectance(cos_eye) * surface.reflectivity;

    // The lights meet the ice where there is any; the water's share of it in between.
    let solid = normal_of(mix(facet.slope, sheet.slope, sheet.cover));
    let rough = mix(facet.hidden, surface.ice_roughness, sheet.cover);
    let lit = light::lights(Place(in.world, solid, to_eye, rough, pixel));
    var reflection = vec3(0.0);
    if sheet.cover < 1.0 {
        reflection = reflected(in.world, facet, to_eye, fog);
    }
    var below = vec3(0.0);
    if ice::is_clear(sheet) {
        below = refraction::refracted(in.world, in.position, normal, to_eye, behind, lit);
    }

    var color = mix(below, reflection, share) * lit.shade + lit.glow;
    if (surface.flags & types::FLAG_SUNLIGHT) != 0u {
        color += lit.glitter * surface.reflectivity;
    }
    color = mix(color, surface.dull_color * lit.below, surface.dullness);
    color = mix(color, foam::color(lit.above), foam::cover(drift, fields.foam, footprint) * felt.open);
    if sheet.cover > 0.0 {
        color = mix(color, ice::color(sheet, in.world, solid, to_eye, lit, below, fog), sheet.cover);
    }
    if (surface.flags & types::FLAG_FOG) != 0u {
        color = scene::with_fog(color, fog);
    }
    // Through a crest above the eye the way is along the ray, not down.
    let way = select(in.world.y - behind.position.y, distance(in.world, behind.position), to_eye.y <= 0.0);
    let cover = edge(way, behind.depth);
    color = mix(scene::color_behind(pixel), color, cover);

    switch surface.view {
        case types::VIEW_REFLECTION: { color = reflection; }
        case types::VIEW_REFRACTION: { color = below; }
        case types::VIEW_FRESNEL: { color = vec3(share, 1.0 - share, 0.0); }
        case types::VIEW_NORMAL: { color = normal * 0.5 + 0.5; }
        case types::VIEW_HEIGHT: { color = split(in.world.y - surface.level); }
        case types::VIEW_EDGE: { color = vec3(cover); }
        case types::VIEW_FLOW: { color = views::flow(in.rest, still.current, pixel_size); }
        case types::VIEW_DEPTH: { color = views::depth(still.depth); }
        case types::VIEW_WIREFRAME: { color = mix(0.3 * color, vec3(0.0, 1.0, 0.0), views::wire(in.rest, pixel_size)); }
        case types::VIEW_FOAM: { color = vec3(fields.foam); }
        case types::VIEW_INTERACTION: { color = vec3(fields.cover, max(20.0 * vec2(fields.height, -fields.height), vec2(0.0))); }
        case types::VIEW_DYE: { color = exp(-fields.dye); }
        case types::VIEW_LEVEL: { color = views::scaled(still.risen); }
        case types::VIEW_SPEED: { color = views::scaled(length(views::velocity(still.current))); }
        case types::VIEW_FROUDE: { color = views::scaled(views::froude(still.current, still.depth)); }
        case types::VIEW_AGE: { color = views::scaled(surface.simulated_age); }
        case types::VIEW_ICE: { color = vec3(felt.thickness, sheet.cover, sheet.snow); }
        default: {}
    }
    return finish(color);
}

// Reflected light, averaged over four rays that lie in the pixel and in the slopes it hides.
fn reflected(at: vec3<f32>, facet: Facet, to_eye: vec3<f32>, fog: scene::Fog) -> vec3<f32> {
    let foot = vec3(at.x, surface.level, at.z);
    // Both directions share the variance; two points at ± one deviation have it.
    let hidden = sqrt(0.5 * facet.hidden);
    var picture = vec4(0.0);
    for (var i = 0; i < 4; i++) {
        let corner = vec2(f32(i & 1), f32(i >> 1)) * 2.0 - 1.0;
        let within = 0.25 * (facet.across * corner.x + facet.down * corner.y);
        picture += 0.25 * mirror::mirrored(foot, bounce(normal_of(facet.slope + within + hidden * corner), to_eye));
    }
    // Slopes turn the mirrored ray by twice their angle; a lobe of that width has the roughness of its square root.
    let width = 2.0 * hidden + length(facet.across) + length(facet.down);
    let sky = mirror::sky_radiance(bounce(normal_of(facet.slope), to_eye), sqrt(clamp(width, 0.0, 1.0)));
    return mirror::freed_of_fog(picture, fog) + sky * (1.0 - picture.a);
}

// Direction of the mirrored ray; the water does not mirror itself, so rays that would dip below it graze it.
fn bounce(normal: vec3<f32>, to_eye: vec3<f32>) -> vec3<f32> {
    let level = vec3(0.0, 1.0, 0.0);
    let bent = normalize(mix(level, normal, surface.mirror_distortion));
    var direction = reflect(-to_eye, bent);
    direction.y = max(abs(direction.y), 0.005);
    return normalize(direction);
}

// Opacity of the edge for a column of `depth` metres: 0 at the waterline, 1 from the edge depth on, with soft ends.
fn edge(depth: f32, behind_depth: f32) -> f32 {
    if surface.edge_depth <= 0.0 || behind_depth <= 0.0 {
        return 1.0;
    }
    return smoothstep(0.0, surface.edge_depth, depth);
}

// From below: the scene above through the surface, or the water itself under total internal reflection.
fn seen_from_below(in: Fragment, normal: vec3<f32>, to_eye: vec3<f32>) -> vec3<f32> {
    let cos_eye = max(dot(-normal, to_eye), 0.02);
    let share = optics::fresnel_exact(cos_eye, 1.0 / surface.index) * surface.reflectivity;
    let lit = light::lights(Place(in.world, normal, to_eye, 1.0, in.position.xy));
    return mix(scene::color_behind(in.position.xy), optics::scattered(lit.below, 1e3, 1e3, 1.0), share);
}

// A height in metres as a coarse and a fine part that 16-bit floats hold to a hundredth of a millimetre.
fn split(height: f32) -> vec3<f32> {
    let coarse = round(height * 64.0) / 64.0;
    return vec3(coarse, (height - coarse) * 64.0, 0.0);
}

fn finish(color: vec3<f32>) -> vec4<f32> {
    let opaque = vec4(color, 1.0);
#ifdef TONEMAP_IN_SHADER
    return tone_mapping(opaque, view.color_grading);
#else
    return opaque;
#endif
}
