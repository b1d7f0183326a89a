//! The current of a flood, one velocity for each cell, from its arrival map and from the speeds that the model wrote.

use freshet_hydro::grid::Grid;
use glam::{UVec2, Vec2, uvec2};
use rayon::prelude::*;

use crate::arrival::ArrivalMap;
use crate::step::{Quantity, Step};

/// Acceleration of gravity, m/s².
const GRAVITY: f32 = 9.81;

/// Where the front of a flood went and how fast: velocity (east, south) in m/s, still where it never came or came
/// everywhere at once. `depth` is the greatest depth, m.
///
/// The direction is J11's: the sum of the differences of arrival to the up to eight neighbours, each along the way to it.
/// With differences Δaᵢ over the ways rᵢ (m) the slope of the arrival is the one that fits them best, each weighed by
/// 1 / |rᵢ|², and the front runs at its inverse:
/// ```text
/// M ∇a = Σ Δaᵢ rᵢ / |rᵢ|²,   M = Σ rᵢ rᵢᵀ / |rᵢ|²,   u = ∇a / |∇a|²
/// ```
/// A front over dry land is at most twice as fast as a long wave, 2 √(g d) (Ritter 1892): what is faster is a plain that the
/// model wetted between two steps, and gets that speed.
pub fn front_velocity(arrival: &ArrivalMap, depth: &Grid<f32>) -> Grid<Vec2> {
    let times = &arrival.after;
    let columns = times.size().x as usize;
    let velocity = |place: usize| {
        let cell = uvec2((place % columns) as u32, (place / columns) as u32);
        let slope = slope(times, cell);
        let fastest = 2.0 * (GRAVITY * depth.values().get(place).copied().unwrap_or_default().max(0.0)).sqrt();
        let speed = slope.length().recip().min(fastest);
        slope.normalize_or_zero() * if speed.is_finite() { speed } else { 0.0 }
    };
    let velocities: Vec<Vec2> = (0..times.values().len()).into_par_iter().map(velocity).collect();
    let mut velocities = velocities.into_iter();
    times.map(|_| velocities.next().unwrap_or_default())
}

/// Slope of the arrival at a cell, s/m; zero where it has none.
fn slope(times: &Grid<f32>, cell: UVec2) -> Vec2 {
    let Some(here) = times.get(cell).copied().filter(|time| !time.is_nan()) else { return Vec2::ZERO };
    let (mut xx, mut xy, mut yy, mut sum) = (0.0, 0.0, 0.0, Vec2::ZERO);
    for row in cell.y.saturating_sub(1)..=cell.y + 1 {
        for column in cell.x.saturating_sub(1)..=cell.x + 1 {
            let other = uvec2(column, row);
            let Some(time) = times.get(other).filter(|time| other != cell && !time.is_nan()) else { continue };
            let way = other.as_vec2() - cell.as_vec2();
            let weight = 1.0 / way.length_squared();
            xx += weight * way.x * way.x;
            xy += weight * way.x * way.y;
            yy += weight * way.y * way.y;
            sum += weight * (time - here) * way;
        }
    }
    let determinant = xx * yy - xy * xy;
    let slope = if determinant > 1e-6 {
        Vec2::new(yy * sum.x - xy * sum.y, xx * sum.y - xy * sum.x) / determinant
    } else {
        // A channel of one cell: the slope along it.
        sum / (xx + yy).max(f32::MIN_POSITIVE)
    };
    slope / times.cell_size()
}

/// Gathers the mean current of a flood from steps that come one at a time, all of one shape.
#[derive(Clone, Debug, Default)]
pub struct CurrentBuilder {
    threshold: f32,
    velocity: Vec<Vec2>,
    speed: Vec<f32>,
    steps: Vec<u32>,
}

impl CurrentBuilder {
    /// Counts cells as wet whose depth is above `threshold`, m.
    pub fn new(threshold: f32) -> Self {
        Self { threshold, ..Self::default() }
    }

