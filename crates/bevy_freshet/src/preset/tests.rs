use super::*;
use crate::{body::*, reflection::WaterReflection, sky::Sky, surface::*};

const FILE: &str = "some.ron";

/// A world with a water, a sky and a camera.
fn scene() -> (App, PresetScene) {
    let mut app = App::new();
    let world = app.world_mut();
    let water = world.spawn((Water::default(), WaterFlow::default())).id();
    let sky = Some(world.spawn(Sky::default()).id());
    let camera = Some(world.spawn((Camera3d::default(), crate::sky::SkyView::default())).id());
    (app, PresetScene { water, sky, camera })
}

fn text_of(app: &App, scene: PresetScene) -> String {
    let registry = app.world().resource::<AppTypeRegistry>().read();
    Preset::of(app.world(), scene).to_text(&registry).unwrap()
}

fn parse(app: &App, text: &str) -> Result<Preset, PresetError> {
    Preset::parse(text, Path::new(FILE), &app.world().resource::<AppTypeRegistry>().read())
}

/// Sets the scene to `text`.
fn load(app: &mut App, scene: PresetScene, text: &str) {
    parse(app, text).unwrap().apply(app.world_mut(), scene);
}

fn get<C: Component + Clone>(app: &App, entity: Entity) -> C {
    app.world().get::<C>(entity).unwrap().clone()
}

/// Finite numbers of every magnitude.
fn any_number(random: &mut fastrand::Rng) -> f32 {
    core::iter::repeat_with(|| f32::from_bits(random.u32(..))).find(|number| number.is_finite()).unwrap()
}

#[test]
fn settings_survive_the_way_through_a_file_bit_for_bit() {
    let mut random = fastrand::Rng::with_seed(7);
    let (mut other, other_scene) = scene();
    for _ in 0..200 {
        let mut number = || any_number(&mut random);
        let mut vector = || vec3(number(), number(), number());
        let optics = WaterOptics { absorption: vector(), backscatter: vector(), index: number(), ..default() };
        let wave = |x: Vec3| Wave { direction: x.xy(), wavelength: x.z, steepness: x.x, phase: x.y };
        let trains = vec![wave(vec3(number(), number(), number())); (number().to_bits() % 9) as usize];
        let waves = WaterWaves { trains, fade_depth: number(), ..WaterWaves::still() };
        let foam = WaterFoam { albedo: LinearRgba::rgb(number(), number(), number()), ..default() };
        let flow = WaterFlow { uniform: vec2(number(), number()), scale: number(), map: None };
        let sky = Sky { sun_elevation: number(), seed: number().to_bits(), ..default() };
        let pose = Transform::from_xyz(number(), number(), number());

        let (mut app, scene) = scene();
        app.world_mut().entity_mut(scene.water).insert((optics, waves.clone(), foam, flow.clone()));
        app.world_mut().entity_mut(scene.sky.unwrap()).insert(sky);
        app.world_mut().entity_mut(scene.camera.unwrap()).insert(pose);
        let text = text_of(&app, scene);
        load(&mut other, other_scene, &text);

        let water = other_scene.water;
        assert_eq!(get::<WaterOptics>(&other, water), optics, "{text}");
        assert_eq!(get::<WaterWaves>(&other, water), waves, "{text}");
        assert_eq!(get::<WaterFoam>(&other, water), foam, "{text}");
        assert_eq!(get::<WaterFlow>(&other, water).uniform, flow.uniform, "{text}");
        assert_eq!(get::<Sky>(&other, other_scene.sky.unwrap()), sky, "{text}");
        assert_eq!(get::<Transform>(&other, other_scene.camera.unwrap()), pose, "{text}");
        assert_eq!(text_of(&other, other_scene), text);
    }
}

#[test]
fn numbers_that_are_none_are_refused() {
    for (field, value) in [("WaterOptics.index", "NaN"), ("WaterOptics.index", "inf"), ("WaterWaves.depth", "NaN")] {
        let (component, name) = field.split_once('.').unwrap();
        let text = format!("(freshet_preset: 1, water: {{\n  \"{component}\": ({name}: {value}),\n}})");
        let error = parse(&scene().0, &text).unwrap_err().to_string();
        assert!(error.starts_with("some.ron:2:") && error.contains(field) && error.contains(value), "{error}");
    }
    for text in [
        r#"(freshet_preset: 1, water: { "WaterOptics": (absorption: (1, NaN, 1)) })"#,
        r#"(freshet_preset: 1, water: { "WaterOptics": (fresnel: Constant(share: inf)) })"#,
        r#"(freshet_preset: 1, water: { "WaterWaves": (trains: [(direction: (1, 0), wavelength: NaN, steepness: 0, phase: 0)]) })"#,
    ] {
        assert!(parse(&scene().0, text).is_err(), "{text}");
    }
    // Deep water is infinitely deep by default.
    let (mut app, scene) = scene();
    load(&mut app, scene, r#"(freshet_preset: 1, water: { "WaterWaves": (depth: inf) })"#);
    assert_eq!(get::<WaterWaves>(&app, scene.water).depth, f32::INFINITY);
}

#[test]
fn errors_name_file_line_column_and_what_was_expected() {
    for (text, place, word) in [
        (
            "(freshet_preset: 1,\n water: {\n  \"WaterOptics\": (index: \"much\"),\n })",
            "some.ron:3:",
            "WaterOptics.index: Expected float",
        ),
        ("(freshet_preset: 2)", "some.ron:1:", "version 1"),
        ("(water: {})", "some.ron:1:", "freshet_preset"),
        ("(freshet_preset: 1,\n water: [])", "some.ron:2:", "`{`"),
        ("(freshet_preset: 1,\n water: {", "some.ron:2:", "xpected"),
        ("", "some.ron:1:", "xpected"),
        ("(freshet_preset: 1, water: { \"WaterOptics\": (fresnel: Newton) })", "some.ron:1:", "Newton"),
    ] {
        let error = parse(&scene().0, text).expect_err(text).to_string();
        assert!(error.starts_with(place) && error.contains(word), "{text:?}: {error}");
    }
    let missing = Preset::read("no/such.ron", &TypeRegistry::new()).unwrap_err().to_string();
    assert!(missing.starts_with("no/such.ron: "), "{missing}");
}

#[test]
fn what_is_unknown_is_told_and_what_is_missing_gets_its_default() {
    let (mut app, scene) = scene();
    let changed = WaterOptics { edge_depth: 3.0, refraction: 0.5, ..default() };
    let reflection = WaterReflection { resolution: 0.25, ..default() };
    app.world_mut().entity_mut(scene.water).insert((changed, reflection.clone()));
    let text = r#"(
        freshet_preset: 1,
        water: { "WaterOptics": (refraction: 0.75, glow: 3, tint: (r: 1, g: [2])), "WaterJelly": (wobble: 1) },
        weather: "nice",
    )"#;
    let preset = parse(&app, text).unwrap();
    assert_eq!(preset.ignored(), ["WaterOptics.glow", "WaterOptics.tint", "WaterJelly", "weather"]);
    preset.apply(app.world_mut(), scene);
    let expected = WaterOptics { refraction: 0.75, ..default() };
    assert_eq!(get::<WaterOptics>(&app, scene.water), expected);
    assert_eq!(get::<WaterReflection>(&app, scene.water), reflection, "a component that is not named stays");
}

