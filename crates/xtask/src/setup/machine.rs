//! What this machine has, found out from files and a few quick commands.

use std::{
    env,
    ffi::{OsStr, OsString},
    fs,
    path::{Path, PathBuf},
    process::Command,
};

use super::system::System;

/// The libraries that winit loads for a window.
const WINDOW_LIBRARIES: [&str; 5] =
    ["libX11.so.6", "libX11-xcb.so.1", "libXcursor.so.1", "libXi.so.6", "libxkbcommon-x11.so.0"];

/// What opens a window without a display and works it, for the tests.
const TEST_PROGRAMS: [&str; 2] = ["Xvfb", "xdotool"];

/// Kernel drivers of virtual machines' displays, which draw nothing themselves.
const VIRTUAL_CARDS: [&str; 5] = ["bochs-drm", "qxl", "virtio-pci", "virtio_gpu", "vmwgfx"];

/// What the machine shall be able to do.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Purpose {
    /// To draw, and to open windows if there is a display.
    Run,
    /// To open windows without a display as well.
    Test,
}

/// Whether a command may be run with root's rights.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rights {
    /// The user is root.
    Root,
    /// There is `sudo`.
    Sudo,
    /// Neither.
    None,
}

/// What decides about an installation.
#[derive(Clone, Debug)]
pub struct Machine {
    /// The operating system.
    pub system: System,
    /// How packages can be installed.
    pub rights: Rights,
    /// Whether there is a Vulkan loader, `libvulkan.so.1`.
    pub loader: bool,
    /// File names of the manifests that the loader finds its drivers by.
    pub drivers: Vec<String>,
    /// Whether there is a graphics card.
    pub graphics_card: bool,
    /// Version of Debian's package `mesa-vulkan-drivers`.
    pub mesa: Option<String>,
    /// Of the libraries that a window needs, if there is a display or a test to show it.
    pub missing_window_libraries: Vec<&'static str>,
    /// Of the programs that tests need, if they shall run.
    pub missing_test_programs: Vec<&'static str>,
    /// Whether Debian's package sources have the backports of release 12.
    pub has_backports: bool,
}

impl Machine {
    /// Looks around.
    pub fn look(purpose: Purpose) -> Self {
        let linux = cfg!(target_os = "linux");
        let system = if linux { System::from_os_release(&read("/etc/os-release")) } else { System::Complete };
        let libraries = output("/sbin/ldconfig", &["-p"]).unwrap_or_default();
        let missing = |library: &&str| !libraries.contains(&format!("\t{library} "));
        let tests = linux && purpose == Purpose::Test;
        let window: &[&str] = if linux && has_display() || tests { &WINDOW_LIBRARIES } else { &[] };
        let programs: &[&str] = if tests { &TEST_PROGRAMS } else { &[] };
        Self {
            rights: rights(),
            loader: !missing(&"libvulkan.so.1"),
            drivers: manifests(&driver_paths(|name| env::var_os(name))),
            graphics_card: has_graphics_card(),
            mesa: output("dpkg-query", &["--show", "--showformat=${Version}", "mesa-vulkan-drivers"]),
            missing_window_libraries: window.iter().copied().filter(missing).collect(),
            missing_test_programs: programs.iter().copied().filter(|program| !has_program(program)).collect(),
            has_backports: sources().iter().any(|text| names_suite(text, "bookworm-backports")),
            system,
        }
    }

    /// Whether something can be drawn with Vulkan, or with what the system has in its place.
    pub fn has_vulkan(&self) -> bool {
        // Mesa's manifest is called lvp_icd, with the processor's name in some releases.
        let in_software = |driver: &String| driver.starts_with("lvp") || driver.contains("swiftshader");
        let usable = |driver| self.graphics_card || in_software(driver);
        self.system == System::Complete || self.loader && self.drivers.iter().any(usable)
    }
}

/// Whether a window can be opened; the engine is built for X11, which Wayland offers too.
pub fn has_display() -> bool {
    !cfg!(target_os = "linux") || env::var_os("DISPLAY").is_some_and(|display| !display.is_empty())
}

fn has_program(name: &str) -> bool {
    let path = env::var_os("PATH").unwrap_or_default();
    env::split_paths(&path).any(|folder| folder.join(name).is_file())
}

fn rights() -> Rights {
    if output("id", &["-u"]).as_deref() == Some("0") {
        Rights::Root
    } else if has_program("sudo") {
        Rights::Sudo
    } else {
        Rights::None
    }
}

