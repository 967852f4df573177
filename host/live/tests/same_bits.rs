//! What the page answers has the bits of `sinew track arm` on the same pictures.

use image::RgbImage;
use sinew::config::Config;
use sinew::frames::FrameReader;
use sinew::motion::{ArmSide, reach};
use sinew::scene::{Scene, SceneOptions, Sides};
use sinew::skin::model::DEFAULT_SKIN;
use sinew::skin::model::{ModelNumbers, SkinModel};
use sinew::skin::white_balance::WhiteBalance;
use sinew::track::{ArmSet, ArmStream, FrameSource, SideChoice, StreamFrame, StreamOptions};
use sinew_core::camera::Pixel;
use sinew_core::skeleton::Side;
use sinew_core::tracker::arm::{ArmEstimate, Status};
use sinew_live::frame::Frame;
use sinew_live::person::{DISTANCE_M, Shoulder};
use sinew_live::session::{Choice, Session};
use sinew_live::skin_model::SHIPPED;
use std::path::Path;

const SIZE_PX: (u32, u32) = (320, 240);
const FRAMES: usize = 40;

fn scene(side: ArmSide) -> Scene {
    let motion = reach::random_reaches(7, 30.0, FRAMES).unwrap();
    let options = SceneOptions {
        width_px: SIZE_PX.0,
        height_px: SIZE_PX.1,
        frames: FRAMES,
        frames_per_second: 30.0,
        seed: 7,
        sides: Sides::One(side),
        ..SceneOptions::default()
    };
    Scene::new(&motion, &options).unwrap()
}

fn write(frame: &mut Frame, image: &RgbImage) {
    for (to, from) in frame.rgba.as_chunks_mut::<4>().0.iter_mut().zip(image.pixels()) {
        *to = [from.0[0], from.0[1], from.0[2], 255];
    }
}

fn session(side: Side, particles: usize, shoulder: Shoulder) -> Session {
    let size_px = (SIZE_PX.0 as usize, SIZE_PX.1 as usize);
    Session::new(Choice { size_px, side, particles, seed: 3, shoulder }).unwrap()
}

fn bits(estimate: &ArmEstimate) -> Vec<u32> {
    let joints = [estimate.joints.shoulder_m, estimate.joints.elbow_m, estimate.joints.hand_m];
    let places = joints.iter().flat_map(|joint| joint.iter().copied());
    let rest = [estimate.hand_std_m, estimate.log_evidence, estimate.effective_sample_size, estimate.hand_likelihood];
    places.chain(estimate.angles_rad).chain(rest).map(f32::to_bits).collect()
}

/// Both on the same pictures, one of which is missing to neither.
fn compare(config: &Config, choice: SideChoice, session: &mut Session, scene: &Scene) {
    let skin = SkinModel::from_option("gaussian").unwrap();
    let mut reader = FrameReader::new(config.likelihood.build().unwrap(), config.edges.build().unwrap()).unwrap();
    let mut arms = ArmSet::new(config, SIZE_PX, choice, 3).unwrap();
    assert_eq!(session.model(), &arms.models()[0]);
    let mut frame = Frame::boxed();
    for number in 0..FRAMES {
        let (image, time_us) = (scene.render(number), number as u64 * 33_333);
        let view = reader.read(&image, skin.for_image(&image).unwrap().as_ref()).unwrap();
        write(&mut frame, &image);
        session.see(&mut frame).unwrap();
        assert_eq!(session.candidates.as_slice(), view.candidates, "frame {number}");
        let (here, there) = (session.track(time_us), arms.step(time_us, Some(&view)).remove(0));
        assert_eq!(bits(&here), bits(&there.estimate), "frame {number}");
        assert_eq!((here.status, here.candidate), (there.estimate.status, there.estimate.candidate), "frame {number}");
        assert_eq!(session.particles.len(), there.particles.len());
    }
    assert!(!session.candidates.is_empty());
}

#[test]
fn the_shipped_skin_model_is_the_commands() {
    let shipped = SkinModel::from_option("gaussian").unwrap();
    let ModelNumbers::Gaussian(theirs) = shipped.numbers() else { panic!("it is a Gaussian") };
    assert_eq!((theirs.mean, theirs.covariance), (SHIPPED.mean, SHIPPED.covariance));
    assert_eq!((theirs.threshold, theirs.min_sum), (SHIPPED.threshold, SHIPPED.min_sum));
    assert_eq!(theirs.white_balance, WhiteBalance::QuarterGreyWorld);
}

#[test]
fn with_a_guessed_shoulder_it_is_the_command_without_a_configuration() {
    let shoulder = Shoulder::Guessed { distance_m: DISTANCE_M };
    for (arm, choice, side) in
        [(ArmSide::Right, SideChoice::Right, Side::Right), (ArmSide::Left, SideChoice::Left, Side::Left)]
    {
        compare(&Config::default(), choice, &mut session(side, 50, shoulder), &scene(arm));
    }
}

