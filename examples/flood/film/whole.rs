//! Files that are there whole or not at all.
use super::{folder_of, named};
use std::{
    io::{self, BufWriter, Seek, SeekFrom, Write},
    path::{Path, PathBuf},
};
use tempfile::NamedTempFile;

/// A file that gets its name when it is complete. Until then it lies hidden beside its place, and goes if it is dropped.
pub struct Whole {
    path: PathBuf,
    file: BufWriter<NamedTempFile>,
}

impl Whole {
    /// Begins a file that will be at `path`; folders that are missing are made.
    ///
    /// # Errors
    /// Why it cannot be there.
    pub fn create(path: &Path) -> Result<Self, String> {
        let folder = folder_of(path)?;
        if path.is_dir() {
            return Err(named(path)(&"expected a file, found a folder"));
        }
        let mut file = tempfile::Builder::new();
        file.prefix(".film-").suffix(".part");
        // As any new file: by default it would be its owner's only.
        #[cfg(unix)]
        let all = <std::fs::Permissions as std::os::unix::fs::PermissionsExt>::from_mode(0o666);
        #[cfg(unix)]
        file.permissions(all);
        let file = file.tempfile_in(folder).map_err(|problem| named(path)(&problem))?;
        Ok(Self { path: path.into(), file: BufWriter::new(file) })
    }

    /// Gives it its name, in place of what had it.
    ///
    /// # Errors
    /// Why it does not get it.
    pub fn keep(self) -> Result<(), String> {
        let Self { path, file } = self;
        let file = file.into_inner().map_err(|problem| named(&path)(&problem))?;
        file.persist(&path).map_err(|problem| named(&path)(&problem.error))?;
        Ok(())
    }
}

impl Write for Whole {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.file.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.flush()
    }
}

impl Seek for Whole {
    fn seek(&mut self, place: SeekFrom) -> io::Result<u64> {
        self.file.seek(place)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    #[test]
    fn a_file_is_there_whole_or_not_at_all() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("new/film.gif");
        let mut file = Whole::create(&path).expect("a file");
        file.write_all(b"half").expect("room");
        drop(file);
        let left = fs::read_dir(folder.path().join("new")).expect("a folder").count();
        assert_eq!(left, 0);

        let mut file = Whole::create(&path).expect("a file");
        file.write_all(b"all of it").expect("room");
        assert!(!path.exists());
        file.keep().expect("its name");
        assert_eq!(fs::read(&path).expect("a file"), b"all of it");
    }

    #[test]
    fn a_folder_is_no_place_for_a_file() {
        let folder = tempfile::tempdir().expect("a folder");
        assert!(Whole::create(folder.path()).is_err_and(|problem| problem.contains("found a folder")));
    }
}
