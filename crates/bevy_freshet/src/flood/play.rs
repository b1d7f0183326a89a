//! Plays floods: their time, and the water at it.
use super::{Flood, FloodMaps, ahead::Ahead};
use crate::{
    body::{SimulatedWater, Water, WaterSimulation},
    report::Reported,
    schedule::WaterSystems,
    simulation::{ShallowFrame, Simulate, Simulated},
};
use bevy::{prelude::*, render::RenderApp};
use freshet_flood::flow_map::MOST_CELLS;
use freshet_flood::playback::{BANK, Moment, PlayedInterval};
use freshet_hydro::shallow_water::Field;
use std::sync::Arc;

/// What is shown of a [`Flood`]. Read only; beside every one.
#[derive(Component, Default)]
pub struct FloodState {
    ahead: Ahead,
    shown: Option<Shown>,
    /// The part that is shown next, if it is there.
    next: Option<Arc<PlayedInterval>>,
    /// The water of every cell, as the GPU draws it.
    picture: Option<Handle<Image>>,
    /// Whether its time is not there yet.
    is_late: bool,
}

/// What is shown of a flood.
struct Shown {
    maps: Arc<FloodMaps>,
    moment: Arc<Moment>,
}

/// Plays every [`Flood`].
pub(crate) struct FloodPlugin;

impl Plugin for FloodPlugin {
    fn build(&self, app: &mut App) {
        app.add_observer(end_flood)
            .add_systems(FixedFirst, (advance, show).chain().after(Simulate).before(WaterSystems::Resolve))
            .add_systems(
                PostUpdate,
                show.after(TransformSystems::Propagate).after(Simulate).before(WaterSystems::Resolve),
            );
        if app.get_sub_app(RenderApp).is_some() {
            app.add_systems(PostUpdate, draw.after(show).before(WaterSystems::Resolve));
        }
    }
}

/// Without [`Flood`] the water is still again.
fn end_flood(removed: On<Remove, Flood>, mut commands: Commands, mut waters: Query<&mut Simulated>) {
    if let Ok(mut simulated) = waters.get_mut(removed.entity) {
        simulated.play(None);
    }
    if let Ok(mut water) = commands.get_entity(removed.entity) {
        water.try_remove::<(FloodState, ShallowFrame)>();
    }
}

/// Floods that are played: none beside a simulation.
type Played = (With<Water>, Without<WaterSimulation>);

/// Lets the time of floods pass, unless they wait for it.
fn advance(
    time: Res<Time>,
    mut reported: ResMut<Reported>,
    mut floods: Query<(Entity, &mut Flood, &FloodState, Has<WaterSimulation>), With<Water>>,
) {
    for (entity, mut flood, playback, is_simulated) in &mut floods {
        if is_simulated {
            reported.warn(entity, "Flood", "is beside a WaterSimulation; the simulation counts");
        } else if flood.playing && !playback.is_late {
            let speed = reported.clamp(entity, "Flood::speed", flood.speed, -1e5..=1e5, 60.0);
            flood.advance(time.delta_secs_f64() * f64::from(speed));
        }
    }
}

/// Brings the water to the time of its flood, as far as its steps are there.
fn show(
    time: Res<Time>,
    mut commands: Commands,
    mut reported: ResMut<Reported>,
    mut floods: Query<(Entity, &Flood, &Water, &mut FloodState, Option<&mut Simulated>), Played>,
) {
    for (entity, flood, water, mut playback, simulated) in &mut floods {
        let Some(maps) = flood.maps() else { continue };
        let Some(mut simulated) = simulated else {
            // It went with a simulation.
            commands.entity(entity).try_insert(Simulated::default());
            continue;
        };
        let factor = reported.clamp(entity, "Flood::exaggeration", flood.exaggeration, 0.01..=100.0, 1.0);
        if flood.time.is_nan() {
            reported.warn(entity, "Flood::time", "is no number; the first step is shown");
        }
        if (water.size - Flood::size(maps)).abs().max_element() > 0.5 * maps.georeference().cell_size as f32 {
            let (found, expected) = (water.size, Flood::size(maps));
            reported.warn(entity, "Water::size", format_args!("is {found}, that of its Flood {expected}"));
        }
        playback.show(entity, flood, maps, factor, time.delta_secs_f64(), &mut reported);
        simulated.play(Some((playback.water(), Flood::size(maps))));
    }
}

impl FloodState {
    /// Time of what is shown, s in the data; `None` until the first steps are there.
    pub fn time(&self) -> Option<f64> {
        self.shown.as_ref().map(|shown| shown.moment.time())
    }

    /// The water that is shown, [`Flood::exaggeration`] times as high: any of its cells can be looked up.
    pub fn moment(&self) -> Option<&Arc<Moment>> {
        self.shown.as_ref().map(|shown| &shown.moment)
    }

