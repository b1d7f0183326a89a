//! `freshet-flood flow`: a river's steady flow as a flow map.

use std::fmt::Write;
use std::path::PathBuf;

use anyhow::{Context, Result};
use clap::Args;
use freshet_flood::esri_ascii::EsriGrid;
use freshet_flood::flow_map::FlowMap;
use freshet_hydro::flow::{FlowField, Reach, Section, discharge_across, steady_flow};
use glam::{DVec2, dvec2};

/// How many cross-sections the table shows.
const SECTIONS: usize = 10;

/// A section is two points, X,Z:X,Z in metres from the centre of the terrain, x to the east and z to the south.
/// It must cross the whole channel, or lie on the edge of the terrain where the channel ends.
#[derive(Args)]
pub struct Arguments {
    /// Bed elevations: an ESRI ASCII grid in metres.
    terrain: PathBuf,
    /// Water level in metres above the terrain's datum.
    #[arg(long, allow_hyphen_values = true)]
    level: f32,
    /// Where water enters: X,Z:X,Z.
    #[arg(long, allow_hyphen_values = true, value_parser = points)]
    inflow: [DVec2; 2],
    /// Where water leaves: X,Z:X,Z.
    #[arg(long, allow_hyphen_values = true, value_parser = points)]
    outflow: [DVec2; 2],
    /// Water through every cross-section in m³/s.
    #[arg(long, allow_hyphen_values = true)]
    discharge: f32,
    /// Manning roughness of the bed in s/m^⅓.
    #[arg(long, allow_hyphen_values = true, default_value_t = Reach::NATURAL_CHANNEL)]
    manning: f32,
    /// Sections are given as EASTING,NORTHING:EASTING,NORTHING in the map coordinates of the terrain instead.
    #[arg(long)]
    map_coordinates: bool,
    /// The flow map to write: a PNG file.
    #[arg(long)]
    output: PathBuf,
}

/// Computes and writes the flow map. Returns a table of what was found.
pub fn run(arguments: &Arguments) -> Result<String> {
    let terrain = EsriGrid::read(&arguments.terrain)?;
    let section = |points: [DVec2; 2]| {
        let [from, to] = points.map(|point| match arguments.map_coordinates {
            true => terrain.local_from_map(point),
            false => point.as_vec2(),
        });
        Section::new(from, to)
    };
    let reach = Reach {
        inflow: section(arguments.inflow),
        outflow: section(arguments.outflow),
        discharge: arguments.discharge,
        manning: arguments.manning,
    };
    let flow = steady_flow(&terrain.grid, arguments.level, &reach)
        .with_context(|| format!("no flow over {}", arguments.terrain.display()))?;
    let map = FlowMap::new(flow.velocity().clone(), Some(arguments.level));
    map.write(&arguments.output)?;
    Ok(table(&terrain, arguments.level, &flow)?)
}

/// What to look at before believing the flow.
fn table(terrain: &EsriGrid, level: f32, flow: &FlowField) -> Result<String, std::fmt::Error> {
    let mut table = String::new();
    let bed = &terrain.grid;
    let (size, extent) = (bed.size(), bed.extent());
    writeln!(table, "terrain     {} × {} cells, {} × {} m", size.x, size.y, extent.x, extent.y)?;
    writeln!(table, "reach area  {:.0} m²", flow.area())?;
    writeln!(table, "head drop   {:.3} m", flow.head_drop())?;
    writeln!(table, "mean speed  {:.2} m/s", flow.mean_speed())?;
    writeln!(table, "max speed   {:.2} m/s", flow.max_speed())?;
    writeln!(table, "discharge in m³/s at sections along the river, through cell faces and as speed × depth seen:")?;
    writeln!(table, "{:>9} {:>9} {:>9} {:>9}", "x", "z", "faces", "seen")?;
    for section in flow.sections(SECTIONS) {
        let middle = section.from.midpoint(section.to);
        let seen = discharge_across(flow.velocity(), bed, level, &section);
        let faces = flow.discharge_through(&section);
        writeln!(table, "{:9.1} {:9.1} {faces:9.3} {seen:9.3}", middle.x, middle.y)?;
    }
    Ok(table)
}

/// Two points written as X,Z:X,Z.
fn points(text: &str) -> Result<[DVec2; 2], String> {
    let number = |text: &str| text.trim().parse().ok().filter(|number: &f64| number.is_finite());
    let point = |text: &str| {
        let (x, z) = text.split_once(',')?;
        Some(dvec2(number(x)?, number(z)?))
    };
    text.split_once(':')
        .and_then(|(from, to)| Some([point(from)?, point(to)?]))
        .ok_or_else(|| "expected two points X,Z:X,Z in metres, as in -20,5:20,5".into())
}
