//! The estimate: the mean of the heaviest cluster of particles, made a pose again.

use super::context::FrameContext;
use super::frame::MAX_CANDIDATES;
use super::options::EstimateRule;
use super::particle::Particle;
use crate::angle::CircularSum;
use crate::kinematics::inverse::{Goal, PoseDensity, PoseObjective, Solve};
use crate::math::{Mat3, Vec3, max};
use crate::skeleton::Side;
use crate::skeleton::arm::{ARM_ANGLES, ArmAngles, FOREARM, UPPER_ARM};

/// How the estimate came about.
///
/// ```
/// use sinew_core::tracker::arm::example::{SHOULDERS_M, hand_blob, left_arm};
/// use sinew_core::tracker::arm::{ArmFrame, ArmImage, ArmOptions, ArmTracker, Status};
/// use sinew_core::vision::candidate::HandCandidate;
///
/// let (model, hand, shoulder_m) = (left_arm()?, hand_blob(), SHOULDERS_M[0]);
/// // A hand is seen once, then the camera is covered.
/// let mut tracker = ArmTracker::<50>::new(&model, shoulder_m, 1)?;
/// let mut at = |timestamp_us, image| tracker.step(&model, &ArmFrame { timestamp_us, image, shoulder_m }).status;
/// let image = ArmImage { candidates: &[hand], edges: &[] };
/// assert_eq!(at(0, Some(image)), Status::Tracking);
/// // A blob that may be something else.
/// let other = ArmImage { candidates: &[HandCandidate { likelihood: 0.5, ..hand }], edges: &[] };
/// assert_eq!(at(33_333, Some(other)), Status::Uncertain);
/// assert_eq!(at(66_667, None), Status::Predicted);
/// // Longer than `ArmOptions::lost_after_s` later the prediction means nothing.
/// assert_eq!(at(1_000_000, None), Status::Predicted);
/// assert_eq!(at(1_100_000, None), Status::Lost);
/// # Ok::<(), sinew_core::error::ParameterError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Status {
    /// A blob of this frame that is likely a hand carries the estimate. Nearly all particles that
    /// are at any blob are at this one. With blob memory it has moved, or nothing else can be the
    /// hand. See
    /// [`ArmOptions::sure_likelihood`](super::ArmOptions::sure_likelihood) and
    /// [`ArmOptions::sure_share`](super::ArmOptions::sure_share).
    Tracking,
    /// Another blob of this frame carries the estimate.
    Uncertain,
    /// No blob does; the estimate is a prediction.
    Predicted,
    /// No blob did for so long (or ever) that the prediction means nothing.
    #[default]
    Lost,
}

/// Places of an arm's joints, metres in camera axes.
///
/// ```
/// use sinew_core::math::Vec3;
/// use sinew_core::skeleton::{ArmGeometry, Side};
/// use sinew_core::tracker::arm::ArmJoints;
///
/// // From the joints of an estimate to the angle that a physiotherapist reads off, and to the arm's own angles.
/// let joints = ArmJoints {
///     shoulder_m: Vec3::new(0.2, -0.1, 1.2),
///     elbow_m: Vec3::new(0.2, 0.2, 1.2),
///     hand_m: Vec3::new(0.2, 0.2, 0.85),
/// };
/// let (upper, fore) = (joints.elbow_m - joints.shoulder_m, joints.hand_m - joints.elbow_m);
/// assert!(upper.dot(&fore).abs() < 1e-6, "a right angle at the elbow");
/// let arm = ArmGeometry::new(Side::Left, 0.30, 0.35)?;
/// let angles_rad = arm.angles_from_joints(&upper, &(upper + fore), &[0.0; 4]);
/// assert!((angles_rad[3] - 90.0_f32.to_radians()).abs() < 1e-3);
/// # Ok::<(), sinew_core::error::ParameterError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ArmJoints {
    /// Shoulder.
    pub shoulder_m: Vec3,
    /// Elbow.
    pub elbow_m: Vec3,
    /// Middle of the hand.
    pub hand_m: Vec3,
}

