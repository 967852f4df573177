//! How deep every function of `sinew.h` goes into the stack, in the emulator, and how large the
//! objects are.
//!
//! The tables of `docs/firmware_memory.md` hold what was measured; a function may not go deeper by
//! more than a twentieth. `SINEW_REGENERATE=1` writes what it measures into the tables, and
//! `SINEW_ALL_TARGETS=1` measures all their columns.

use sinew_c_interface::{
    LEVELS, builds_with_debian, expect_success, has_target, has_tool, is_checked, static_library, workspace_root,
};
use sinew_core::cyclic::model::bytes::write;
use sinew_core::cyclic::model::walking::WALKING;
use std::collections::BTreeMap;
use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Bytes of stack that no call exceeds, and none that makes an object.
const MAX_BYTES: u32 = 8192;
const MAX_INIT_BYTES: u32 = 2048;
/// What a cell of the table may grow by: a twentieth, as the budgets of firmware.
const MAX_GROWTH: f64 = 1.05;
/// Bytes that may come on top: registers that a compiler saves, in calls that take almost nothing.
const GROWTH_BYTES: u32 = 32;
const PAGE: &str = "docs/firmware_memory.md";
const REGENERATE: &str = "SINEW_ALL_TARGETS=1 SINEW_REGENERATE=1 cargo test -p sinew-c-interface stack";

/// A processor, and a machine of QEMU that runs its instructions.
struct Processor {
    target: &'static str,
    compiler: &'static str,
    flags: &'static [&'static str],
    emulator: &'static str,
    machine: &'static [&'static str],
    flash: u32,
    ram: u32,
}

const PROCESSORS: [Processor; 3] = [
    Processor {
        target: "thumbv7em-none-eabihf",
        compiler: "arm-none-eabi-gcc",
        flags: &["-mcpu=cortex-m4", "-mthumb", "-mfloat-abi=hard", "-mfpu=fpv4-sp-d16"],
        emulator: "qemu-system-arm",
        machine: &["mps2-an386"],
        flash: 0,
        ram: 0x2000_0000,
    },
    Processor {
        target: "thumbv6m-none-eabi",
        compiler: "arm-none-eabi-gcc",
        flags: &["-mcpu=cortex-m0", "-mthumb"],
        // A Cortex-M3, which has all instructions of a Cortex-M0, and enough memory.
        emulator: "qemu-system-arm",
        machine: &["mps2-an385"],
        flash: 0,
        ram: 0x2000_0000,
    },
    Processor {
        target: "riscv32imc-unknown-none-elf",
        compiler: "riscv64-unknown-elf-gcc",
        flags: &["-march=rv32imc", "-mabi=ilp32", "-mcmodel=medany"],
        emulator: "qemu-system-riscv32",
        machine: &["virt", "-bios", "none"],
        flash: 0x8000_0000,
        ram: 0x8020_0000,
    },
];

/// Bytes by function, and by object.
type Measured = BTreeMap<String, u32>;

fn sources() -> PathBuf {
    workspace_root().join("tests/c_interface/stack")
}

/// The walking model as a model of one's own: `const uint32_t model[]`.
fn model_source() -> String {
    let mut bytes = vec![0; 64 * 1024];
    let count = write(&WALKING.model().unwrap(), &mut bytes).unwrap();
    let words = bytes[..count].as_chunks::<4>().0.iter().map(|word| format!("{:#x},", u32::from_le_bytes(*word)));
    let words: String = words.collect();
    format!(
        "#include <stddef.h>\n#include <stdint.h>\nextern const uint32_t model[];\nextern const size_t model_bytes;\n\
         const uint32_t model[] = {{{words}}};\nconst size_t model_bytes = sizeof model;\n"
    )
}

fn link(processor: &Processor, library: &Path, folder: &Path) -> PathBuf {
    let Processor { flash, ram, .. } = processor;
    let (program, memory, model) = (folder.join("program"), folder.join("memory.ld"), folder.join("model.c"));
    let regions =
        format!("FLASH (rx) : ORIGIN = {flash:#x}, LENGTH = 1M\nRAM (rwx) : ORIGIN = {ram:#x}, LENGTH = 512K\n");
    fs::write(&memory, format!("MEMORY {{\n{regions}}}\nENTRY(start)\n")).unwrap();
    fs::write(&model, model_source()).unwrap();
    let mut command = Command::new(processor.compiler);
    command.args(processor.flags);
    command.args(["-std=c11", "-O2", "-ffreestanding", "-Wall", "-Wextra", "-Werror", "-nostdlib"]);
    command.args(["-Wl,--gc-sections", "-T"]).arg(&memory).arg("-T").arg(sources().join("program.ld"));
    command.arg("-I").arg(workspace_root().join("core/include"));
    command.args(["calls.c", "frames.c", "machine.c"].map(|source| sources().join(source)));
    expect_success(command.arg(&model).arg(library).arg("-lgcc").arg("-o").arg(&program));
    program
}

/// What every call takes; `None` where a tool is missing.
fn measure(processor: &Processor, level: &str) -> Option<Measured> {
    let tools = [processor.compiler, processor.emulator, "timeout"];
    if !(tools.into_iter().all(has_tool) && has_target(processor.target)) {
        return None;
    }
    let library = static_library("sinew-core", Some(processor.target), level, "c-api,walking-model,prove-no-panic");
    let folder = tempfile::tempdir().unwrap();
    let program = link(processor, &library, folder.path());
    let mut emulator = Command::new("timeout");
    emulator.args(["240", processor.emulator, "-machine"]).args(processor.machine).args(["-nographic", "-monitor"]);
    emulator.args(["none", "-serial", "none", "-semihosting-config", "enable=on,target=native", "-kernel"]);
    let output = expect_success(emulator.arg(&program));
    let text = String::from_utf8(output.stdout).unwrap();
    let line = |line: &str| {
        let (name, bytes) = line.rsplit_once(' ').expect("a name and a number");
        (name.trim().to_owned(), bytes.parse().expect("a number"))
    };
    Some(text.lines().map(line).collect())
}

