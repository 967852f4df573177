//! The paper's Kalman filter as it is saved.

use crate::cyclic::kalman::filter::KalmanFilter;
use crate::cyclic::phase::POSITIONS_IN_CYCLE;
use crate::cyclic::saved_ranges::{NUMBER, VARIANCE, covariance_bound};
use crate::cyclic::start::MAX_CYCLE_VELOCITY;
use crate::math::abs;
use crate::saved_state::{SavedState, StateVisitor};
use core::f32::consts::PI;

impl<const N: usize> SavedState for KalmanFilter<N> {
    fn visit(&mut self, visitor: &mut impl StateVisitor) {
        visitor.reals(&mut self.angles_rad, &(-PI..=PI));
        for turns in &mut self.turns {
            visitor.integer(turns);
        }
        visitor.reals(&mut self.velocities, &NUMBER);
        let blocks = &mut self.covariance;
        for block in [&mut blocks.angle, &mut blocks.cross, &mut blocks.velocity] {
            visitor.reals(block.as_flattened_mut(), &NUMBER);
        }
        if !self.covariance.is_plausible() {
            visitor.refuse();
        }
        let cycle = &mut self.cycle;
        visitor.real(&mut cycle.position, &POSITIONS_IN_CYCLE);
        visitor.real(&mut cycle.velocity, &(-MAX_CYCLE_VELOCITY..=MAX_CYCLE_VELOCITY));
        visitor.real(&mut cycle.position_variance, &VARIANCE);
        let mut saved = cycle.covariance;
        visitor.real(&mut saved, &NUMBER);
        visitor.real(&mut cycle.velocity_variance, &VARIANCE);
        let within = covariance_bound([cycle.position_variance, cycle.velocity_variance]);
        if !(abs(saved) <= within) {
            visitor.refuse();
        }
        cycle.covariance = saved;
    }
}

#[cfg(test)]
mod tests {
    use crate::cyclic::{AngleMeasurement, CycleStart, KalmanFilter, KalmanOptions, synthetic};
    use crate::saved_state::{StateError, StateKind, restore, save};

    #[test]
    fn a_restored_filter_equals_the_saved_one() {
        let table = synthetic::table(4.0e-3, 9);
        let model = table.model().unwrap();
        let seen = |frame: u16| -> [Option<f32>; 13] {
            core::array::from_fn(|i| Some(synthetic::mean_angle(i, f32::from(frame) / 65.0)))
        };
        let options = KalmanOptions::default();
        let start = CycleStart::standard(&model, &seen(0), None, None).unwrap();
        let mut filter = KalmanFilter::<13>::new(&model, &options, &start).unwrap();
        let mut other = filter;
        let mut bytes = [0; 4096];
        for frame in 1..=100 {
            filter.step(&model, &options, &AngleMeasurement::new(&seen(frame), 0.1).unwrap());
            let count = save(StateKind::Cyclic, 1, &mut filter, &mut bytes).unwrap();
            restore(StateKind::Cyclic, 1, &mut other, &bytes[..count]).unwrap();
            assert_eq!(other, filter, "frame {frame}");
        }
        filter.cycle.position = 1.0;
        let count = save(StateKind::Cyclic, 1, &mut filter, &mut bytes).unwrap();
        assert_eq!(restore(StateKind::Cyclic, 1, &mut other, &bytes[..count]), Err(StateError::Illegal));
    }
}
