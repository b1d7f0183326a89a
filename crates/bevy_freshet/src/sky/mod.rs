//! A sky that is one source of what is seen, what is mirrored and what is lit: moving the sun moves all three.
//!
//! ```no_run
//! # use bevy::prelude::*;
//! # use bevy_freshet::sky::{Sky, SkyPlugin, SkyView};
//! # let mut app = App::new();
//! app.add_plugins((DefaultPlugins, SkyPlugin));
//! # fn setup(mut commands: Commands) {
//! commands.spawn(Sky::with_sun(25.0, 140.0));
//! commands.spawn((Camera3d::default(), SkyView { visibility: Some(8_000.0), ..default() }));
//! # }
//! ```
//!
//! Air comes from the model of Hošek & Wilkie (2012), sunlight from the extinction of the air mass, twilight from measured
//! illuminance, clouds from noise lit by all of these. At night there are stars and, if wanted, a [`Moon`], whose light passes
//! through the same air and clouds. Everything is in cd/m² and lux. It is computed on the CPU when a
//! [`Sky`] changes, so a sky that stands still costs nothing. It is not for a sun that moves in every frame: a repaint of
//! the default resolution took 0.5 to 1.1 s on two cores, and 2.2 to 2.9 s when the clouds were new.
//!
//! Without `Assets<Image>`, as on a server, nothing runs. The same [`Sky`] gives the same bytes on the same machine.

mod clear;
mod clouds;
mod cubemap;
mod dome;
mod filter;
mod firmament;
mod image;
mod maps;
mod moon;
mod settings;
mod stars;
mod sun;
mod view;

pub use maps::SkyMaps;
pub use moon::Moon;
pub use settings::Sky;
pub use view::SkyView;

use crate::{report::Reported, schedule::WaterSystems};
use bevy::{app::prelude::*, asset::Assets, ecs::prelude::*, image::Image, transform::TransformSystems};

/// Draws the [`Sky`] for every camera with a [`SkyView`].
pub struct SkyPlugin;

/// What [`SkyPlugin`] does, in `PostUpdate`.
#[derive(SystemSet, Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum SkySystems {
    /// A changed [`Sky`] turns its light and repaints its [`SkyMaps`]; the cameras get both. Before
    /// [`TransformSystems::Propagate`].
    Paint,
    /// The fog of the cameras takes the colour of the horizon. After [`TransformSystems::Propagate`], before
    /// [`WaterSystems::Present`].
    Fog,
}

impl Plugin for SkyPlugin {
    fn build(&self, app: &mut App) {
        let paint = (maps::update_skies, view::show_sky).chain().in_set(SkySystems::Paint);
        app.init_resource::<Reported>()
            .configure_sets(
                PostUpdate,
                (
                    SkySystems::Paint.before(TransformSystems::Propagate),
                    SkySystems::Fog.after(TransformSystems::Propagate).before(WaterSystems::Displace),
                ),
            )
            .add_systems(PostUpdate, paint.run_if(resource_exists::<Assets<Image>>))
            .add_systems(PostUpdate, view::tint_fog.in_set(SkySystems::Fog));
    }
}
