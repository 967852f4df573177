//! The output for a person or a script: results on standard output, everything else on standard
//! error.

use super::interrupted;
use super::stdout::write_all;
use crate::output::Target;
use anyhow::Result;
use clap::Args;
use indicatif::{ProgressBar, ProgressStyle};
use serde::Serialize;
use std::borrow::Cow;
use std::fmt::Display;
use std::path::Path;
use std::time::Duration;

/// How often a spinner turns.
const TICK: Duration = Duration::from_millis(100);

/// The options that every subcommand has.
#[derive(Debug, Clone, Copy, Default, Args)]
#[command(next_help_heading = "Global options")]
pub struct Console {
    /// Print results and errors only: no notes, no progress bar.
    #[arg(long, short, global = true)]
    pub quiet: bool,
    /// Print results as JSON, for scripts.
    #[arg(long, global = true)]
    pub json: bool,
}

impl Console {
    /// The options that were given, for a program that has the same.
    pub fn flags(&self) -> impl Iterator<Item = &'static str> {
        [(self.quiet, "--quiet"), (self.json, "--json")].into_iter().filter_map(|(is_set, flag)| is_set.then_some(flag))
    }

    /// Tells on standard error what a user should know and a script need not, unless `--quiet` was
    /// given.
    pub fn note(&self, text: impl Display) {
        if !self.quiet {
            eprintln!("{}", printable(&text.to_string()));
        }
    }

    /// Prints a result: `text`, or with `--json` the same as one line of JSON. A reader that has
    /// gone away is no error.
    ///
    /// # Errors
    /// A failure of the operating system.
    pub fn answer(&self, text: &str, json: &impl Serialize) -> Result<()> {
        if self.json {
            let mut line = serde_json::to_vec(json)?;
            line.push(b'\n');
            return write_all(&line);
        }
        write_all(printable(text).as_bytes())
    }

    /// As [`Console::answer`], on standard error where results went to standard output.
    ///
    /// # Errors
    /// As [`Console::answer`].
    pub fn answer_beside(&self, out: &Path, text: &str, json: &impl Serialize) -> Result<()> {
        if Target::of(out)? != Target::Standard {
            return self.answer(text, json);
        }
        let line = if self.json { serde_json::to_string(json)? } else { text.trim_end().to_owned() };
        self.note(line);
        Ok(())
    }

    /// A progress bar on standard error; hidden where that is no terminal, and with `--quiet`.
    ///
    /// # Errors
    /// A `template` that indicatif does not know.
    pub fn bar(&self, length: u64, template: &str) -> Result<ProgressBar> {
        // `new` hides the bar by itself where standard error is no terminal.
        let bar = if self.quiet { ProgressBar::hidden() } else { ProgressBar::new(length) };
        bar.set_length(length);
        bar.set_style(ProgressStyle::with_template(template)?);
        Ok(bar)
    }

    /// Passes on how a run ended, and says where a signal ended it that it can be gone on with.
    ///
    /// # Errors
    /// That of the run.
    pub fn resumable<T>(&self, ended: Result<T>) -> Result<T> {
        ended.inspect_err(|error| {
            if interrupted(error).is_some() {
                self.note("the same command with --resume goes on from there");
            }
        })
    }

    /// Does what takes long and has no count, while standard error, if it is a terminal, shows
    /// `what` and for how long.
    ///
    /// # Errors
    /// As `work`.
    pub fn busy<T>(&self, what: &'static str, work: impl FnOnce() -> Result<T>) -> Result<T> {
        let spinner = if self.quiet { ProgressBar::hidden() } else { ProgressBar::new_spinner() };
        spinner.set_style(ProgressStyle::with_template("{spinner} {msg}, {elapsed}")?);
        spinner.set_message(what);
        spinner.enable_steady_tick(TICK);
        let done = work();
        spinner.finish_and_clear();
        done
    }
}

/// `text` with its control characters, but for line breaks and tabs, written as `\u{1b}`: names of
/// files cannot move the cursor or change the title of a terminal.
pub fn printable(text: &str) -> Cow<'_, str> {
    let is_harmful = |letter: char| letter.is_control() && !matches!(letter, '\n' | '\t');
    if !text.contains(is_harmful) {
        return Cow::Borrowed(text);
    }
    let mut shown = String::with_capacity(text.len());
    for letter in text.chars() {
        if is_harmful(letter) { shown.extend(letter.escape_unicode()) } else { shown.push(letter) }
    }
    Cow::Owned(shown)
}

#[cfg(test)]
mod tests {
    use super::printable;

    #[test]
    fn control_characters_are_written_out() {
        assert_eq!(printable("a `b.png`\n\tok é"), "a `b.png`\n\tok é");
        assert_eq!(printable("\u{1b}]0;x\u{7}\r\u{9b}1m"), "\\u{1b}]0;x\\u{7}\\u{d}\\u{9b}1m");
    }
}
