//! `freshet-flood convert`: from the steps of a model to a folder of maps.

use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::time::Duration;

use anyhow::{Context, Result};
use clap::Args;
use freshet_flood::arrival::ArrivalOptions;
use freshet_flood::conversion::{Amount, Crop, Options, Part, Progress, Summary, convert};
use freshet_flood::duration::clock;
use freshet_flood::raster::Raster;
use freshet_flood::steps::Steps;
use freshet_flood::terrain::Resampling;
use glam::DVec2;
use indicatif::{ProgressBar, ProgressStyle};

use crate::source::StepArguments;

const EXAMPLES: &str = "\
Examples:
  freshet-flood convert --terrain terrain.asc --steps flood.inc --out flood
  freshet-flood convert --terrain terrain.asc --steps steps/ --interval 30min --out flood
  freshet-flood convert --steps steps/ --times times.csv --only arrival,flow --radius 7 --out flood
  freshet-flood convert --steps steps/ --interval 30min --crop 105000,530000,109430,536930 --precision 0.01 --out flood

The folder appears when all of it is done. A flood that was in its place is replaced; anything else stays.";

/// Converts a flood into pictures of 16 bits and a manifest: terrain and normals, arrival of the water, depth and velocity at
/// every step, current, greatest depth and speed, duration and hazard.
#[derive(Args)]
#[command(after_help = EXAMPLES)]
pub struct Arguments {
    /// Elevations under the flood, which must cover all of its steps: an ESRI ASCII grid or a GeoTIFF, in metres.
    #[arg(long, value_name = "FILE")]
    terrain: Option<PathBuf>,
    /// A folder of rasters, one for each step and quantity, or an incremental file.
    #[arg(long, value_name = "DIR|FILE")]
    steps: PathBuf,
    /// The folder to write.
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
    #[command(flatten)]
    source: StepArguments,
    /// Convert only these, separated by commas: terrain, arrival, depth, velocity, flow, maxima.
    #[arg(long, value_delimiter = ',', value_parser = part)]
    only: Vec<Part>,
    /// Three standard deviations of the Gaussian that smooths the arrival, in cells, up to 100.
    #[arg(long, default_value_t = ArrivalOptions::default().radius)]
    radius: u32,
    /// Depth in metres from which on a cell is wet.
    #[arg(long, default_value_t = ArrivalOptions::default().threshold)]
    threshold: f32,
    /// Cells to convert: wet, for the least rectangle with all water, none, or WEST,SOUTH,EAST,NORTH on the map.
    #[arg(long, default_value = "wet", value_parser = crop, allow_hyphen_values = true)]
    crop: Crop,
    /// Depths err by at most half of this, in metres.
    #[arg(long, default_value_t = Options::default().precision, allow_hyphen_values = true)]
    precision: f64,
    /// Threads to compute with; as many as there are cores if 0.
    #[arg(long, default_value_t = 0)]
    threads: usize,
    /// Print nothing but errors.
    #[arg(long, short)]
    quiet: bool,
}

fn part(text: &str) -> Result<Part, String> {
    let part = Part::ALL.into_iter().find(|part| part.name().eq_ignore_ascii_case(text.trim()));
    part.ok_or_else(|| format!("expected {}", Part::ALL.map(Part::name).join(", ")))
}

fn crop(text: &str) -> Result<Crop, String> {
    let sides: Vec<f64> = text.split(',').filter_map(|side| side.trim().parse().ok()).collect();
    match (text, sides.as_slice()) {
        ("wet", _) => Ok(Crop::Wet),
        ("none", _) => Ok(Crop::All),
        (_, [west, south, east, north]) if text.split(',').count() == 4 && west < east && south < north => {
            Ok(Crop::Rectangle(DVec2::new(*west, *south), DVec2::new(*east, *north)))
        }
        _ => Err("expected wet, none or WEST,SOUTH,EAST,NORTH with west < east and south < north".into()),
    }
}