    /// Takes the next step. One without depths, or without velocities and speeds, tells nothing.
    pub fn add(&mut self, step: &Step) {
        let Some(depth) = step.get(Quantity::Depth) else { return };
        let count = depth.values().len();
        let is_wet = |place: usize| depth.values()[place] >= self.threshold;
        if let Some(velocity) = step.velocity().filter(|velocity| velocity.size() == depth.size()) {
            self.velocity.resize(count, Vec2::ZERO);
            for (place, velocity) in velocity.values().iter().enumerate().filter(|(_, velocity)| velocity.is_finite()) {
                self.velocity[place] += if is_wet(place) { *velocity } else { Vec2::ZERO };
            }
        } else if let Some(speed) = step.get(Quantity::Speed).filter(|speed| speed.size() == depth.size()) {
            self.speed.resize(count, 0.0);
            for (place, speed) in speed.values().iter().enumerate().filter(|(_, speed)| speed.is_finite()) {
                self.speed[place] += if is_wet(place) { *speed } else { 0.0 };
            }
        } else {
            return;
        }
        self.steps.resize(count, 0);
        for (place, steps) in self.steps.iter_mut().enumerate() {
            *steps += u32::from(is_wet(place));
        }
    }

    /// The current (east, south) in m/s, still where it is never wet: the mean of the velocities that the model wrote for
    /// wet cells, or else the mean of its speeds along the way of the front, or else that of the front itself.
    pub fn finish(self, arrival: &ArrivalMap, depth: &Grid<f32>) -> Grid<Vec2> {
        let mut current = front_velocity(arrival, depth);
        let count = current.values().len();
        let mean = |place: usize| 1.0 / self.steps[place].max(1) as f32;
        if self.velocity.len() == count {
            for (place, current) in current.values_mut().iter_mut().enumerate() {
                *current = self.velocity[place] * mean(place);
            }
        } else if self.speed.len() == count {
            for (place, current) in current.values_mut().iter_mut().enumerate() {
                *current = current.normalize_or_zero() * self.speed[place] * mean(place);
            }
        }
        current
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;
    use glam::vec2;

    fn plane_wave(velocity: Vec2) -> ArrivalMap {
        let times = Grid::from_fn(uvec2(9, 9), 4.0, |cell| {
            100.0 + (cell.as_vec2() * 4.0).dot(velocity) / velocity.length_squared()
        });
        ArrivalMap { start: 0.0, after: times.unwrap() }
    }

    #[test]
    fn an_even_front_has_its_velocity_everywhere_also_on_the_rim() {
        for expected in [vec2(2.0, 0.0), vec2(0.0, -0.5), vec2(0.6, 0.8)] {
            let arrival = plane_wave(expected);
            for velocity in front_velocity(&arrival, &arrival.after.map(|_| 10.0)).values() {
                assert_relative_eq!(*velocity, expected, epsilon = 1e-3);
            }
        }
    }

    #[test]
    fn a_front_is_no_faster_than_water_of_its_depth() {
        let arrival = plane_wave(vec2(300.0, 0.0));
        let velocity = front_velocity(&arrival, &arrival.after.map(|_| 1.0));
        assert_relative_eq!(velocity.values()[40].x, 6.264, epsilon = 1e-3);
        let lake = ArrivalMap { start: 0.0, after: arrival.after.map(|_| 0.0) };
        assert!(front_velocity(&lake, &arrival.after).values().iter().all(|velocity| *velocity == Vec2::ZERO));
    }

    #[test]
    fn speeds_go_the_way_of_the_front_and_velocities_their_own() {
        let arrival = plane_wave(vec2(2.0, 0.0));
        let depth = arrival.after.map(|_| 1.0);
        let step = Step::new(0.0).with(Quantity::Depth, depth.clone());
        let mean = |step: Step| {
            let mut current = CurrentBuilder::new(0.02);
            current.add(&step);
            current.finish(&arrival, &depth).values()[40]
        };
        assert_relative_eq!(mean(step.clone()), vec2(2.0, 0.0), epsilon = 1e-3);
        let with_speed = step.with(Quantity::Speed, depth.map(|_| 0.7));
        assert_relative_eq!(mean(with_speed.clone()), vec2(0.7, 0.0), epsilon = 1e-3);
        let with_velocity =
            with_speed.with(Quantity::East, depth.map(|_| 0.1)).with(Quantity::North, depth.map(|_| 0.3));
        assert_relative_eq!(mean(with_velocity), vec2(0.1, -0.3), epsilon = 1e-3);
    }
}
