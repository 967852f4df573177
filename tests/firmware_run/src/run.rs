//! One image: input made, emulated, log shown, answers compared.

use crate::emulator::{self, Machine};
use crate::expected::{self, Expected};
use crate::{inputs, log};
use anyhow::{Context, Result, bail, ensure};
use sinew_firmware_sim::port::Part;
use sinew_record::{Cost, RecordStream};
use std::fs;
use std::path::Path;

/// What a run reported besides its answers.
#[derive(Debug, Clone, Default)]
pub struct Told {
    /// What it printed.
    pub printed: String,
    /// Lines of its log.
    pub log: Vec<String>,
    /// What its parts cost.
    pub costs: Vec<(Part, Cost)>,
}

/// Runs the image at `path` and compares what it answers with what is expected of its file name.
///
/// # Errors
/// The emulator is missing, the image fails (or does not, where it has to), or answers differently.
pub fn run(path: &Path, machine: Machine) -> Result<Told> {
    let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let wanted = expected::of_image(&name)?;
    let elf = fs::read(path).with_context(|| format!("the image `{}` cannot be read", path.display()))?;
    let ended = emulator::run(path, machine, inputs::of_image(&name)?.as_deref())?;
    let reported = Told { log: log::decode(&elf, &ended.serial)?, costs: costs(&ended.costs)?, printed: ended.printed };
    let context = || format!("it printed:\n{}{}", reported.printed, reported.log.join("\n"));
    match &wanted {
        Expected::Failure(path) => {
            let reason = fs::read_to_string(path)?;
            ensure!(ended.code != Some(0), "`{name}` has to fail and did not; {}", context());
            ensure!(
                reported.printed.contains(reason.trim()),
                "`{name}` failed, but not by {}; {}",
                reason.trim(),
                context()
            );
            return Ok(reported);
        }
        _ if ended.code != Some(0) => bail!("`{name}` failed with {:?}; {}", ended.code, context()),
        Expected::Records(path) => {
            let results = ended.results.with_context(|| format!("`{name}` wrote no results"))?;
            expected::compare_records(&results, path)?;
        }
        Expected::Text(path) if expected::regenerates() => fs::write(path, &reported.printed)?,
        Expected::Text(path) => {
            let text = fs::read_to_string(path)?;
            ensure!(reported.printed == text, "`{name}` printed other than `{}`; {}", path.display(), context());
        }
    }
    Ok(reported)
}

fn costs(bytes: &[u8]) -> Result<Vec<(Part, Cost)>> {
    let mut stream = RecordStream::<_, 64>::new(bytes);
    let mut costs = Vec::new();
    while let Some(record) = stream.next_record() {
        // Costs come one by one, without an end mark.
        let Ok(record) = record else { break };
        let cost = record.read::<Cost>()?;
        let part = Part::ALL.into_iter().find(|part| *part as u16 == cost.part);
        costs.push((part.with_context(|| format!("there is no part {}", cost.part))?, cost));
    }
    Ok(costs)
}