/// Converts the flood. Returns a summary.
pub fn run(arguments: &Arguments) -> Result<String> {
    let steps = arguments.source.open(&arguments.steps)?;
    let terrain = arguments.terrain.as_deref().map(|path| Raster::read(path).map(|raster| (name(path), raster)));
    let terrain = terrain.transpose()?;
    let options = Options {
        parts: if arguments.only.is_empty() { Part::ALL.to_vec() } else { arguments.only.clone() },
        arrival: ArrivalOptions { radius: arguments.radius, threshold: arguments.threshold, ..Default::default() },
        crop: arguments.crop,
        precision: arguments.precision,
    };
    let bar = progress_bar(&steps, arguments.quiet)?;
    let threads = rayon::ThreadPoolBuilder::new().num_threads(arguments.threads).build();
    let summary = threads.context("the threads cannot be started")?.install(|| {
        let terrain = terrain.as_ref().map(|(name, raster)| (name.as_str(), raster));
        convert(&steps, terrain, &options, &arguments.out, |progress| show(&bar, progress))
    });
    bar.finish_and_clear();
    let summary = summary?;
    if arguments.quiet {
        return Ok(String::new());
    }
    Ok(describe(&summary, &steps, &arguments.out)?)
}

fn name(path: &Path) -> String {
    path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default()
}

/// The bar while the number of steps is known.
const TIME_LEFT: &str = "{msg:10} {wide_bar} {pos}/{len}, {eta} left";
/// The bar while it is not.
const TIME_PASSED: &str = "{msg:10} {spinner} {pos} steps, {elapsed}";

/// A bar with the time left; it hides by itself where there is no terminal.
fn progress_bar(steps: &Steps, is_quiet: bool) -> Result<ProgressBar> {
    if is_quiet {
        return Ok(ProgressBar::hidden());
    }
    // Each step is read twice.
    let count = steps.count().map(|count| 2 * count as u64);
    let bar = count.map_or_else(ProgressBar::new_spinner, ProgressBar::new);
    bar.set_style(ProgressStyle::with_template(if count.is_some() { TIME_LEFT } else { TIME_PASSED })?);
    bar.enable_steady_tick(Duration::from_millis(200));
    Ok(bar)
}

fn show(bar: &ProgressBar, progress: Progress) {
    match progress {
        Progress::Read(step) => {
            bar.set_message("reading");
            bar.set_position(step as u64);
        }
        Progress::Maps(count) => {
            bar.set_message("maps");
            // Now an incremental file has told how many steps there are.
            if let Ok(style) = ProgressStyle::with_template(TIME_LEFT) {
                bar.set_style(style);
            }
            bar.set_length(2 * count as u64);
            bar.set_position(count as u64);
        }
        Progress::Written(_) => {
            bar.set_message("writing");
            bar.inc(1);
        }
    }
}

fn describe(summary: &Summary, steps: &Steps, out: &Path) -> Result<String, std::fmt::Error> {
    let mut text = String::new();
    let all = steps.georeference().size;
    let (origin, size) = (summary.window.origin, summary.window.size);
    let (first, last) = (summary.steps.first(), summary.steps.last());
    writeln!(text, "model    {} × {} cells of {} m", all.x, all.y, steps.georeference().cell_size)?;
    writeln!(text, "maps     {} × {} cells from column {}, row {}", size.x, size.y, origin.x, origin.y)?;
    for file in steps.left_out() {
        writeln!(text, "left out {}", file.display())?;
    }
    if let Some(Resampling::Bilinear) = summary.terrain {
        writeln!(text, "terrain  has other cells: resampled bilinearly")?;
    }
    let most = summary.steps.iter().copied().reduce(|most, step| if step.volume > most.volume { step } else { most });
    if let (Some(first), Some(last), Some(most)) = (first, last, most) {
        let count = summary.steps.len();
        writeln!(text, "steps    {count} from {} to {}", clock(first.time), clock(last.time))?;
        let volume = |of: Amount| format!("{:.0} m³ at {}", of.volume, clock(of.time));
        writeln!(text, "volume   {}, {}, at most {}", volume(*first), volume(*last), volume(most))?;
        let widest = summary.steps.iter().fold(0.0, |widest: f64, step| widest.max(step.area));
        writeln!(text, "wet      {} cells, {:.0} m² in the end, at most {widest:.0} m²", summary.wet_cells, last.area)?;
        let arrival = first.time + f64::from(summary.last_arrival);
        writeln!(text, "front    last new cell at {}", clock(arrival))?;
    }
    writeln!(text, "written  {} with {:.1} MB", out.display(), summary.bytes as f64 / 1e6)?;
    Ok(text)
}
