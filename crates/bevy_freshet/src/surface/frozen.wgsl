// Where the water is frozen, as bodies feel it.
#define_import_path freshet::surface::frozen

#import freshet::surface::bindings::{surface, ice_order}
#import freshet::surface::ground
#import freshet::surface::ice_growth as growth
#import freshet::surface::types

// The order of freezing at local `place`, sampled as `freshet_hydro::grid::Grid::sample` does.
fn order(place: vec2<f32>) -> f32 {
    let c = ground::cells_around(place, surface.ice_order_cell, surface.ice_order_size);
    let nw = textureLoad(ice_order, c.low, 0).x;
    let ne = textureLoad(ice_order, vec2(c.high.x, c.low.y), 0).x;
    let sw = textureLoad(ice_order, vec2(c.low.x, c.high.y), 0).x;
    let se = textureLoad(ice_order, c.high, 0).x;
    let north = nw + (ne - nw) * c.t.x;
    let south = sw + (se - sw) * c.t.x;
    return north + (south - north) * c.t.y;
}

// The ice as bodies feel it.
struct Felt {
    order: f32,
    thickness: f32, // units: m
    open: f32,      // share of the surface that no ice covers
}

fn felt(place: vec2<f32>) -> Felt {
    if (surface.flags & types::FLAG_ICE) == 0u {
        return Felt(1.0, 0.0, 1.0);
    }
    let order = order(place);
    let thickness = growth::thickness(order, surface.ice_freezing, surface.ice_thickest);
    return Felt(order, thickness, 1.0 - growth::cover(thickness));
}
