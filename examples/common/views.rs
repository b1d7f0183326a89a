//! Where the river is seen from, and under which sky.
use bevy::prelude::*;

/// A camera, the light and the season.
#[derive(Clone, Copy, Debug)]
pub struct View {
    pub name: &'static str,
    /// x, height over the water, z; m.
    pub eye: Vec3,
    pub target: Vec3,
    /// Elevation and azimuth of the sun, degrees.
    pub sun: (f32, f32),
    /// How far the river is frozen, 0…1.
    pub freezing: f32,
}

const AFTERNOON: (f32, f32) = (32.0, 215.0);
const NOON: (f32, f32) = (61.0, 180.0);
const EVENING: (f32, f32) = (7.0, 246.0);
const NIGHT: (f32, f32) = (-40.0, 60.0);
const WINTER: (f32, f32) = (14.0, 205.0);

/// Elevation and azimuth of the full moon, while the sun is down; degrees.
pub const MOON: (f32, f32) = (19.0, 252.0);

const fn view(name: &'static str, eye: Vec3, target: Vec3, sun: (f32, f32)) -> View {
    View { name, eye, target, sun, freezing: 0.0 }
}

const BANK: View = view("bank", vec3(-62.0, 2.2, 262.0), vec3(-20.0, 0.3, 250.0), AFTERNOON);
const BEND: View = view("bend", vec3(-75.0, 7.5, 232.0), vec3(-30.0, -1.0, 262.0), AFTERNOON);

const VIEWS: [View; 13] = [
    BANK,
    BEND,
    view("drift", vec3(-40.0, 0.9, 262.0), vec3(-18.0, 0.2, 252.0), AFTERNOON),
    view("shallows", vec3(-66.0, 2.6, 240.0), vec3(-72.0, -0.8, 246.0), AFTERNOON),
    view("boat", vec3(-32.0, 2.4, 254.0), vec3(-23.0, 0.2, 252.0), AFTERNOON),
    view("above", vec3(-30.0, 70.0, 320.0), vec3(-20.0, 0.0, 245.0), AFTERNOON),
    view("sluice", vec3(-150.0, 14.0, 205.0), vec3(-105.0, 0.0, 150.0), AFTERNOON),
    view("bridge", vec3(-84.0, 1.5, 237.0), vec3(-92.5, 0.6, 224.0), AFTERNOON),
    View { sun: NOON, name: "noon", ..BEND },
    view("sunset", vec3(-8.0, 2.0, 244.0), vec3(-50.0, 1.5, 261.0), EVENING),
    view("night", vec3(-8.0, 2.0, 244.0), vec3(-50.0, 2.2, 261.0), NIGHT),
    View { name: "frost", sun: WINTER, freezing: 0.5, ..BEND },
    View { name: "ice", sun: WINTER, freezing: 1.0, ..BANK },
];

impl View {
    /// The view that is called `name`, the first one for `None`.
    ///
    /// # Errors
    /// The names there are, if there is no such view.
    pub fn named(name: Option<&str>) -> Result<Self, String> {
        let name = name.unwrap_or(VIEWS[0].name);
        VIEWS.into_iter().find(|view| view.name == name).ok_or_else(|| {
            let names: Vec<_> = VIEWS.iter().map(|view| view.name).collect();
            format!("there is no camera {name:?}; there are {}", names.join(", "))
        })
    }

    /// Whether the sun is down.
    pub fn is_night(&self) -> bool {
        self.sun.0 < 0.0
    }

    /// Pose of the camera over a water at world height `level`, m.
    pub fn pose(&self, level: f32) -> Transform {
        let up = Vec3::Y * level;
        Transform::from_translation(self.eye + up).looking_at(self.target + up, Vec3::Y)
    }
}