/// What a step answers.
///
/// ```
/// use sinew_core::camera::Pixel;
/// use sinew_core::tracker::arm::example::{SHOULDERS_M, hand_blob, left_arm};
/// use sinew_core::tracker::arm::{ArmFrame, ArmImage, ArmTracker};
/// use sinew_core::vision::candidate::HandCandidate;
///
/// let (model, hand, shoulder_m) = (left_arm()?, hand_blob(), SHOULDERS_M[0]);
/// let mut tracker = ArmTracker::<50>::new(&model, shoulder_m, 1)?;
/// // A speck comes first in the list, the hand second.
/// let speck = HandCandidate { centre: Pixel::new(50.0, 50.0), likelihood: 0.06, ..hand };
/// let image = Some(ArmImage { candidates: &[speck, hand], edges: &[] });
/// let estimate = tracker.step(&model, &ArmFrame { timestamp_us: 0, image, shoulder_m });
/// assert_eq!((estimate.candidate, estimate.hand_likelihood), (Some(1), 0.8), "the hand carries the estimate");
/// assert!(estimate.hand_std_m < 0.5 && estimate.effective_sample_size > 1.0);
/// // Without an image the estimate is a prediction, which knows less.
/// let later = tracker.step(&model, &ArmFrame { timestamp_us: 200_000, image: None, shoulder_m });
/// assert_eq!((later.candidate, later.log_evidence), (None, 0.0));
/// # Ok::<(), sinew_core::error::ParameterError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ArmEstimate {
    /// The person's own side.
    pub side: Side,
    /// How the estimate came about.
    pub status: Status,
    /// Joints of the estimated pose.
    pub joints: ArmJoints,
    /// Angles of the estimated pose, inside the limits.
    pub angles_rad: ArmAngles,
    /// Standard deviation of the hand, metres an axis: how far the particles' hands, those of other
    /// clusters too, are from the estimated one, and how far a hand goes while no blob carries it.
    pub hand_std_m: f32,
    /// Effective sample size of all weights.
    pub effective_sample_size: f32,
    /// ln of the mean weight: this frame's part of the log evidence. Zero where nothing was seen.
    pub log_evidence: f32,
    /// Whether all weights were zero and the frame taught nothing.
    pub degenerate: bool,
    /// Likelihood of the blob that carries the estimate; zero without one.
    pub hand_likelihood: f32,
    /// Index in the frame's candidate list of the blob that carries the estimate.
    pub candidate: Option<usize>,
    /// Candidates that were not considered (over capacity, or not finite).
    pub dropped_candidates: usize,
}

/// The heaviest cluster.
pub(super) struct Cluster {
    /// Considered candidate that it lies at.
    pub candidate: Option<usize>,
    pub angles_rad: ArmAngles,
    pub joints: ArmJoints,
    /// Mean square distance of all particles' hands from the cluster's, square metres an axis.
    pub hand_variance_m2: f32,
    /// Share of the weights at each candidate.
    pub masses: [f32; MAX_CANDIDATES],
}

impl Cluster {
    /// Share of the candidate in the weights at all candidates; zero at none.
    pub fn share(&self) -> f32 {
        let all: f32 = self.masses.iter().sum();
        let own = self.candidate.and_then(|index| self.masses.get(index)).copied().unwrap_or(0.0);
        if all > 0.0 { own / all } else { 0.0 }
    }
}

