//! The fields of a water that are simulated on the GPU: rings, foam and dye.
mod deposits;
mod window;

pub(crate) use deposits::{Deposits, SilhouetteCell, Stroke};
pub(crate) use window::FieldWindow;

use bevy::prelude::*;

/// The simulated fields of a water as pictures of its [`FieldWindow`], for the surface's shader.
#[derive(Component, Clone, Debug, Default)]
pub(crate) struct FieldPictures {
    /// Slope of the rings (xy, local), their height (z, m) and the share that bodies cover at the waterline (w).
    pub rings: Option<Handle<Image>>,
    /// Cover of foam (x) and the absorption of dye (yzw, 1/m).
    pub matter: Option<Handle<Image>>,
}
