//! Weights: what the image says of one arm.

use super::context::FrameContext;
use super::limbs::{LimbDensities, LimbHypotheses};
use super::options::LimbCombination;
use super::particle::Particle;
use super::propose::Proposed;
use crate::camera::Pixel;
use crate::math::{Vec3, atan2, exp, ln, max, unit};
use crate::observation::limbs::ArmImagePoints;
use crate::observation::orientation::OrientationDensity;
use crate::vision::candidate::HandCandidate;

/// A limb whose image is shorter than this has no orientation.
/// Chosen: fewer pixels have no direction.
const MIN_LIMB_IMAGE_PX: f32 = 6.0;

impl FrameContext<'_> {
    /// Images of the joints of `particle`; `None` where one of them lies behind the camera.
    pub fn image_of(&self, particle: &Particle) -> Option<ArmImagePoints> {
        self.model.image_points(&self.shoulder_m, &particle.elbow_m, &particle.hand_m)
    }

    /// ln of the particle's weight, up to a constant of the frame.
    pub fn log_weight(&self, proposed: &Proposed, limbs: &LimbHypotheses) -> f32 {
        let image = self.image_of(&proposed.particle);
        let place =
            proposed.particle.driver.map(usize::from).or_else(|| self.candidate_at(image.map(|points| points.hand)));
        let mut log_weight = proposed.log_importance + self.log_orientation(image.as_ref(), limbs.at(place));
        log_weight += self.log_gate(proposed);
        let hand = image.map(|points| points.hand);
        let traits = self.model.options().variant.traits();
        if traits.has_blob_term {
            log_weight += self.log_blob_term(&proposed.particle, hand);
        } else if traits.has_area_cue {
            log_weight += self.log_area_cue(proposed, hand);
        }
        log_weight
    }

    /// Continuity: what a jump to a blob costs, and what it costs to ignore one that is likely the
    /// hand.
    fn log_gate(&self, proposed: &Proposed) -> f32 {
        let options = self.model.options();
        let Some(gate) = options.gate.filter(|_| options.variant.traits().has_gate) else { return 0.0 };
        if proposed.particle.driver.is_none() {
            return ln(max(1.0 - self.best_chance * (1.0 - gate.missed_share), 1.0e-6));
        }
        let jumps = proposed.jump_m / (gate.std_m + gate.growth_m_per_s * self.unseen_s);
        ln(exp(-0.5 * jumps * jumps) + gate.floor)
    }

    /// Observation density of both limbs, arm (3) or the product; uniform where a limb has no
    /// orientation. Chosen: fewer pixels have no direction.
    fn log_orientation(&self, image: Option<&ArmImagePoints>, limbs: &LimbDensities) -> f32 {
        let limb = |density: &OrientationDensity, a: Pixel, b: Pixel| {
            if a.distance_px(b) < MIN_LIMB_IMAGE_PX { 1.0 } else { density.at(atan2(b.v_px - a.v_px, b.u_px - a.u_px)) }
        };
        let (upper, fore) = image.map_or((1.0, 1.0), |points| {
            (limb(&limbs.upper, points.shoulder, points.elbow), limb(&limbs.fore, points.elbow, points.hand))
        });
        match self.model.options().combination {
            LimbCombination::Mean => ln(max(0.5 * (upper + fore), 1.0e-6)),
            LimbCombination::Auto | LimbCombination::Product => {
                let floor = self.model.options().product_floor;
                ln((upper + floor) * (fore + floor))
            }
        }
    }

    /// Squared deviation of a blob's log area from what the hand's depth lets expect, in standard
    /// deviations; zero without the cue.
    fn area_deviation(&self, particle: &Particle, forearm: &Vec3, candidate: &HandCandidate) -> f32 {
        let Some(cue) = self.model.options().area_cue else { return 0.0 };
        let focal_px = self.model.camera().focal_px();
        let depth_m = max(particle.hand_m.z, 0.05);
        let pointing = unit(particle.hand_m).map_or(0.0, |view| forearm.dot(&view));
        let expected_px = cue.expected_area_m2(pointing) * focal_px * focal_px / (depth_m * depth_m);
        let deviation = ln(candidate.length_weighted_area_px(cue.length_share) / expected_px) / cue.log_std;
        deviation * deviation
    }

    /// The area cue where the likelihood has no blob term: the blob that drove the particle, or the
    /// one its hand lies on.
    ///
    /// A particle at no blob gets what a fitting one has on average. With `depth_from_area` the
    /// area already placed the driven hands and is not counted again.
    fn log_area_cue(&self, proposed: &Proposed, hand: Option<Pixel>) -> f32 {
        /// Mean of the logarithm of a normal density about its top: half of chi-square's mean, 1.
        const AVERAGE: f32 = -0.5;
        let options = self.model.options();
        if options.area_cue.is_none() || self.candidates.is_empty() {
            return 0.0;
        }
        let particle = &proposed.particle;
        let own = particle.driver.map(usize::from);
        let place = own.or_else(|| self.candidate_at(hand));
        let Some(candidate) = place.and_then(|index| self.candidates.get(index)) else { return AVERAGE };
        let log_area = -0.5 * self.area_deviation(particle, &particle.forearm(), candidate);
        if own.is_some() && options.depth_from_area {
            return AVERAGE + log_area + 0.5 * self.area_deviation(particle, &proposed.supposed_forearm, candidate);
        }
        log_area
    }

    /// ln p(blobs | hand) times the image's area: clutter + sum_b pi_b N(u(hand); CoG_b, R_b), with
    /// the area cue as a factor of each blob. What the blobs' beliefs leave of one is clutter too.
    /// A blob that was not the hand before does not become the hand by being the only one.
    fn log_blob_term(&self, particle: &Particle, hand: Option<Pixel>) -> f32 {
        let hand_share = 1.0 - self.model.options().clutter_share;
        let sum_of_beliefs: f32 = self.beliefs.iter().sum();
        let total = max(sum_of_beliefs, 1.0);
        let clutter = 1.0 - hand_share * sum_of_beliefs / total;
        let Some(hand) = hand else { return ln(clutter) };
        let std_px = self.model.options().centre_std_per_focal * self.model.camera().focal_px();
        let peak = self.model.image_area_px() / (core::f32::consts::TAU * std_px * std_px);
        let mut sum = 0.0;
        for (candidate, belief) in self.candidates.iter().zip(&self.beliefs) {
            let miss = hand.distance_px(candidate.centre) / std_px;
            let exponent = -0.5 * (miss * miss + self.area_deviation(particle, &particle.forearm(), candidate));
            sum += belief / total * peak * exp(exponent);
        }
        ln(clutter + hand_share * sum)
    }
}

