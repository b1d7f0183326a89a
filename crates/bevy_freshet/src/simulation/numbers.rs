//! The numbers of the simulated fields as the stages read them.
use super::FieldWindow;
use crate::{
    body::{ResolvedWater, WaterFoam, WaterInteraction},
    report::Reported,
};
use bevy::{prelude::*, render::render_resource::ShaderType};
use core::f32::consts::TAU;
use freshet_hydro::{
    fields::{Cells, foam, rings, transport},
    waves::GRAVITY,
};

/// Duration of a step of the fields' clock, s.
pub(super) const STEP: f32 = 1.0 / 60.0;

/// Depth over which dye mixes at most, m: deeper down the water stays clear.
const DYE_MIXING: f32 = 2.0;

/// Most parts into which a step is divided for stability; beyond them what is too fast is slowed down.
const MOST_PARTS: f32 = 8.0;

/// The Rust twin of `Numbers` in `numbers.wgsl`, where each member is explained.
#[derive(ShaderType, Clone, Debug, Default, PartialEq)]
#[cfg_attr(test, derive(Reflect))]
pub(crate) struct GpuNumbers {
    pub size: UVec2,
    pub shift: IVec2,
    pub origin: Vec2,
    pub drift: Vec2,
    pub absorbs: Vec4,
    pub cell: f32,
    pub open_below: f32,
    pub silhouettes: u32,

    pub wavenumber: f32,
    pub deep_celerity: f32,
    pub most_celerity: f32,
    pub ring_step: f32,
    pub ring_decay: f32,
    pub rim_width: f32,
    pub rim_decay: f32,

    pub transport_step: f32,
    pub most_speed: f32,
    pub spreading: f32,
    pub dye_decay: f32,
    pub dye_mixing: f32,

    pub foam_life: f32,
    pub calm_shore: f32,
    pub shore: f32,
    pub shore_depth: f32,
    pub shear: f32,
    pub shear_threshold: f32,
    pub breaking: f32,
    pub breaking_threshold: f32,
    pub speed: f32,
    pub speed_threshold: f32,
    pub bodies: f32,
}

/// Into how many parts a step is divided.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Parts {
    pub rings: u32,
    pub transport: u32,
}

impl GpuNumbers {
    /// The numbers of a water whose map's current is nowhere faster than `fastest` (m/s), and how its steps are divided.
    pub fn new(
        entity: Entity,
        settings: &WaterInteraction,
        foam: &WaterFoam,
        water: &ResolvedWater,
        window: &FieldWindow,
        fastest: f32,
        reported: &mut Reported,
    ) -> (Self, Parts) {
        let mut numbers = Self {
            size: window.size,
            origin: window.origin(),
            drift: water.drift,
            absorbs: window.open_sides(water.half_size),
            cell: window.cell,
            open_below: transport::OPEN_BELOW,
            dye_mixing: DYE_MIXING,
            calm_shore: foam::CALM_SHORE,
            ..default()
        };
        let speed = water.drift.length() + fastest;
        let parts = Parts {
            rings: numbers.set_rings(entity, settings, speed, reported),
            transport: numbers.set_transport(entity, settings, speed, reported),
        };
        numbers.set_foam(entity, foam, reported);
        (numbers, parts)
    }

    /// Rings and the parts that their step needs: rings are not faster than in deep water.
    fn set_rings(&mut self, entity: Entity, settings: &WaterInteraction, speed: f32, reported: &mut Reported) -> u32 {
        let mut clamp = |field, value, range, fallback| reported.clamp(entity, field, value, range, fallback);
        let usable = WaterInteraction::default();
        let length = clamp("WaterInteraction::wavelength", settings.wavelength, 0.05..=1e3, usable.wavelength);
        self.ring_decay = clamp("WaterInteraction::decay", settings.decay, 0.05..=1e3, usable.decay).recip();
        self.wavenumber = TAU / length;
        self.deep_celerity = GRAVITY / self.wavenumber;
        let courant = self.deep_celerity.sqrt() * STEP / (rings::MAX_COURANT * self.cell);
        let parts = courant.max(speed * STEP / self.cell).ceil().clamp(1.0, MOST_PARTS);
        self.ring_step = STEP / parts;
        self.most_celerity = (rings::MAX_COURANT * self.cell / self.ring_step).powi(2);
        if courant > parts {
            let problem =
                format_args!("is {length} m: its rings cross more than {MOST_PARTS} cells a step; they are slowed");
            reported.warn(entity, "WaterInteraction::wavelength", problem);
        }
        let cells = Cells { size: self.size, side: self.cell };
        self.rim_width = rings::rim_width(&cells);
        self.rim_decay = rings::rim_decay(&cells);
        parts as u32
    }

