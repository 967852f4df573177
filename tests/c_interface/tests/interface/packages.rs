//! The archive of static libraries, and projects that use it or the sources: CMake, pkg-config, and
//! the glue for Zephyr and ESP-IDF with stand-ins for their builds.
//!
//! `SINEW_ALL_TARGETS=1` packs all libraries of `packaging/libraries.txt` and runs every one that
//! the emulator can.

use sinew_c_interface::{
    builds_with_debian, checks_all_targets, expect_success, has_target, has_tool, leaves_out_long_builds,
    workspace_root,
};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::LazyLock;

/// Those that are always packed: for this computer, and for a Cortex-M4F with each way of passing
/// floats that the emulator then runs; one that the component for ESP-IDF takes, but in the short
/// form.
const SHORT: [&str; 3] = ["x86_64", "thumbv7em-softfp", "riscv32imc"];
/// What the emulated Cortex-M4F runs, or for `thumbv8m.main` the Cortex-M33, and the flags that ask
/// for it.
const EMULATED: [(&str, &str); 7] = [
    ("thumbv7em-softfp", "-mcpu=cortex-m4 -mthumb -mfloat-abi=softfp -mfpu=fpv4-sp-d16"),
    ("thumbv7em-hard", "-mcpu=cortex-m4 -mthumb -mfloat-abi=hard -mfpu=fpv4-sp-d16"),
    ("thumbv7em-soft", "-mcpu=cortex-m4 -mthumb -mfloat-abi=soft"),
    ("thumbv6m", "-mcpu=cortex-m0 -mthumb -mfloat-abi=soft"),
    ("thumbv8m.main-soft", "-mcpu=cortex-m33 -mthumb -mfloat-abi=soft"),
    ("thumbv8m.main-softfp", "-mcpu=cortex-m33 -mthumb -mfloat-abi=softfp -mfpu=fpv5-sp-d16"),
    ("thumbv8m.main-hard", "-mcpu=cortex-m33 -mthumb -mfloat-abi=hard -mfpu=fpv5-sp-d16"),
];

/// Name and Rust target of each library of `packaging/libraries.txt`.
fn libraries() -> Vec<(String, String)> {
    let text = fs::read_to_string(workspace_root().join("packaging/libraries.txt")).unwrap();
    let lines = text.lines().filter(|line| !line.starts_with('#'));
    lines
        .map(|line| {
            let mut fields = line.split_whitespace().map(str::to_owned);
            (fields.next().expect("a name"), fields.next().expect("a target"))
        })
        .collect()
}

struct Archive {
    folder: tempfile::TempDir,
    names: Vec<String>,
}

impl Archive {
    /// The unpacked archive.
    fn root(&self) -> PathBuf {
        self.folder.path().join(concat!("unpacked/sinew-", env!("CARGO_PKG_VERSION")))
    }

    fn has(&self, name: &str) -> bool {
        self.names.iter().any(|packed| packed == name)
    }
}

/// The archive, made and unpacked elsewhere once for all tests.
static ARCHIVE: LazyLock<Archive> = LazyLock::new(|| {
    let folder = tempfile::tempdir().unwrap();
    let short = if leaves_out_long_builds() { &SHORT[..2] } else { &SHORT };
    let wanted = libraries().into_iter().filter(|(name, _)| checks_all_targets() || short.contains(&&**name));
    let names: Vec<String> = wanted.filter(|(_, target)| has_target(target)).map(|(name, _)| name).collect();
    let mut script = Command::new("bash");
    script.arg(workspace_root().join("packaging/archive")).arg("--out").arg(folder.path().join("packed"));
    script.arg("--libraries").arg(names.join(",")).env("CARGO_TARGET_DIR", target_folder());
    if !checks_all_targets() {
        // Half of the time; what is packed, and how it is linked, is the same at any level.
        script.args(["--opt-level", "1"]);
    }
    if builds_with_debian() {
        script.env("RUSTC", "/usr/bin/rustc").env("RUSTC_BOOTSTRAP", "1");
        script.env("SINEW_CARGO", "/usr/bin/cargo -Zbuild-std=core");
    }
    expect_success(&mut script);
    let packed = folder.path().join(concat!("packed/sinew-", env!("CARGO_PKG_VERSION"), ".tar.gz"));
    let unpacked = folder.path().join("unpacked");
    fs::create_dir(&unpacked).unwrap();
    expect_success(Command::new("tar").arg("-xzf").arg(packed).arg("-C").arg(&unpacked));
    // What the script left beside the archive must not be what the tests use.
    fs::remove_dir_all(folder.path().join("packed")).unwrap();
    Archive { folder, names }
});

