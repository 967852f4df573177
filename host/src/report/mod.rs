//! One page about one run or several: what was run, its frames, plots and tables, in a file that
//! loads nothing.
//!
//! Each kind of run directory has a file that turns it into a [`document::Run`]; the page's own
//! script draws that.

pub mod arm;
pub mod arm_plots;
pub mod batch;
pub mod body;
pub mod body_plots;
pub mod cyclic;
pub mod cyclic_plots;
pub mod document;
pub mod evaluate;
pub mod facts;
pub mod folder;
pub mod kind;
pub mod other;
pub mod page;
pub mod pictures;
pub mod series;
pub mod table;

use crate::error::{Result, bail, ensure};
use document::{Document, FORMAT, Level, Notice, Run};
use folder::RunFolder;
use kind::Kind;
use pictures::{Encoded, Pictures};
use std::io::Write;
use std::path::Path;

/// A page before it is written.
#[derive(Debug)]
pub struct Page {
    document: Document,
    encoded: Encoded,
}

impl Page {
    /// Reads the run directories.
    ///
    /// # Errors
    /// A path that is no folder, or a folder that holds nothing of a run.
    pub fn read(folders: &[impl AsRef<Path>]) -> Result<Self> {
        let mut pictures = Pictures::default();
        let mut runs = Vec::new();
        for folder in folders {
            runs.push(read_run(folder.as_ref(), &mut pictures)?);
        }
        let encoded = pictures.encode()?;
        for run in &mut runs {
            tell_of_pictures(run, &encoded);
        }
        Ok(Self { document: Document { format: FORMAT, sinew_version: env!("CARGO_PKG_VERSION"), runs }, encoded })
    }

    /// The runs.
    #[must_use]
    pub fn runs(&self) -> &[Run] {
        &self.document.runs
    }

    /// Writes the page.
    ///
    /// # Errors
    /// What the writer refuses.
    pub fn write(&self, writer: &mut dyn Write) -> Result<()> {
        page::write_page(&self.document, &self.encoded.blocks, writer)
    }
}

fn read_run(path: &Path, pictures: &mut Pictures) -> Result<Run> {
    const REMEDY: &str = "give a folder that `sinew demo`, `sinew track`, `sinew batch` or `sinew evaluate` wrote";
    ensure!(path.is_dir(), "`{}` is no folder; {REMEDY}", path.display());
    let folder = RunFolder::new(path);
    match Kind::of(&folder) {
        Some(Kind::Arm) => Ok(arm::arm_run(folder, pictures)),
        Some(Kind::Body) => Ok(body::body_run(folder, pictures)),
        Some(Kind::Cyclic) => Ok(cyclic::cyclic_run(folder, pictures)),
        Some(Kind::EvaluateArm) => Ok(evaluate::evaluate_arm_run(folder)),
        Some(Kind::EvaluateBody) => Ok(evaluate::evaluate_body_run(folder)),
        Some(Kind::EvaluateCyclic) => Ok(evaluate::evaluate_cyclic_run(folder)),
        Some(Kind::Batch) => Ok(batch::batch_run(folder)),
        Some(Kind::Other) => Ok(other::other_run(folder, pictures)),
        None => bail!("`{}` holds nothing of a run; {REMEDY}", path.display()),
    }
}

/// Says which pictures are not on the page.
fn tell_of_pictures(run: &mut Run, encoded: &Encoded) {
    let own: Vec<String> = encoded.unreadable.iter().filter(|name| name.starts_with(&run.name)).cloned().collect();
    if !own.is_empty() {
        let text = format!("{} pictures cannot be read", own.len());
        run.notices.insert(0, Notice { level: Level::Missing, text, items: own });
    }
    let has_pictures = run.player.as_ref().is_some_and(|player| player.pictures.is_some());
    if encoded.every > 1 && has_pictures {
        let text = format!(
            "one picture of {} is shown, so that the page stays small; the numbers are all there",
            encoded.every
        );
        run.notices.push(Notice { level: Level::Note, text, items: Vec::new() });
    }
}
