//! What every image costs, as a table that is committed and compared.

use crate::build;
use crate::emulator::Machine;
use crate::expected::{self, Expected};
use crate::run::run;
use anyhow::{Context, Result, bail, ensure};
use defmt_decoder::Table;
use object::{Object, ObjectSection, SectionFlags};
use sinew_firmware_sim::port::Part;
use std::collections::BTreeMap;
use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// A cell may grow by this part before the check fails.
const GROWTH: f64 = 0.05;
/// What a cell may come to at all: by this much a processor of 168 MHz is busy for a third of the
/// time at 15 frames a second.
const LIMITS: [(&str, u64); 18] = [
    ("cyclic cyclic step, worst", 120_000),
    ("cyclic, static RAM, bytes", 4 * 1024 + 256),
    ("cyclic, stack, bytes", 8 * 1024),
    ("arm arm step, worst", 1_500_000),
    ("arm, static RAM, bytes", 16 * 1024),
    ("arm, stack, bytes", 8 * 1024),
    ("camera, static RAM, bytes", 44 * 1024),
    ("camera, stack, bytes", 8 * 1024),
    ("camera front end, worst", 1_600_000),
    ("camera arm step, worst", 1_500_000),
    ("camera, flash, bytes", 180_000),
    ("cyclic, flash, bytes", 90_000),
    ("particles particle step, worst", 2_600_000),
    ("particles, static RAM, bytes", 36 * 1024),
    ("particles, stack, bytes", 8 * 1024),
    ("body body step, worst", 10_500_000),
    ("body, static RAM, bytes", 24 * 1024),
    ("body, stack, bytes", 14 * 1024),
];
/// Lines of docs/firmware.md between which the table stands.
const MARKS: [&str; 2] = ["<!-- budget -->", "<!-- end of budget -->"];

/// Sizes of one image, bytes, and what its parts cost.
#[derive(Debug, Clone)]
struct Row {
    image: String,
    flash: u64,
    ram: u64,
    stack: u64,
    parts: Vec<(Part, u64, u64)>,
}

/// The table as it is written.
#[derive(Debug, Clone)]
pub struct Budget {
    compiler: String,
    rows: Vec<Row>,
}

impl Budget {
    /// Runs all images that answer with records, on the Cortex-M4F.
    ///
    /// # Errors
    /// Those of [`run`].
    pub fn measure() -> Result<Self> {
        let mut rows = Vec::new();
        for (image, expected) in expected::all()? {
            if matches!(expected, Expected::Records(_)) {
                rows.push(row(&image)?);
            }
        }
        Ok(Self { compiler: compiler()?, rows })
    }

    /// The tables in Markdown.
    #[must_use]
    pub fn to_markdown(&self) -> String {
        let mut text = format!(
            "Cortex-M4F, release, {}; made by `cargo run --release -p sinew-firmware-run -- budget`.\n\n\
             | image | flash, bytes | static RAM, bytes | stack, bytes |\n|---|---:|---:|---:|\n",
            self.compiler
        );
        // Writing to a string cannot fail.
        for row in &self.rows {
            let _ = writeln!(text, "| {} | {} | {} | {} |", row.image, row.flash, row.ram, row.stack);
        }
        text.push_str("\n| image | part | instructions a frame, mean | worst |\n|---|---|---:|---:|\n");
        for row in &self.rows {
            for (part, mean, worst) in &row.parts {
                let _ = writeln!(text, "| {} | {} | {mean} | {worst} |", row.image, part.name());
            }
        }
        text
    }

    /// Writes the table into docs/firmware.md.
    ///
    /// # Errors
    /// The page has no place for it, or cannot be written.
    pub fn write(&self) -> Result<()> {
        let page = fs::read_to_string(page())?;
        let (before, _, after) = parts(&page)?;
        fs::write(self::page(), format!("{before}{}\n\n{}\n{}{after}", MARKS[0], self.to_markdown(), MARKS[1]))?;
        Ok(())
    }

    /// Compares with the limits.
    fn check_limits(&self) -> Result<()> {
        let found = cells(&self.to_markdown());
        for (name, limit) in LIMITS {
            let value = found.get(name).with_context(|| format!("no image has `{name}`"))?;
            ensure!(*value <= limit, "{name}: {value}, but at most {limit}");
        }
        Ok(())
    }

