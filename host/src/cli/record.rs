//! `sinew record`: the input of a run as a stream for firmware.

use super::console::Console;
use crate::output::{check_writable_file, write_atomically};
use crate::record::{self, Form};
use anyhow::Result;
use clap::Args;
use serde_json::json;
use std::path::PathBuf;

/// Options of `sinew record`.
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  sinew simulate arm --motion builtin --frames 20 --out scene
  sinew track arm scene/frames --config scene/camera.toml --out run
  sinew record run --out arm.stream")]
pub struct RecordArgs {
    /// Folder of a run: of `sinew track arm` or `sinew demo`, or the report of `sinew track
    /// cyclic`.
    #[arg(value_name = "RUN_DIR")]
    pub run: PathBuf,
    /// What is recorded.
    #[arg(long, value_enum, default_value_t)]
    pub form: Form,
    /// Stream of records to write: what the tracker was given, bit for bit.
    #[arg(long, value_name = "FILE")]
    pub out: PathBuf,
}

/// Writes the stream.
///
/// # Errors
/// A folder that holds no run that firmware can play, an output that cannot be written.
pub fn run(args: &RecordArgs, console: &Console) -> Result<()> {
    check_writable_file(&args.out)?;
    let recorded = record::record(&args.run, args.form)?;
    write_atomically(&args.out, |writer| Ok(writer.write_all(&recorded.bytes)?))?;
    let bytes = recorded.bytes.len();
    let text = format!("{}: {bytes} bytes in `{}`\n", recorded.what, args.out.display());
    console.answer_beside(&args.out, &text, &json!({ "what": recorded.what, "bytes": bytes, "out": args.out }))
}
