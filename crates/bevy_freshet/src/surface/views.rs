//! How the inspecting views are called and read.
use super::SurfaceView;

impl SurfaceView {
    /// Every view, the water itself first.
    pub const ALL: [Self; 18] = [
        Self::Water,
        Self::Reflection,
        Self::Refraction,
        Self::Fresnel,
        Self::Normal,
        Self::Height,
        Self::Edge,
        Self::Flow,
        Self::Depth,
        Self::Wireframe,
        Self::Foam,
        Self::Interaction,
        Self::Dye,
        Self::Ice,
        Self::Level,
        Self::Speed,
        Self::Froude,
        Self::Age,
    ];

    /// What it is called.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Water => "water",
            Self::Reflection => "reflection",
            Self::Refraction => "refraction",
            Self::Fresnel => "Fresnel",
            Self::Normal => "normals",
            Self::Height => "height",
            Self::Edge => "edge mask",
            Self::Flow => "flow",
            Self::Depth => "depth",
            Self::Wireframe => "wireframe",
            Self::Foam => "foam",
            Self::Interaction => "interaction",
            Self::Dye => "dye",
            Self::Ice => "ice",
            Self::Level => "level",
            Self::Speed => "speed",
            Self::Froude => "Froude number",
            Self::Age => "age",
        }
    }

    /// How its colours are read.
    pub const fn legend(self) -> &'static str {
        match self {
            Self::Water => "The water as it is.",
            Self::Reflection => "Reflected light alone.",
            Self::Refraction => "Light from below alone.",
            Self::Fresnel => "Red: reflected share. Green: refracted share. Together always 1.",
            Self::Normal => "Red, green, blue: normal along x, y, z; half is 0. A level surface is light green.",
            Self::Height => "Red: height over the still surface, m, rounded to 1/64 m. Green: 64 times the rest.",
            Self::Edge => "White: opaque water. Black: the waterline.",
            Self::Flow => {
                "Hue: direction, red +x, yellow-green +z, cyan −x, violet −z. Brightness: speed, full at 2 m/s. \
                 Arrows point downstream."
            }
            Self::Depth => "Red 0 m, yellow 1 m, green 3 m, cyan 7 m, blue 15 m, black 31 m and more.",
            Self::Wireframe => "Green: edges of the mesh's triangles.",
            Self::Foam => "White: covered by foam. Black: none.",
            Self::Interaction => "Red: covered by bodies. Green: raised by rings, blue: lowered; full at 5 cm.",
            Self::Dye => "Light that a metre of the water lets through, by dye alone. White: no dye.",
            Self::Ice => "Red: thickness, full at 1 m. Green: drawn cover. Blue: snow on it.",
            Self::Level => "Level without waves, over the still level.",
            Self::Speed => "Speed of the current.",
            Self::Froude => "Speed of the current over that of long waves, u/√(gd): above 1 no wave runs upstream.",
            Self::Age => "Age of the simulated state that bodies and queries know.",
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use bevy::{
        platform::collections::HashSet,
        reflect::{TypeInfo, Typed},
    };

    #[test]
    fn every_view_is_listed_once_under_a_name_of_its_own() {
        let TypeInfo::Enum(info) = SurfaceView::type_info() else { panic!("the view is an enum") };
        assert_eq!(SurfaceView::ALL.len(), info.variant_len());
        let names: HashSet<_> = SurfaceView::ALL.map(SurfaceView::name).into_iter().collect();
        assert_eq!(names.len(), info.variant_len());
    }
}
