//! `sinew completions` and `sinew man`: what a shell and `man` know about the command.

use super::Cli;
use super::console::Console;
use crate::output::OutputDir;
use anyhow::Result;
use clap::{Args, CommandFactory};
use clap_complete::Shell;
use serde_json::json;
use std::path::PathBuf;

/// Options of `sinew completions`.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  sinew completions bash > sinew.bash")]
pub struct CompletionsArgs {
    /// The shell.
    #[arg(value_enum)]
    pub shell: Shell,
}

/// Options of `sinew man`.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  sinew man --out man1")]
pub struct ManArgs {
    /// Folder for sinew.1 and a page for each command.
    #[arg(long, value_name = "DIR")]
    pub out: PathBuf,
}

/// Prints the shell's script.
///
/// # Errors
/// Standard output that cannot be written.
pub fn completions(args: &CompletionsArgs, console: &Console) -> Result<()> {
    let mut script = Vec::new();
    clap_complete::generate(args.shell, &mut Cli::command(), "sinew", &mut script);
    let script = String::from_utf8(script)?;
    console.answer(&script, &json!({ "shell": args.shell.to_string(), "script": script }))
}

/// Writes the manual pages.
///
/// # Errors
/// A folder that cannot be written.
pub fn man(args: &ManArgs, console: &Console) -> Result<()> {
    let output = OutputDir::create(&args.out)?;
    let mut root = Cli::command();
    root.build();
    let mut pages = vec![root];
    let mut count = 0;
    while let Some(command) = pages.pop() {
        let name = command.get_display_name().unwrap_or(command.get_name()).replace(' ', "-");
        let below = command.get_subcommands().filter(|below| below.get_name() != "help" && !below.is_hide_set());
        pages.extend(below.cloned());
        output.write(format!("{name}.1"), |writer| {
            let mut page = Vec::new();
            clap_mangen::Man::new(command.clone()).render(&mut page)?;
            Ok(writer.write_all(&page)?)
        })?;
        count += 1;
    }
    let text = format!("{count} manual pages: {}\n", args.out.display());
    console.answer(&text, &json!({ "pages": count, "out": args.out }))
}
