//! A body whose lengths became known better: what trackers hold of its places is placed anew.

use super::state::BodyTracker;
use crate::kinematics::forward::posture;
use crate::math::Vec3;
use crate::pik::motion::BodyParticle;
use crate::skeleton::Skeleton;

impl<const BONES: usize, const ANGLES: usize> BodyParticle<BONES, ANGLES> {
    /// The same pose of a body with other lengths.
    pub(super) fn reshape(&mut self, skeleton: &Skeleton<BONES, ANGLES>) {
        self.ends_m = posture(skeleton, &Vec3::zeros(), &self.angles_rad).ends;
    }
}

impl<const BONES: usize, const ANGLES: usize, const N: usize, S> BodyTracker<BONES, ANGLES, N, S>
where
    S: AsRef<[BodyParticle<BONES, ANGLES>]> + AsMut<[BodyParticle<BONES, ANGLES>]>,
{
    /// Goes on with the same poses of a body with the lengths of `skeleton`. The next step has to
    /// be given a scene with it.
    pub fn reshape(&mut self, skeleton: &Skeleton<BONES, ANGLES>) {
        self.particles.as_mut().iter_mut().for_each(|particle| particle.reshape(skeleton));
        self.before.reshape(skeleton);
        if let Some(rival) = &mut self.rival {
            rival.pose.reshape(skeleton);
        }
        self.deadband.reported.reshape(skeleton);
    }
}
