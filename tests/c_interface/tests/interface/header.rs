//! `sinew.h` is what the interface's source says, and every C and C++ compiler takes it.

use sinew_c_interface::{expanded_source, expect_success, has_tool, workspace_root};
use std::fs;
use std::process::Command;

/// Sources of the interface, and of the structures that it shares with the trackers.
const SOURCES: [&str; 21] = [
    "c_api/status.rs",
    "c_api/clock.rs",
    "c_api/cyclic_frame.rs",
    "c_api/cyclic_config.rs",
    "c_api/cyclic.rs",
    "c_api/cyclic_particles_config.rs",
    "c_api/cyclic_particles.rs",
    "c_api/arm_frame.rs",
    "c_api/arm_config.rs",
    "c_api/arm.rs",
    "c_api/arm_pair.rs",
    "c_api/body_frame.rs",
    "c_api/body_config.rs",
    "c_api/body.rs",
    "c_api/vision_frame.rs",
    "c_api/vision.rs",
    "c_api/model.rs",
    "c_api/on_panic.rs",
    "camera.rs",
    "vision/candidate.rs",
    "vision/edges.rs",
];

const PREAMBLE: &str = "\
/* Sinew: how a human body moves, from a camera, in a few kilobytes.
 *
 * Made from the interface's source by `SINEW_REGENERATE=1 cargo test -p sinew-c-interface header`; do not edit.
 *
 * Nothing is allocated, nothing is global. Objects live in memory that the caller gives: SINEW_*_MAX_BYTES bytes, aligned to SINEW_ALIGN,
 * always suffice, and sinew_*_size and sinew_*_align return the exact numbers of this target. Different objects may be used by different
 * threads at the same time. All functions but sinew_*_size, sinew_*_align, sinew_version and sinew_error_text answer with a status, zero
 * for done. */";

fn header() -> String {
    let mut config = cbindgen::Config {
        language: cbindgen::Language::C,
        cpp_compat: true,
        include_guard: Some("SINEW_H".into()),
        header: Some(PREAMBLE.into()),
        no_includes: true,
        sys_includes: vec!["stddef.h".into(), "stdint.h".into()],
        usize_is_size_t: true,
        documentation_style: cbindgen::DocumentationStyle::Doxy,
        style: cbindgen::Style::Both,
        line_length: 130,
        ..cbindgen::Config::default()
    };
    config.enumeration.rename_variants = cbindgen::RenameRule::QualifiedScreamingSnakeCase;
    for name in ["HandCandidate", "EdgePixel", "Pixel"] {
        config.export.rename.insert(name.into(), format!("Sinew{name}"));
    }
    config.defines.insert("feature = vga".into(), "SINEW_VGA".into());
    // Constants of the sources that the structures come from.
    config.export.exclude.extend(["DEFAULT_MIN_GRADIENT", "DEFAULT_MIN_MOTION"].map(String::from));
    let mut builder = cbindgen::Builder::new().with_config(config);
    let folder = tempfile::tempdir().unwrap();
    for source in SOURCES {
        let expanded = folder.path().join(source.replace('/', "_"));
        fs::write(&expanded, expanded_source(&workspace_root().join("core/src").join(source))).unwrap();
        builder = builder.with_src(expanded);
    }
    let mut text = Vec::new();
    builder.generate().expect("the interface can be said in C").write(&mut text);
    without_examples(&String::from_utf8(text).expect("the header is text")).replace("# Safety\n", "Caller's duty:\n")
}

/// The header without the examples of its types, which are in Rust, and the empty line before each.
fn without_examples(header: &str) -> String {
    let (mut kept, mut is_example) = (Vec::new(), false);
    for line in header.lines() {
        if line.trim_start() == "* ```" {
            if !is_example && kept.last().is_some_and(|last: &&str| last.trim() == "*") {
                kept.pop();
            }
            is_example = !is_example;
        } else if !is_example {
            kept.push(line);
        }
    }
    kept.join("\n") + "\n"
}

#[test]
fn the_header_is_current() {
    let path = workspace_root().join("core/include/sinew.h");
    let header = header();
    if std::env::var_os("SINEW_REGENERATE").is_some() {
        fs::write(&path, &header).unwrap();
    }
    assert!(
        fs::read_to_string(&path).unwrap_or_default() == header,
        "the interface changed; SINEW_REGENERATE=1 cargo test -p sinew-c-interface header"
    );
}

#[test]
fn every_function_of_the_interface_is_in_the_header() {
    let header = header();
    let sources = fs::read_dir(workspace_root().join("core/src/c_api")).unwrap();
    let mut count = 0;
    for source in sources {
        let source = expanded_source(&source.unwrap().path());
        for function in source.split("extern \"C\" fn sinew_").skip(1) {
            let name = function.split('(').next().unwrap();
            let declared = header.contains(&format!("sinew_{name}("));
            // Those of the proof are linked only, and never called.
            assert!(declared || name == "panic_is_reachable" || name.starts_with("proof_"), "sinew_{name}");
            count += usize::from(declared);
        }
    }
    assert!(count > 30, "{count} functions");
}

#[test]
fn the_header_compiles_as_c99_c11_and_cpp17() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("sinew.h"), header()).unwrap();
    for (compiler, standard, file) in
        [("gcc", "c99", "a.c"), ("gcc", "c11", "a.c"), ("g++", "c++17", "a.cpp"), ("arm-none-eabi-gcc", "c99", "a.c")]
    {
        if !has_tool(compiler) {
            continue;
        }
        let source = folder.path().join(file);
        fs::write(
            &source,
            "#include <sinew.h>\n#include <sinew.h>\nextern SinewStatus done;\nSinewStatus done = SINEW_STATUS_OK;\n",
        )
        .unwrap();
        let mut command = Command::new(compiler);
        command.arg(format!("-std={standard}")).args(["-Wall", "-Wextra", "-Wpedantic", "-Wconversion", "-Werror"]);
        expect_success(
            command.arg("-I").arg(folder.path()).arg("-c").arg(&source).arg("-o").arg(folder.path().join("a.o")),
        );
    }
}
