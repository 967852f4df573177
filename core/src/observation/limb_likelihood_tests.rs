//! A limb's own evidence on a made-up body and cloud.

use super::*;
use crate::kinematics::forward::posture;
use crate::math::Vec3;
use crate::observation::point_cloud::PointCloud;
use crate::random::Stream;
use crate::skeleton::BodyMeasures;
use crate::skeleton::full_body::{BODY_ANGLES, BODY_BONES, BodySkeleton, FOREARMS, HEAD, body_radii_m, full_body};
use proptest::prelude::*;
use std::vec::Vec as StdVec;

const LIKELIHOOD: PointLikelihood = PointLikelihood { std_m: 0.15, outlier_m: 0.25 };

struct Body {
    skeleton: BodySkeleton,
    radii_m: [f32; BODY_BONES],
}

impl Body {
    fn new() -> Self {
        let measures = BodyMeasures::of_height(1.75).unwrap();
        Self { skeleton: full_body(&measures).unwrap(), radii_m: body_radii_m(&measures) }
    }

    fn surface(&self, angles_rad: &[f32; BODY_ANGLES]) -> BodySurface<BODY_BONES> {
        BodySurface::new(&posture(&self.skeleton, &Vec3::zeros(), angles_rad), &self.radii_m, Vec3::zeros())
    }

    fn pose(&self, about: &[f32; BODY_ANGLES], std: f32, stream: &mut Stream) -> [f32; BODY_ANGLES] {
        self.skeleton.clamp(about.map(|angle| angle + std * stream.normal()))
    }
}

fn standing() -> [f32; BODY_ANGLES] {
    let mut angles = [0.0; BODY_ANGLES];
    angles[2] = 3.0;
    angles
}

fn cloud(surface: &BodySurface<BODY_BONES>, stream: &mut Stream) -> PointCloud<64> {
    let mut points: StdVec<Vec3> = (0..500)
        .map(|i| {
            let capsule = surface.capsules[i % surface.capsules.len()].capsule;
            let axis = capsule.start_m + (capsule.end_m - capsule.start_m) * stream.uniform();
            axis + stream.normal3() * if i % 9 == 0 { 0.5 } else { 0.06 }
        })
        .collect();
    let mut blocks = PointCloud::new();
    let _ = blocks.set(&mut points, &Vec3::zeros());
    blocks
}

/// Distance by definition: every point against every capsule of the groups in `counts`.
fn exact(surface: &BodySurface<BODY_BONES>, blocks: &[PointBlock], counts: impl Fn(usize) -> bool) -> StdVec<f64> {
    let mut all = StdVec::new();
    for block in blocks {
        for i in 0..usize::from(block.count) {
            let point = block.point_m(i);
            let near = surface.capsules.iter().filter(|seen| counts(seen.bone));
            let squared =
                near.map(|seen| (point - seen.capsule.nearest_visible(&Vec3::zeros(), &point)).norm_squared());
            all.push(f64::from(squared.fold(0.25 * 0.25, f32::min)));
        }
    }
    all
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(40))]
    #[test]
    fn logs_are_those_of_their_definition(seed in 0_u64..100_000) {
        let (body, mut stream) = (Body::new(), Stream::new(seed, 0, 0));
        let limbs = Limbs::of(&body.skeleton);
        let truth = body.pose(&standing(), 0.4, &mut stream);
        let (expected_rad, guess_rad) = (body.pose(&truth, 0.1, &mut stream), body.pose(&truth, 0.3, &mut stream));
        let blocks = cloud(&body.surface(&truth), &mut stream);
        let blocks = blocks.blocks();
        let (expected_surface, guess) = (body.surface(&expected_rad), body.surface(&guess_rad));
        let mut expected = ExpectedBody::new(limbs);
        expected.expect(&LIKELIHOOD, &expected_surface, blocks);
        let logs = expected.log_weights(&LIKELIHOOD, &guess, blocks);
        let scale = 2.0 * 0.15 * 0.15;
        let whole = -exact(&guess, blocks, |_| true).iter().sum::<f64>() / scale;
        prop_assert!((f64::from(logs[TRUNK_GROUP]) / whole - 1.0).abs() < 1.0e-3, "{} {whole}", logs[TRUNK_GROUP]);
        for group in 1..limbs.count() {
            let others = exact(&expected_surface, blocks, |bone| limbs.group(bone) != group);
            let own = exact(&guess, blocks, |bone| limbs.group(bone) == group);
            let gain: f64 = others.iter().zip(&own).map(|(others, own)| (others - own).max(0.0)).sum::<f64>() / scale;
            let found = f64::from(logs[group]);
            prop_assert!((found - gain).abs() < 1.0e-3 * (1.0 + gain), "group {group}: {found} {gain}");
        }
    }
}

