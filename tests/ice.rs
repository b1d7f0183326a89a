//! Ice: it grows from the banks inward, and what is drawn of it is felt.
use crate::{
    said::{complaints, run_on_this_thread},
    stage::{Picture, SIZE, Stage},
    waves,
};
use bevy::{ecs::system::RunSystemOnce, prelude::*};
use bevy_freshet::prelude::*;
use freshet_hydro::grid::Grid;

/// Width of the pictures from above, m.
const WIDTH: f32 = 40.0;
/// Half of the river's width, m.
const BANK: f32 = 16.0;

/// A straight river along z with waves and a current that is fastest in its middle, 2 m deep there, under a low sun.
/// Returns the water.
fn river(stage: &mut Stage) -> Entity {
    stage.app.insert_resource(ClearColor(Color::linear_rgb(0.3, 0.5, 0.7)));
    let across = |x: f32| 1.0 - (x / BANK).powi(2);
    let bed = WaterBed::from_fn(uvec2(84, 64), 0.5, |p| -2.0 * across(p.x)).unwrap();
    stage.paint(bed.mesh(0..84, 0..64).unwrap(), LinearRgba::rgb(0.2, 0.15, 0.1), Transform::IDENTITY);
    stage.spawn(bed);
    let cells = Grid::from_fn(uvec2(42, 32), 1.0, |cell| cell).unwrap();
    let flow = cells.map(|&cell| vec2(0.0, 1.2 * across(cells.position(cell).x).max(0.0)));
    stage.spawn((DirectionalLight::default(), Transform::from_xyz(1.0, 0.6, -2.0).looking_at(Vec3::ZERO, Vec3::Y)));
    stage.spawn((
        Water::new(vec2(42.0, 32.0)),
        WaterOptics::RIVER,
        WaterWaves::wind(3.0, 200.0, vec2(0.3, 1.0)),
        WaterFlow::from_map(flow),
    ))
}

/// A camera that looks along the river.
fn along(stage: &mut Stage) -> Entity {
    let pose = Transform::from_xyz(-4.0, 3.0, 14.0).looking_at(vec3(0.0, 0.0, -2.0), Vec3::Y);
    stage.camera(PerspectiveProjection::default(), pose)
}

/// A camera that looks straight down; columns of its picture lie along the river.
fn above(stage: &mut Stage) -> Entity {
    stage.camera_above(Vec3::ZERO, WIDTH)
}

fn freeze(stage: &mut Stage, water: Entity, freezing: f32) {
    stage.app.world_mut().entity_mut(water).insert(WaterIce::frozen(freezing));
}

fn show_ice(stage: &mut Stage, water: Entity) {
    stage.app.world_mut().get_mut::<WaterSurface>(water).unwrap().view = SurfaceView::Ice;
}

fn sample(stage: &mut Stage, place: Vec3) -> WaterSample {
    stage.app.world_mut().run_system_once(move |water: WaterQuery| water.sample(place)).unwrap().unwrap()
}

#[test]
fn before_winter_the_water_is_as_without_ice() {
    let mut stage = Stage::new();
    let water = river(&mut stage);
    let camera = along(&mut stage);
    stage.settle();
    stage.run(0.5);
    let without = stage.picture(camera).bits();
    freeze(&mut stage, water, 0.0);
    assert!(stage.picture(camera).bits() == without);
    freeze(&mut stage, water, 0.4);
    assert!(stage.picture(camera).bits() != without, "ice is seen");
}

#[test]
fn frozen_water_stands_still_and_open_water_moves() {
    let mut stage = Stage::new();
    let water = river(&mut stage);
    let camera = along(&mut stage);
    let mut moving_pixels = |freezing: f32| {
        freeze(&mut stage, water, freezing);
        stage.settle();
        stage.run(0.5);
        let before = stage.picture(camera).bits();
        stage.run(1.0);
        let after = stage.picture(camera).bits();
        before.iter().zip(after).filter(|(before, after)| *before != after).count()
    };
    assert_eq!(moving_pixels(1.0), 0);
    assert!(moving_pixels(0.0) > 10_000);
}

/// Thickness, cover and snow at every pixel of the river from above, for each time of the winter.
fn winter(times: &[f32]) -> Vec<Picture> {
    let mut stage = Stage::new();
    let water = river(&mut stage);
    let camera = above(&mut stage);
    show_ice(&mut stage, water);
    let mut at = |&freezing: &f32| {
        freeze(&mut stage, water, freezing);
        stage.picture(camera)
    };
    times.iter().map(&mut at).collect()
}

