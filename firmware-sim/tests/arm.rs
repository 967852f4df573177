//! The program's output is what lies in `expected/arm.out`, and the hand that it reports is where the scene has it.
//!
//! After a wanted change of the tracker: `SINEW_REGENERATE=1 cargo test -p sinew-firmware-sim`.

use sinew_firmware_sim::device::Device;
use std::path::Path;
use std::process::Command;

#[test]
fn the_output_is_the_expected_one() {
    let output = Command::new(env!("CARGO_BIN_EXE_sinew-firmware-sim")).output().unwrap();
    assert!(output.status.success());
    let text = String::from_utf8(output.stdout).unwrap();
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("expected/arm.out");
    if std::env::var_os("SINEW_REGENERATE").is_some() {
        std::fs::write(&path, &text).unwrap();
    }
    let expected = std::fs::read_to_string(&path).unwrap();
    for (number, (now, then)) in text.lines().zip(expected.lines()).enumerate() {
        assert_eq!(now, then, "line {} differs; SINEW_REGENERATE=1 writes the new output", number + 1);
    }
    assert_eq!(text, expected);
}

#[test]
fn the_hand_is_found_in_the_scene() {
    let mut errors_px = Vec::new();
    for seed in 1..=5 {
        let mut device = Device::new(seed).unwrap();
        for frame in 0..60 {
            let estimate = device.step().unwrap();
            let Some(scene) = device.camera().scene(device.model(), frame) else { continue };
            let camera = device.camera().geometry();
            let (found, truth) = (camera.project(&estimate.joints.hand_m), camera.project(&scene.hand_m));
            if frame >= 10 {
                errors_px.push(found.unwrap().distance_px(truth.unwrap()));
            }
        }
    }
    errors_px.sort_by(f32::total_cmp);
    let median_px = errors_px[errors_px.len() / 2];
    println!("median error {median_px} px of {} frames", errors_px.len());
    assert!((0.1..6.0).contains(&median_px), "{median_px} px");
}
