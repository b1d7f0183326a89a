//! Still frames against the data.
use super::*;
use crate::viewer::{HAZARDS, hazard_color};
use bevy_freshet::{flood::FloodState, surface::ViewScale};
use freshet_flood::maxima::hazard_rating;
use freshet_hydro::shallow_water::WaterCells;

/// The colour of a wet cell in the legend; nothing if the water never came there, as far as steps tell.
fn in_legend(viewer: &Viewer, index: usize, water: Vec4) -> Option<LinearRgba> {
    let (depth, speed) = (water.y / viewer.exaggeration, water.zw().length());
    let value = match viewer.coloring {
        Coloring::Water => return None,
        Coloring::Depth => depth,
        Coloring::Speed => speed,
        Coloring::Arrival => (viewer.arrival_of(index)? / 60.0) as f32,
        Coloring::Hazard => {
            let rating = hazard_rating(depth, speed);
            let class = HAZARDS.iter().filter(|(from, _)| *from <= rating).count().saturating_sub(1);
            return Some(hazard_color(class));
        }
    };
    let scale = viewer.scale()?;
    Some(ViewScale::color((value - scale.low) / (scale.high - scale.low)))
}

/// Where the middle of every wet cell is seen, px, away from what is written over the picture, and its colour in the legend.
fn expected(app: &mut App) -> Vec<(UVec2, [u8; 3])> {
    let world = app.world_mut();
    let moment = world.query::<&FloodState>().single(world).unwrap().moment().unwrap().clone();
    let (camera, pose) = world.query::<(&Camera, &GlobalTransform)>().single(world).unwrap();
    let viewer = world.resource::<Viewer>();
    let size = camera.physical_viewport_size().unwrap().as_vec2();
    let mut cells = Vec::new();
    for (index, cell) in viewer.terrain.cells().enumerate() {
        let water = moment.cell(index);
        let place = viewer.terrain.position(cell);
        let ground = vec3(place.x, viewer.terrain.values()[index] * viewer.exaggeration, place.y);
        let Ok(pixel) = camera.world_to_viewport(pose, ground) else { continue };
        let is_free = (0.3..0.7).contains(&(pixel.x / size.x)) && (0.0..size.y).contains(&pixel.y);
        if let Some(color) = in_legend(viewer, index, water).filter(|_| is_free && water.y > 0.0) {
            let [red, green, blue, _] = Srgba::from(color).to_u8_array();
            cells.push((pixel.as_uvec2(), [red, green, blue]));
        }
    }
    cells
}

#[test]
fn cells_have_the_colours_of_the_legend() {
    let options = ["flood", "--camera", "top", "--at", "25min", "--tolerance", "0", "--out", "flood.png"];
    let (mut app, plan) = viewer_of(Arguments::parse_from(options));
    let plan = plan.unwrap();
    common::start(&mut app);
    for coloring in [Coloring::Depth, Coloring::Speed, Coloring::Arrival, Coloring::Hazard] {
        app.world_mut().resource_mut::<Viewer>().coloring = coloring;
        (0..3).for_each(|_| film::show(&mut app, &plan, plan.to));
        let picture = common::screenshot(&mut app).unwrap();
        let cells = expected(&mut app);
        let off = |(pixel, color): &&(UVec2, [u8; 3])| {
            let found = picture.get_pixel(pixel.x, pixel.y).0;
            found.iter().zip(color).any(|(a, b)| a.abs_diff(*b) > 2)
        };
        let count = cells.iter().filter(off).count();
        println!("{}: {count} of {} cells are off", coloring.name(), cells.len());
        // Ratings on the border of two classes may be rounded to either.
        assert!(cells.len() > 5000 && count <= cells.len() / 1000, "{count} of {}", cells.len());
    }
}
