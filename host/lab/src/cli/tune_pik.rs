//! `sinew-lab tune-pik`: the numbers that the PIK paper leaves open.

use crate::body::search::{Found, Searched, search};
use crate::body::trial::SeenMotion;
use crate::data_split::{Role, motions};
use anyhow::Result;
use clap::Args;
use serde_json::json;
use sinew::body::BodyPart;
use sinew::body::run::tuning_file;
use sinew::body::tracking::{BodyTuning, PaperTuning};
use sinew::cli::console::Console;
use std::fmt::Write;
use std::path::PathBuf;

/// Options of `sinew-lab tune-pik`.
#[derive(Debug, Args)]
#[command(after_help = "Example:\n  sinew-lab tune-pik --data ../shared/data --tries 150")]
pub struct TunePikArgs {
    /// Folder of the recordings.
    #[arg(long, value_name = "DIR", default_value = "../shared/data")]
    pub data: PathBuf,
    /// How much of the body is tracked; the paper's sequence shows an upper body.
    #[arg(long, value_enum, default_value_t = BodyPart::Upper)]
    pub body: BodyPart,
    /// Particles of a tracker.
    #[arg(long, default_value_t = 100)]
    pub particles: usize,
    /// Sets of numbers that are tried, the same for goals and angles.
    #[arg(long, default_value_t = 150)]
    pub tries: usize,
    /// Seeds of each motion. One is enough to search; to compare what several searches found, take
    /// five with `--tries 0`, since rounding alone changes the error of one seed by 2 to 15 %.
    #[arg(long, default_value_t = 1, value_parser = clap::value_parser!(u64).range(1..))]
    pub seeds: u64,
    /// Search only these numbers.
    #[arg(long, value_enum)]
    pub only: Option<Searched>,
    /// Where the search begins, `[paper]` as `sinew track body --config` reads it [default: the
    /// shipped numbers].
    #[arg(long, value_name = "FILE.toml")]
    pub config: Option<PathBuf>,
}

impl TunePikArgs {
    fn start(&self) -> Result<PaperTuning> {
        let tuning = self.config.as_deref().map_or_else(|| Ok(BodyTuning::default()), tuning_file::load)?;
        Ok(tuning.paper)
    }
}

/// Searches each model's own best and the best with one likelihood, and prints them.
///
/// # Errors
/// A recording that cannot be read.
pub fn run(args: &TunePikArgs, console: &Console) -> Result<()> {
    let skeleton = args.data.join("mocap/cmu-walk/35/35.asf");
    let mut seen: Vec<(u64, SeenMotion)> = Vec::new();
    for motion in motions(&args.data, "body-paper", Role::Tuning)? {
        let read = motion.read(Some(&skeleton))?;
        for seed in 1..=args.seeds {
            seen.push((seed, read.seen(args.body, seed)?));
        }
    }
    let (mut all, mut text): (Vec<Found>, String) = (Vec::new(), String::new());
    let all_searches = [Searched::Goals, Searched::Angles, Searched::AnglesByJoint, Searched::Both, Searched::Root];
    for searched in all_searches.into_iter().filter(|searched| args.only.is_none_or(|only| only == *searched)) {
        let bar = console.bar(args.tries as u64, "{msg} {pos}/{len} {wide_bar} {eta}")?;
        let tried = |_, error_m: f64| {
            bar.set_message(format!("{searched:?} {:.2} cm", 100.0 * error_m));
            bar.inc(1);
        };
        let start = args.start()?;
        let found = search(searched, &start, (&seen, args.particles), args.tries, tried)?;
        bar.finish_and_clear();
        let _ =
            writeln!(text, "{searched:?}: {:.2} cm\n{}", 100.0 * found.error_m, serde_json::to_string(&found.paper)?);
        console.note(&text);
        all.push(found);
    }
    console.answer(&text, &json!({ "particles": args.particles, "seeds": args.seeds, "found": all }))
}
