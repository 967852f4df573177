//! The images `body` and `particles` answer on this machine what is expected of the board, and the
//! body is that of the host's `modes`, bit for bit.

use sinew::body::BodyPart;
use sinew::body::tracking::{BodyFilter, BodyModelKind, BodyTuning};
use sinew_core::math::Vec3;
use sinew_core::pik::processes::stick::StickSight;
use sinew_core::skeleton::BodyMeasures;
use sinew_core::skeleton::full_body::BODY_ANGLES;
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