    /// Dye, drift and the parts that their step needs.
    fn set_transport(
        &mut self,
        entity: Entity,
        settings: &WaterInteraction,
        speed: f32,
        reported: &mut Reported,
    ) -> u32 {
        let mut clamp = |field, value, range, fallback| reported.clamp(entity, field, value, range, fallback);
        let usable = WaterInteraction::default();
        self.spreading = clamp("WaterInteraction::spreading", settings.spreading, 0.0..=1.0, usable.spreading);
        self.dye_decay = clamp("WaterInteraction::dye_life", settings.dye_life, 0.1..=1e6, usable.dye_life).recip();
        let courant = speed * STEP / (transport::MAX_COURANT * self.cell);
        let diffusion = self.spreading * STEP / (transport::MAX_DIFFUSION * self.cell * self.cell);
        let parts = courant.max(diffusion).ceil().clamp(1.0, MOST_PARTS);
        self.transport_step = STEP / parts;
        self.most_speed = transport::MAX_COURANT * self.cell / self.transport_step;
        self.spreading = self.spreading.min(transport::MAX_DIFFUSION * self.cell * self.cell / self.transport_step);
        if courant > parts {
            let problem = format_args!("is {} m: the current crosses too many in a step; foam is slowed", self.cell);
            reported.warn(entity, "WaterInteraction::cell", problem);
        }
        parts as u32
    }

    fn set_foam(&mut self, entity: Entity, foam: &WaterFoam, reported: &mut Reported) {
        let mut clamp = |field, value, range, fallback| reported.clamp(entity, field, value, range, fallback);
        let usable = WaterFoam::default();
        self.foam_life = clamp("WaterFoam::life", foam.life, 0.1..=1e3, usable.life);
        self.shore = clamp("WaterFoam::shore", foam.shore, 0.0..=10.0, usable.shore);
        self.shore_depth = clamp("WaterFoam::shore_depth", foam.shore_depth, 0.01..=10.0, usable.shore_depth);
        self.shear = clamp("WaterFoam::shear", foam.shear, 0.0..=10.0, usable.shear);
        self.shear_threshold =
            clamp("WaterFoam::shear_threshold", foam.shear_threshold, 0.0..=100.0, usable.shear_threshold);
        self.breaking = clamp("WaterFoam::breaking", foam.breaking, 0.0..=10.0, usable.breaking);
        self.breaking_threshold =
            clamp("WaterFoam::breaking_threshold", foam.breaking_threshold, 0.0..=100.0, usable.breaking_threshold);
        self.speed = clamp("WaterFoam::speed", foam.speed, 0.0..=10.0, usable.speed);
        self.speed_threshold =
            clamp("WaterFoam::speed_threshold", foam.speed_threshold, 0.0..=100.0, usable.speed_threshold);
        self.bodies = clamp("WaterFoam::bodies", foam.bodies, 0.0..=10.0, usable.bodies);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_stages_read_what_is_written() {
        crate::layout::assert_same_layout::<GpuNumbers, _>(include_str!("numbers.wgsl"), "Numbers");
    }

    fn numbers(settings: &WaterInteraction, water: &ResolvedWater) -> (GpuNumbers, Parts) {
        let window = FieldWindow { first: IVec2::splat(-32), size: UVec2::splat(64), cell: settings.cell };
        let foam = WaterFoam::default();
        GpuNumbers::new(Entity::PLACEHOLDER, settings, &foam, water, &window, 0.0, &mut Reported::default())
    }

    #[test]
    fn a_step_is_divided_until_it_is_stable() {
        let water = ResolvedWater { half_size: Vec2::splat(100.0), ..default() };
        let (usual, parts) = numbers(&WaterInteraction::default(), &water);
        assert_eq!(parts, Parts { rings: 1, transport: 1 });
        assert!(usual.deep_celerity < usual.most_celerity);
        let (long, parts) = numbers(&WaterInteraction { wavelength: 100.0, ..default() }, &water);
        assert!(parts.rings > 1 && long.deep_celerity < long.most_celerity, "{parts:?}");
        // What cannot be carried at all is slowed to what can.
        let (tiny, parts) = numbers(&WaterInteraction { wavelength: 1e3, cell: 0.01, ..default() }, &water);
        assert_eq!(parts.rings, MOST_PARTS as u32);
        let courant = tiny.most_celerity.sqrt() * tiny.ring_step / tiny.cell;
        assert!((courant - rings::MAX_COURANT).abs() < 1e-4 && tiny.deep_celerity > tiny.most_celerity);
        let fast = ResolvedWater { drift: vec2(5.0, 0.0), ..water };
        let (fast, parts) = numbers(&WaterInteraction::default(), &fast);
        assert!(parts.transport > 1 && fast.most_speed > 5.0, "{parts:?}");
    }
}
