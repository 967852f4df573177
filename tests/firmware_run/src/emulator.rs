//! QEMU with one image, in a folder of its own, never longer than a limit.

use anyhow::{Context, Result, bail};
use sinew_firmware_sim::port::{COSTS_FILE, ICOUNT_SHIFT, INPUT_FILE, RESULTS_FILE};
use std::fs::{self, File};
use std::io::ErrorKind;
use std::path::Path;
use std::process::{Command, Stdio};
use std::str::FromStr;
use std::time::{Duration, Instant};

/// The program.
pub const QEMU: &str = "qemu-system-arm";
/// Longest run; the images take seconds.
const LIMIT: Duration = Duration::from_secs(300);
/// File of the log bytes in the emulator's folder.
const SERIAL_FILE: &str = "serial.bin";

/// Which board is emulated.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Machine {
    /// MPS2 AN386: Cortex-M4F.
    #[default]
    M4,
    /// MPS2 AN500: Cortex-M7.
    M7,
}

impl Machine {
    /// Both.
    pub const ALL: [Self; 2] = [Self::M4, Self::M7];

    /// Its name in QEMU.
    #[must_use]
    pub const fn qemu_name(self) -> &'static str {
        match self {
            Self::M4 => "mps2-an386",
            Self::M7 => "mps2-an500",
        }
    }

    /// As the environment variable `SINEW_MACHINE` says, the Cortex-M4F without it.
    ///
    /// # Errors
    /// Another value than `m4` or `m7`.
    pub fn from_environment() -> Result<Self> {
        std::env::var("SINEW_MACHINE").map_or(Ok(Self::default()), |name| name.parse())
    }
}

impl FromStr for Machine {
    type Err = anyhow::Error;

    fn from_str(name: &str) -> Result<Self> {
        match name {
            "m4" => Ok(Self::M4),
            "m7" => Ok(Self::M7),
            _ => bail!("there is no machine `{name}`; use m4 or m7"),
        }
    }
}

/// What a run left.
#[derive(Debug, Clone, Default)]
pub struct Ended {
    /// Exit code; `None` where a signal ended the emulator.
    pub code: Option<i32>,
    /// What it wrote to standard output and standard error.
    pub printed: String,
    /// Bytes of the serial line: defmt's log.
    pub serial: Vec<u8>,
    /// The answers, if it wrote any.
    pub results: Option<Vec<u8>>,
    /// The costs, if it wrote any.
    pub costs: Vec<u8>,
}

/// Runs `image` with `input`.
///
/// # Errors
/// QEMU is missing or did not end within the limit.
pub fn run(image: &Path, machine: Machine, input: Option<&[u8]>) -> Result<Ended> {
    let folder = tempfile::tempdir()?;
    let file = |name: &str| folder.path().join(name);
    fs::write(file(INPUT_FILE), input.unwrap_or_default())?;
    let printed = File::create(file("printed"))?;
    let mut command = Command::new(QEMU);
    command
        .args(["-machine", machine.qemu_name(), "-nographic", "-monitor", "none"])
        .args(["-serial", &format!("file:{SERIAL_FILE}")])
        .args(["-icount", &format!("shift={ICOUNT_SHIFT},align=off,sleep=off")])
        .args(["-semihosting-config", "enable=on,target=native"])
        .arg("-kernel")
        .arg(image.canonicalize().with_context(|| format!("there is no image `{}`", image.display()))?)
        .current_dir(folder.path())
        .stdin(Stdio::null())
        .stdout(printed.try_clone()?)
        .stderr(printed);
    let code = wait(&mut command)?;
    let printed = String::from_utf8_lossy(&fs::read(file("printed"))?).into_owned();
    Ok(Ended {
        code,
        printed,
        serial: fs::read(file(SERIAL_FILE)).unwrap_or_default(),
        results: fs::read(file(RESULTS_FILE)).ok(),
        costs: fs::read(file(COSTS_FILE)).unwrap_or_default(),
    })
}

/// Exit code of the emulator, which is ended after the limit.
fn wait(command: &mut Command) -> Result<Option<i32>> {
    let mut child = command.spawn().map_err(|error| match error.kind() {
        ErrorKind::NotFound => anyhow::anyhow!("`{QEMU}` is not installed; Debian's package is qemu-system-arm"),
        _ => error.into(),
    })?;
    let begun = Instant::now();
    loop {
        if let Some(status) = child.try_wait()? {
            return Ok(status.code());
        }
        if begun.elapsed() > LIMIT {
            child.kill()?;
            child.wait()?;
            bail!("the image did not end within {} s", LIMIT.as_secs());
        }
        std::thread::sleep(Duration::from_millis(5));
    }
}

/// Whether QEMU is installed.
#[must_use]
pub fn is_installed() -> bool {
    Command::new(QEMU).arg("--version").stdout(Stdio::null()).stderr(Stdio::null()).status().is_ok()
}
