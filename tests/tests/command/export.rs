//! `sinew export` as a user types it.

use assert_cmd::Command;
use predicates::prelude::PredicateBooleanExt;
use predicates::str::contains;
use sinew::cyclic::CyclicModel;
use sinew_core::cyclic::model::bytes::{HEADER_BYTES, ModelBytesError, ModelHeader};
use sinew_core::cyclic::model::walking::{WALKING, WALKING_COUPLED};
use sinew_core::cyclic::{HumanCoupledTable, HumanModelTable};
use sinew_record::model_checksum;
use sinew_tests::sinew_command;
use std::fs;
use std::path::Path;

fn export(folder: &Path, arguments: &[&str]) -> assert_cmd::assert::Assert {
    Command::from_std(sinew_command()).current_dir(folder).arg("export").args(arguments).assert()
}

#[test]
fn the_bytes_are_the_model_that_the_command_tracks_with() {
    let folder = tempfile::tempdir().unwrap();
    for name in ["walking", "running", "arm-circles"] {
        export(folder.path(), &[name, "--out", "deep/er/model.bin"])
            .success()
            .stdout(contains("100 positions and 13 angles").and(contains("deep/er/model.bin")));
        let bytes = fs::read(folder.path().join("deep/er/model.bin")).unwrap();
        let header = ModelHeader::read(&bytes).unwrap();
        let (numbers, turns) = bytes[HEADER_BYTES..].split_at(4 * header.number_count());
        let numbers: Vec<f32> = numbers.as_chunks::<4>().0.iter().map(|word| f32::from_le_bytes(*word)).collect();
        let turns: Vec<i8> = turns[..header.angle_count].iter().map(|turn| turn.cast_signed()).collect();
        let read = header.lend(&numbers, &turns).unwrap();
        let shipped = CyclicModel::from_option(name).unwrap();
        assert_eq!(model_checksum(&read), model_checksum(&shipped.view()), "{name}");
        assert_eq!(name == "walking", model_checksum(&read) == model_checksum(&WALKING.model().unwrap()), "{name}");
    }
}

#[test]
fn the_source_in_c_holds_the_same_words() {
    let folder = tempfile::tempdir().unwrap();
    export(folder.path(), &["running", "--out", "model.bin"]).success();
    export(folder.path(), &["running", "--form", "c", "--out", "running_model.c"]).success();
    let bytes = fs::read(folder.path().join("model.bin")).unwrap();
    let source = fs::read_to_string(folder.path().join("running_model.c")).unwrap();
    assert!(source.contains(&format!("const uint32_t running_model[{}] = {{", bytes.len() / 4)));
    let words = source.split("= {").nth(1).unwrap().split(|c: char| !c.is_ascii_alphanumeric());
    let words = words.filter_map(|word| u32::from_str_radix(word.strip_prefix("0x")?, 16).ok());
    assert_eq!(words.flat_map(u32::to_le_bytes).collect::<Vec<u8>>(), bytes);
}

#[test]
fn the_coupled_forms_hold_what_the_coupled_filter_reads() {
    let folder = tempfile::tempdir().unwrap();
    export(folder.path(), &["walking", "--form", "coupled-bytes", "--out", "model.bin"])
        .success()
        .stdout(contains("100 positions and 13 angles: 5504 bytes of flash"));
    let bytes = fs::read(folder.path().join("model.bin")).unwrap();
    assert_eq!(HumanCoupledTable::from_bytes(&bytes).unwrap(), WALKING_COUPLED);
    assert_eq!(HumanModelTable::from_bytes(&bytes), Err(ModelBytesError::CoupledOnly));
    export(folder.path(), &["walking", "--form", "coupled-c", "--out", "walking_model.c"]).success();
    let source = fs::read_to_string(folder.path().join("walking_model.c")).unwrap();
    assert!(source.contains("const uint32_t walking_model[1376] = {"));
}

#[test]
fn what_cannot_be_exported_is_refused_with_the_remedy() {
    let folder = tempfile::tempdir().unwrap();
    export(folder.path(), &["swimming", "--out", "a.bin"])
        .failure()
        .stderr(contains("swimming").and(contains("walking")));
    for name in ["9-lives", "int", "uint32_t"] {
        let refusal = contains(format!("`{name}` cannot name an array in C"));
        export(folder.path(), &["walking", "--form", "c", "--out", &format!("{name}.c")]).failure().stderr(refusal);
    }
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
}
