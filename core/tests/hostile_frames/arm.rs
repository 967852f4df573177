//! One arm, and a pair of arms.

use crate::corners::Corners;
use crate::drive::{Recovery, Subject, drive, holds};
use sinew_core::camera::Pixel;
use sinew_core::math::Vec3;
use sinew_core::saved_state::SavedState;
use sinew_core::tracker::arm::example::{SHOULDERS_M, hand_blob, left_arm, right_arm};
use sinew_core::tracker::arm::{
    ArmEstimate, ArmFrame, ArmImage, ArmModel, ArmOptions, ArmPair, ArmTracker, PairFrame, Variant,
};
use sinew_core::vision::candidate::HandCandidate;
use sinew_core::vision::edges::EdgePixel;

const FRAME_US: u64 = 66_667;
const EDGES: [EdgePixel; 3] = [EdgePixel { u: 0, v: 0 }, EdgePixel { u: u16::MAX, v: 3 }, EdgePixel { u: 380, v: 240 }];
/// The hand of the twin, pixels: a hand's width.
const MAX_APART_PX: f32 = 30.0;

fn blob(clean: &HandCandidate, corners: &mut Corners) -> HandCandidate {
    HandCandidate {
        centre: Pixel::new(corners.number(clean.centre.u_px), corners.number(clean.centre.v_px)),
        moments_px2: clean.moments_px2.map(|moment| corners.number(moment)),
        area_px: corners.number(clean.area_px),
        likelihood: corners.number(clean.likelihood),
    }
}

fn sound(estimate: &ArmEstimate) -> Result<(), String> {
    let joints = &estimate.joints;
    let places =
        [joints.shoulder_m, joints.elbow_m, joints.hand_m].iter().all(|place| place.iter().all(|x| x.is_finite()));
    let numbers = estimate.angles_rad.iter().chain([&estimate.log_evidence]).all(|x| x.is_finite());
    let variances =
        estimate.hand_std_m >= 0.0 && estimate.hand_std_m.is_finite() && estimate.effective_sample_size > 0.0;
    holds(places && numbers && variances, || format!("{estimate:?}"))
}

fn apart(model: &ArmModel, one: &ArmEstimate, twin: &ArmEstimate) -> f32 {
    let [Some(a), Some(b)] = [one, twin].map(|estimate| model.camera().project(&estimate.joints.hand_m)) else {
        return f32::INFINITY;
    };
    if one.status == twin.status { a.distance_px(b) / MAX_APART_PX } else { f32::INFINITY }
}

struct OneArm {
    model: ArmModel,
    trackers: [ArmTracker<50>; 2],
    last: Option<[ArmEstimate; 2]>,
    time_us: u64,
}

impl OneArm {
    fn new(variant: Variant) -> Self {
        let example = left_arm().unwrap();
        let options = ArmOptions { variant, ..ArmOptions::default() };
        let model = ArmModel::new(*example.camera(), (640, 480), *example.geometry(), options).unwrap();
        let tracker = ArmTracker::new(&model, SHOULDERS_M[0], 1).unwrap();
        Self { model, trackers: [tracker.clone(), tracker], last: None, time_us: 0 }
    }
}

impl Subject for OneArm {
    fn hostile(&mut self, corners: &mut Corners) -> Result<(), String> {
        let candidates: Vec<_> = (0..corners.below(4)).map(|_| blob(&hand_blob(), corners)).collect();
        let image = ArmImage { candidates: &candidates, edges: &EDGES[..corners.below(4)] };
        let frame = ArmFrame {
            timestamp_us: corners.time_us(self.time_us),
            image: (!corners.one_in(4)).then_some(image),
            shoulder_m: corners.place(SHOULDERS_M[0]),
        };
        let estimate = self.trackers[0].step(&self.model, &frame);
        if corners.only_refused() {
            // The twin sees the frame without what is refused. This tracker may lose a hand that is
            // missing for some frames, whatever it was given instead.
            let kept: Vec<_> = candidates.iter().filter(|candidate| **candidate == hand_blob()).copied().collect();
            let image = frame.image.map(|image| ArmImage { candidates: &kept, ..image });
            self.trackers[1].step(&self.model, &ArmFrame { image, shoulder_m: SHOULDERS_M[0], ..frame });
        }
        sound(&estimate).map_err(|message| format!("{message} by {frame:?}"))?;
        holds(self.trackers[0].is_finite(), || format!("the state by {frame:?}"))
    }

