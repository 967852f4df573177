//! The phase-coupled filter's state as it is saved.

use crate::cyclic::coupled::state::CoupledFilter;
use crate::saved_state::{NOT_NEGATIVE, SavedState, StateVisitor};
use core::f32::consts::PI;

impl<const N: usize> SavedState for CoupledFilter<N> {
    fn visit(&mut self, visitor: &mut impl StateVisitor) {
        self.leader.visit(visitor);
        self.rival.visit(visitor);
        self.grid.visit(visitor);
        visitor.real(&mut self.unwatched_frames, &NOT_NEGATIVE);
        visitor.flag(&mut self.searching);
        visitor.real(&mut self.misfit_cycles, &(-1.0..=1.0));
        visitor.real(&mut self.second_speed_cycles, &(0.0..=1.0));
        self.noise.visit(visitor);
        visitor.reals(&mut self.angles_rad, &(-PI..=PI));
        for turns in &mut self.turns {
            visitor.integer(turns);
        }
        self.winding.visit(visitor);
        self.path.visit(visitor);
        visitor.word(&mut self.hypotheses);
    }
}

#[cfg(test)]
mod tests {
    use crate::cyclic::{AngleMeasurement, CoupledFilter, synthetic};
    use crate::saved_state::{StateError, StateKind, restore, save};

    #[test]
    fn a_restored_filter_equals_the_saved_one() {
        let table = synthetic::table(4.0e-3, 9);
        let model = table.model().unwrap();
        let seen = |frame: u16| {
            let angles: [_; 13] = core::array::from_fn(|i| Some(synthetic::mean_angle(i, f32::from(frame) / 65.0)));
            AngleMeasurement::new(&angles, 0.1).unwrap()
        };
        let mut filter = CoupledFilter::<13>::new(&model, &seen(0), None, None).unwrap();
        let mut other = filter;
        let mut bytes = [0; 8192];
        for frame in 1..=150 {
            filter.step(&model, &seen(frame));
            let count = save(StateKind::Cyclic, 1, &mut filter, &mut bytes).unwrap();
            restore(StateKind::Cyclic, 1, &mut other, &bytes[..count]).unwrap();
            assert_eq!(other, filter, "frame {frame}");
        }
        filter.leader.position = 1.0;
        let count = save(StateKind::Cyclic, 1, &mut filter, &mut bytes).unwrap();
        assert_eq!(restore(StateKind::Cyclic, 1, &mut other, &bytes[..count]), Err(StateError::Illegal));
    }
}
