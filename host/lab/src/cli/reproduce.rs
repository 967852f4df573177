//! `sinew-lab reproduce`: every table and figure of a paper, theirs beside ours.

use super::until_signal;
use crate::experiments::STACK_BYTES;
use crate::reproduce::page::Page;
use crate::reproduce::runs::{Runs, commit};
use crate::reproduce::{Made, Material, arm, cyclic, pik};
use crate::tables::{markdown, page};
use anyhow::{Context, Result, ensure};
use clap::{Args, ValueEnum};
use serde_json::json;
use sinew::body::tracking::BodyTuning;
use sinew::cli::console::Console;
use sinew::output::OutputDir;
use sinew::resume::{Begun, CELLS_FOLDER, Cells, Stop};
use std::fs;
use std::path::{Path, PathBuf};
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
    /// PIK and cyclic: leave out larger numbers of particles; a later run with more goes on from
    /// this one.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(100..))]
    pub max_particles: Option<u32>,
    /// Also renew the tables of this page that have a mark of the paper, such as
    /// docs/reproduce.md.
    #[arg(long, value_name = "FILE.md")]
    pub page: Option<PathBuf>,
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
    if let Some(page) = &args.page {
        fs::read_to_string(page).with_context(|| format!("the page `{}`", page.display()))?;
    }
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
    let max_particles = args.max_particles.map_or(usize::MAX, |most| most as usize);
    let material = Material { data: &args.data, is_quick: args.quick, max_particles };
    let (start, commit) = (Instant::now(), commit());
    let mut runs = if is_begun { Runs::read(&output) } else { Runs::default() };
    let make = || match args.paper {
        Paper::Cyclic => cyclic::make(material, &cells),
        Paper::Pik => pik::make(material, &cells),
        Paper::Arm => arm::make(material, &cells),
    };
    let made = console.busy("tracking", || pool.install(make));
    runs.add(&output, &commit, start.elapsed().as_secs_f64())?;
    let Made { mut page, plots, drawings, pictures } = made?;
    page.made_by = made_by(args, &runs);
    let plots = plots.into_iter().map(|(file, plot)| (file, plot.to_svg()));
    for (file, svg) in plots.chain(drawings) {
        output.write(&file, |writer| Ok(writer.write_all(svg.as_bytes())?))?;
        #[cfg(feature = "png")]
        output.write_png(file.replace(".svg", ".png"), &crate::reproduce::raster::to_picture(&svg)?)?;
    }
    for (file, picture) in &pictures {
        output.write_png(file, picture)?;
    }
    output.write("index.html", |writer| Ok(writer.write_all(page.to_html().as_bytes())?))?;
    if let Some(book) = &args.page {
        renew(book, name, &page)?;
    }
    let path = output.join("index.html");
    console.answer(&format!("page: {}\n", path.display()), &json!({ "page": path }))
}

/// Renews the tables of `book` that have a mark of the paper `name`.
fn renew(book: &Path, name: &str, page: &Page) -> Result<()> {
    let shown = book.display();
    let mut text = fs::read_to_string(book).with_context(|| format!("the page `{shown}`"))?;
    for (mark, rows) in page.tables(name) {
        if page::names(&text).contains(&mark.as_str()) {
            text = page::renewed(&text, &mark, &markdown::table(&rows)).with_context(|| shown.to_string())?;
        }
    }
    fs::write(book, text).with_context(|| format!("the page `{shown}` cannot be written"))
}

/// Command, commits, machine and time of what a page shows.
fn made_by(args: &ReproduceArgs, runs: &Runs) -> Vec<(&'static str, String)> {
    let quick = if args.quick { " --quick" } else { "" };
    let most = args.max_particles.map_or_else(String::new, |most| format!(" --max-particles {most}"));
    let (arch, threads) = (std::env::consts::ARCH, rayon::current_num_threads());
    vec![
        ("command", format!("`sinew-lab reproduce {}{quick}{most}`", args.paper.name())),
        ("commit", runs.commits()),
        ("machine", format!("{arch}, {threads} threads")),
        ("time, s", format!("{:.0}", runs.seconds())),
    ]
}
