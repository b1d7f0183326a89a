//! Pictures and films without a window. Each frame is that of its time in the data, so that it is the same whenever it is drawn.
use crate::{cameras::CameraPath, common};
use bevy::{prelude::*, time::TimeUpdateStrategy};
use bevy_freshet::{flood::Flood, panel::OrbitCamera};
use freshet_flood::duration::clock;
use image::RgbImage;
use std::{
    fs::File,
    io::{BufWriter, Write},
    path::{Path, PathBuf},
    time::{Duration, Instant},
};

/// Where frames go.
#[derive(Clone, Debug)]
pub enum Output {
    /// One picture.
    Picture(PathBuf),
    /// A picture for each frame; `%05d` in the name stands for its number, from 0.
    Pictures(String),
    /// An animated picture.
    Gif(PathBuf),
}

/// What is drawn.
#[derive(Resource, Clone, Debug)]
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

/// The output that a name asks for.
///
/// # Errors
/// What the name must be.
pub fn film(text: &str) -> Result<Output, String> {
    let path = PathBuf::from(text);
    let ends_in = |wanted: &str| path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case(wanted));
    if ends_in("gif") {
        return Ok(Output::Gif(path));
    }
    if ends_in("png") && numbered(text, 0).is_some() {
        return Ok(Output::Pictures(text.into()));
    }
    Err("expected a name like film/%05d.png, or one that ends in .gif".into())
}

/// The name of a frame.
fn numbered(pattern: &str, frame: usize) -> Option<String> {
    let (before, rest) = pattern.split_once('%')?;
    let (digits, after) = rest.split_once('d')?;
    let width = if digits.is_empty() { 0 } else { digits.parse::<usize>().ok().filter(|width| *width < 20)? };
    Some(format!("{before}{frame:0width$}{after}"))
}

impl Plan {
    /// Times of the frames, s in the data.
    fn times(&self) -> Vec<f64> {
        if matches!(self.output, Output::Picture(_)) {
            return vec![self.to];
        }
        let step = self.speed / f64::from(self.fps);
        let count = ((self.to - self.from) / step + 1e-9).floor().max(0.0) as usize + 1;
        (0..count).map(|frame| self.from + frame as f64 * step).collect()
    }
}

/// Draws all frames.
pub fn run(mut app: App, plan: &Plan) -> AppExit {
    common::start(&mut app);
    let frame = Duration::from_secs_f64(1.0 / f64::from(plan.fps));
    app.insert_resource(TimeUpdateStrategy::ManualDuration(frame));
    let times = plan.times();
    let step = plan.speed / f64::from(plan.fps);
    for before in (1..=plan.lead).rev() {
        show(&mut app, times[0] - f64::from(before) * step);
    }
    match draw(&mut app, plan, &times) {
        Ok(()) => AppExit::Success,
        Err(problem) => {
            error!("{problem}");
            AppExit::error()
        }
    }
}

/// Draws the frame at a time of the data.
fn show(app: &mut App, time: f64) {
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

fn draw(app: &mut App, plan: &Plan, times: &[f64]) -> Result<(), String> {
    make_folder(&plan.output)?;
    let mut animation = match &plan.output {
        Output::Gif(path) => Some(Animation::new(path, plan.fps)),
        _ => None,
    };
    let start = Instant::now();
    for (number, time) in times.iter().enumerate() {
        show(app, *time);
        let picture = common::screenshot(app)?;
        match (&plan.output, &mut animation) {
            (Output::Picture(path), _) => save(&picture, path)?,
            (Output::Pictures(pattern), _) => {
                let name = numbered(pattern, number).ok_or("there is no place for the number")?;
                save(&picture, Path::new(&name))?;
            }
            (_, Some(animation)) => animation.add(&picture)?,
            _ => {}
        }
        if times.len() > 1 {
            let left = start.elapsed().as_secs_f64() / (number + 1) as f64 * (times.len() - number - 1) as f64;
            print!("\r{} of {} frames, {} left ", number + 1, times.len(), clock(left));
            _ = std::io::stdout().flush();
        }
    }
    if times.len() > 1 {
        println!();
    }
    animation.map_or(Ok(()), Animation::finish)
}

/// Makes the folder of a film, if it is not there.
fn make_folder(output: &Output) -> Result<(), String> {
    let path = match output {
        Output::Picture(_) => return Ok(()),
        Output::Pictures(pattern) => Path::new(pattern),
        Output::Gif(path) => path,
    };
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(".".as_ref());
    std::fs::create_dir_all(folder).map_err(|error| format!("{}: {error}", folder.display()))
}

fn save(picture: &RgbImage, path: &Path) -> Result<(), String> {
    picture.save(path).map_err(|problem| format!("{}: {problem}", path.display()))
}

/// A GIF that is written frame by frame.
struct Animation {
    path: PathBuf,
    fps: u32,
    encoder: Option<gif::Encoder<BufWriter<File>>>,
    frames: u32,
}

impl Animation {
    fn new(path: &Path, fps: u32) -> Self {
        Self { path: path.into(), fps, encoder: None, frames: 0 }
    }

    fn add(&mut self, picture: &RgbImage) -> Result<(), String> {
        let (width, height) = (picture.width() as u16, picture.height() as u16);
        let named = |problem: &dyn core::fmt::Display| format!("{}: {problem}", self.path.display());
        let mut encoder = match self.encoder.take() {
            Some(encoder) => encoder,
            None => {
                let file = File::create(&self.path).map_err(|problem| named(&problem))?;
                let mut encoder =
                    gif::Encoder::new(BufWriter::new(file), width, height, &[]).map_err(|it| named(&it))?;
                encoder.set_repeat(gif::Repeat::Infinite).map_err(|problem| named(&problem))?;
                encoder
            }
        };
        let mut frame = gif::Frame::from_rgb_speed(width, height, picture, 10);
        // Hundredths of a second, so that their sum is right.
        let ends = [self.frames, self.frames + 1].map(|frame| frame * 100 / self.fps);
        frame.delay = (ends[1] - ends[0]) as u16;
        encoder.write_frame(&frame).map_err(|problem| named(&problem))?;
        self.encoder = Some(encoder);
        self.frames += 1;
        Ok(())
    }

    fn finish(self) -> Result<(), String> {
        let Some(encoder) = self.encoder else { return Ok(()) };
        let named = |problem: &dyn core::fmt::Display| format!("{}: {problem}", self.path.display());
        let mut file = encoder.into_inner().map_err(|problem| named(&problem))?;
        file.flush().map_err(|problem| named(&problem))
    }
}
