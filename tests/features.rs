//! Every feature, switched off, changes the water where it acts, and nothing else.
use crate::stage::{Picture, Stage};
use bevy::{
    pbr::{DistanceFog, FogFalloff},
    prelude::*,
};
use bevy_freshet::{features::Feature, prelude::*};
use freshet_hydro::grid::Grid;

/// Where the ground meets the level, m.
const WATERLINE: f32 = -3.0;

/// A river between a beach on the left and deep water on the right, in which everything acts that can be switched.
struct River {
    stage: Stage,
    camera: Entity,
    water: Entity,
}

impl River {
    /// The river after half a second, without the feature `off` from the beginning.
    fn new(off: Option<Feature>) -> Self {
        let mut stage = Stage::new();
        stage.app.insert_resource(ClearColor(Color::linear_rgb(0.4, 0.5, 0.7)));
        stage.spawn((DirectionalLight::default(), Transform::default().looking_to(vec3(-0.3, -0.6, 1.0), Vec3::Y)));
        let pillar = land(&mut stage);
        // Faster towards the right, and foaming there.
        let speed = |place: Vec2| (0.1 * (place.x - WATERLINE)).clamp(0.0, 0.9);
        let cells = Grid::from_fn(uvec2(20, 20), 2.0, |cell| cell).unwrap();
        let map = Grid::from_fn(uvec2(20, 20), 2.0, |cell| vec2(0.0, speed(cells.position(cell)))).unwrap();
        let optics = WaterOptics { dispersion: 0.02, edge_depth: 0.3, absorption: vec3(0.4, 0.2, 0.3), ..default() };
        let waves = WaterWaves::wind(4.0, 500.0, vec2(0.4, 1.0));
        let foam = WaterFoam { speed_threshold: 0.5, speed: 0.5, ..default() };
        let water = stage.spawn((Water::new(Vec2::splat(36.0)), optics, waves, foam, WaterFlow::from_map(map)));
        // With fewer cells of the mesh where there is less to show, all pixels would change a little.
        let surface = WaterSurface { mesh_error: 0.0, ..default() };
        stage.app.world_mut().entity_mut(water).insert((surface, WaterIce::frozen(0.15)));
        if let Some(feature) = off {
            feature.switch(false, &mut stage.app.world_mut().entity_mut(water));
        }
        let pose = Transform::from_xyz(1.0, 3.0, 14.0).looking_at(vec3(1.0, 0.0, 0.0), Vec3::Y);
        let camera = stage.camera(PerspectiveProjection::default(), pose);
        let falloff = FogFalloff::Linear { start: 5.0, end: 60.0 };
        let fog = DistanceFog { color: Color::linear_rgb(0.6, 0.6, 0.6), falloff, ..default() };
        stage.app.world_mut().entity_mut(camera).insert(fog);
        stage.settle();
        let place = vec3(5.0, 0.0, 4.0);
        stage.app.world_mut().write_message(Disturb::dye(place, 0.8, vec3(0.1, 2.0, 4.0), 2.0).with_foam(2.0));
        // A pillar that sinks makes rings.
        for _ in 0..30 {
            stage.app.world_mut().get_mut::<Transform>(pillar).unwrap().translation.y -= 0.02;
            stage.step(1.0 / 60.0);
        }
        Self { stage, camera, water }
    }

    fn switch(&mut self, feature: Feature, on: bool) {
        feature.switch(on, &mut self.stage.app.world_mut().entity_mut(self.water));
    }

    fn picture(&mut self) -> Picture {
        self.stage.picture(self.camera)
    }

    fn view(&mut self, view: SurfaceView) -> Picture {
        self.stage.app.world_mut().get_mut::<WaterSurface>(self.water).unwrap().view = view;
        let picture = self.picture();
        self.stage.app.world_mut().get_mut::<WaterSurface>(self.water).unwrap().view = SurfaceView::Water;
        picture
    }

    /// The pixels of the water: everything else has some blue, which the shares of reflection and refraction have not.
    fn surface(&mut self) -> Mask {
        Mask::of(&self.view(SurfaceView::Fresnel), |color| color.z == 0.0 && (color.x + color.y - 1.0).abs() < 0.01)
    }
}

/// The ground, a post on it, a box under water, and a pillar in the current, which is returned.
fn land(stage: &mut Stage) -> Entity {
    let bed = WaterBed::from_fn(uvec2(40, 40), 1.0, |place| -0.25 * (place.x - WATERLINE)).unwrap();
    stage.paint(bed.mesh(0..40, 0..40).unwrap(), LinearRgba::rgb(0.8, 0.7, 0.5), Transform::IDENTITY);
    stage.spawn(bed);
    stage.paint(Cuboid::new(0.5, 3.0, 0.5), LinearRgba::rgb(0.1, 0.6, 0.2), Transform::from_xyz(-4.0, 1.0, 2.0));
    stage.paint(Cuboid::new(1.0, 0.4, 1.0), LinearRgba::rgb(0.9, 0.1, 0.3), Transform::from_xyz(-0.5, -0.6, 7.0));
    let pillar =
        stage.paint(Cuboid::new(1.0, 7.0, 1.0), LinearRgba::rgb(0.9, 0.2, 0.1), Transform::from_xyz(3.0, -1.5, 1.0));
    stage.app.world_mut().entity_mut(pillar).insert(DisturbsWater);
    pillar
}