#[test]
fn what_belongs_to_the_scene_is_neither_saved_nor_changed() {
    let (mut app, scene) = scene();
    let map = freshet_hydro::grid::Grid::from_fn(UVec2::splat(4), 1.0, |_| Vec2::X).unwrap();
    let view = WaterSurface { view: SurfaceView::Fresnel, ripples: 0.5, ..default() };
    let size = Water::new(vec2(7.0, 8.0));
    app.world_mut().entity_mut(scene.water).insert((WaterFlow::from_map(map), view, size));
    let text = text_of(&app, scene);
    for absent in ["view:", "layers", "\"Water\"", "map:"] {
        assert!(!text.contains(absent), "{absent}: {text}");
    }
    load(
        &mut app,
        scene,
        r#"(freshet_preset: 1, water: { "WaterFlow": (scale: 2), "WaterSurface": (ripples: 0.1), "Water": (size: (1, 1)) })"#,
    );
    let flow = get::<WaterFlow>(&app, scene.water);
    assert!(flow.map.is_some() && flow.scale == 2.0);
    let surface = get::<WaterSurface>(&app, scene.water);
    assert_eq!((surface.view, surface.ripples), (SurfaceView::Fresnel, 0.1));
    assert_eq!(get::<Water>(&app, scene.water), size);
}

#[test]
fn fewer_trains_than_before_leave_none_of_the_old_ones() {
    let (mut app, scene) = scene();
    assert!(get::<WaterWaves>(&app, scene.water).trains.len() > 1);
    load(&mut app, scene, r#"(freshet_preset: 1, water: { "WaterWaves": (trains: []) })"#);
    assert_eq!(get::<WaterWaves>(&app, scene.water).trains, []);
}

#[test]
fn components_and_entities_that_are_missing_are_no_error() {
    let (mut app, mut scene) = scene();
    app.world_mut().entity_mut(scene.water).remove::<WaterFlow>();
    app.world_mut().despawn(scene.sky.unwrap());
    scene.camera = None;
    load(
        &mut app,
        scene,
        r#"(freshet_preset: 1, water: { "WaterFlow": (uniform: (1, 2)) }, sky: { "Sky": () }, camera: { "Transform": () })"#,
    );
    assert_eq!(get::<WaterFlow>(&app, scene.water).uniform, vec2(1.0, 2.0));
}

#[test]
fn a_file_is_replaced_as_a_whole_or_not_at_all() {
    let folder = std::env::temp_dir().join(format!("freshet_preset_{}", std::process::id()));
    let path = folder.join("deeper/lake.ron");
    let (app, scene) = scene();
    let registry = app.world().resource::<AppTypeRegistry>().read();
    let preset = Preset::of(app.world(), scene);
    preset.write(&path, &registry).unwrap();
    preset.write(&path, &registry).unwrap();
    assert_eq!(fs::read_to_string(&path).unwrap(), preset.to_text(&registry).unwrap());
    let files = || fs::read_dir(path.parent().unwrap()).unwrap().count();
    assert_eq!(files(), 1, "nothing else is left behind");
    // A folder of that name cannot be replaced by a file.
    let taken = folder.join("deeper/taken.ron");
    fs::create_dir_all(taken.join("inside")).unwrap();
    let error = preset.write(&taken, &registry).unwrap_err().to_string();
    assert!(error.contains("taken.ron"), "{error}");
    assert_eq!(files(), 2, "nothing else is left behind");
    fs::remove_dir_all(folder).unwrap();
}

#[test]
fn every_shipped_preset_is_known_completely_and_needs_no_correction() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../assets/presets");
    let mut count = 0;
    for file in fs::read_dir(folder).unwrap() {
        let path = file.unwrap().path();
        let (mut app, scene) = scene();
        let preset = Preset::read(&path, &app.world().resource::<AppTypeRegistry>().read()).unwrap();
        assert_eq!(preset.ignored(), [""; 0], "{}", path.display());
        let before = text_of(&app, scene);
        preset.apply(app.world_mut(), scene);
        assert_ne!(text_of(&app, scene), before, "{}", path.display());
        count += 1;
    }
    assert!(count >= 6);
}
