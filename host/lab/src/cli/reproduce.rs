//! `sinew-lab reproduce`: every table and figure of a paper, theirs beside ours.

use super::until_signal;
use crate::experiments::STACK_BYTES;
use crate::reproduce::{Made, Material, arm, cyclic, pik};
use anyhow::{Result, ensure};
use clap::{Args, ValueEnum};
use serde_json::json;
use sinew::body::tracking::BodyTuning;
use sinew::cli::console::Console;
use sinew::output::OutputDir;
use sinew::resume::{Begun, CELLS_FOLDER, Cells, Stop};
use std::path::PathBuf;
use std::time::Instant;

/// The papers.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Paper {
    /// Greif and Lienhart: a kinematic model for cyclic motion.
    Cyclic,
    /// Hauberg and Pedersen: probabilistic inverse kinematics.
    Pik,
    /// Moeslund and Granum: an arm corrected by skin-coloured blobs.
    Arm,
}

impl Paper {
    const fn name(self) -> &'static str {
        match self {
            Self::Cyclic => "cyclic",
            Self::Pik => "pik",
            Self::Arm => "arm",
        }
    }
}

/// Options of `sinew-lab reproduce`.
#[derive(Debug, Args)]
#[command(after_help = "What is done is kept in --out and is not run again.

Example:
  sinew-lab reproduce cyclic --data ../shared/data --out out/reproduce --quick")]
pub struct ReproduceArgs {
    /// The paper.
    #[arg(value_enum)]
    pub paper: Paper,
    /// Folder of the recordings.
    #[arg(long, value_name = "DIR", default_value = "../shared/data")]
    pub data: PathBuf,
    /// Folder of the pages, one folder a paper.
    #[arg(long, value_name = "DIR")]
    pub out: PathBuf,
    /// Fewer seeds and particles; the page says what is left out.
    #[arg(long)]
    pub quick: bool,
}

/// Makes the page of a paper, with its pictures and numbers.
///
/// # Errors
/// Recordings that are missing, an output that cannot be written, or
/// [`sinew::resume::Interrupted`].
pub fn run(args: &ReproduceArgs, console: &Console) -> Result<()> {
    until_signal(console, |stop| run_until(args, console, stop))
}

fn run_until(args: &ReproduceArgs, console: &Console, stop: Stop<'_>) -> Result<()> {
    ensure!(args.data.is_dir(), "`{}` is no folder; give that of the recordings as --data", args.data.display());
    let name = args.paper.name();
    let output = OutputDir::create(&args.out.join(name))?;
    let begun = Begun::new(
        &format!("reproduce {name}"),
        &json!({ "quick": args.quick, "data": args.data, "numbers": BodyTuning::default() }),
        &[],
    )?;
    // Kept after the end as well, so that a part that is done is not run again.
    let is_begun = output.join(CELLS_FOLDER).join("begun.json").is_file();
    let cells = Cells::keep(&output, &begun, is_begun, stop)?;
    let pool = rayon::ThreadPoolBuilder::new().stack_size(STACK_BYTES).build()?;
    let material = Material { data: &args.data, is_quick: args.quick };
    let start = Instant::now();
    let make = || match args.paper {
        Paper::Cyclic => cyclic::make(material, &cells),
        Paper::Pik => pik::make(material, &cells),
        Paper::Arm => arm::make(material, &cells),
    };
    let Made { mut page, plots, drawings, pictures } = console.busy("tracking", || pool.install(make))?;
    let quick = if args.quick { " --quick" } else { "" };
    page.made_by = format!(
        "Made by `sinew-lab reproduce {name}{quick}` of sinew {}, on {} with {} threads, in {:.0} s of this run.",
        env!("CARGO_PKG_VERSION"),
        std::env::consts::ARCH,
        rayon::current_num_threads(),
        start.elapsed().as_secs_f64()
    );
    let plots = plots.into_iter().map(|(file, plot)| (file, plot.to_svg()));
    for (file, svg) in plots.chain(drawings) {
        output.write(&file, |writer| Ok(writer.write_all(svg.as_bytes())?))?;
    }
    for (file, picture) in &pictures {
        output.write_png(file, picture)?;
    }
    output.write("index.html", |writer| Ok(writer.write_all(page.to_html().as_bytes())?))?;
    let path = output.join("index.html");
    console.answer(&format!("page: {}\n", path.display()), &json!({ "page": path }))
}
