//! `sinew batch`: a list of recordings, each tracked once, in one process.

mod content;
mod job;
mod manifest;
mod store;
mod tables;
mod work;

use super::console::Console;
use super::data_error;
use super::signals::stop_flag;
use crate::output::{OutputLock, write_atomically};
use crate::resume::Interrupted;
use anyhow::{Result, bail, ensure};
use clap::Args;
use serde_json::json;
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, Ordering};
use store::Store;
use tables::{Line, status_csv, summary_csv};

/// Options of `sinew batch`.
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  sinew simulate keypoints --out recordings/anna.csv
  sinew batch recordings --out runs")]
pub struct BatchArgs {
    /// Recordings: a folder, or a list with a row each, as CSV or JSON lines (.jsonl), with id,
    /// input (relative to the list), kind (recording, cyclic, angles, arm, body) and options named
    /// like the flags.
    #[arg(value_name = "MANIFEST|FOLDER")]
    pub manifest: PathBuf,
    /// Folder of all results: results/KEY, status.csv, summary.csv.
    #[arg(long, value_name = "DIR")]
    pub out: PathBuf,
    /// Recordings that are worked on at once [default: the number of processors].
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub jobs: Option<u16>,
    /// Only every N-th recording, beginning with the I-th, 1 to N: for arrays of a scheduler. The
    /// tables get the shard's name.
    #[arg(long, value_name = "I/N", value_parser = shard)]
    pub shard: Option<(usize, usize)>,
    /// An option of all recordings whose row has none: `model=running`, `online=true`.
    #[arg(long, value_name = "NAME=VALUE", value_parser = pair)]
    pub set: Vec<(String, String)>,
    /// Try those again that failed before.
    #[arg(long)]
    pub retry_failed: bool,
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

/// As [`run`], ended by `stop` in the place of a signal.
///
/// # Errors
/// As [`run`].
pub fn run_until(args: &BatchArgs, console: &Console, stop: &AtomicBool) -> Result<()> {
    let all = manifest::read(&args.manifest)?.into_iter().enumerate();
    let mut rows: Vec<_> = all.filter(|(index, _)| args.is_mine(*index)).map(|(_, row)| row).collect();
    for row in &mut rows {
        for (name, value) in &args.set {
            row.options.entry(name.clone()).or_insert_with(|| value.clone());
        }
    }
    ensure!(!rows.is_empty(), "--shard: the manifest has fewer recordings than shards; nothing is left for this one");
    std::fs::create_dir_all(&args.out)
        .or_else(|error| bail!("`{}` cannot be made ({error}); choose another --out", args.out.display()))?;
    let status = args.out.join(args.named("status") + ".csv");
    let _lock = OutputLock::of_table(&status, "batch")?;
    let store = Store::open(&args.out, &args.named("status"))?;
    let jobs = args.jobs.map_or_else(|| std::thread::available_parallelism().map_or(1, usize::from), usize::from);
    let done = work::all(&rows, &store, work::Plan { jobs, retry_failed: args.retry_failed }, console, stop)?;
    store.close();
    let summary = args.out.join(args.named("summary") + ".csv");
    let tables = [(&status, status_csv(&done.lines)?), (&summary, summary_csv(&done.lines)?)];
    for (path, text) in tables {
        write_atomically(path, |file| Ok(file.write_all(text.as_bytes())?))?;
    }
    let count = |is: fn(&Line) -> bool| done.lines.iter().filter(|line| is(line)).count();
    let failed = count(|line| line.ended.as_ref().is_some_and(|ended| ended.failure.is_some()));
    let open = count(|line| line.ended.is_none());
    let good = done.lines.len() - failed - open;
    let text = format!(
        "{} recordings: {good} with a result, {} of these from before; {failed} failed, {open} open\nwrote {} and {}\n",
        done.lines.len(),
        done.from_before,
        status.display(),
        summary.display()
    );
    let json = json!({
        "recordings": done.lines.len(),
        "good": good,
        "from_before": done.from_before,
        "failed": failed,
        "open": open,
        "status": status,
        "summary": summary,
    });
    console.answer(&text, &json)?;
    let finished = done.lines.len() - open;
    let interrupted =
        || Interrupted { finished, all: Some(done.lines.len()), unit: "recordings", out: args.out.clone() };
    ensure!(!stop.load(Ordering::Relaxed) || open == 0, interrupted());
    if failed > 0 {
        return Err(data_error(format!(
            "{failed} of {} recordings have no result; `{}` says why; put them right, and give the same command again (--retry-failed \
             for those whose files stay as they are)",
            done.lines.len(),
            status.display()
        )));
    }
    Ok(())
}