    /// Compares with the table in docs/firmware.md.
    ///
    /// # Errors
    /// Names every cell that grew by more than a twentieth, and every one that the table lacks.
    pub fn check(&self) -> Result<String> {
        self.check_limits()?;
        let page = fs::read_to_string(page())?;
        let (_, table, _) = parts(&page)?;
        if !table.contains(&self.compiler) {
            return Ok(format!("the table is of another compiler than {}: not compared", self.compiler));
        }
        let (wanted, found) = (cells(table), cells(&self.to_markdown()));
        ensure!(
            wanted.keys().eq(found.keys()),
            "the table in docs/firmware.md has other rows; `sinew-firmware-run budget` writes it anew"
        );
        let mut grown = String::new();
        for (name, (&value, &limit)) in found.iter().map(|(name, value)| (name, (value, &wanted[name]))) {
            if value as f64 > limit as f64 * (1.0 + GROWTH) {
                let _ = writeln!(grown, "  {name}: {value} in place of {limit}");
            }
        }
        if !grown.is_empty() {
            bail!(
                "grown by more than 5 %:\n{grown}after a wanted change: `sinew-firmware-run budget` writes the table anew"
            );
        }
        Ok(format!("{} cells are within 5 % of the table in docs/firmware.md", found.len()))
    }
}

fn page() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/firmware.md")
}

/// What stands before the marks, between them, and behind them.
fn parts(page: &str) -> Result<(&str, &str, &str)> {
    let cut = page.split_once(MARKS[0]).and_then(|(before, rest)| {
        let (table, after) = rest.split_once(MARKS[1])?;
        Some((before, table, after))
    });
    cut.with_context(|| format!("docs/firmware.md has to hold the lines `{}` and `{}`", MARKS[0], MARKS[1]))
}

/// Cells with a number, by the names of row and column.
fn cells(markdown: &str) -> BTreeMap<String, u64> {
    let mut header: Vec<&str> = Vec::new();
    let mut cells = BTreeMap::new();
    for line in markdown.lines() {
        let row: Vec<&str> = line.trim_matches('|').split('|').map(str::trim).collect();
        if !line.starts_with('|') {
            continue;
        }
        let numbers: Vec<(usize, u64)> =
            row.iter().enumerate().filter_map(|(column, cell)| Some((column, cell.parse().ok()?))).collect();
        if row.first() == Some(&"image") {
            header = row;
            continue;
        }
        let name: Vec<&str> = row.iter().copied().filter(|cell| cell.parse::<u64>().is_err()).collect();
        for (column, value) in numbers {
            cells.insert(format!("{}, {}", name.join(" "), header.get(column).unwrap_or(&"")), value);
        }
    }
    cells
}

fn row(image: &str) -> Result<Row> {
    let path = build::image_path(image);
    let ended = run(&path, Machine::M4)?;
    let elf = fs::read(&path)?;
    ensure!(Table::parse(&elf)?.is_some(), "`{image}` logs nothing; the table is for images that log");
    let (flash, ram) = sizes(&elf)?;
    let mut row = Row { image: image.to_owned(), flash, ram, stack: 0, parts: Vec::new() };
    for (part, cost) in ended.costs {
        if part == Part::Stack {
            row.stack = u64::from(cost.worst);
        } else {
            row.parts.push((part, cost.total / u64::from(cost.frames.max(1)), u64::from(cost.worst)));
        }
    }
    Ok(row)
}

/// Bytes of flash and of static RAM.
fn sizes(elf: &[u8]) -> Result<(u64, u64)> {
    const WRITTEN: u64 = object::elf::SHF_WRITE as u64;
    const LOADED: u64 = object::elf::SHF_ALLOC as u64;
    let (mut flash, mut ram) = (0, 0);
    for section in object::File::parse(elf)?.sections() {
        let SectionFlags::Elf { sh_flags } = section.flags() else { continue };
        if sh_flags & LOADED == 0 {
            continue;
        }
        if section.file_range().is_some() {
            flash += section.size();
        }
        if sh_flags & WRITTEN != 0 {
            ram += section.size();
        }
    }
    Ok((flash, ram))
}

/// Name and version of the compiler of the images.
fn compiler() -> Result<String> {
    let rustc = std::env::var("RUSTC").unwrap_or_else(|_| "rustc".to_owned());
    let output = Command::new(&rustc).arg("--version").output().with_context(|| format!("`{rustc}` cannot be run"))?;
    Ok(String::from_utf8_lossy(&output.stdout).trim().to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_found_by_row_and_column() {
        let budget = Budget {
            compiler: "rustc 1".to_owned(),
            rows: vec![Row {
                image: "cyclic".to_owned(),
                flash: 1000,
                ram: 20,
                stack: 3,
                parts: vec![(Part::CyclicStep, 7, 9)],
            }],
        };
        let cells = cells(&budget.to_markdown());
        assert_eq!(cells.len(), 5);
        assert_eq!(cells["cyclic, flash, bytes"], 1000);
        assert_eq!(cells["cyclic cyclic step, worst"], 9);
    }

    #[test]
    fn the_page_has_a_place_for_the_table() {
        let text = fs::read_to_string(page()).unwrap();
        assert!(cells(parts(&text).unwrap().1).len() > 10);
    }
}
