//! Draws pictures and films without a window. Each frame has the water of its time in the data, however long it takes to draw; its foam is what
//! the frames before have left.
use super::{Clip, Output};
use crate::{
    cameras::CameraPath,
    common::{self, Options},
};
use bevy::{prelude::*, time::TimeUpdateStrategy};
use bevy_freshet::{flood::Flood, panel::OrbitCamera};
use freshet_flood::duration::clock;
use std::{
    io::Write,
    time::{Duration, Instant},
};

/// What is drawn.
#[derive(Clone, Debug)]
pub struct Plan {
    pub output: Output,
    /// Times in the data of the first and the last frame, s.
    pub from: f64,
    pub to: f64,
    /// Seconds of the data in a second of the film.
    pub speed: f64,
    /// Frames in a second of the film.
    pub fps: u32,
    /// Frames that are drawn before the first, so that foam is there.
    pub lead: u32,
}

impl Plan {
    /// How many frames there are.
    pub fn frames(&self) -> usize {
        match self.output {
            Output::Picture(_) => 1,
            _ => ((self.to - self.from) / self.step() + 1e-9).floor().max(0.0) as usize + 1,
        }
    }

    /// From one frame to the next, s in the data.
    fn step(&self) -> f64 {
        self.speed / f64::from(self.fps)
    }

    /// Times of the frames, s in the data.
    fn times(&self) -> Vec<f64> {
        if matches!(self.output, Output::Picture(_)) {
            return vec![self.to];
        }
        (0..self.frames()).map(|frame| self.from + frame as f64 * self.step()).collect()
    }
}

/// Draws all frames.
pub fn run(mut app: App, plan: &Plan) -> AppExit {
    let drawn = draw(&mut app, plan);
    if let Err(problem) = drawn {
        eprintln!("error: {problem}");
        return AppExit::error();
    }
    AppExit::Success
}

fn draw(app: &mut App, plan: &Plan) -> Result<(), String> {
    let times = plan.times();
    let size = app.world().resource::<Options>().size;
    // First of all, so that a name that cannot be written is told at once.
    let mut sink = plan.output.open(Clip { size, fps: plan.fps, frames: times.len() })?;
    common::start(app);
    for before in (1..=plan.lead).rev() {
        show(app, plan, times[0] - f64::from(before) * plan.step());
    }
    let (start, mut written) = (Instant::now(), Duration::ZERO);
    for (number, time) in times.iter().enumerate() {
        show(app, plan, *time);
        let picture = common::screenshot(app)?;
        let begun = Instant::now();
        sink.add(&picture)?;
        written += begun.elapsed();
        if app.should_exit().is_some() {
            return Err(format!("stopped after {} of {} frames", number + 1, times.len()));
        }
        if times.len() > 1 {
            tell(number + 1, times.len(), start);
        }
    }
    let begun = Instant::now();
    sink.finish()?;
    written += begun.elapsed();
    if times.len() > 1 {
        let [seconds, share] = [start.elapsed(), written].map(|time| time.as_secs_f64());
        println!(
            "\nfinished after {}; {:.0} ms for a frame to be written",
            clock(seconds),
            1e3 * share / times.len() as f64
        );
    }
    Ok(())
}

/// Says how many frames are done, and how long the others will take.
fn tell(done: usize, all: usize, start: Instant) {
    let left = start.elapsed().as_secs_f64() / done as f64 * (all - done) as f64;
    print!("\r{done} of {all} frames, {} left ", clock(left));
    _ = std::io::stdout().flush();
}

/// Draws the frame at a time of the data.
pub fn show(app: &mut App, plan: &Plan, time: f64) {
    // For a screenshot the clock stands still.
    let frame = Duration::from_secs_f64(1.0 / f64::from(plan.fps));
    app.insert_resource(TimeUpdateStrategy::ManualDuration(frame));
    let world = app.world_mut();
    if let Some(led) = world.get_resource::<CameraPath>().map(|path| path.at(time)) {
        let mut cameras = world.query::<(&mut Transform, &mut OrbitCamera)>();
        for (mut pose, mut orbit) in cameras.iter_mut(world) {
            orbit.enabled = false;
            *pose = led;
        }
    }
    for mut flood in world.query::<&mut Flood>().iter_mut(world) {
        flood.time = time;
    }
    app.update();
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plan(output: Output) -> Plan {
        Plan { output, from: 600.0, to: 700.0, speed: 60.0, fps: 30, lead: 0 }
    }

    #[test]
    fn a_film_goes_from_its_first_time_to_its_last() {
        let times = plan(Output::Mp4("film.mp4".into())).times();
        assert_eq!((times.len(), times[0], times[50]), (51, 600.0, 700.0));
        let times = Plan { fps: 7, speed: 3.0, ..plan(Output::Gif("film.gif".into())) }.times();
        assert!(times.len() == 234 && times[233] <= 700.0, "{}", times.len());
    }

    #[test]
    fn a_picture_is_that_of_its_time() {
        assert_eq!(plan(Output::Picture("flood.png".into())).times(), [700.0]);
    }
}
