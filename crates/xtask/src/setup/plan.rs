//! What to install: decided from what the machine has, without touching it.

use std::fmt;

use super::machine::{Machine, Rights};

/// Where the file goes that adds Debian's backports to the package sources.
const BACKPORTS_FILE: &str = "/etc/apt/sources.list.d/bookworm-backports.sources";

const BACKPORTS_SOURCE: &str = "\
Types: deb
URIs: http://deb.debian.org/debian
Suites: bookworm-backports
Components: main
Signed-By: /usr/share/keyrings/debian-archive-keyring.gpg
";

/// What is missing, and how it is installed.
#[derive(Debug, PartialEq, Eq)]
pub struct Plan {
    /// Never empty.
    pub lacks: Vec<Lack>,
    /// Commands in order; empty where the system's packages are unknown.
    pub steps: Vec<Step>,
}

/// Something that is missing.
#[derive(Debug, PartialEq, Eq)]
pub enum Lack {
    /// A Vulkan loader and a driver for a device that exists.
    Vulkan,
    /// A software driver newer than this version of Mesa.
    NewerMesa(String),
    /// Libraries that a window needs.
    Window(Vec<&'static str>),
    /// Programs that the tests need.
    Tests(Vec<&'static str>),
}

impl fmt::Display for Lack {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Self::Vulkan => write!(f, "there is no Vulkan device: a loader or a driver is missing"),
            Self::NewerMesa(version) => {
                write!(f, "the software driver of Mesa {version} is slow and crashes on some compute shaders")
            }
            Self::Window(libraries) => write!(f, "a window needs {}", libraries.join(", ")),
            Self::Tests(programs) => write!(f, "the test of the panel needs {}", programs.join(", ")),
        }
    }
}

/// A command that needs root's rights.
#[derive(Debug, PartialEq, Eq)]
pub struct Step {
    words: Vec<String>,
    /// What it reads from its standard input.
    pub input: Option<&'static str>,
}

impl Step {
    fn new(words: &[&str]) -> Self {
        Self { words: words.iter().map(ToString::to_string).collect(), input: None }
    }

    /// The program and its arguments.
    pub fn words(&self, rights: Rights) -> Vec<&str> {
        let sudo = (rights == Rights::Sudo).then_some("sudo");
        sudo.into_iter().chain(self.words.iter().map(String::as_str)).collect()
    }

    /// The same for a shell.
    pub fn shell(&self, rights: Rights) -> String {
        let line = self.words(rights).join(" ");
        self.input.map_or(line.clone(), |text| format!("{line} <<'END'\n{text}END"))
    }
}

/// What to do on this machine, or nothing.
pub fn plan(machine: &Machine) -> Option<Plan> {
    let lacks = lacks(machine);
    (!lacks.is_empty()).then(|| Plan { steps: steps(machine, &lacks), lacks })
}

fn lacks(machine: &Machine) -> Vec<Lack> {
    let mut lacks = Vec::new();
    if !machine.has_vulkan() {
        lacks.push(Lack::Vulkan);
    } else if let Some(version) = &machine.mesa
        && machine.system.is_bookworm()
        && !machine.graphics_card
        && major(version).is_some_and(|major| major < 23)
    {
        lacks.push(Lack::NewerMesa(version.clone()));
    }
    if !machine.missing_window_libraries.is_empty() {
        lacks.push(Lack::Window(machine.missing_window_libraries.clone()));
    }
    if !machine.missing_test_programs.is_empty() {
        lacks.push(Lack::Tests(machine.missing_test_programs.clone()));
    }
    lacks
}

/// The first number of a version such as `22.3.6-1+deb12u1`.
fn major(version: &str) -> Option<u32> {
    version.split('.').next()?.parse().ok()
}

fn steps(machine: &Machine, lacks: &[Lack]) -> Vec<Step> {
    let Some(packages) = machine.system.packages() else {
        return Vec::new();
    };
    let mut install = packages.install.to_vec();
    let mut steps = Vec::new();
    let driver = lacks.iter().any(|lack| matches!(lack, Lack::Vulkan | Lack::NewerMesa(_)));
    if driver && machine.system.is_bookworm() {
        if !machine.has_backports {
            steps.push(Step { input: Some(BACKPORTS_SOURCE), ..Step::new(&["tee", BACKPORTS_FILE]) });
        }
        install.extend(["--target-release", "bookworm-backports"]);
    }
    if machine.system.is_debian_like() {
        steps.push(Step::new(&["apt-get", "update"]));
    }
    for lack in lacks {
        install.extend(match lack {
            Lack::Vulkan | Lack::NewerMesa(_) => packages.vulkan,
            Lack::Window(_) => packages.window,
            Lack::Tests(_) => packages.tests,
        });
    }
    steps.push(Step::new(&install));
    steps
}

#[cfg(test)]
mod tests {
    use super::{super::system::System, *};

    const INSTALL: &str = "env DEBIAN_FRONTEND=noninteractive apt-get install --yes --no-install-recommends";