impl FrameContext<'_> {
    /// Mean of the heaviest cluster (or of all particles).
    pub fn heaviest_cluster(&self, particles: &[Particle], weights: &[f32]) -> Cluster {
        let at = |particle: &Particle| self.candidate_at(self.model.camera().project(&particle.hand_m));
        let slot = |candidate: Option<usize>| candidate.map_or(MAX_CANDIDATES, |index| index.min(MAX_CANDIDATES - 1));
        let mut masses = [0.0; MAX_CANDIDATES + 1];
        for (particle, weight) in particles.iter().zip(weights) {
            masses[slot(at(particle))] += weight;
        }
        masses[MAX_CANDIDATES] *= self.concentration(particles, weights);
        let (mut heaviest, mut most) = (MAX_CANDIDATES, masses[MAX_CANDIDATES]);
        for (index, &mass) in masses.iter().enumerate() {
            if mass > most {
                (heaviest, most) = (index, mass);
            }
        }
        let all = self.model.options().estimate == EstimateRule::Mean;
        let members = particles.iter().zip(weights).filter(|(p, _)| all || slot(at(p)) == heaviest);
        let candidate = (heaviest < MAX_CANDIDATES).then_some(heaviest);
        let mut cluster = self.mean_pose(members.map(|(p, w)| (p, *w)), candidate);
        cluster.masses.copy_from_slice(&masses[..MAX_CANDIDATES]);
        let hand_m = cluster.joints.hand_m;
        let square_m2 = particles.iter().zip(weights).map(|(p, w)| w * (p.hand_m - hand_m).norm_squared());
        cluster.hand_variance_m2 = square_m2.sum::<f32>() / 3.0;
        cluster
    }

    /// How far the particles at no candidate are a cluster: 1 where they fill no more than a disc
    /// of the least cluster radius, else the disc's share of what they fill. Scattered
    /// particles agree on nothing.
    fn concentration(&self, particles: &[Particle], weights: &[f32]) -> f32 {
        let camera = self.model.camera();
        let (mut mass, mut sum, mut square) = (0.0, [0.0; 2], 0.0);
        for (particle, weight) in particles.iter().zip(weights) {
            let Some(pixel) = camera.project(&particle.hand_m) else { continue };
            if self.candidate_at(Some(pixel)).is_none() {
                mass += weight;
                sum[0] += weight * pixel.u_px;
                sum[1] += weight * pixel.v_px;
                square += weight * (pixel.u_px * pixel.u_px + pixel.v_px * pixel.v_px);
            }
        }
        if !(mass > 0.0) || self.candidates.is_empty() {
            return 1.0;
        }
        let variance_px2 = square / mass - (sum[0] * sum[0] + sum[1] * sum[1]) / (mass * mass);
        let radius_px = self.model.least_cluster_radius_px();
        radius_px * radius_px / max(variance_px2, radius_px * radius_px)
    }

    /// Circular mean of the angles, then the pose next to it whose hand is the mean hand.
    fn mean_pose<'p>(&self, members: impl Iterator<Item = (&'p Particle, f32)>, candidate: Option<usize>) -> Cluster {
        let mut mass = 0.0;
        let mut hand = Vec3::zeros();
        let mut sums = [CircularSum::default(); ARM_ANGLES];
        for (particle, weight) in members {
            mass += weight;
            hand += particle.hand_m * weight;
            for (sum, angle) in sums.iter_mut().zip(particle.angles_rad) {
                sum.add(angle, weight);
            }
        }
        let mass = if mass > 0.0 { mass } else { 1.0 };
        let hand = hand / mass;
        let mut mean_rad = self.model.waiting_pose();
        for (angle, sum) in mean_rad.iter_mut().zip(&sums) {
            *angle = sum.mean_rad().unwrap_or(*angle);
        }
        let goal = Goal { bone: FOREARM, position_m: hand, precision: Mat3::identity() * 1.0e4 };
        let density = PoseDensity {
            skeleton: self.model.skeleton(),
            root_m: self.shoulder_m,
            goals: &[goal],
            previous_rad: self.model.skeleton().clamp(mean_rad),
            stiffness: [1.0; ARM_ANGLES],
            held: 0,
        };
        let angles_rad = density.mode(4).angles_rad;
        let there = density.posture(&angles_rad);
        let joints =
            ArmJoints { shoulder_m: self.shoulder_m, elbow_m: there.ends[UPPER_ARM], hand_m: there.ends[FOREARM] };
        Cluster { candidate, angles_rad, joints, hand_variance_m2: 0.0, masses: [0.0; MAX_CANDIDATES] }
    }
}
