//! Builds the live page: `cargo run --release -p sinew-live-page -- --out out/live`.
//!
//! One HTML file with the tracker as WebAssembly and the built-in scene. It loads nothing, and its
//! own rules forbid it to.

mod bits;
mod builtin;
mod fake_camera;
mod module;
mod page;
mod recording;
mod rounding;
mod scene_pack;

use anyhow::{Result, bail, ensure};
use builtin::BuiltinScene;
use clap::Parser;
use sinew::output::OutputDir;
use std::path::PathBuf;

/// Maximum number of bytes of the page: what a visitor downloads. The model of the face detector
/// has 1.6 million of them.
const MAX_PAGE_BYTES: usize = 3_200_000;

/// Build the live page.
#[derive(Debug, Parser)]
struct Args {
    /// Folder that gets `index.html`.
    #[arg(long, value_name = "DIR", default_value = "out/live")]
    out: PathBuf,
    /// The module, where it was built already: `sinew_live.wasm`.
    #[arg(long, value_name = "FILE")]
    module: Option<PathBuf>,
    /// Also write the inputs of `tests/browser/live.mjs`. These are the built-in scene for a fake
    /// camera (`camera.y4m`) with its truth (`camera.json`), and some of its frames (`frames.rgba`)
    /// with this machine's answers (`bits.json`).
    #[arg(long)]
    for_tests: bool,
}

fn main() -> Result<()> {
    let args = Args::parse();
    let out = OutputDir::create(&args.out)?;
    let module = match &args.module {
        Some(file) => module::read(file)?,
        None => module::build()?,
    };
    let quiet = BuiltinScene::new(0.0)?;
    let page = page::page(&module, &scene_pack::packed(&quiet)?)?;
    ensure!(page.len() < MAX_PAGE_BYTES, "the page has {} bytes; at most {MAX_PAGE_BYTES}", page.len());
    out.write("index.html", |writer| Ok(writer.write_all(page.as_bytes())?))?;
    if args.for_tests {
        let noisy = BuiltinScene::new(builtin::CAMERA_NOISE_STD)?;
        fake_camera::write(&noisy, &out)?;
        bits::write(&noisy, &out)?;
    }
    let Some(file) = out.join("index.html").to_str().map(str::to_owned) else { bail!("the path is not a text") };
    println!("{file}: {} bytes, of which the module has {}; open it in a browser", page.len(), module.len());
    Ok(())
}
