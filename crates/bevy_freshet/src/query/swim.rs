//! The water around a swimmer.
use super::{WaterQuery, WaterSample};
use bevy::prelude::*;

/// The water around a point, and how deep in it that lies.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Submersion {
    /// The water's surface over or under the point, with its entity, height, normal, ice and depth.
    pub surface: WaterSample,
    /// Depth of the point below the surface, m; negative above it.
    pub depth: f32,
    /// Velocity of the water at the point, m/s: the current, and of the waves what is left at that depth. Above the surface that of the surface.
    pub velocity: Vec3,
    /// Height of the point over the bed, m: negative in the ground, infinite without a bed.
    pub above_bed: f32,
}

impl Submersion {
    /// Whether the point is under water: below the surface, and below the ice if there is any.
    pub fn is_under_water(&self) -> bool {
        self.depth > self.surface.ice
    }
}

impl WaterQuery<'_, '_> {
    /// How a point (world, m) lies in the water that [`WaterQuery::sample`] finds for it; `None` where that finds none.
    ///
    /// The current is the same at all depths. A wave of wavenumber k (rad/m) moves water at depth d in a column of height h by
    /// cosh k(h − d)/cosh k h of what it does at the surface to and fro, and by sinh k(h − d)/sinh k h up and down (Airy 1845), which is
    /// e^(−k d) in deep water and nothing up and down at the bed.
    ///
    /// ```
    /// # use bevy::prelude::*;
    /// # use bevy_freshet::prelude::*;
    /// #[derive(Component)]
    /// struct Swimmer {
    ///     /// m/s.
    ///     velocity: Vec3,
    ///     /// s.
    ///     breath: f32,
    /// }
    ///
    /// /// Takes swimmers along with the water, and up to it until their chest is 0.2 m below its surface.
    /// fn swim(water: WaterQuery, time: Res<Time>, mut swimmers: Query<(&mut Transform, &mut Swimmer)>) {
    ///     let dt = time.delta_secs();
    ///     for (mut chest, mut swimmer) in &mut swimmers {
    ///         let around = water.swim(chest.translation).filter(|around| around.depth > 0.0);
    ///         let Some(around) = around else {
    ///             swimmer.velocity.y -= 9.81 * dt;
    ///             chest.translation += swimmer.velocity * dt;
    ///             continue;
    ///         };
    ///         let wanted = around.velocity + Vec3::Y * (around.depth - 0.2).clamp(-1.0, 1.0);
    ///         swimmer.velocity = swimmer.velocity.lerp(wanted, 1.0 - (-3.0 * dt).exp());
    ///         // Standing on the bed with legs of a metre.
    ///         let stand = (1.0 - around.above_bed).max(0.0);
    ///         chest.translation += swimmer.velocity * dt + Vec3::Y * stand;
    ///         let head = water.swim(chest.translation + Vec3::Y * 0.3);
    ///         let is_breathing = !head.is_some_and(|head| head.is_under_water());
    ///         swimmer.breath = if is_breathing { 60.0 } else { swimmer.breath - dt };
    ///     }
    /// }
    /// # let mut app = App::new();
    /// # app.add_plugins((MinimalPlugins, TransformPlugin, AssetPlugin::default())).init_asset::<Mesh>();
    /// # app.add_plugins(WaterPlugin).add_systems(Update, swim);
    /// # app.world_mut().spawn((Water::new(Vec2::splat(100.0)), WaterFlow::uniform(Vec2::X)));
    /// # let swimmer = (Transform::from_xyz(0.0, 0.3, 0.0), Swimmer { velocity: Vec3::ZERO, breath: 60.0 });
    /// # let swimmer = app.world_mut().spawn(swimmer).id();
    /// # let step = std::time::Duration::from_millis(20);
    /// # app.insert_resource(bevy::time::TimeUpdateStrategy::ManualDuration(step));
    /// # (0..300).for_each(|_| app.update());
    /// # let (pose, swimmer) = (app.world().get::<Transform>(swimmer).unwrap(), app.world().get::<Swimmer>(swimmer).unwrap());
    /// # assert!((swimmer.velocity.x - 1.0).abs() < 0.1 && pose.translation.y.abs() < 0.4 && swimmer.breath == 60.0);
    /// ```
    pub fn swim(&self, position: Vec3) -> Option<Submersion> {
        let surface = self.sample(position)?;
        let (_, water) = self.waters.get(surface.water).ok()?;
        let depth = surface.height - position.y;
        let above_bed = surface.depth - depth;
        let below = depth.clamp(0.0, surface.depth);

        let place = water.local_from_world.transform_point2(position.xz());
        let [particle, ..] = water.particles(&[place]);
        let fade = water.fade(particle.rest);
        let waves = |below| water.waves.velocity_below(particle.rest, fade, below, surface.depth);
        let at_surface = water.direction_to_world(particle.velocity);
        // What is no wave rises and falls with the surface, and less so towards the bed.
        let flowing = (surface.velocity - at_surface) * vec3(1.0, (1.0 - below / surface.depth).max(0.0), 1.0);
        Some(Submersion { surface, depth, velocity: flowing + water.direction_to_world(waves(below)), above_bed })
    }
}
