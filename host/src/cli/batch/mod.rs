//! `sinew batch`: a list of recordings, each tracked once, in one process.

pub mod chunk;
mod content;
mod job;
pub mod manifest;
mod numbers;
#[cfg_attr(feature = "parquet", path = "parquet.rs")]
#[cfg_attr(not(feature = "parquet"), path = "no_parquet.rs")]
mod parquet;
mod progress;
mod store;
mod tables;
mod work;

use super::console::Console;
use super::data_error;
use super::signals::stop_flag;
use crate::output::OutputLock;
use crate::resume::Interrupted;
use anyhow::{Result, ensure};
use clap::Args;
use manifest::Manifest;
use progress::Progress;
use serde_json::json;
use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, Ordering};
use store::Store;
use tables::Counts;

/// Options of `sinew batch`.
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  sinew simulate keypoints --out recordings/anna.csv
  sinew batch recordings --out runs")]
pub struct BatchArgs {
    /// Recordings: a folder, or a list with a row each, as CSV or JSON lines (.jsonl), with id,
    /// input (relative to the list), kind (recording, cyclic, angles, arm, body) and options named
    /// like the flags; `-` reads the list from standard input.
    #[arg(value_name = "MANIFEST|FOLDER")]
    pub manifest: PathBuf,
    /// Folder of all results: results/KEY, status.csv, summary.csv.
    #[arg(long, value_name = "DIR")]
    pub out: PathBuf,
    /// Folder that relative paths of the list start from [default: the list's folder].
    #[arg(long, value_name = "DIR")]
    pub folder: Option<PathBuf>,
    /// Recordings that are worked on at once [default: one more than there are processors].
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub jobs: Option<u16>,
    /// Only every N-th recording, beginning with the I-th, 1 to N: for arrays of a scheduler. The
    /// tables get the shard's name.
    #[arg(long, value_name = "I/N", value_parser = shard)]
    pub shard: Option<(usize, usize)>,
    /// An option of all recordings whose row has none and whose kind has it: `model=running`,
    /// `online=true`.
    #[arg(long, value_name = "NAME=VALUE", value_parser = pair)]
    pub set: Vec<(String, String)>,
    /// Try those again that failed before.
    #[arg(long)]
    pub retry_failed: bool,
    /// Also write what becomes of each recording as JSON, a line each.
    #[arg(long, value_name = "FILE.jsonl")]
    pub rows: Option<PathBuf>,
    /// Print how many recordings are done as lines on standard error, with --json as JSON. The
    /// batch ends when these cannot be written.
    #[arg(long)]
    pub progress: bool,
    /// Also write both tables as Parquet.
    #[cfg(feature = "parquet")]
    #[arg(long)]
    pub parquet: bool,
}

fn shard(text: &str) -> Result<(usize, usize), String> {
    let parts = text.split_once('/').and_then(|(index, count)| Some((index.parse().ok()?, count.parse().ok()?)));
    match parts {
        Some((index, count)) if 1 <= index && index <= count => Ok((index, count)),
        _ => Err("has to be I/N with whole numbers, I from 1 to N, such as 3/8".to_owned()),
    }
}

fn pair(text: &str) -> Result<(String, String), String> {
    let pair = text.split_once('=').filter(|(name, _)| !name.is_empty());
    pair.map(|(name, value)| (name.to_owned(), value.to_owned())).ok_or_else(|| "has to be NAME=VALUE".to_owned())
}

impl BatchArgs {
    /// Name of a table of this run: of all recordings, or of its shard.
    fn named(&self, name: &str) -> String {
        match self.shard {
            Some((index, count)) => format!("{name}_{index}_of_{count}"),
            None => name.to_owned(),
        }
    }

    fn is_mine(&self, index: usize) -> bool {
        self.shard.is_none_or(|(mine, count)| index % count == mine - 1)
    }
}

/// Works on all recordings, then writes both tables.
///
/// # Errors
/// A manifest that cannot be used, a folder that cannot be written, a recording without a result,
/// or [`Interrupted`].
pub fn run(args: &BatchArgs, console: &Console) -> Result<()> {
    run_until(args, console, stop_flag()?)
}

/// Notes files of the folder that are no recordings, and how many recordings of another kind each
/// value of `--set` is not for.
fn note_left_out(console: &Console, skipped: usize, left_out: &BTreeMap<String, usize>) {
    if skipped > 0 {
        console.note(format!("skipped {skipped} of the folder's files: no reader of recordings knows them"));
    }
    for (name, count) in left_out {
        let of = if *count == 1 { "1 recording".to_owned() } else { format!("{count} recordings") };
        console.note(format!("--set {name}: left out for {of} of a kind that has no such option"));
    }
}

/// One more than there are processors: a recording that is done waits for the disk.
fn default_jobs() -> usize {
    1 + std::thread::available_parallelism().map_or(1, usize::from)
}

/// As [`run`], ended by `stop` in the place of a signal.
///
/// # Errors
/// As [`run`].
pub fn run_until(args: &BatchArgs, console: &Console, stop: &AtomicBool) -> Result<()> {
    let Manifest { rows, skipped } = manifest::read(&args.manifest, args.folder.as_deref())?;
    let all = rows.into_iter().enumerate();
    let mut rows: Vec<_> = all.filter(|(index, _)| args.is_mine(*index)).map(|(_, row)| row).collect();
    rows.iter_mut().for_each(|row| row.set(&args.set));
    ensure!(!rows.is_empty(), "--shard: the manifest has fewer recordings than shards; nothing is left for this one");
    chunk::make_folder(&args.out)?;
    let status = args.out.join(args.named("status") + ".csv");
    let _lock = OutputLock::of_table(&status, "batch")?;
    let store = Store::open(&args.out, &args.named("status"))?;
    let jobs = args.jobs.map_or_else(default_jobs, usize::from);
    let progress = Progress::new(rows.len(), console, args.progress)?;
    let plan = work::Plan { jobs, retry_failed: args.retry_failed };
    let work::Done { lines, left_out } = work::all(&rows, &store, plan, &progress, stop)?;
    progress.end();
    store.close();
    let summary = args.out.join(args.named("summary") + ".csv");
    tables::write(&lines, &status, &summary)?;
    if let Some(path) = &args.rows {
        tables::write_json_lines(&lines, path)?;
    }
    #[cfg(feature = "parquet")]
    if args.parquet {
        parquet::write(&lines, &status.with_extension("parquet"), &summary.with_extension("parquet"))?;
    }
    note_left_out(console, skipped, &left_out);
    let Counts { recordings, good, from_before, failed, open } = Counts::of(&lines);
    let text = format!(
        "{recordings} recordings: {good} with a result, {from_before} of these from before; {failed} failed, {open} open\n\
         wrote {} and {}\n",
        status.display(),
        summary.display()
    );
    let json = json!({
        "recordings": recordings,
        "good": good,
        "from_before": from_before,
        "failed": failed,
        "open": open,
        "skipped": skipped,
        "status": status,
        "summary": summary,
    });
    console.answer(&text, &json)?;
    let interrupted = || Interrupted {
        finished: recordings - open,
        all: Some(recordings),
        unit: "recordings",
        out: args.out.clone(),
    };
    ensure!(!stop.load(Ordering::Relaxed) || open == 0, interrupted());
    if failed > 0 {
        return Err(data_error(format!(
            "{failed} of {recordings} recordings have no result; `{}` says why; put them right, and give the same \
             command again (--retry-failed for those whose files stay as they are)",
            status.display()
        )));
    }
    Ok(())
}
