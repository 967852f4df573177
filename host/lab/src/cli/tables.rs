//! `sinew-lab tables`: the tables of the book, written and checked.

use crate::tables::{Cost, TABLES, Table, markdown, page};
use anyhow::{Context, Result, bail, ensure};
use clap::Args;
use serde_json::json;
use sinew::cli::console::Console;
use std::fs;
use std::path::{Path, PathBuf};
use std::time::Instant;

/// Options of `sinew-lab tables`.
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  sinew-lab tables
  sinew-lab tables arm-hands skin-scores
  sinew-lab tables --check --cheap")]
pub struct TablesArgs {
    /// Tables to write; without a choice all are listed.
    #[arg(value_name = "NAME", conflicts_with_all = ["cheap", "all"])]
    pub names: Vec<String>,
    /// Write those that take less than a minute each.
    #[arg(long, conflicts_with = "all")]
    pub cheap: bool,
    /// Write all that have a maker; this takes hours.
    #[arg(long)]
    pub all: bool,
    /// Write nothing, and fail where a table is not current.
    #[arg(long)]
    pub check: bool,
    /// Folder of the pages.
    #[arg(long, value_name = "DIR", default_value = "docs")]
    pub docs: PathBuf,
    /// Folder of the recordings.
    #[arg(long, value_name = "DIR", default_value = "../shared/data")]
    pub data: PathBuf,
}

/// Lists the tables, writes those that were chosen, or checks them.
///
/// # Errors
/// An unknown table; a page without its marks; recordings that are missing where `CI=true`; a
/// table that is not current.
pub fn run(args: &TablesArgs, console: &Console) -> Result<()> {
    let docs = &args.docs;
    ensure!(docs.is_dir(), "`{}` is no folder; run this in the project's root, or give --docs", docs.display());
    let chosen = chosen(args)?;
    if chosen.is_empty() {
        ensure!(!args.check, "--check needs a choice of tables: --cheap, --all or their names");
        return list(docs, console);
    }
    let (mut written, mut outdated) = (Vec::new(), Vec::new());
    for table in chosen {
        let Some(rows) = rows(table, &args.data, console)? else { continue };
        let path = docs.join(table.page);
        let text = fs::read_to_string(&path).with_context(|| path.display().to_string())?;
        let made = markdown::table(&rows);
        let current = page::is_current(&text, table.name, &made).with_context(|| path.display().to_string())?;
        if current {
            continue;
        }
        if args.check {
            console.note(format!("{} of {} should be:\n{made}", table.name, path.display()));
            outdated.push(table.name);
        } else {
            fs::write(&path, page::renewed(&text, table.name, &made)?).with_context(|| path.display().to_string())?;
            written.push(table.name);
        }
    }
    if !outdated.is_empty() {
        let names = outdated.join(" ");
        bail!("not current: {names}; `cargo run --release -p sinew-lab -- tables {names}` renews them");
    }
    let changed = if written.is_empty() { "none changed".to_owned() } else { written.join(", ") };
    console.answer(&format!("tables: {changed}\n"), &json!({ "written": written }))
}

fn chosen(args: &TablesArgs) -> Result<Vec<&'static Table>> {
    let named = |name: &String| {
        let found = TABLES.iter().find(|table| table.name == name);
        found.with_context(|| format!("`{name}` is no table that has a maker; `sinew-lab tables` lists them"))
    };
    if args.all || args.cheap {
        return Ok(TABLES.iter().filter(|table| args.all || table.cost == Cost::Cheap).collect());
    }
    args.names.iter().map(named).collect()
}

/// Makes a table; `None`, with a note, where its recordings are not there.
fn rows(table: &Table, data: &Path, console: &Console) -> Result<Option<markdown::Rows>> {
    if let Some(folder) = table.recordings.map(|part| data.join(part)).filter(|folder| !folder.is_dir()) {
        let is = |name: &str| std::env::var(name).is_ok_and(|value| value == "true");
        let (name, folder) = (table.name, folder.display());
        ensure!(!is("CI") || is("SINEW_WITHOUT_DATA"), "{name} needs the recordings of `{folder}`");
        console.note(format!("left out: {name}, which needs the recordings of `{folder}`"));
        return Ok(None);
    }
    let begun = Instant::now();
    let rows = console.busy(table.name, || (table.rows)(data)).with_context(|| table.name)?;
    console.note(format!("{}: {:.0} s", table.name, begun.elapsed().as_secs_f64()));
    Ok(Some(rows))
}

/// Every table of the pages with its cost, or that `sinew-lab reproduce` or somebody by hand
/// writes it.
fn list(docs: &Path, console: &Console) -> Result<()> {
    let mut pages: Vec<PathBuf> = fs::read_dir(docs)?.map(|entry| Ok(entry?.path())).collect::<Result<_>>()?;
    pages.retain(|path| path.extension().is_some_and(|extension| extension == "md"));
    pages.sort();
    let (mut text, mut listed) = (String::new(), Vec::new());
    for path in pages {
        let file = path.file_name().unwrap_or_default().to_string_lossy();
        for name in page::names(&fs::read_to_string(&path)?) {
            let maker = TABLES.iter().find(|table| table.name == name && table.page == file);
            let without = if name.starts_with("reproduce-") { "reproduce" } else { "by hand" };
            let cost = maker.map_or(without, |table| table.cost.name());
            text.push_str(&format!("{name:<22} {cost:<9} {}\n", path.display()));
            listed.push(json!({ "name": name, "page": path, "cost": cost }));
        }
    }
    console.answer(&text, &listed)
}