#[test]
fn an_arm_is_weighed_whatever_the_other_does() {
    let (body, mut stream) = (Body::new(), Stream::new(4, 0, 0));
    let limbs = Limbs::of(&body.skeleton);
    let [left, right] = FOREARMS.map(|bone| limbs.group(bone));
    let blocks = cloud(&body.surface(&standing()), &mut stream);
    let mut expected = ExpectedBody::new(limbs);
    expected.expect(&LIKELIHOOD, &body.surface(&standing()), blocks.blocks());
    let log = |pose: &[f32; BODY_ANGLES]| expected.log_weights(&LIKELIHOOD, &body.surface(pose), blocks.blocks());
    let (right_first, good) = (16, log(&standing()));
    let mut lifted = standing();
    lifted[right_first] -= 1.2;
    let lifted = log(&body.skeleton.clamp(lifted));
    assert!(lifted[right] < 0.8 * good[right], "{} {}", lifted[right], good[right]);
    assert_eq!(lifted[left], good[left]);
    assert_eq!(lifted[limbs.group(HEAD)], good[limbs.group(HEAD)]);
    assert!(lifted[TRUNK_GROUP] < good[TRUNK_GROUP]);
}

#[test]
fn a_limb_that_no_point_shows_is_weighed_alike_everywhere() {
    let (body, mut stream) = (Body::new(), Stream::new(5, 0, 0));
    let limbs = Limbs::of(&body.skeleton);
    let mut far = [Vec3::new(9.0, 9.0, 9.0); 40];
    let mut blocks = PointCloud::<4>::new();
    let _ = blocks.set(&mut far, &Vec3::zeros());
    let mut expected = ExpectedBody::new(limbs);
    expected.expect(&LIKELIHOOD, &body.surface(&standing()), blocks.blocks());
    for _ in 0..5 {
        let pose = body.pose(&standing(), 0.3, &mut stream);
        let logs = expected.log_weights(&LIKELIHOOD, &body.surface(&pose), blocks.blocks());
        assert_eq!(logs[1..], [0.0; MAX_GROUPS - 1]);
    }
}

#[test]
fn a_cloud_beyond_the_capacity_is_looked_at_in_every_nth_block() {
    let (body, mut stream) = (Body::new(), Stream::new(6, 0, 0));
    let surface = body.surface(&standing());
    let few = cloud(&surface, &mut stream);
    let many: StdVec<PointBlock> = few.blocks().iter().flat_map(|block| [*block; 20]).collect();
    assert!(many.len() > MAX_BLOCKS);
    let mut expected = ExpectedBody::new(Limbs::of(&body.skeleton));
    expected.expect(&LIKELIHOOD, &surface, few.blocks());
    let once = expected.log_weights(&LIKELIHOOD, &surface, few.blocks());
    expected.expect(&LIKELIHOOD, &surface, &many);
    let often = expected.log_weights(&LIKELIHOOD, &surface, &many);
    for (one, twenty) in once.into_iter().zip(often) {
        assert!((twenty - 20.0 * one).abs() <= 0.1 * (20.0 * one).abs(), "{twenty} {one}");
    }
}
