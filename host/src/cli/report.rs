//! `sinew report`: one page about one run or several.

use super::console::Console;
use crate::output::{check_writable_file, write_atomically};
use crate::report::Page;
use anyhow::{Context, Result, ensure};
use clap::Args;
use serde_json::json;
use std::path::PathBuf;

/// Options of `sinew report`.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  sinew demo --out run\n  sinew report run --out run.html")]
pub struct ReportArgs {
    /// Folders that `sinew demo`, `sinew track`, `sinew batch` or `sinew evaluate` wrote; several
    /// stand side by side. Of `sinew track cyclic` it is the folder of --report.
    #[arg(value_name = "RUN_DIR", required = true)]
    pub runs: Vec<PathBuf>,
    /// The page: one file that loads nothing, for any browser.
    #[arg(long, value_name = "FILE.html")]
    pub out: PathBuf,
}

/// Reads the folders and writes the page.
///
/// # Errors
/// A path that is no folder, a folder that holds nothing of a run, or an output that cannot be
/// written.
pub fn run(args: &ReportArgs, console: &Console) -> Result<()> {
    let is_page = args
        .out
        .extension()
        .is_some_and(|extension| ["html", "htm"].iter().any(|end| extension.eq_ignore_ascii_case(end)));
    ensure!(is_page, "`--out {}` has to end in .html, so that browsers open it", args.out.display());
    check_writable_file(&args.out)?;
    let page = Page::read(&args.runs)?;
    write_atomically(&args.out, |writer| page.write(writer))?;
    let bytes =
        std::fs::metadata(&args.out).with_context(|| format!("`{}` cannot be read back", args.out.display()))?.len();
    let (mut text, mut runs) = (String::new(), Vec::new());
    for run in page.runs() {
        let notices = match run.notices.len() {
            0 => String::new(),
            1 => ", 1 notice".to_owned(),
            count => format!(", {count} notices"),
        };
        text.push_str(&format!(
            "{} ({}): {} plots, {} tables{notices}\n",
            run.name,
            run.kind,
            run.plots.len(),
            run.tables.len()
        ));
        runs.push(json!({
            "name": run.name,
            "kind": run.kind.to_string(),
            "plots": run.plots.len(),
            "tables": run.tables.len(),
            "notices": run.notices.len(),
        }));
    }
    text.push_str(&format!("page of {:.1} MB: {}\n", bytes as f64 / 1.0e6, args.out.display()));
    console.answer_beside(&args.out, &text, &json!({ "runs": runs, "bytes": bytes, "out": args.out }))
}