    /// Debian 12 with a current Mesa, without a graphics card or a display.
    fn machine() -> Machine {
        Machine {
            system: System::Debian { codename: "bookworm".into() },
            rights: Rights::Root,
            loader: true,
            drivers: vec!["lvp_icd.json".into(), "radeon_icd.json".into()],
            graphics_card: false,
            mesa: Some("25.0.7-2~bpo12+1".into()),
            missing_window_libraries: Vec::new(),
            missing_test_programs: Vec::new(),
            has_backports: true,
        }
    }

    fn without_vulkan(codename: &str) -> Machine {
        let system = System::Debian { codename: codename.into() };
        Machine { system, loader: false, drivers: Vec::new(), mesa: None, has_backports: false, ..machine() }
    }

    fn shell(machine: &Machine) -> Vec<String> {
        let steps = plan(machine).expect("something is missing").steps;
        steps.iter().map(|step| step.shell(machine.rights)).collect()
    }

    #[test]
    fn leaves_a_complete_machine_alone() {
        assert_eq!(plan(&machine()), None);
        let elsewhere = Machine { system: System::Complete, loader: false, drivers: Vec::new(), ..machine() };
        assert_eq!(plan(&elsewhere), None);
    }

    #[test]
    fn takes_the_driver_of_a_fresh_debian_12_from_backports() {
        let tee = format!("tee {BACKPORTS_FILE} <<'END'\n{BACKPORTS_SOURCE}END");
        let install = format!("{INSTALL} --target-release bookworm-backports libvulkan1 mesa-vulkan-drivers");
        assert_eq!(shell(&without_vulkan("bookworm")), [tee, "apt-get update".into(), install]);
    }

    #[test]
    fn uses_backports_that_are_already_configured() {
        let machine = Machine { has_backports: true, ..without_vulkan("bookworm") };
        let shell = shell(&machine);
        assert_eq!(shell[0], "apt-get update");
        assert!(shell[1].contains("--target-release bookworm-backports"), "{shell:?}");
    }

    #[test]
    fn takes_the_driver_of_other_releases_from_their_own_suite() {
        for codename in ["trixie", "noble"] {
            let install = format!("{INSTALL} libvulkan1 mesa-vulkan-drivers");
            assert_eq!(shell(&without_vulkan(codename)), ["apt-get update".into(), install]);
        }
    }

    #[test]
    fn asks_sudo_when_not_root() {
        let machine = Machine { rights: Rights::Sudo, ..without_vulkan("noble") };
        let shell = shell(&machine);
        assert_eq!(shell[0], "sudo apt-get update");
        assert!(shell[1].starts_with("sudo env DEBIAN_FRONTEND=noninteractive apt-get"), "{shell:?}");
    }

    #[test]
    fn replaces_mesa_22_where_it_draws_in_software_on_debian_12() {
        let old = Machine { mesa: Some("22.3.6-1+deb12u1".into()), ..machine() };
        let plan = plan(&old).expect("Mesa 22 is too old");
        assert_eq!(plan.lacks, [Lack::NewerMesa("22.3.6-1+deb12u1".into())]);
        assert!(shell(&old)[1].ends_with("--target-release bookworm-backports libvulkan1 mesa-vulkan-drivers"));
    }

    #[test]
    fn keeps_mesa_22_where_a_card_draws_or_another_release_ships_it() {
        let old = Machine { mesa: Some("22.3.6-1+deb12u1".into()), ..machine() };
        assert_eq!(plan(&Machine { graphics_card: true, ..old.clone() }), None);
        assert_eq!(plan(&Machine { system: System::Debian { codename: "jammy".into() }, ..old }), None);
    }

    #[test]
    fn a_driver_without_its_card_or_without_a_loader_is_no_device() {
        let radeon = Machine { drivers: vec!["radeon_icd.json".into()], ..machine() };
        assert_eq!(plan(&radeon).map(|plan| plan.lacks), Some(vec![Lack::Vulkan]));
        assert_eq!(plan(&Machine { graphics_card: true, ..radeon }), None);
        assert_eq!(plan(&Machine { loader: false, ..machine() }).map(|plan| plan.lacks), Some(vec![Lack::Vulkan]));
    }

    #[test]
    fn installs_window_libraries_from_the_normal_suite() {
        let machine = Machine { missing_window_libraries: vec!["libXi.so.6"], ..machine() };
        let install = format!("{INSTALL} libx11-xcb1 libxcursor1 libxi6 libxkbcommon-x11-0");
        assert_eq!(shell(&machine), ["apt-get update".into(), install]);
    }

    #[test]
    fn installs_an_x_server_for_the_tests() {
        let machine = Machine { missing_test_programs: vec!["Xvfb"], ..machine() };
        assert_eq!(shell(&machine), ["apt-get update".into(), format!("{INSTALL} xvfb xdotool")]);
    }

    #[test]
    fn names_the_command_of_other_systems_if_it_is_known() {
        let fedora = Machine { system: System::Fedora, ..without_vulkan("") };
        assert_eq!(shell(&fedora), ["dnf install vulkan-loader mesa-vulkan-drivers"]);
        let other = Machine { system: System::OtherLinux, ..without_vulkan("") };
        assert!(shell(&other).is_empty());
    }
}