/// Distance of a pixel of the picture from above to the middle of the river, m.
fn off_middle(pixel: UVec2) -> f32 {
    ((pixel.x as f32 + 0.5 - SIZE.x as f32 / 2.0) * WIDTH / SIZE.x as f32).abs()
}

/// Pixels of the river, a little off the waterline, where the drawn edge is soft.
fn wet(picture: &Picture) -> impl Iterator<Item = (UVec2, Vec3)> {
    picture.pixels().filter(|(pixel, _)| off_middle(*pixel) < BANK - 1.0)
}

#[test]
fn ice_grows_at_every_pixel_and_in_all() {
    let times: Vec<f32> = (0..=10).map(|i| i as f32 / 10.0).collect();
    let pictures = winter(&times);
    for pair in pictures.windows(2) {
        for ((pixel, earlier), (_, later)) in wet(&pair[0]).zip(wet(&pair[1])) {
            assert!((later - earlier).min_element() >= -1e-3, "{pixel}: {earlier}, later {later}");
        }
    }
    let covered = |picture: &Picture| wet(picture).map(|(_, ice)| ice.y).sum::<f32>() / wet(picture).count() as f32;
    let covers: Vec<f32> = pictures.iter().map(covered).collect();
    assert!(covers[0] == 0.0 && covers[10] == 1.0, "{covers:?}");
    // About an eighth of the river freezes in each tenth of the winter; the last fifth makes the cover solid.
    for pair in covers[1..8].windows(2) {
        assert!((0.05..0.2).contains(&(pair[1] - pair[0])), "{covers:?}");
    }
}

#[test]
fn banks_freeze_before_mid_stream() {
    let [picture] = winter(&[0.35]).try_into().ok().unwrap();
    let cover = |from: f32, to: f32| {
        let band = wet(&picture).filter(|(pixel, _)| (from..to).contains(&off_middle(*pixel)));
        let (sum, count) = band.fold((0.0, 0.0), |(sum, count), (_, ice)| (sum + ice.y, count + 1.0));
        sum / count
    };
    let bands = [cover(13.0, 15.0), cover(9.0, 12.0), cover(0.0, 5.0)];
    assert!(bands[0] > 0.95 && bands[2] < 0.05 && bands[0] > bands[1] && bands[1] > bands[2], "{bands:?}");
}

#[test]
fn bodies_feel_the_drawn_thickness_and_neither_waves_nor_current_under_it() {
    let mut stage = Stage::new();
    let water = river(&mut stage);
    let camera = above(&mut stage);
    show_ice(&mut stage, water);
    freeze(&mut stage, water, 0.5);
    let picture = stage.picture(camera);
    for x in [-14.0, -10.0, -6.0, 0.0, 8.0, 13.0] {
        let felt = sample(&mut stage, vec3(x, 0.0, 0.0));
        let pixel = ((x / WIDTH + 0.5) * SIZE.x as f32) as u32;
        let drawn = 0.5 * (picture.at(pixel - 1, SIZE.y / 2) + picture.at(pixel, SIZE.y / 2)).x;
        assert!((felt.ice - drawn).abs() < 3e-3, "at {x} {} m are felt, {drawn} m drawn", felt.ice);
    }
    let middle = sample(&mut stage, Vec3::ZERO);
    assert!(middle.ice == 0.0 && middle.velocity.z > 1.0, "{middle:?}");

    freeze(&mut stage, water, 1.0);
    stage.run(0.1);
    for x in [-14.0, 0.0, 10.0] {
        let felt = sample(&mut stage, vec3(x, 0.0, 3.0));
        assert!(felt.ice > 0.05 && felt.velocity == Vec3::ZERO && felt.normal == Vec3::Y, "{felt:?}");
        assert!((felt.height + 0.2 * felt.ice).abs() < 1e-5, "the level sinks by a fifth of the thickness: {felt:?}");
    }
}

#[test]
fn rays_meet_the_surface_that_the_ice_has_lowered() {
    let mut stage = Stage::new();
    let water = river(&mut stage);
    freeze(&mut stage, water, 1.0);
    stage.app.update();
    stage.app.update();
    for x in [-12.0, 0.0, 10.0] {
        let felt = sample(&mut stage, vec3(x, 0.0, 3.0));
        let ray = Ray3d::new(vec3(x, 2.0, 3.0), Dir3::NEG_Y);
        let ask = move |water: WaterQuery| water.raycast(ray, 10.0);
        let hit = stage.app.world_mut().run_system_once(ask).unwrap().unwrap();
        assert!(felt.ice > 0.05 && (hit.position.y - felt.height).abs() < 1e-3, "{hit:?}, {felt:?}");
    }
}