    fn clean(&mut self) {
        self.time_us += FRAME_US;
        let image = ArmImage { candidates: &[hand_blob()], edges: &[] };
        let frame = ArmFrame { timestamp_us: self.time_us, image: Some(image), shoulder_m: SHOULDERS_M[0] };
        self.last = Some(self.trackers.each_mut().map(|tracker| tracker.step(&self.model, &frame)));
    }

    fn apart(&mut self) -> f32 {
        self.last.as_ref().map_or(f32::INFINITY, |[one, twin]| apart(&self.model, one, twin))
    }
}

#[test]
fn an_arm_survives_hostile_frames() {
    drive("arm", 45, Recovery::FromAll, || OneArm::new(Variant::Pik));
}

#[test]
fn an_arm_with_a_corrected_weight_survives_hostile_frames() {
    drive("arm, weighted", 45, Recovery::FromRefused, || OneArm::new(Variant::PikWeighted));
}

struct TwoArms {
    models: [ArmModel; 2],
    pairs: [ArmPair<50>; 2],
    last: Option<[[ArmEstimate; 2]; 2]>,
    time_us: u64,
}

/// Each hand out of the other arm's reach, so that no wrong frame can exchange them.
fn two_hands() -> [HandCandidate; 2] {
    [60.0, 580.0].map(|u_px| HandCandidate { centre: Pixel::new(u_px, 250.0), ..hand_blob() })
}

impl Subject for TwoArms {
    fn hostile(&mut self, corners: &mut Corners) -> Result<(), String> {
        // Hands elsewhere would draw both arms there, from where they may go on crossed.
        let hands = two_hands();
        let candidates: Vec<_> = hands[..corners.below(3)].iter().map(|hand| blob(hand, corners)).collect();
        let image = ArmImage { candidates: &candidates, edges: &EDGES[..corners.below(4)] };
        let shoulders_m: [Vec3; 2] = SHOULDERS_M.map(|shoulder_m| corners.place(shoulder_m));
        let image = (!corners.one_in(4)).then_some(image);
        let frame = PairFrame { timestamp_us: corners.time_us(self.time_us), image, shoulders_m };
        let [left, right] = &self.models;
        let estimates = self.pairs[0].step([left, right], &frame);
        for estimate in &estimates {
            sound(estimate).map_err(|message| format!("{message} by {frame:?}"))?;
        }
        holds(self.pairs[0].is_finite(), || format!("the state by {frame:?}"))
    }

    fn clean(&mut self) {
        self.time_us += FRAME_US;
        let image = Some(ArmImage { candidates: &two_hands(), edges: &[] });
        let frame = PairFrame { timestamp_us: self.time_us, image, shoulders_m: SHOULDERS_M };
        let [left, right] = &self.models;
        self.last = Some(self.pairs.each_mut().map(|pair| pair.step([left, right], &frame)));
    }

    fn apart(&mut self) -> f32 {
        let Some([one, twin]) = &self.last else { return f32::INFINITY };
        let sides = self.models.iter().zip(one.iter().zip(twin));
        sides.map(|(model, (one, twin))| apart(model, one, twin)).fold(0.0, f32::max)
    }
}

#[test]
fn a_pair_of_arms_survives_hostile_frames() {
    drive("pair of arms", 45, Recovery::FromRefused, || {
        let models = [left_arm().unwrap(), right_arm().unwrap()];
        let pair = ArmPair::new([&models[0], &models[1]], SHOULDERS_M, 1).unwrap();
        TwoArms { models, pairs: [pair.clone(), pair], last: None, time_us: 0 }
    });
}
