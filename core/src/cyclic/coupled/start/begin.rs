//! Start of the phase-coupled filter: at the first row, or anywhere in the cycle.

use crate::cyclic::coupled::ablation::{Part, is_on};
use crate::cyclic::coupled::measurement::measured_path::MeasuredPath;
use crate::cyclic::coupled::measurement::measurement_noise::MeasurementNoise;
use crate::cyclic::coupled::measurement::winding::Winding;
use crate::cyclic::coupled::phase::phase_grid::PhaseGrid;
use crate::cyclic::coupled::start::initial_measurement::InitialMeasurement;
use crate::cyclic::coupled::state::CoupledFilter;
use crate::cyclic::phase::wrap_position;
use crate::cyclic::{AngleMeasurement, CoupledModel};
use crate::error::{ParameterError, Rule, finite, within};
use crate::math::round;
use crate::numeric::rolled::rolled;
use core::f32::consts::TAU;

impl<const N: usize> CoupledFilter<N> {
    /// The standard start from the first row. Its noise is estimated from its distance to the mean
    /// pose, up to the stated one. Without a `position` the best match is taken, without a
    /// `velocity`, cycles per frame, the model's mean.
    ///
    /// # Errors
    /// At most `N` angles, a model with a deviation, a finite position, a velocity within +-0.5
    /// cycles a frame.
    pub fn new(
        model: &CoupledModel<'_>,
        first: &AngleMeasurement<N>,
        position: Option<f32>,
        velocity: Option<f32>,
    ) -> Result<Self, ParameterError> {
        let mut filter = Self::empty();
        filter.begin(model, first, position, velocity)?;
        Ok(filter)
    }

    /// Becomes what [`Self::new`] gives, in place.
    ///
    /// # Errors
    /// Those of [`Self::new`]; the filter is as before then.
    pub fn begin(
        &mut self,
        model: &CoupledModel<'_>,
        first: &AngleMeasurement<N>,
        position: Option<f32>,
        velocity: Option<f32>,
    ) -> Result<(), ParameterError> {
        let velocity = within("initial cycle velocity", velocity.unwrap_or(model.mean_cycle_velocity()), -0.5, 0.5)?;
        let position = match position {
            Some(position) => wrap_position(finite("initial cycle position", position)?),
            None => crate::cyclic::start::best_position(model, first.angles_rad()),
        };
        let row = InitialMeasurement::of(model, first, position)?;
        self.forget(model)?;
        self.leader.position = position;
        self.leader.velocity = velocity;
        self.grid.store(&PhaseGrid::near(position));
        for (block, excess_rad2) in self.leader.blocks.iter_mut().zip(row.offset_excess_rad2).take(rolled(N)) {
            block.inflate_offset(excess_rad2);
        }
        self.leader.correct(model, &row.measurement, &self.winding, (&mut self.noise, false));
        self.update_angles(model, &row.measurement);
        self.start_counting(model, first);
        if !model.winds() && is_on(Part::SecondSpeed) {
            self.begin_second_speed();
        }
        Ok(())
    }

    /// A person two standard deviations faster, for one cycle: one linearisation does not reach so
    /// far, and teaches the person a wrong phase. In an even circle likelihoods distinguish none.
    fn begin_second_speed(&mut self) {
        self.hypotheses = 1;
        self.rival.begin_faster(&self.leader, 2.0);
        self.second_speed_cycles = 1.0;
    }

    /// A start anywhere in the cycle at any speed, with the first row as a measurement among
    /// others.
    ///
    /// # Errors
    /// At most `N` angles, a model with a deviation.
    pub fn anywhere(model: &CoupledModel<'_>, first: &AngleMeasurement<N>) -> Result<Self, ParameterError> {
        let mut filter = Self::empty();
        filter.forget(model)?;
        filter.searching = true;
        filter.correct(model, first);
        filter.start_counting(model, first);
        Ok(filter)
    }

    /// Resets to position 0, the model's mean speed and an unknown person.
    fn forget(&mut self, model: &CoupledModel<'_>) -> Result<(), ParameterError> {
        if model.angle_count() > N {
            return Err(ParameterError::new("angles of the model", Rule::Capacity { capacity: N }));
        }
        if model.parts().deviation.is_absent() {
            return Err(ParameterError::new("deviation of the model", Rule::NotEmpty));
        }
        self.leader.forget(model);
        self.rival.forget(model);
        self.grid.forget();
        self.unwatched_frames = 0.0;
        self.searching = false;
        self.misfit_cycles = 0.0;
        self.second_speed_cycles = 0.0;
        self.noise = MeasurementNoise::new();
        self.angles_rad = [0.0; N];
        self.turns = [0; N];
        self.winding = Winding::new();
        self.path = MeasuredPath::new();
        self.hypotheses = 0;
        Ok(())
    }

    /// Starts all counts. Whole turns of the first row (of the mean pose for a missing angle) are
    /// kept, so that no angle jumps after it.
    fn start_counting(&mut self, model: &CoupledModel<'_>, first: &AngleMeasurement<N>) {
        let pose = model.mean_pose_rad::<N>(model.point(self.leader.position));
        let angles = self.turns.iter_mut().zip(&self.angles_rad).zip(&pose).enumerate().take(rolled(N));
        for (i, ((turns, angle_rad), &mean_rad)) in angles {
            let first_rad = first.angle_rad(i).unwrap_or(mean_rad);
            *turns = round((first_rad - angle_rad) / TAU) as i32;
        }
        self.leader.cycles = 0;
        self.winding = Winding::new();
    }
}