    /// The same on the GPU, for materials of one's own: level (m), depth (m) and velocity to the east and the south (m/s) of every cell, as
    /// [`TextureFormat::Rgba32Float`](bevy::render::render_resource::TextureFormat::Rgba32Float), drawn anew before the cameras
    /// whenever the water changes. The velocity is undefined where the depth is at most 1 mm. `None` until it is there, or if nothing is drawn.
    pub fn picture(&self) -> Option<&Handle<Image>> {
        self.picture.as_ref()
    }

    /// Whether the water of the flood's time is not there yet.
    pub fn is_late(&self) -> bool {
        self.is_late
    }

    /// The water that is shown; none as long as nothing is there.
    fn water(&self) -> SimulatedWater {
        match &self.shown {
            Some(shown) => SimulatedWater::Moment(shown.moment.clone()),
            None => SimulatedWater::Field(Arc::new(Field::dry(BANK))),
        }
    }

    /// Makes the water of the flood's time, if that is not shown already; the last frame or fixed step was `elapsed` (s) ago.
    fn show(
        &mut self,
        entity: Entity,
        flood: &Flood,
        maps: &Arc<FloodMaps>,
        factor: f32,
        elapsed: f64,
        reported: &mut Reported,
    ) {
        let time = flood.usable_time();
        if self.shown.as_ref().is_some_and(|shown| !Arc::ptr_eq(&shown.maps, maps)) {
            self.shown = None;
        }
        let parts = around(maps, time, flood);
        let (part, failed) = self.ahead.part(maps, parts, flood.waits);
        if let Some(error) = failed {
            reported.warn(entity, "Flood (its steps)", format_args!("cannot be read: {error}"));
        }
        // What stands does not rise.
        let stands = !flood.playing || flood.speed == 0.0;
        self.next = self.ahead.get(parts[1]).filter(|_| parts[1] != parts[0]);
        let is_shown =
            |shown: &Moment| shown.time() == time && shown.factor() == factor && !(stands && shown.is_rising());
        if self.shown.as_ref().is_some_and(|shown| is_shown(&shown.moment)) {
            self.is_late = false;
            return;
        }
        // What cannot be read is passed over; what was shown before stays.
        self.is_late = part.is_none() && !self.ahead.has_failed(parts[0]);
        let Some(part) = part else {
            // What waits does not rise.
            if let Some(shown) = self.shown.as_mut().filter(|shown| shown.moment.is_rising()) {
                shown.moment = Arc::new(shown.moment.standing());
            }
            return;
        };
        // A jump is no rise.
        let most = f64::from(flood.speed.abs()) * elapsed * 1.5;
        let is_steady =
            |shown: &&Shown| !stands && shown.moment.factor() == factor && (shown.moment.time() - time).abs() <= most;
        let before = self.shown.as_ref().filter(is_steady).map(|shown| shown.moment.time());
        let moment = Moment::new(part, time, factor);
        let moment = match before {
            Some(before) => moment.rising_since(before, elapsed),
            None => moment,
        };
        self.shown = Some(Shown { maps: maps.clone(), moment: Arc::new(moment) });
    }
}

/// The part that a time lies in, and the one that is played after it.
fn around(maps: &FloodMaps, time: f64, flood: &Flood) -> [usize; 2] {
    let last = maps.times().len().saturating_sub(2);
    let wanted = maps.step_before(time).min(last);
    let next = match (flood.speed < 0.0, flood.looping) {
        (false, _) if wanted < last => wanted + 1,
        (false, true) => 0,
        (true, _) if wanted > 0 => wanted - 1,
        (true, true) => last,
        _ => wanted,
    };
    [wanted, next]
}

/// Hands what is shown to the renderer.
fn draw(
    mut commands: Commands,
    mut images: ResMut<Assets<Image>>,
    mut reported: ResMut<Reported>,
    mut floods: Query<(Entity, &Flood, &mut FloodState, &mut Simulated), Played>,
) {
    for (entity, flood, mut playback, mut simulated) in &mut floods {
        let size = flood.maps().map_or(UVec2::ZERO, |maps| maps.georeference().size);
        if size.max_element() > MOST_CELLS {
            reported.warn(
                entity,
                "Flood (its size)",
                format_args!("has {size} cells, more than {MOST_CELLS}; it is not drawn"),
            );
            playback.picture = None;
            commands.entity(entity).try_remove::<ShallowFrame>();
            continue;
        }
        match simulated.played_frame(playback.next.clone(), &mut images) {
            Some(frame) => {
                let is_there = playback.shown.is_some();
                playback.picture = simulated.pictures.as_ref().filter(|_| is_there).map(|[picture, _]| picture.clone());
                commands.entity(entity).try_insert(frame);
            }
            None => _ = commands.entity(entity).try_remove::<ShallowFrame>(),
        }
    }
}
