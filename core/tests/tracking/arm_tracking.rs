//! The arm tracker on simulated blobs and edges with known truth: no pixels, so only the tracker is
//! tested.

use sinew_core::camera::{Camera, Pixel};
use sinew_core::math::{Vec3, exp, sin_cos};
use sinew_core::random::Stream;
use sinew_core::skeleton::{ArmGeometry, Side};
use sinew_core::tracker::arm::{ArmEstimate, ArmFrame, ArmImage, ArmModel, ArmOptions, ArmTracker, Status, Variant};
use sinew_core::vision::candidate::HandCandidate;
use sinew_core::vision::edges::EdgePixel;
use std::f32::consts::TAU;

const SHOULDER: Vec3 = Vec3::new(0.2, -0.2, 1.3);
const FRAMES: u64 = 300;

fn model(options: ArmOptions) -> ArmModel {
    let camera = Camera::from_field_of_view(640, 480, 1.05).unwrap();
    ArmModel::new(camera, (640, 480), ArmGeometry::new(Side::Left, 0.3, 0.35).unwrap(), options).unwrap()
}

/// A smooth arm motion with incommensurate frequencies.
fn truth(model: &ArmModel, seed: u64, frame: u64) -> (Vec3, Vec3) {
    let mut stream = Stream::new(seed, 1 << 40, 0);
    let mut wave = |middle: f32, swing: f32| {
        let (period_s, phase) = (1.8 + 2.5 * stream.uniform(), TAU * stream.uniform());
        middle + swing * sin_cos(TAU * frame as f32 / 15.0 / period_s + phase).0
    };
    let angles = [wave(0.9, 0.5), wave(0.3, 0.5), wave(0.4, 0.5), wave(1.3, 0.6)];
    model.elbow_and_hand(&SHOULDER, &angles)
}

fn limb_edges(camera: &Camera, a: &Vec3, b: &Vec3, stream: &mut Stream, edges: &mut Vec<EdgePixel>) {
    for _ in 0..60 {
        let point = a + (b - a) * stream.uniform();
        let Some(pixel) = camera.project(&point) else { continue };
        let side = if stream.bits() & 1 == 0 { 12.0 } else { -12.0 };
        let (u, v) = (pixel.u_px + side, pixel.v_px + stream.normal() * 2.0);
        if u > 0.0 && v > 0.0 {
            edges.push(EdgePixel { u: u as u16, v: v as u16 });
        }
    }
}

struct Scene {
    false_blob: bool,
    hidden: std::ops::Range<u64>,
}

/// Tracks one simulated sequence and returns each frame's estimate with its 3D (m) and 2D (px) hand
/// error.
fn run(model: &ArmModel, scene: &Scene, seed: u64) -> Vec<(ArmEstimate, f32, f32)> {
    let mut tracker = ArmTracker::<512>::new(model, SHOULDER, seed).unwrap();
    let camera = *model.camera();
    (0..FRAMES)
        .map(|frame| {
            let (elbow, hand) = truth(model, seed, frame);
            let mut stream = Stream::new(seed, frame, 1 << 20);
            let mut edges = Vec::new();
            limb_edges(&camera, &SHOULDER, &elbow, &mut stream, &mut edges);
            limb_edges(&camera, &elbow, &hand, &mut stream, &mut edges);
            let image = camera.project(&hand).unwrap();
            let mut candidates = Vec::new();
            if !scene.hidden.contains(&frame) {
                let forearm = (hand - elbow).normalize();
                let cue = ArmOptions::default().area_cue.unwrap();
                let size_px = camera.focal_px() / hand.z;
                let area_px = cue.expected_area_m2(forearm.dot(&hand.normalize())) * size_px * size_px;
                let oblong = HandCandidate { moments_px2: [350.0, 0.0, 100.0], ..HandCandidate::default() };
                let scale = area_px * exp(0.25 * stream.normal()) / oblong.length_weighted_area_px(cue.length_share);
                candidates.push(HandCandidate {
                    centre: Pixel::new(image.u_px + 4.0 * stream.normal(), image.v_px + 4.0 * stream.normal()),
                    moments_px2: oblong.moments_px2.map(|moment| moment * scale),
                    area_px,
                    likelihood: 0.75,
                });
            }
            if scene.false_blob && (frame / 40) % 2 == 0 {
                candidates.push(HandCandidate {
                    centre: Pixel::new(320.0, 90.0),
                    moments_px2: [400.0, 0.0, 400.0],
                    area_px: 2600.0,
                    likelihood: 0.7,
                });
            }
            let input = ArmFrame {
                timestamp_us: frame * 66_667,
                image: Some(ArmImage { candidates: &candidates, edges: &edges }),
                shoulder_m: SHOULDER,
            };
            let estimate = tracker.step(model, &input);
            let error_px = camera.project(&estimate.joints.hand_m).map_or(1.0e3, |p| p.distance_px(image));
            (estimate, (estimate.joints.hand_m - hand).norm(), error_px)
        })
        .collect()
}

fn mean_errors(model: &ArmModel, scene: &Scene) -> (f32, f32) {
    let (mut metres, mut pixels, mut count) = (0.0, 0.0, 0.0);
    for seed in 1..=8 {
        for (_, error_m, error_px) in run(model, scene, seed).into_iter().skip(100) {
            metres += error_m;
            pixels += error_px;
            count += 1.0;
        }
    }
    (metres / count, pixels / count)
}

#[test]
fn the_default_tracker_follows_an_arm() {
    let (metres, pixels) = mean_errors(&model(ArmOptions::default()), &Scene { false_blob: false, hidden: 0..0 });
    println!("pik: {metres:.3} m, {pixels:.1} px");
    assert!((0.01..0.08).contains(&metres), "{metres} m");
    assert!((1.0..10.0).contains(&pixels), "{pixels} px");
}

#[test]
fn blobs_beat_the_standard_tracker() {
    let scene = Scene { false_blob: true, hidden: 120..130 };
    let errors = |variant| mean_errors(&model(ArmOptions { variant, ..ArmOptions::default() }), &scene);
    let (standard_m, standard_px) = errors(Variant::Standard);
    for variant in [Variant::Pik, Variant::Corrected] {
        let (metres, pixels) = errors(variant);
        println!("{variant:?}: {metres:.3} m, {pixels:.1} px (standard {standard_m:.3} m, {standard_px:.1} px)");
        assert!(metres > 0.02 && metres < 0.5 * standard_m, "{variant:?}: {metres} m beside {standard_m} m");
        assert!(pixels > 1.0 && pixels < 0.3 * standard_px, "{variant:?}: {pixels} px beside {standard_px} px");
    }
}

#[test]
fn a_returning_hand_is_found_again() {
    let model = model(ArmOptions::default());
    for seed in 1..=8 {
        let frames = run(&model, &Scene { false_blob: false, hidden: 150..180 }, seed);
        assert_eq!(frames[140].0.status, Status::Tracking);
        assert_eq!(frames[152].0.status, Status::Predicted);
        assert_eq!(frames[178].0.status, Status::Lost);
        assert!(frames[185..200].iter().all(|(_, _, pixels)| *pixels < 32.0), "seed {seed} did not recover");
    }
}
