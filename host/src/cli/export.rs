//! `sinew export`: a motion model as firmware reads it.

use super::console::Console;
use super::data_error;
use crate::cyclic::CyclicModel;
use crate::cyclic::model_file::MODEL_VALUE;
use crate::output::{check_writable_file, write_atomically};
use anyhow::{Result, ensure};
use clap::{Args, ValueEnum};
use serde_json::json;
use sinew_core::skeleton::stick_figure::HUMAN_ANGLES;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

/// Options of `sinew export`.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  sinew export walking --form coupled-c --out walking_model.c")]
pub struct ExportArgs {
    /// The motion model.
    #[arg(value_name = MODEL_VALUE)]
    pub model: String,
    /// How it is written.
    #[arg(long, value_enum, default_value_t)]
    pub form: ModelForm,
    /// File to write.
    #[arg(long, value_name = "FILE")]
    pub out: PathBuf,
}

/// How a model is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, ValueEnum)]
pub enum ModelForm {
    /// Its bytes, for `include_bytes!` or a place in flash of their own.
    #[default]
    Bytes,
    /// A C source with an array of words that is named as the file.
    C,
    /// The bytes that the coupled filter reads: a ninth.
    CoupledBytes,
    /// Those as a C source.
    CoupledC,
}

impl ModelForm {
    const fn is_source(self) -> bool {
        matches!(self, Self::C | Self::CoupledC)
    }

    fn bytes_of(self, model: &CyclicModel) -> Option<Vec<u8>> {
        match self {
            Self::Bytes | Self::C => model.to_bytes(),
            Self::CoupledBytes | Self::CoupledC => model.to_coupled_bytes(),
        }
    }
}

/// Writes the model.
///
/// # Errors
/// No such model, one that firmware cannot use, an output that cannot be written.
pub fn run(args: &ExportArgs, console: &Console) -> Result<()> {
    check_writable_file(&args.out)?;
    let model = CyclicModel::from_option(&args.model)?;
    let angles = model.view().angle_count();
    if angles > HUMAN_ANGLES {
        return Err(data_error(format!(
            "`{}` has {angles} angles, two a joint; firmware takes {HUMAN_ANGLES} at most: train it on tables of one angle a joint",
            args.model
        )));
    }
    let bytes = args
        .form
        .bytes_of(&model)
        .ok_or_else(|| data_error(format!("`{}` says nothing of how people differ; train it anew", args.model)))?;
    let text =
        args.form.is_source().then(|| Ok::<_, anyhow::Error>(c_source(&array_name(&args.out)?, &bytes))).transpose()?;
    let written = text.as_ref().map_or(bytes.as_slice(), |text| text.as_bytes());
    write_atomically(&args.out, |writer| Ok(writer.write_all(written)?))?;
    let report = format!(
        "motion model of {} positions and {angles} angles: {} bytes of flash, in `{}`\n",
        model.view().position_count(),
        bytes.len(),
        args.out.display()
    );
    let json = json!({
        "positions": model.view().position_count(),
        "angles": angles,
        "bytes": bytes.len(),
        "out": args.out,
    });
    console.answer_beside(&args.out, &report, &json)
}

/// Words of C and C++ that name nothing, and the types of `stdint.h` that the source uses.
///
/// Chosen: the keywords of C23 and C++20 without those that begin with an underscore and a capital.
const RESERVED: &str = "\
    alignas alignof and and_eq asm auto bitand bitor bool break case catch char char16_t \
    char32_t char8_t class co_await co_return co_yield compl concept const const_cast consteval \
    constexpr constinit continue decltype default delete do double dynamic_cast else enum \
    explicit export extern false float for friend goto if inline int long mutable namespace new \
    noexcept not not_eq nullptr operator or or_eq private protected public register \
    reinterpret_cast requires restrict return short signed sizeof static static_assert \
    static_cast struct switch template this thread_local throw true try typedef typeid typename \
    typeof typeof_unqual uint32_t union unsigned using virtual void volatile wchar_t while xor \
    xor_eq";

/// The file's name without its ending, which has to be a name in C.
fn array_name(out: &Path) -> Result<String> {
    let name = out.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let is_name =
        name.chars().all(|c| c == '_' || c.is_ascii_alphanumeric()) && !name.starts_with(|c: char| c.is_ascii_digit());
    ensure!(
        is_name && !name.is_empty() && !RESERVED.split(' ').any(|word| word == name),
        "`{name}` cannot name an array in C; give `--out` a file name of letters, digits and underscores that is no word of the language, such as running_model.c"
    );
    Ok(name)
}

/// The bytes as an array of words, which lies at a multiple of four as `sinew_cyclic_init` asks
/// for.
fn c_source(name: &str, bytes: &[u8]) -> String {
    let words = bytes.as_chunks::<4>().0;
    let mut text = format!(
        "/* A motion model for sinew_cyclic_init, for little-endian processors; made by `sinew export`. */\n\n\
         #include <stdint.h>\n\nextern const uint32_t {name}[{count}];\n\nconst uint32_t {name}[{count}] = {{\n",
        count = words.len()
    );
    for line in words.chunks(8) {
        let line: Vec<String> = line.iter().map(|word| format!("0x{:08x}", u32::from_le_bytes(*word))).collect();
        // Writing to a string cannot fail.
        let _ = writeln!(text, "    {},", line.join(", "));
    }
    text + "};\n"
}
