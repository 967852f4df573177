//! The WebAssembly module: built by the same cargo, or read.

use anyhow::{Context, Result, bail, ensure};
use serde::Deserialize;
use std::env;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

const TARGET: &str = "wasm32-unknown-unknown";
/// Vector instructions of WebAssembly, which every browser has had since 2023: vision takes half
/// the time.
const FLAGS: &str = "-C target-feature=+simd128";

/// What cargo reports of a file that it made.
#[derive(Debug, Deserialize)]
struct Message {
    #[serde(default)]
    filenames: Vec<PathBuf>,
}

/// Builds the module and gives its bytes. `SINEW_CARGO` names another cargo, whose arguments may
/// follow.
///
/// # Errors
/// Cargo is missing, or lacks the target.
pub fn build() -> Result<Vec<u8>> {
    let cargo = env::var("SINEW_CARGO").or_else(|_| env::var("CARGO")).unwrap_or_else(|_| "cargo".to_owned());
    let mut words = cargo.split_whitespace();
    let program = words.next().context("SINEW_CARGO is empty")?;
    let output = Command::new(program)
        .args(["build", "--locked", "--profile", "live", "--package", "sinew-live", "--lib", "--target", TARGET])
        .args(["--message-format", "json-render-diagnostics"])
        .args(words)
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .env("CARGO_TARGET_WASM32_UNKNOWN_UNKNOWN_RUSTFLAGS", FLAGS)
        .stderr(Stdio::inherit())
        .output()
        .with_context(|| format!("`{program}` cannot be run; run this program by `cargo run`"))?;
    if !output.status.success() {
        bail!("the module could not be built; `rustup target add {TARGET}` gives the compiler what it needs")
    }
    let messages = String::from_utf8(output.stdout)?;
    let files = messages.lines().filter_map(|line| serde_json::from_str::<Message>(line).ok());
    let is_module = |file: &PathBuf| file.extension().is_some_and(|extension| extension == "wasm");
    let file = files.flat_map(|message| message.filenames).find(is_module);
    read(&file.context("cargo made no module")?)
}

/// Reads a module.
///
/// # Errors
/// The file cannot be read, or is none.
pub fn read(file: &Path) -> Result<Vec<u8>> {
    let bytes = std::fs::read(file).with_context(|| format!("module `{}` cannot be read", file.display()))?;
    ensure!(bytes.starts_with(b"\0asm"), "`{}` is no WebAssembly module", file.display());
    Ok(bytes)
}
