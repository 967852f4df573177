//! What a frame gave, as numbers in a row that a page can read.

use sinew_core::camera::Pixel;
use sinew_core::tracker::arm::{ArmEstimate, ArmModel, Particle, Status};
use sinew_core::vision::objects::head::HeadBox;

/// Numbers of one answer, in the order of [`answer`].
pub const ANSWER_NUMBERS: usize = 19;
/// Numbers of one particle, in the order of [`particle`].
pub const PARTICLE_NUMBERS: usize = 5;

/// Status: 0 tracking, 1 predicted, 2 lost, 3 uncertain. Images of shoulder, elbow and hand,
/// pixels, NaN behind the camera. The hand in camera axes and its standard deviation, metres.
/// Effective sample size. Likelihood of the blob that carries the estimate and its number, -1
/// without one. Temporal edge pixels. Whether all weights were zero. Middle and width of the
/// `head`, pixels, NaN without one.
#[must_use]
pub fn answer(estimate: &ArmEstimate, model: &ArmModel, edges: usize, head: Option<HeadBox>) -> [f32; ANSWER_NUMBERS] {
    let status = match estimate.status {
        Status::Tracking => 0.0,
        Status::Predicted => 1.0,
        Status::Lost => 2.0,
        Status::Uncertain => 3.0,
    };
    let joints = &estimate.joints;
    let [shoulder, elbow, hand] =
        [joints.shoulder_m, joints.elbow_m, joints.hand_m].map(|joint| place(model.camera().project(&joint)));
    let carrier = estimate.candidate.map_or(-1.0, |index| index as f32);
    let degenerate = if estimate.degenerate { 1.0 } else { 0.0 };
    let face = head.map_or([f32::NAN; 3], |head| [head.centre_px[0], head.centre_px[1], head.width_px]);
    [
        status,
        shoulder[0],
        shoulder[1],
        elbow[0],
        elbow[1],
        hand[0],
        hand[1],
        joints.hand_m.x,
        joints.hand_m.y,
        joints.hand_m.z,
        estimate.hand_std_m,
        estimate.effective_sample_size,
        estimate.hand_likelihood,
        carrier,
        edges as f32,
        degenerate,
        face[0],
        face[1],
        face[2],
    ]
}

/// Images of a particle's hand and elbow, pixels, and its weight.
#[must_use]
pub fn particle(particle: &Particle, weight: f32, model: &ArmModel) -> [f32; PARTICLE_NUMBERS] {
    let [hand, elbow] = [particle.hand_m, particle.elbow_m].map(|joint| place(model.camera().project(&joint)));
    [hand[0], hand[1], elbow[0], elbow[1], weight]
}

fn place(pixel: Option<Pixel>) -> [f32; 2] {
    pixel.map_or([f32::NAN; 2], |pixel| [pixel.u_px, pixel.v_px])
}