fn target_folder() -> PathBuf {
    // TARGET/PROFILE/deps/TEST
    std::env::current_exe().unwrap().ancestors().nth(3).unwrap().to_owned()
}

fn projects() -> PathBuf {
    workspace_root().join("tests/c_interface/packages")
}

fn examples() -> PathBuf {
    workspace_root().join("tests/c_interface/examples")
}

/// Configures and builds a project with CMake, and gives its folder.
fn build(project: &str, folder: &Path, compiler: Option<&str>, definitions: &[String]) -> PathBuf {
    let out = folder.join(format!("{project}-{}", definitions.len()));
    let mut configure = Command::new("cmake");
    configure.arg("-S").arg(projects().join(project)).arg("-B").arg(&out);
    configure.arg(format!("-DEXAMPLES={}", examples().display()));
    if let Some(compiler) = compiler {
        configure.arg(format!("-DCMAKE_C_COMPILER={compiler}"));
    }
    if compiler.is_some_and(|compiler| compiler.starts_with("arm")) {
        // As a toolchain file says it: a program for no system, which a library proves.
        configure.args(["-DCMAKE_SYSTEM_NAME=Generic", "-DCMAKE_TRY_COMPILE_TARGET_TYPE=STATIC_LIBRARY"]);
    }
    expect_success(configure.args(definitions));
    expect_success(Command::new("cmake").arg("--build").arg(&out));
    out
}

/// What the example has to print, on this computer and in the emulator.
fn expect_walk(output: &[u8]) {
    let expected = fs::read_to_string(examples().join("walking.out")).unwrap();
    assert_eq!(String::from_utf8_lossy(output).replace("\r\n", "\n"), expected);
}

fn emulate(program: &Path, machine: &str) {
    let mut emulator = Command::new("timeout");
    emulator.args(["120", "qemu-system-arm", "-machine", machine, "-nographic", "-monitor", "none"]);
    emulator.args(["-serial", "none", "-semihosting-config", "enable=on,target=native", "-kernel"]).arg(program);
    expect_walk(&expect_success(&mut emulator).stdout);
}

fn has_all(tools: &[&str]) -> bool {
    tools.iter().all(|tool| has_tool(tool))
}

#[test]
fn the_archive_names_no_path_of_the_machine_that_made_it() {
    let root = ARCHIVE.root();
    let home = std::env::var("HOME").unwrap_or_default();
    for name in &ARCHIVE.names {
        let library = fs::read(root.join("lib").join(name).join("libsinew.a")).unwrap();
        for path in [workspace_root().to_str().unwrap(), home.as_str()].into_iter().filter(|path| path.len() > 1) {
            let path = format!("{path}/");
            let found = library.windows(path.len()).any(|window| window == path.as_bytes());
            assert!(!found, "the library {name} holds the path {path}");
        }
    }
    for file in ["include/sinew.h", "LICENSE-MIT", "LICENSE-APACHE", "zephyr/module.yml", "idf_component.yml"] {
        assert!(root.join(file).is_file(), "{file}");
    }
}

