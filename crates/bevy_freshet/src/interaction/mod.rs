//! What touches the water: bodies, rain, touches and spilled liquid.
//!
//! Everything here ends as deposits of a water, once per frame on the virtual clock, for the simulated fields:
//!
//! * [`DisturbsWater`] on an entity cuts its meshes with the waves: their silhouettes at the waterline, and the water that
//!   they displace. Floating bodies have it by themselves. Simulated water is pushed along by them.
//! * [`Disturb`] is a message for everything that happens once: a stone, a splash, a blot of dye.
//! * [`DyesWater`] on an entity leaks dye where it is in the water.
//! * [`WaterTouch`] on a camera lets the player touch the water with mouse or finger.
//! * [`WaterInteraction::rain`](crate::body::WaterInteraction::rain) lets it rain.
//!
//! While the virtual clock stands still nothing is added, and messages are lost.
//!
//! # Limits
//!
//! * A hull is displaced by what its meshes enclose: a boat without a deck is cut as the shell that it is, and water is
//!   seen inside.
//! * Waves are met at the vertices of a mesh: between them its faces are straight, so that a long face does not see a
//!   short wave.
//! * Skinned meshes are left out with a warning, morph targets count in their rest shape.
mod body;
mod disturb;
mod dye;
mod push;
mod rain;
mod shape;
mod silhouette;
#[cfg(test)]
mod tests;
mod touch;

#[cfg(feature = "rapier")]
pub(crate) use body::BodyMotion;
pub use body::DisturbsWater;
pub use disturb::Disturb;
pub use dye::{DyesWater, absorption_from_color};
pub use touch::{WaterTouch, WaterTouchBlocked};

use crate::{
    report::Reported,
    schedule::WaterSystems,
    simulation::{Deposits, FieldSystems, FieldWindow},
};
use bevy::prelude::*;

/// Gathers what touches the waters. Part of `WaterPlugin`.
pub struct InteractionPlugin;

impl Plugin for InteractionPlugin {
    fn build(&self, app: &mut App) {
        app.init_resource::<Reported>()
            .init_resource::<WaterTouchBlocked>()
            .add_message::<Disturb>()
            .add_message::<AssetEvent<Mesh>>()
            .configure_sets(
                PostUpdate,
                (
                    WaterSystems::Displace.after(WaterSystems::Resolve),
                    (FieldSystems::Window, FieldSystems::Deposit, FieldSystems::Step)
                        .chain()
                        .in_set(WaterSystems::Displace),
                ),
            )
            .add_systems(
                PostUpdate,
                (
                    clear_deposits,
                    body::track_motion,
                    silhouette::draw_silhouettes,
                    (dye::leak, touch::touch_water, disturb::apply_disturbances, rain::fall).chain().run_if(clock_runs),
                )
                    .chain()
                    .in_set(FieldSystems::Deposit),
            );
    }
}

/// Silhouettes are those of this frame. Strokes wait for the step that takes them; where nothing is simulated nobody does.
fn clear_deposits(mut waters: Query<(&mut Deposits, &FieldWindow)>) {
    for (mut deposits, window) in &mut waters {
        deposits.silhouettes.clear();
        if window.size == UVec2::ZERO {
            deposits.strokes.clear();
        }
    }
}

fn clock_runs(time: Res<Time>) -> bool {
    !time.delta().is_zero()
}