/// Some pixels of a picture.
#[derive(Clone)]
struct Mask {
    width: usize,
    pixels: Vec<bool>,
}

impl Mask {
    fn of(picture: &Picture, is_in: impl Fn(Vec3) -> bool) -> Self {
        Self { width: picture.size.x as usize, pixels: picture.pixels().map(|(_, color)| is_in(color)).collect() }
    }

    /// Where two pictures differ.
    fn changed(a: &Picture, b: &Picture) -> Self {
        let pairs = a.pixels().zip(b.pixels());
        let pixels = pairs.map(|((_, a), (_, b))| (a - b).abs().max_element() > 1e-3).collect();
        Self { width: a.size.x as usize, pixels }
    }

    fn or(&self, other: &Self) -> Self {
        let pixels = self.pixels.iter().zip(&other.pixels).map(|(a, b)| *a || *b).collect();
        Self { width: self.width, pixels }
    }

    /// With the pixels within `reach` along each axis.
    fn widened(&self, reach: isize) -> Self {
        let (width, height) = (self.width as isize, (self.pixels.len() / self.width) as isize);
        let is_in = |x: isize, y: isize| {
            (0..width).contains(&x) && (0..height).contains(&y) && self.pixels[(y * width + x) as usize]
        };
        let near = |i: isize| {
            let (x, y) = (i % width, i / width);
            (-reach..=reach).any(|dy| (-reach..=reach).any(|dx| is_in(x + dx, y + dy)))
        };
        Self { width: self.width, pixels: (0..width * height).map(near).collect() }
    }

    fn count(&self) -> usize {
        self.pixels.iter().filter(|is_in| **is_in).count()
    }

    /// How many pixels are in it that `other` lacks.
    fn beyond(&self, other: &Self) -> usize {
        self.pixels.iter().zip(&other.pixels).filter(|(is_in, other)| **is_in && !**other).count()
    }
}

/// The fewest pixels that a feature changes here.
const FEWEST: usize = 150;

#[test]
fn a_feature_changes_the_water_where_it_acts_and_nothing_else() {
    let mut river = River::new(None);
    let all = river.picture();
    let surface = river.surface();
    assert!((10_000..50_000).contains(&surface.count()), "{} pixels of water", surface.count());
    let foam = Mask::of(&river.view(SurfaceView::Foam), |color| color.x > 0.0);
    let edge = Mask::of(&river.view(SurfaceView::Edge), |color| color.x < 1.0);
    // Under the ice that bodies feel and the one that is drawn, and as far as a vertex of the mesh reaches.
    let ice = Mask::of(&river.view(SurfaceView::Ice), |color| color.x.max(color.y) > 0.0).widened(6);
    // Rings are drawn by their slope, from cell to cell.
    let rings = Mask::of(&river.view(SurfaceView::Interaction), |color| color.y + color.z > 0.0).widened(4);
    let covered = Mask::of(&river.view(SurfaceView::Interaction), |color| color.x > 0.0);
    let dyed = Mask::of(&river.view(SurfaceView::Dye), |color| color.min_element() < 1.0);
    let simulated = rings.or(&covered).or(&dyed).or(&foam);
    let check = |river: &mut River, feature: Feature, off: &Picture| {
        let changed = Mask::changed(&all, off);
        // Where the surface itself moves, so does what it covers.
        let moves = matches!(feature, Feature::Waves | Feature::Ice | Feature::Flow);
        let allowed = if moves { surface.or(&river.surface()) } else { surface.clone() };
        println!("{}: {} of {} pixels change", feature.name(), changed.count(), surface.count());
        assert!(changed.count() >= FEWEST, "{}: only {} pixels change", feature.name(), changed.count());
        assert_eq!(changed.beyond(&allowed), 0, "{}: pixels beside the water change", feature.name());
        let acts = match feature {
            Feature::Foam => &foam,
            Feature::Edge => &edge,
            Feature::Ice => &ice,
            Feature::Rings => &rings,
            Feature::Interaction => &simulated,
            _ => return,
        };
        assert_eq!(changed.beyond(acts), 0, "{}: of {} pixels where it acts", feature.name(), acts.count());
    };
    let later = [Feature::Rings, Feature::Interaction];
    for feature in Feature::ALL.into_iter().filter(|feature| !later.contains(feature)) {
        river.switch(feature, false);
        let off = river.picture();
        check(&mut river, feature, &off);
        river.switch(feature, true);
    }
    assert!(river.picture().bits() == all.bits(), "what was switched off and on is as before");

    // What is simulated is gone with the fields, and rings are made as time goes by.
    river.switch(Feature::Interaction, false);
    let off = river.picture();
    check(&mut river, Feature::Interaction, &off);
    let mut calm = River::new(Some(Feature::Rings));
    let off = calm.picture();
    check(&mut calm, Feature::Rings, &off);

    // The water is nowhere but where it is.
    river.stage.app.world_mut().entity_mut(river.camera).insert(NoWater);
    let dry = Mask::changed(&all, &river.picture());
    assert_eq!(dry.beyond(&surface), 0);
    assert!(10 * dry.count() > 9 * surface.count(), "{} pixels are water", dry.count());
}