#[cfg(test)]
mod tests {
    use super::super::model::ArmModel;
    use super::super::options::ArmOptions;
    use super::*;
    use crate::camera::Camera;
    use crate::skeleton::{ArmGeometry, Side};

    fn only(upper: OrientationDensity, fore: OrientationDensity) -> LimbHypotheses {
        LimbHypotheses { estimate: LimbDensities { upper, fore }, blobs: heapless::Vec::new() }
    }

    fn context(model: &ArmModel) -> FrameContext<'_> {
        let shoulder_m = Vec3::new(0.2, -0.1, 1.2);
        FrameContext {
            model,
            shoulder_m,
            reachable: model.reachable(&shoulder_m),
            dt_s: 0.066,
            unseen_s: 0.0,
            hand_velocity_m_per_s: Vec3::zeros(),
            elbow_velocity_m_per_s: Vec3::zeros(),
            candidates: heapless::Vec::new(),
            rays: heapless::Vec::new(),
            radii_px: [0.0; 8],
            beliefs: [0.0; 8],
            counts: [0; 8],
            free: 1,
            best_chance: 0.0,
        }
    }

    #[test]
    fn the_weight_follows_the_forearm_s_orientation_and_is_uniform_without_edges() {
        let camera = Camera::from_field_of_view(640, 480, 1.05).unwrap();
        let geometry = ArmGeometry::new(Side::Left, 0.3, 0.35).unwrap();
        let model = ArmModel::new(camera, (640, 480), geometry, ArmOptions::default()).unwrap();
        let context = context(&model);
        let angles_rad = [0.0, 0.0, 1.57, 1.57];
        let (elbow_m, hand_m) = model.elbow_and_hand(&context.shoulder_m, &angles_rad);
        let particle = Particle { angles_rad, elbow_m, hand_m, driver: None };
        let proposed = Proposed { particle, jump_m: 0.0, supposed_forearm: Vec3::zeros(), log_importance: 0.0 };
        let uniform = OrientationDensity::uniform(36).unwrap();
        let flat = only(uniform, uniform);
        let image = context.image_of(&proposed.particle).unwrap();
        let slope = atan2(image.hand.v_px - image.elbow.v_px, image.hand.u_px - image.elbow.u_px);
        let mut votes = [0_u16; 36];
        votes[uniform.bin_of(slope)] = 10;
        let fitting = only(uniform, uniform.from_votes(&votes));
        votes.rotate_left(18);
        let crossing = only(uniform, uniform.from_votes(&votes));
        let weight = |limbs: &LimbHypotheses| context.log_weight(&proposed, limbs);
        assert!(weight(&fitting) > weight(&flat) + 2.0);
        assert!(weight(&crossing) < weight(&flat) - 2.0);
        assert!((weight(&flat) - 2.0 * ln(1.1)).abs() < 1.0e-5);
    }
}
