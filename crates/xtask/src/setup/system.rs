//! Which operating system this is, and what its packages are called.

/// An operating system, as far as its packages differ.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum System {
    /// Debian, Ubuntu and what is made of them.
    Debian {
        /// Of the Debian release, such as `bookworm`; of Ubuntu and others their own.
        codename: String,
    },
    /// Fedora, Red Hat Enterprise Linux and the like.
    Fedora,
    /// Arch Linux and the like.
    Arch,
    /// openSUSE and the like.
    Suse,
    /// Another Linux.
    OtherLinux,
    /// A system that brings graphics along: macOS, Windows.
    Complete,
}

/// How a system installs what the water needs at run time.
pub struct Packages {
    /// The command before the package names.
    pub install: &'static [&'static str],
    /// The Vulkan loader and a driver that needs no graphics card.
    pub vulkan: &'static [&'static str],
    /// What winit loads for a window: X11 with its XCB bridge, cursors and input, and the keyboard's state.
    pub window: &'static [&'static str],
    /// An X server without a screen, and hands for it: what the test of the panel needs.
    pub tests: &'static [&'static str],
}

impl System {
    /// Reads the text of `/etc/os-release` (see the manual page of that name).
    pub fn from_os_release(text: &str) -> Self {
        let value = |key: &str| {
            let line = text.lines().find_map(|line| line.strip_prefix(key)?.strip_prefix('='));
            line.unwrap_or_default().trim().trim_matches(['"', '\'']).to_owned()
        };
        let names = format!("{} {}", value("ID"), value("ID_LIKE"));
        let named = |wanted: &[&str]| names.split_whitespace().any(|name| wanted.contains(&name));
        if named(&["debian", "ubuntu"]) {
            let debian = value("DEBIAN_CODENAME");
            Self::Debian { codename: if debian.is_empty() { value("VERSION_CODENAME") } else { debian } }
        } else if named(&["fedora", "rhel", "centos"]) {
            Self::Fedora
        } else if named(&["arch"]) {
            Self::Arch
        } else if named(&["suse", "opensuse"]) {
            Self::Suse
        } else {
            Self::OtherLinux
        }
    }

    /// Whether packages come through apt.
    pub fn is_debian_like(&self) -> bool {
        matches!(self, Self::Debian { .. })
    }

    /// Whether this is Debian 12, whose own Mesa 22.3 is too old.
    pub fn is_bookworm(&self) -> bool {
        matches!(self, Self::Debian { codename } if codename == "bookworm")
    }

    /// The names of its packages, where they are known.
    pub fn packages(&self) -> Option<Packages> {
        Some(match self {
            Self::Debian { .. } => Packages {
                install: &[
                    "env",
                    "DEBIAN_FRONTEND=noninteractive",
                    "apt-get",
                    "install",
                    "--yes",
                    "--no-install-recommends",
                ],
                vulkan: &["libvulkan1", "mesa-vulkan-drivers"],
                window: &["libx11-xcb1", "libxcursor1", "libxi6", "libxkbcommon-x11-0"],
                tests: &["xvfb", "xdotool"],
            },
            Self::Fedora => Packages {
                install: &["dnf", "install"],
                vulkan: &["vulkan-loader", "mesa-vulkan-drivers"],
                window: &["libX11-xcb", "libXcursor", "libXi", "libxkbcommon-x11"],
                tests: &["xorg-x11-server-Xvfb", "xdotool"],
            },
            Self::Arch => Packages {
                install: &["pacman", "-S", "--needed"],
                vulkan: &["vulkan-icd-loader", "vulkan-swrast"],
                window: &["libx11", "libxcursor", "libxi", "libxkbcommon-x11"],
                tests: &["xorg-server-xvfb", "xdotool"],
            },
            Self::Suse => Packages {
                install: &["zypper", "install"],
                vulkan: &["libvulkan1", "libvulkan_lvp"],
                window: &["libX11-xcb1", "libXcursor1", "libXi6", "libxkbcommon-x11-0"],
                tests: &["xorg-x11-server-Xvfb", "xdotool"],
            },
            Self::OtherLinux | Self::Complete => return None,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn debian(codename: &str) -> System {
        System::Debian { codename: codename.into() }
    }

    #[test]
    fn reads_os_release() {
        let system = System::from_os_release;
        let bookworm = "PRETTY_NAME=\"Debian GNU/Linux 12 (bookworm)\"\nVERSION_CODENAME=bookworm\nID=debian\n";
        assert_eq!(system(bookworm), debian("bookworm"));
        assert_eq!(system("ID=ubuntu\nID_LIKE=debian\nVERSION_CODENAME=noble\n"), debian("noble"));
        let mint_on_debian = "ID=linuxmint\nID_LIKE=\"debian\"\nVERSION_CODENAME=faye\nDEBIAN_CODENAME=bookworm\n";
        assert_eq!(system(mint_on_debian), debian("bookworm"));
        assert_eq!(system("ID=\"rocky\"\nID_LIKE=\"rhel centos fedora\"\n"), System::Fedora);
        assert_eq!(system("ID=manjaro\nID_LIKE=arch\n"), System::Arch);
        assert_eq!(system("ID=\"opensuse-tumbleweed\"\nID_LIKE=\"opensuse suse\"\n"), System::Suse);
        assert_eq!(system("ID=nixos\n"), System::OtherLinux);
        assert_eq!(system(""), System::OtherLinux);
    }
}
