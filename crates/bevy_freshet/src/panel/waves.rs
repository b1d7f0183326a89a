//! The waves: raised by a wind, or train by train.
use super::WaterPanel;
use crate::body::{WaterWaves, Wave};
use bevy::prelude::*;
use bevy_egui::egui::{self, Slider, Ui};

/// Beside a water: the wind that its waves were last set to.
#[derive(Component, Clone, Copy, Debug, PartialEq)]
struct Wind {
    /// m/s
    speed: f32,
    /// m
    fetch: f32,
    /// Bearing towards which it blows, degrees from local +x towards +z.
    direction: f32,
    /// Factor on the height.
    height: f32,
}

impl Default for Wind {
    /// As [`WaterWaves::default`] has it.
    fn default() -> Self {
        Self { speed: 3.0, fetch: 200.0, direction: 19.3, height: 1.0 }
    }
}

impl Wind {
    fn waves(self) -> WaterWaves {
        let direction = Vec2::from_angle(self.direction.to_radians());
        WaterWaves::wind(self.speed, self.fetch, direction).scaled(self.height)
    }
}

/// Draws the section, and writes what is changed.
pub(super) fn draw(ui: &mut Ui, world: &mut World, panel: &mut WaterPanel, water: Entity) {
    let Ok(mut water) = world.get_entity_mut(water) else { return };
    let Some(before) = water.get::<WaterWaves>().cloned() else { return };
    let mut waves = before.clone();
    egui::CollapsingHeader::new("Waves").show(ui, |ui| {
        let known = water.get::<Wind>().copied().unwrap_or_default();
        let mut wind = known;
        draw_wind(ui, panel, &mut wind);
        if wind != known {
            waves.trains = wind.waves().trains;
            water.insert(wind);
        }
        draw_trains(ui, &mut waves.trains);
        if ui.small_button("Defaults").on_hover_text("Sets the waves to their defaults.").clicked() {
            waves.trains = WaterWaves::default().trains;
            water.insert(Wind::default());
        }
    });
    if waves != before {
        water.insert(waves);
    }
}

fn draw_wind(ui: &mut Ui, panel: &mut WaterPanel, wind: &mut Wind) {
    let speed = ui
        .add(Slider::new(&mut wind.speed, 0.0..=30.0).suffix(" m/s").text("Wind"))
        .on_hover_text("Raises new waves as a steady wind does.\n0…30 m/s, 10 m above the water");
    panel.note(ui, "Wind", &speed);
    ui.add(Slider::new(&mut wind.fetch, 1.0..=100_000.0).logarithmic(true).suffix(" m").text("Fetch"))
        .on_hover_text("Way over which the wind has blown.\n1…100 000 m");
    ui.add(Slider::new(&mut wind.direction, -180.0..=180.0).suffix("°").text("Direction"))
        .on_hover_text("Towards which it blows: 0 is +x, 90 is +z.\n−180…180°");
    ui.add(Slider::new(&mut wind.height, 0.0..=2.0).text("Height"))
        .on_hover_text("Factor on the waves' height; below 1 the wind has dropped.\n0…2");
}

fn draw_trains(ui: &mut Ui, trains: &mut Vec<Wave>) {
    let mut removed = None;
    for (i, train) in trains.iter_mut().enumerate() {
        let title = format!("Train {}: {:.2} m", i + 1, train.wavelength);
        egui::CollapsingHeader::new(title).id_salt(i).show(ui, |ui| {
            ui.add(Slider::new(&mut train.wavelength, 0.05..=200.0).logarithmic(true).suffix(" m").text("Wavelength"))
                .on_hover_text("Between crests.\n0.05…200 m");
            ui.add(Slider::new(&mut train.steepness, 0.0..=1.0).text("Steepness"))
                .on_hover_text("Wavenumber × amplitude; all trains together below 1.\n0…1");
            let mut degrees = train.direction.to_angle().to_degrees();
            let slider = Slider::new(&mut degrees, -180.0..=180.0).suffix("°").text("Direction");
            if ui.add(slider).on_hover_text("Of travel: 0 is +x, 90 is +z.\n−180…180°").changed() {
                train.direction = Vec2::from_angle(degrees.to_radians());
            }
            ui.add(Slider::new(&mut train.phase, 0.0..=core::f32::consts::TAU).suffix(" rad").text("Phase"))
                .on_hover_text("At the middle of the water at time zero.\n0…2π rad");
            if ui.small_button("Remove").clicked() {
                removed = Some(i);
            }
        });
    }
    if let Some(i) = removed {
        trains.remove(i);
    }
    if trains.len() < WaterWaves::MAX && ui.small_button("Add a train").clicked() {
        trains.push(Wave { direction: Vec2::X, wavelength: 2.0, steepness: 0.05, phase: 0.0 });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_wind_is_that_of_the_default_waves() {
        let (wind, default) = (Wind::default().waves(), WaterWaves::default());
        for (wind, default) in wind.trains.iter().zip(&default.trains) {
            assert!((wind.wavelength - default.wavelength).abs() < 1e-6, "{wind:?}");
            assert!((wind.steepness - default.steepness).abs() < 1e-6, "{wind:?}");
            assert!(wind.direction.distance(default.direction) < 1e-3, "{wind:?}");
        }
    }
}
