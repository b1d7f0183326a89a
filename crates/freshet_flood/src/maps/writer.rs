//! Writing a flood: its folder appears whole or not at all.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use freshet_hydro::grid::Grid;
use glam::Vec3;
use ron::ser::PrettyConfig;
use tempfile::TempDir;

use super::manifest::{self, Entry, Manifest, Map, Picture};
use super::picture::{self, Scale};
use super::{MapsError, empty_of};
use crate::step::{Quantity, Step};

/// Writes a flood into a hidden folder beside its place, and moves it there when all is done.
///
/// Dropped before [`MapsWriter::finish`] it leaves nothing, and what was in its place before stays.
#[derive(Debug)]
pub struct MapsWriter {
    place: PathBuf,
    /// Removed when dropped. What is written lies in a folder within, so that it has the usual permissions.
    temporary: TempDir,
    folder: PathBuf,
    manifest: Manifest,
}

impl MapsWriter {
    /// A flood that will be at `place`: nowhere yet, an empty folder, or a flood that was written before.
    ///
    /// # Errors
    /// [`MapsError::InTheWay`] if something else is there, or [`MapsError::Io`] if the folder beside it cannot be made.
    pub fn new(place: impl Into<PathBuf>, manifest: Manifest) -> Result<Self, MapsError> {
        let place = place.into();
        check_place(&place)?;
        let parent = match place.parent() {
            Some(parent) if parent != Path::new("") => parent,
            _ => Path::new("."),
        };
        let temporary = tempfile::Builder::new().prefix(".freshet-flood-").tempdir_in(parent);
        let temporary = temporary.map_err(|source| MapsError::io(parent, source))?;
        let folder = temporary.path().join("flood");
        fs::create_dir(&folder).map_err(|source| MapsError::io(&folder, source))?;
        Ok(Self { place, temporary, folder, manifest })
    }

    /// Writes one value for each cell of the whole flood.
    ///
    /// # Errors
    /// [`MapsError`] if the picture cannot be written.
    pub fn add_map(&mut self, map: Map, grid: &Grid<f32>) -> Result<(), MapsError> {
        let file = format!("{}.png", map.name());
        let is_empty = |value: f32| map.empty() == value;
        let (scale, pixels) = match map {
            Map::MaximumDepth => self.depths(grid),
            _ => {
                let scale = Scale::of_range(grid.values(), is_empty);
                // No cell is shown as wet at a step at which it was still dry: arrivals are rounded up.
                let round = if map == Map::Arrival { f64::ceil } else { f64::round };
                (scale, scale.values(grid.values(), is_empty, round))
            }
        };
        picture::write(&self.folder.join(&file), grid.size(), &pixels).map_err(|error| self.placed(error))?;
        let Scale { scale, offset } = scale;
        self.manifest.maps.insert(map, Picture { file, scale, offset });
        Ok(())
    }

    /// Writes the current: the bytes of a picture as [`FlowMap::encode`](crate::flow_map::FlowMap::encode) gives them.
    ///
    /// # Errors
    /// [`MapsError`] if the picture cannot be written.
    pub fn add_flow(&mut self, bytes: &[u8]) -> Result<(), MapsError> {
        let file = "flow.png".to_owned();
        let path = self.folder.join(&file);
        fs::write(&path, bytes).map_err(|source| self.placed(MapsError::io(&path, source)))?;
        self.manifest.flow = Some(file);
        Ok(())
    }

    /// Writes the normals of the terrain (east, up, south).
    ///
    /// # Errors
    /// [`MapsError`] if the picture cannot be written.
    pub fn add_normals(&mut self, normals: &Grid<Vec3>) -> Result<(), MapsError> {
        let file = "normals.png".to_owned();
        picture::write_normals(&self.folder.join(&file), normals).map_err(|error| self.placed(error))?;
        self.manifest.normals = Some(file);
        Ok(())
    }