#[test]
fn drawn_height_is_the_queried_height_on_half_frozen_water() {
    let mut stage = Stage::new();
    stage.spawn(WaterBed::from_fn(uvec2(20, 20), 2.0, |p| waves::LEVEL - 2.0 + 0.1 * p.x).unwrap());
    let pose = Transform::from_xyz(0.0, waves::LEVEL, 0.0);
    let camera = waves::scene(&mut stage, waves::sea(), pose);
    stage.app.update();
    let mut found = stage.app.world_mut().query_filtered::<Entity, With<Water>>();
    let water = found.single(stage.app.world()).unwrap();
    freeze(&mut stage, water, 0.45);
    stage.settle();
    stage.run(2.0);
    let samples = waves::heights(&mut stage, camera, Vec2::ZERO);
    let (mut open, mut sunk) = (0, 0);
    for (place, drawn, queried) in samples {
        // At the front a cell of the mesh holds a part of the change from waves to ice.
        assert!((drawn - queried).abs() < 2e-3, "{place}: drawn {drawn}, queried {queried}");
        let felt = sample(&mut stage, vec3(place.x, waves::LEVEL, place.y));
        open += u32::from(felt.ice == 0.0);
        sunk += u32::from(felt.ice > 0.05);
    }
    assert!(open > 100 && sunk > 100, "{open} places are open, {sunk} frozen");
}

#[test]
fn ice_comes_without_popping() {
    let mut stage = Stage::new();
    let water = river(&mut stage);
    let camera = along(&mut stage);
    freeze(&mut stage, water, 1.0);
    let snow = stage.picture(camera).pixels().map(|(_, color)| color.max_element()).fold(0.0, f32::max);
    let step = 1.0 / 200.0;
    // The begin, the middle and the end of a winter of 200 pictures.
    for from in [0, 70, 195] {
        let mut before: Option<Picture> = None;
        for i in from..=from + 5 {
            freeze(&mut stage, water, i as f32 * step);
            let picture = stage.picture(camera);
            if let Some(before) = &before {
                let change = |(pixel, a): (UVec2, Vec3)| (picture.at(pixel.x, pixel.y) - a).abs().max_element();
                let most = before.pixels().map(change).fold(0.0, f32::max);
                assert!(most < 0.3 * snow, "picture {i} differs by {most}, snow has {snow}");
            }
            before = Some(picture);
        }
    }
}

#[test]
fn a_flow_that_stops_lets_the_middle_freeze() {
    let mut stage = Stage::new();
    let water = river(&mut stage);
    freeze(&mut stage, water, 0.6);
    stage.app.update();
    let rapid = sample(&mut stage, Vec3::ZERO).ice;
    stage.app.world_mut().entity_mut(water).remove::<WaterFlow>();
    stage.app.world_mut().get_mut::<WaterIce>(water).unwrap().bank_reach = 1.0;
    stage.app.update();
    stage.app.update();
    let places: Vec<f32> = (-20..20).map(|z| sample(&mut stage, vec3(0.0, 0.0, 0.7 * z as f32)).ice).collect();
    assert!(rapid == 0.0 && places.iter().any(|&ice| ice > 0.0), "{places:?}");
}

/// Fields of unusable ice.
const UNUSABLE: &str = "freezing thickness level_drop bank_reach flow_limit snow cracks pattern_size absorption
    scattering roughness snow_albedo";

#[test]
fn unusable_ice_is_named_once_and_falls_back() {
    let nan = f32::NAN;
    let mut stage = Stage::new();
    run_on_this_thread(&mut stage.app);
    let water = river(&mut stage);
    let camera = along(&mut stage);
    stage.app.world_mut().entity_mut(water).insert(WaterIce {
        freezing: 7.0,
        thickness: nan,
        level_drop: -1.0,
        bank_reach: 0.0,
        flow_limit: nan,
        snow: nan,
        cracks: f32::INFINITY,
        pattern_size: nan,
        absorption: Vec3::splat(nan),
        scattering: -1.0,
        roughness: 0.0,
        snow_albedo: LinearRgba::rgb(nan, 0.0, 0.0),
    });
    let said = complaints(&mut stage.app, |app| (0..10).for_each(|_| app.update()));
    for field in UNUSABLE.split_whitespace() {
        let field = format!(" {water}: WaterIce::{field} ");
        assert_eq!(said.iter().filter(|line| line.contains(&field)).count(), 1, "{field}in {said:#?}");
    }
    assert_eq!(said.len(), UNUSABLE.split_whitespace().count(), "{said:#?}");
    for (pixel, color) in stage.picture(camera).pixels() {
        assert!(color.is_finite() && color.min_element() >= 0.0, "{pixel}: {color}");
    }
}