/// Files, and folders of files, where the Vulkan loader looks for its drivers' manifests on Linux.
///
/// Khronos, "Architecture of the Vulkan Loader Interfaces", driver discovery.
fn driver_paths(variable: impl Fn(&str) -> Option<OsString>) -> Vec<PathBuf> {
    let variable = |name: &str| variable(name).filter(|value| !value.is_empty());
    let list = |name: &str| variable(name).map(|value| env::split_paths(&value).collect::<Vec<_>>());
    if let Some(only) = list("VK_DRIVER_FILES").or_else(|| list("VK_ICD_FILENAMES")) {
        return only;
    }
    let home = variable("HOME").map(PathBuf::from).unwrap_or_default();
    let one = |name: &str, default: &str| vec![variable(name).map_or_else(|| home.join(default), PathBuf::from)];
    let several =
        |name: &str, default: &[&str]| list(name).unwrap_or_else(|| default.iter().map(PathBuf::from).collect());
    let folders = [
        one("XDG_CONFIG_HOME", ".config"),
        several("XDG_CONFIG_DIRS", &["/etc/xdg"]),
        vec!["/etc".into(), "/usr/local/etc".into()],
        one("XDG_DATA_HOME", ".local/share"),
        several("XDG_DATA_DIRS", &["/usr/local/share", "/usr/share"]),
    ];
    let folders = folders.concat().into_iter().map(|folder| folder.join("vulkan/icd.d"));
    list("VK_ADD_DRIVER_FILES").unwrap_or_default().into_iter().chain(folders).collect()
}

/// The names of the manifests at these paths.
fn manifests(paths: &[PathBuf]) -> Vec<String> {
    let files = paths.iter().flat_map(|path| if path.is_dir() { entries(path) } else { vec![path.clone()] });
    files
        .filter(|file| file.is_file() && file.extension().is_some_and(|extension| extension == "json"))
        .filter_map(|file| Some(file.file_name()?.to_string_lossy().into_owned()))
        .collect()
}

/// Whether the kernel drives a card that renders.
fn has_graphics_card() -> bool {
    let renders = |node: &PathBuf| {
        let is_render_node = node.file_name().is_some_and(|name| name.as_encoded_bytes().starts_with(b"renderD"));
        let driver = fs::read_link(node.join("device/driver")).unwrap_or_default();
        let is_real = |name: &OsStr| !VIRTUAL_CARDS.iter().any(|virtual_card| name == *virtual_card);
        is_render_node && driver.file_name().is_some_and(is_real)
    };
    Path::new("/dev/nvidia0").exists() || entries(Path::new("/sys/class/drm")).iter().any(renders)
}

/// The texts of apt's lists of package sources.
fn sources() -> Vec<String> {
    let mut files = entries(Path::new("/etc/apt/sources.list.d"));
    files.retain(|file| file.extension().is_some_and(|extension| extension == "list" || extension == "sources"));
    files.push("/etc/apt/sources.list".into());
    files.iter().map(read).collect()
}

/// Whether a list of package sources, of the one-line or the deb822 form, names a suite.
fn names_suite(text: &str, suite: &str) -> bool {
    let lines = text.lines().filter_map(|line| line.split('#').next());
    lines.flat_map(str::split_whitespace).any(|word| word == suite)
}

fn entries(folder: &Path) -> Vec<PathBuf> {
    fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.path()).collect()
}

/// The text of a file, empty if it cannot be read.
fn read(path: impl AsRef<Path>) -> String {
    fs::read_to_string(path).unwrap_or_default()
}

/// What a command prints, if it exists and succeeds.
fn output(program: &str, args: &[&str]) -> Option<String> {
    let output = Command::new(program).args(args).output().ok().filter(|output| output.status.success())?;
    Some(String::from_utf8_lossy(&output.stdout).trim_end().to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn paths(variables: &[(&str, &str)]) -> Vec<PathBuf> {
        driver_paths(|wanted| variables.iter().find(|(name, _)| *name == wanted).map(|(_, value)| value.into()))
    }

    #[test]
    fn drivers_named_by_the_environment_stand_alone() {
        assert_eq!(paths(&[("VK_ICD_FILENAMES", "/a.json:/b")]), [PathBuf::from("/a.json"), "/b".into()]);
        let both = [("VK_ICD_FILENAMES", "/old.json"), ("VK_DRIVER_FILES", "/new.json")];
        assert_eq!(paths(&both), [PathBuf::from("/new.json")]);
    }

    #[test]
    fn drivers_are_looked_for_in_the_loaders_folders() {
        let found = paths(&[("HOME", "/home/ann"), ("XDG_DATA_DIRS", "/opt/share")]);
        for folder in ["/home/ann/.config", "/etc/xdg", "/etc", "/home/ann/.local/share", "/opt/share"] {
            assert!(found.contains(&Path::new(folder).join("vulkan/icd.d")), "{folder} in {found:?}");
        }
        assert!(!found.contains(&"/usr/share/vulkan/icd.d".into()));
    }

    #[test]
    fn finds_a_suite_in_both_forms_of_sources() {
        let finds = |text| names_suite(text, "bookworm-backports");
        assert!(finds("deb http://deb.debian.org/debian bookworm-backports main\n"));
        assert!(finds("Types: deb\nSuites: bookworm bookworm-backports\n"));
        assert!(!finds("# deb http://deb.debian.org/debian bookworm-backports main\n"));
        assert!(!finds("deb http://deb.debian.org/debian bookworm-backports-sloppy main\n"));
    }
}