    /// Writes those `quantities` of the next step that it has.
    ///
    /// # Errors
    /// [`MapsError`] if a picture cannot be written.
    pub fn add_step(&mut self, step: &Step, quantities: &[Quantity]) -> Result<(), MapsError> {
        let mut pictures = BTreeMap::new();
        for quantity in quantities {
            let Some(grid) = step.get(*quantity) else { continue };
            let file = format!("{quantity}/{:04}.png", self.manifest.steps.len());
            let folder = self.folder.join(quantity.name());
            fs::create_dir_all(&folder).map_err(|source| self.placed(MapsError::io(&folder, source)))?;
            let is_empty = |value: f32| empty_of(*quantity) == value;
            let (scale, pixels) = match quantity {
                Quantity::Depth => self.depths(grid),
                _ => {
                    let scale = Scale::of_range(grid.values(), is_empty);
                    (scale, scale.values(grid.values(), is_empty, f64::round))
                }
            };
            picture::write(&self.folder.join(&file), grid.size(), &pixels).map_err(|error| self.placed(error))?;
            let Scale { scale, offset } = scale;
            pictures.insert(*quantity, Picture { file, scale, offset });
        }
        self.manifest.steps.push(Entry { time: step.time, pictures });
        Ok(())
    }

    /// The error with the place that a file is meant for instead of the hidden one.
    fn placed(&self, mut error: MapsError) -> MapsError {
        if let MapsError::Io { path, .. } | MapsError::Picture { path, .. } = &mut error
            && let Ok(file) = path.strip_prefix(&self.folder)
        {
            *path = self.place.join(file);
        }
        error
    }

    fn depths(&self, grid: &Grid<f32>) -> (Scale, Vec<u16>) {
        let scale = Scale::of_depth(self.manifest.precision, self.manifest.threshold);
        (scale, scale.depths(grid.values(), self.manifest.threshold))
    }

    /// Writes the manifest, puts everything in its place and tells how many bytes it takes.
    ///
    /// # Errors
    /// [`MapsError`] if the manifest cannot be written or the folder cannot be moved. What was in its place is still there
    /// then.
    pub fn finish(self) -> Result<u64, MapsError> {
        let path = self.folder.join(manifest::FILE);
        let pretty = PrettyConfig::new().depth_limit(3);
        let text = ron::ser::to_string_pretty(&self.manifest, pretty);
        let text = text.map_err(|error| MapsError::Manifest { path: path.clone(), reason: error.to_string() })?;
        fs::write(&path, text + "\n").map_err(|source| self.placed(MapsError::io(&path, source)))?;
        let bytes = size_of(&self.folder)?;
        check_place(&self.place)?;
        let moved = |from: &Path, to: &Path| fs::rename(from, to).map_err(|source| MapsError::io(&self.place, source));
        let old = self.temporary.path().join("old");
        let had_one = self.place.exists();
        if had_one {
            moved(&self.place, &old)?;
        }
        if let Err(error) = moved(&self.folder, &self.place) {
            if had_one {
                moved(&old, &self.place)?;
            }
            return Err(error);
        }
        Ok(bytes)
    }
}

/// Refuses to take the place of anything but a flood, also of one with other files in its folder, as they would be lost.
fn check_place(place: &Path) -> Result<(), MapsError> {
    if !place.exists() {
        return Ok(());
    }
    let entries = fs::read_dir(place).map_err(|_| MapsError::InTheWay(place.into()))?;
    let names: Vec<_> = entries.flatten().map(|entry| entry.file_name()).collect();
    if !names.is_empty() && !names.iter().any(|name| name == manifest::FILE) {
        return Err(MapsError::InTheWay(place.into()));
    }
    let is_own = |name: &str| match name.strip_suffix(".png") {
        Some(name) => ["flow", "normals"].contains(&name) || Map::ALL.iter().any(|map| map.name() == name),
        None => name == manifest::FILE || Quantity::ALL.iter().any(|quantity| quantity.name() == name),
    };
    match names.iter().find(|name| !name.to_str().is_some_and(is_own)) {
        Some(foreign) => Err(MapsError::InTheWay(place.join(foreign))),
        None => Ok(()),
    }
}

/// Bytes of all files in a folder and those within.
fn size_of(folder: &Path) -> Result<u64, MapsError> {
    let io = |source| MapsError::io(folder, source);
    let mut bytes = 0;
    for entry in fs::read_dir(folder).map_err(io)? {
        let entry = entry.map_err(io)?;
        let data = entry.metadata().map_err(io)?;
        bytes += if data.is_dir() { size_of(&entry.path())? } else { data.len() };
    }
    Ok(bytes)
}
