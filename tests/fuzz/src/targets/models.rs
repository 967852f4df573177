//! Readers of models: of cyclic motion and of skin.

use crate::Target;
use crate::file::file;
use sinew::cyclic::{CyclicModel, model_file as cyclic_file};
use sinew::skin::{SkinModel, model_file as skin_file};
use sinew_core::cyclic::example::swing_table;
use sinew_core::cyclic::model::bytes::{HEADER_BYTES, ModelHeader, write, write_coupled};
use sinew_core::numeric::semi_definite::packed_len;
use std::sync::OnceLock;

/// Models of cyclic motion as JSON and as bytes, and models of skin.
pub const TARGETS: &[Target] = &[
    Target { name: "cyclic_model", run: cyclic, seeds: || vec![small_cyclic()] },
    Target { name: "cyclic_model_bytes", run: bytes, seeds: || vec![swing_bytes(), swing_coupled_bytes()] },
    Target { name: "skin_model", run: skin, seeds: || vec![small_skin()] },
];

/// The model of walking with every tenth position.
fn small_cyclic() -> Vec<u8> {
    let text = cyclic_file::to_json(walking()).expect("memory takes it");
    let mut value: serde_json::Value = serde_json::from_str(&text).expect("it was written");
    for name in ["mean_acceleration", "acceleration_covariance", "mean_pose_rad", "mean_velocity"] {
        let rows = value[name].as_array().cloned().unwrap_or_default();
        value[name] = rows.into_iter().step_by(10).collect();
    }
    serde_json::to_string_pretty(&value).expect("memory takes it").into_bytes()
}

/// The model of walking, which takes milliseconds to read.
pub fn walking() -> &'static CyclicModel {
    static WALKING: OnceLock<CyclicModel> = OnceLock::new();
    WALKING.get_or_init(|| CyclicModel::from_option("walking").expect("it is built in"))
}

fn small_skin() -> Vec<u8> {
    let model = SkinModel::from_option("gaussian").expect("it is built in");
    skin_file::to_json(&model).expect("memory takes it").into_bytes()
}

fn swing_bytes() -> Vec<u8> {
    let table = swing_table();
    let mut bytes = vec![0; 1 << 16];
    let length = write(&table.model().expect("it is built in"), &mut bytes).expect("there is room");
    bytes.truncate(length);
    bytes
}

fn swing_coupled_bytes() -> Vec<u8> {
    let table = swing_table();
    let mut bytes = vec![0; 1 << 16];
    let length = write_coupled(&table.model().expect("it is built in"), &mut bytes).expect("there is room");
    bytes.truncate(length);
    bytes
}

fn cyclic(bytes: &[u8]) {
    let Ok(model) = cyclic_file::read(&file("model.json", bytes)) else { return };
    let text = cyclic_file::to_json(&model).expect("memory takes it");
    let again = cyclic_file::parse(&text).expect("it was written");
    assert_eq!(cyclic_file::to_json(&again).expect("memory takes it"), text, "as it was written");
}

fn skin(bytes: &[u8]) {
    let Ok(model) = skin_file::read(&file("skin.json", bytes)) else { return };
    let text = skin_file::to_json(&model).expect("memory takes it");
    let again = skin_file::parse(&text).expect("it was written");
    assert_eq!(skin_file::to_json(&again).expect("memory takes it"), text, "as it was written");
    let picture = super::pictures::picture(&mut crate::numbers::Numbers::new(bytes));
    let _ = model.classify(&picture);
}

/// As they are, and with a sound checksum, whose place is word 6 of the header.
fn bytes(bytes: &[u8]) {
    lend(bytes);
    let mut sound = bytes.to_vec();
    if sound.len() >= HEADER_BYTES {
        sound[24..28].fill(0);
        let sum = [&sound[..24], &sound[28..]].concat();
        sound[24..28].copy_from_slice(&sinew_core::checksum::crc32(&sum).to_le_bytes());
        lend(&sound);
    }
}

fn lend(bytes: &[u8]) {
    let Ok(header) = ModelHeader::read(bytes) else { return };
    assert_eq!(header.byte_count(), bytes.len());
    let words = bytes[HEADER_BYTES..].chunks_exact(4).take(header.number_count());
    let numbers: Vec<f32> = words.map(|word| f32::from_le_bytes(word.try_into().unwrap_or_default())).collect();
    let turns = bytes[HEADER_BYTES + 4 * header.number_count()..].iter().take(header.angle_count);
    let turns: Vec<i8> = turns.map(|byte| byte.cast_signed()).collect();
    let coupled = header.lend_coupled(&numbers, &turns);
    let Ok(model) = header.lend(&numbers, &turns) else { return };
    assert_eq!(coupled.as_ref(), Ok(model.coupled()), "the part of a sound model is sound");
    let mut covariance = vec![0.0; packed_len(model.angle_count())];
    for position in [0.0, 0.31, 0.999, -0.2] {
        model.acceleration_covariance(model.point(position), &mut covariance);
        assert!(covariance.iter().all(|number| number.is_finite()), "a covariance");
    }
}
