// Point and spot lights, as Bevy sorts them into the clusters of the view.
#define_import_path freshet::surface::lamps

#import bevy_pbr::{
    clustered_forward as clusters,
    mesh_view_bindings as view_bindings,
    mesh_view_bindings::view,
    mesh_view_types::{POINT_LIGHT_FLAGS_SHADOWS_ENABLED_BIT, POINT_LIGHT_FLAGS_SPOT_LIGHT_Y_NEGATIVE},
    shadows::{fetch_point_shadow, fetch_spot_shadow},
}
#import freshet::surface::beam::Beam

// The lamps near a place: `first` … `spots` are point lights, `spots` … `end` spot lights.
struct Lamps {
    first: u32,
    spots: u32,
    end: u32,
}

fn near(position: vec3<f32>, pixel: vec2<f32>) -> Lamps {
    let view_z = (view.view_from_world * vec4(position, 1.0)).z;
    let is_orthographic = view.clip_from_view[3].w == 1.0;
    let cluster = clusters::view_fragment_cluster_index(pixel, view_z, is_orthographic);
    let ranges = clusters::unpack_clusterable_object_index_ranges(cluster);
    return Lamps(
        ranges.first_point_light_index_offset,
        ranges.first_spot_light_index_offset,
        ranges.first_reflection_probe_index_offset,
    );
}

// The light of lamp number `index` of a cluster that arrives at `position`.
fn beam(index: u32, is_spot: bool, position: vec3<f32>, pixel: vec2<f32>) -> Beam {
    let id = clusters::get_clusterable_object_id(index);
    let lamp = &view_bindings::clustered_lights.data[id];
    let way = (*lamp).position_radius.xyz - position;
    let distance_squared = max(dot(way, way), 1e-4);
    let to_light = way * inverseSqrt(distance_squared);
    // The window in which Bevy lets the light end at its range: (1 − (r/range)⁴)².
    let share = distance_squared * (*lamp).color_inverse_square_range.w;
    let window = saturate(1.0 - share * share);
    var irradiance = (*lamp).color_inverse_square_range.rgb * (view.exposure * window * window / distance_squared);
    let shadowed = ((*lamp).flags & POINT_LIGHT_FLAGS_SHADOWS_ENABLED_BIT) != 0u;
    let place = vec4(position, 1.0);
    let up = vec3(0.0, 1.0, 0.0);
    var shadow = 1.0;
    if is_spot {
        irradiance *= cone(id, to_light);
        if shadowed {
            shadow = fetch_spot_shadow(id, place, up, (*lamp).shadow_map_near_z, pixel);
        }
    } else if shadowed {
        shadow = fetch_point_shadow(id, place, up, pixel);
    }
    // A sphere of angular radius α = r/d turns the half vector by half of that; the mean square of a disc's two
    // coordinates together is α²/2, so the highlight spreads as by the slope variance α²/8.
    let radius = (*lamp).position_radius.w;
    return Beam(to_light, irradiance, shadow, 0.125 * radius * radius / distance_squared);
}

// Share of a spot light's intensity in the direction opposite to `to_light`: 1 in the inner cone, 0 beyond the outer one.
fn cone(id: u32, to_light: vec3<f32>) -> f32 {
    let lamp = &view_bindings::clustered_lights.data[id];
    let data = (*lamp).light_custom_data;
    var axis = vec3(data.x, sqrt(max(0.0, 1.0 - data.x * data.x - data.y * data.y)), data.y);
    if ((*lamp).flags & POINT_LIGHT_FLAGS_SPOT_LIGHT_Y_NEGATIVE) != 0u {
        axis.y = -axis.y;
    }
    let share = saturate(dot(axis, -to_light) * data.z + data.w);
    return share * share;
}