#[test]
fn with_a_placed_shoulder_it_is_the_command_with_that_shoulder() {
    let scene = scene(ArmSide::Right);
    let place_m = scene.body().shoulder_m(ArmSide::Right);
    let pixel = scene.camera().project(&place_m).unwrap();
    let shoulder = Shoulder::At { pixel, distance_m: place_m.z };
    let there_m = shoulder.place_m(&scene.camera(), Side::Right);
    assert!((there_m - place_m).norm() < 1.0e-5, "{there_m}");
    let mut config = Config::default();
    let places = [Shoulder::Guessed { distance_m: 1.0 }.place_m(&scene.camera(), Side::Left), there_m];
    (config.body.left_shoulder_m, config.body.right_shoulder_m) = (Some(places[0].into()), Some(places[1].into()));
    config.tracker.particles = 200;
    compare(&config, SideChoice::Right, &mut session(Side::Right, 200, shoulder), &scene);
}

#[test]
fn beginning_again_forgets_the_frames_and_keeps_the_skin() {
    let (scene, shoulder) = (scene(ArmSide::Right), Shoulder::Guessed { distance_m: DISTANCE_M });
    let mut frame = Frame::boxed();
    let mut session = session(Side::Right, 50, shoulder);
    let mut run = |session: &mut Session| {
        (0..3).for_each(|number| {
            write(&mut frame, &scene.render(number));
            session.see(&mut frame).unwrap();
            session.track(number as u64 * 33_333);
        });
        session.answer.map(f32::to_bits)
    };
    let first = run(&mut session);
    assert_ne!(run(&mut session), first);
    let choice = Choice { size_px: (320, 240), side: Side::Right, particles: 50, seed: 3, shoulder };
    session.begin_again(choice).unwrap();
    assert_eq!(run(&mut session), first);
    let hand = scene.truth(2).sides[0].hand_px(&scene.camera()).unwrap();
    let mut shown = Frame::boxed();
    write(&mut shown, &scene.render(2));
    session.see(&mut shown).unwrap();
    session.calibrate(&shown, hand.u_px as usize, hand.v_px as usize).unwrap();
    session.begin_again(choice).unwrap();
    let calibrated = run(&mut session);
    assert_ne!(calibrated, first);
    session.forget_calibration();
    session.begin_again(choice).unwrap();
    assert_eq!(run(&mut session), first);
    assert_eq!(session.begin_again(Choice { particles: 0, ..choice }).unwrap_err().parameter, "particles");
    assert_eq!(session.begin_again(Choice { size_px: (641, 1), ..choice }).unwrap_err().parameter, "width");
    let nowhere = Shoulder::At { pixel: Pixel::new(f32::INFINITY, 0.0), distance_m: 1.0 };
    assert_eq!(session.begin_again(Choice { shoulder: nowhere, ..choice }).unwrap_err().parameter, "shoulder");
}

/// On a person with a face, looks for it included.
#[test]
fn a_person_with_a_face_is_followed_as_by_the_command() {
    let clip = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data/video/asl/yes.mkv");
    if !clip.exists() {
        eprintln!("skipped: ../shared/data is not beside the project");
        return;
    }
    for (choice, side) in [(SideChoice::Right, Side::Right), (SideChoice::Left, Side::Left)] {
        let mut frames = FrameSource::open(&clip, false, 30.0).unwrap();
        let size_px = frames.size_px();
        let options = StreamOptions { side: choice, rate_hz: 30.0, seed: 3, ..StreamOptions::default() };
        let mut stream = ArmStream::new(options, SkinModel::from_option(DEFAULT_SKIN).unwrap(), size_px).unwrap();
        let size_px = (size_px.0 as usize, size_px.1 as usize);
        let shoulder = Shoulder::Guessed { distance_m: DISTANCE_M };
        let mut session = Session::new(Choice { size_px, side, particles: 50, seed: 3, shoulder }).unwrap();
        let mut frame = Frame::boxed();
        let (mut number, mut tracking) = (0, 0);
        while let Some(Ok(image)) = frames.load(number, 1).unwrap().pop() {
            let timestamp_us = number as u64 * 33_333;
            let answer = stream
                .step(StreamFrame { number, timestamp_us, image: Some(&image), hands: None, head: None })
                .unwrap();
            write(&mut frame, &image);
            session.see(&mut frame).unwrap();
            let here = session.track(timestamp_us);
            assert!(answer.knows_face && session.person().head().is_some(), "frame {number}");
            assert_eq!(bits(&here), bits(&answer.arms[0].estimate), "frame {number}");
            assert_eq!(here.status, answer.arms[0].estimate.status, "frame {number}");
            tracking += usize::from(here.status == Status::Tracking);
            number += 1;
        }
        assert!(number > 60 && tracking > number / 2, "{tracking} of {number} frames");
        // A click on the hand adds its colour to that of the face.
        let hand = session.candidates[0].centre;
        session.calibrate(&frame, hand.u_px as usize, hand.v_px as usize).unwrap();
        session.see(&mut frame).unwrap();
        let likeliest = session.candidates[0].centre;
        assert!(likeliest.distance_px(hand) < 40.0, "{likeliest:?}, not {hand:?}");
    }
}