#[test]
fn a_package_of_cmake_is_found_in_the_archive() {
    if !(ARCHIVE.has("x86_64") && has_all(&["cmake", "gcc"])) {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let out = build("consumer", folder.path(), Some("gcc"), &[format!("-DSinew_ROOT={}", ARCHIVE.root().display())]);
    expect_walk(&expect_success(&mut Command::new(out.join("program"))).stdout);
}

/// The compiler's flags choose the library: one of another float ABI does not link.
#[test]
fn each_float_abi_links_and_runs_in_the_emulator() {
    if !has_all(&["cmake", "arm-none-eabi-gcc", "qemu-system-arm", "timeout"]) {
        return;
    }
    let mut count = 0;
    for (name, flags) in EMULATED.into_iter().filter(|(name, _)| ARCHIVE.has(name)) {
        let folder = tempfile::tempdir().unwrap();
        let is_secure = name.starts_with("thumbv8m");
        let definitions = [
            format!("-DSinew_ROOT={}", ARCHIVE.root().display()),
            format!("-DCMAKE_C_FLAGS={flags}"),
            "-DEMULATED=ON".into(),
            format!("-DSECURE={}", if is_secure { "ON" } else { "OFF" }),
        ];
        let out = build("consumer", folder.path(), Some("arm-none-eabi-gcc"), &definitions);
        emulate(&out.join("program"), if is_secure { "mps2-an505" } else { "mps2-an386" });
        eprintln!("linked and run: {name}");
        count += 1;
    }
    assert!(count > 0 || !has_target("thumbv7em-none-eabi"), "no library for the emulator was packed");
}

#[test]
fn a_folder_of_sources_is_built_by_cargo() {
    if leaves_out_long_builds() || builds_with_debian() || !has_all(&["cmake", "gcc", "cargo"]) {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let out =
        build("consumer", folder.path(), Some("gcc"), &[format!("-DSINEW_SOURCE={}", workspace_root().display())]);
    expect_walk(&expect_success(&mut Command::new(out.join("program"))).stdout);
}

#[test]
fn pkg_config_names_header_and_library() {
    if !(ARCHIVE.has("x86_64") && has_all(&["pkg-config", "gcc"])) {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let mut query = Command::new("pkg-config");
    query.env("PKG_CONFIG_PATH", ARCHIVE.root().join("lib/x86_64/pkgconfig"));
    let flags = expect_success(query.args(["--cflags", "--libs", concat!("sinew >= ", env!("CARGO_PKG_VERSION"))]));
    let flags = String::from_utf8(flags.stdout).unwrap();
    let program = folder.path().join("program");
    let mut compile = Command::new("gcc");
    compile.args(["-std=c11", "-ffp-contract=off"]).arg(examples().join("walking.c"));
    expect_success(compile.args(flags.split_whitespace()).arg("-o").arg(&program));
    expect_walk(&expect_success(&mut Command::new(&program)).stdout);
}

/// The real trees are not here: a stand-in calls the glue as they do.
#[test]
fn the_module_for_zephyr_links_by_a_stand_in_for_its_build() {
    let tools = ["cmake", "arm-none-eabi-gcc", "qemu-system-arm", "timeout"];
    if !(ARCHIVE.has("thumbv7em-softfp") && has_all(&tools)) {
        return;
    }
    let flags = format!("-DCMAKE_C_FLAGS={}", EMULATED[0].1);
    let folder = tempfile::tempdir().unwrap();
    let definitions = [format!("-DMODULE={}", ARCHIVE.root().display()), flags];
    emulate(
        &build("zephyr_stub", folder.path(), Some("arm-none-eabi-gcc"), &definitions).join("program"),
        "mps2-an386",
    );
}

#[test]
fn the_component_for_esp_idf_names_its_library_by_a_stand_in_for_its_build() {
    if !(ARCHIVE.has("riscv32imc") && has_tool("cmake")) {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    build("esp_idf_stub", folder.path(), None, &[format!("-DCOMPONENT_DIR={}", ARCHIVE.root().display())]);
}

#[test]
fn an_unknown_library_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let mut script = Command::new("bash");
    script.arg(workspace_root().join("packaging/archive")).arg("--out").arg(folder.path());
    let output = script.args(["--libraries", "thumbv9"]).output().unwrap();
    assert!(!output.status.success() && String::from_utf8_lossy(&output.stderr).contains("thumbv9"));
}