/// Names of all functions that the header declares.
fn declared_functions() -> Vec<String> {
    let header = fs::read_to_string(workspace_root().join("core/include/sinew.h")).unwrap();
    let declared = header.split("sinew_").skip(1).filter_map(|rest| {
        let end = rest.find(|c: char| !(c.is_ascii_lowercase() || c == '_'))?;
        rest[end..].starts_with('(').then(|| format!("sinew_{}", &rest[..end]))
    });
    // That one is the caller's.
    declared.filter(|name| name != "sinew_on_panic").collect()
}

fn check_limits(column: &str, measured: &Measured) {
    for function in declared_functions() {
        let bytes = *measured.get(&function).unwrap_or_else(|| panic!("{column}: {function} was not called"));
        let limit = match function.as_str() {
            _ if function.ends_with("_init") => MAX_INIT_BYTES,
            _ => MAX_BYTES,
        };
        assert!(bytes <= limit, "{column}: {function} takes {bytes} bytes of stack, more than {limit}");
    }
}

/// Cells of the page's table `name`: by row and column.
fn read_table(page: &str, name: &str) -> BTreeMap<(String, String), u32> {
    let mut cells = BTreeMap::new();
    let Some((_, rest)) = page.split_once(&format!("<!-- {name} -->\n")) else { return cells };
    let rows = rest.lines().take_while(|line| !line.starts_with("<!--")).filter(|line| line.starts_with('|'));
    let rows: Vec<Vec<&str>> = rows.map(|row| row.trim_matches('|').split('|').map(str::trim).collect()).collect();
    for row in rows.iter().skip(2) {
        for (column, cell) in rows[0].iter().zip(row).skip(1) {
            if let Ok(bytes) = cell.parse() {
                cells.insert((row[0].trim_matches('`').to_owned(), (*column).to_owned()), bytes);
            }
        }
    }
    cells
}

fn write_table(page: &str, name: &str, first: &str, cells: &BTreeMap<(String, String), u32>) -> String {
    let mut columns: Vec<&String> = cells.keys().map(|(_, column)| column).collect();
    columns.sort_by_key(|column| {
        (PROCESSORS.iter().position(|one| one.target.starts_with(&column[..8])), column.to_owned())
    });
    columns.dedup();
    let mut rows: Vec<&String> = cells.keys().map(|(row, _)| row).collect();
    rows.dedup();
    let mut text = format!("\n| {first} |");
    columns.iter().for_each(|column| write!(text, " {column} |").unwrap());
    write!(text, "\n|---|{}", "---:|".repeat(columns.len())).unwrap();
    for row in rows {
        write!(text, "\n| `{row}` |").unwrap();
        for &column in &columns {
            let cell = cells.get(&(row.clone(), column.clone())).map_or("-".into(), u32::to_string);
            write!(text, " {cell} |").unwrap();
        }
    }
    let (begin, end) = (format!("<!-- {name} -->\n"), format!("\n<!-- end of {name} -->"));
    let (before, rest) = page.split_once(&begin).unwrap_or_else(|| panic!("{PAGE} has no {begin}"));
    let (_, after) = rest.split_once(&end).unwrap_or_else(|| panic!("{PAGE} has no {end}"));
    format!("{before}{begin}{text}\n{end}{after}")
}

/// Compares what was measured with the page's tables, or writes it there. Functions that take
/// almost nothing have no row.
fn check_page(measured: &[(String, String, Measured)]) {
    const FEW_BYTES: u32 = 256;
    let path = workspace_root().join(PAGE);
    let mut page = fs::read_to_string(&path).unwrap();
    let (mut stack, mut memory) = (read_table(&page, "stack"), read_table(&page, "objects"));
    let regenerates = std::env::var_os("SINEW_REGENERATE").is_some();
    for (target, level, bytes_of) in measured {
        let short_name = target.split('-').next().expect("a triple has a first part");
        for (name, &bytes) in bytes_of {
            let is_function = name.starts_with("sinew_");
            let column = if is_function { format!("{short_name} {level}") } else { short_name.to_owned() };
            let table = if is_function { &mut stack } else { &mut memory };
            let key = (name.clone(), column);
            if regenerates && !(is_function && bytes < FEW_BYTES) {
                table.insert(key, bytes);
                continue;
            }
            let stated = table.get(&key).copied().unwrap_or(if is_function { FEW_BYTES } else { 0 });
            let most = (f64::from(stated) * MAX_GROWTH) as u32 + GROWTH_BYTES;
            assert!(
                builds_with_debian() || if is_function { bytes <= most } else { bytes == stated },
                "{PAGE}: {name} takes {bytes} bytes on {target} at {level}, and {stated} are stated; {REGENERATE}"
            );
        }
    }
    if regenerates {
        page = write_table(&page, "stack", "function", &stack);
        page = write_table(&page, "objects", "object", &memory);
        fs::write(&path, page).unwrap();
    }
}

#[test]
fn every_call_keeps_within_its_stack() {
    let mut measured = Vec::new();
    for processor in &PROCESSORS {
        for level in LEVELS.into_iter().filter(|level| is_checked(processor.target, level)) {
            if let Some(bytes) = measure(processor, level) {
                check_limits(&format!("{} at {level}", processor.target), &bytes);
                measured.push((processor.target.to_owned(), level.to_owned(), bytes));
            }
        }
    }
    check_page(&measured);
}
