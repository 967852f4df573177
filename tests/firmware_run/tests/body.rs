//! The images `body` and `particles` answer on this machine what is expected of the board, and the
//! body is that of the host's `modes`, bit for bit.

use sinew::body::BodyPart;
use sinew::body::tracking::{BodyFilter, BodyModelKind, BodyTuning};
use sinew_core::math::Vec3;
use sinew_core::pik::processes::stick::StickSight;
use sinew_core::skeleton::BodyMeasures;
use sinew_core::skeleton::full_body::{BODY_ANGLES, FOREARMS};
use sinew_core::skeleton::upper_body::{UPPER_BONES, UPPER_COORDINATES};
use sinew_firmware_run::host_port::HostPort;
use sinew_firmware_run::{expected, inputs};
use sinew_firmware_sim::body::{BodyApp, DT_S, FRAMES, POINTS, follow, look, scene, true_pose_rad};
use sinew_firmware_sim::particles::ParticlesApp;
use sinew_firmware_sim::player::play;
use sinew_record::{BodyResult, RecordStream};

fn body_answers() -> Vec<u8> {
    let mut port = HostPort::new(&[]);
    follow(&mut port, &mut BodyApp::new()).unwrap();
    port.results.0
}

fn body_results() -> Vec<BodyResult> {
    let answers = body_answers();
    let mut stream = RecordStream::<_, 512>::new(&answers[..]);
    (0..FRAMES).map(|_| stream.next_record().unwrap().unwrap().read().unwrap()).collect()
}

#[test]
fn this_machine_answers_what_is_expected_of_the_board() {
    expected::compare_records(&body_answers(), &expected::folder().join("body.rec")).unwrap();
    let input = inputs::of_image("particles").unwrap().unwrap();
    let mut port = HostPort::new(&input);
    play(&mut port, &mut ParticlesApp::new()).unwrap();
    expected::compare_records(&port.results.0, &expected::folder().join("particles.rec")).unwrap();
}

#[test]
fn the_body_is_that_of_the_hosts_modes() {
    let mut tuning = BodyTuning::default();
    // Points as they are, one mode, nothing drawn.
    (tuning.smoothing.radius_m, tuning.modes.draws) = (0.0, 0);
    let mut first_rad = [0.0; BODY_ANGLES];
    for (&index, angle) in UPPER_COORDINATES.iter().zip(true_pose_rad(0)) {
        first_rad[index] = angle;
    }
    let measures = BodyMeasures::of_height(1.75).unwrap();
    let who = (&measures, first_rad);
    let mut filter = BodyFilter::of_part(BodyPart::Upper, BodyModelKind::Modes, tuning, who, 1, 1).unwrap();
    let (person, mut points_m) = (scene().unwrap(), [Vec3::zeros(); POINTS]);
    for result in body_results() {
        let count = look(&person, result.frame, &mut points_m);
        let blocks = filter.blocks(&mut points_m[..count]);
        let estimate = filter.step(&blocks, DT_S, StickSight::Unseen);
        for bone in 0..UPPER_BONES {
            let end_m: [f32; 3] = estimate.ends_m[bone].into();
            assert_eq!(result.ends_m[bone].map(f32::to_bits), end_m.map(f32::to_bits), "frame {}", result.frame);
            assert_eq!(result.observed >> bone & 1 == 1, estimate.observed[bone]);
        }
    }
}

/// The person of the image waves with both arms, one forearm is hidden for six frames.
#[test]
fn the_arms_are_followed() {
    let person = scene().unwrap();
    let (mut sum_m, mut worst_m) = (0.0, 0.0_f32);
    for result in body_results() {
        let truth = person.posture(&true_pose_rad(result.frame)).ends;
        for bone in FOREARMS {
            let off_m = (Vec3::from(result.ends_m[bone]) - truth[bone]).norm();
            sum_m += off_m / (2.0 * FRAMES as f32);
            worst_m = worst_m.max(off_m);
        }
        let is_hidden = (30..36).contains(&result.frame) || result.frame == 45;
        assert!(!is_hidden || result.observed >> FOREARMS[1] & 1 == 0, "frame {}", result.frame);
    }
    println!("wrists: mean {sum_m} m, worst {worst_m} m");
    assert!((0.002..0.03).contains(&sum_m), "{sum_m}");
}
