//! The cyclic trackers: filter, counter, root and lengths.

use crate::corners::Corners;
use crate::cyclic::{Table, estimates_apart, hostile_measurement, seen, sound};
use crate::drive::{Recovery, Subject, drive, holds};
use sinew_core::cyclic::example::swing_table;
use sinew_core::cyclic::filter::FilterChoice;
use sinew_core::cyclic::{AngleMeasurement, KalmanOptions, MotionModel, PlaceOptions};
use sinew_core::saved_state::SavedState;
use sinew_core::tracker::cyclic::{
    CoupledTracker, CyclicFrame, CyclicFrameInput, CyclicTracker, CyclicTrackerOptions, FirstPhase,
};

const ROOT_PX: [f32; 2] = [300.0, 200.0];
const LENGTHS_PX: [f32; 2] = [80.0, 60.0];
/// Root and lengths of the twin, pixels: a tenth of a segment.
const MAX_APART_PX: f32 = 8.0;
/// After so many a tracker is near its twin: three cycles. After two, one burst of 400,000 was 1.02
/// times as far away as allowed.
const CLEAN_FRAMES: usize = 180;

type Input = CyclicFrameInput<2>;

trait Tracker: SavedState {
    fn step(&mut self, model: &MotionModel<'_>, input: &Input) -> CyclicFrame<2>;
    /// Root and lengths, where they are followed.
    fn place_px(&self) -> Vec<f32>;
}

impl Tracker for CyclicTracker<2> {
    fn step(&mut self, model: &MotionModel<'_>, input: &Input) -> CyclicFrame<2> {
        self.step(model, input)
    }

    fn place_px(&self) -> Vec<f32> {
        let Some(place) = self.place() else { return Vec::new() };
        let missing = [f32::NAN; 2];
        let lengths_px = place.lengths_px().map(|length_px| length_px.unwrap_or(f32::NAN));
        place.root_px().unwrap_or(missing).into_iter().chain(lengths_px).collect()
    }
}

impl Tracker for CoupledTracker<2> {
    fn step(&mut self, model: &MotionModel<'_>, input: &Input) -> CyclicFrame<2> {
        self.step(model, &input.angles)
    }

    fn place_px(&self) -> Vec<f32> {
        Vec::new()
    }
}

struct Tracked<T> {
    table: Table,
    trackers: [T; 2],
    last: Option<[CyclicFrame<2>; 2]>,
    frame: f32,
}

fn clean_input(frame: f32) -> Input {
    Input { angles: seen(frame), root_px: Some(ROOT_PX), lengths_px: LENGTHS_PX.map(Some) }
}

impl<T: Tracker> Subject for Tracked<T> {
    fn hostile(&mut self, corners: &mut Corners) -> Result<(), String> {
        let model = self.table.model().unwrap();
        let Some(angles) = hostile_measurement(corners, self.frame + 1.0) else { return Ok(()) };
        self.frame += angles.step_frames();
        let missing = AngleMeasurement::nothing().after(angles.step_frames()).unwrap();
        let root_px = (!corners.one_in(4)).then(|| ROOT_PX.map(|coordinate| corners.number(coordinate)));
        let hostile = Input { angles, root_px, lengths_px: LENGTHS_PX.map(|length| Some(corners.number(length))) };
        let [one, twin] = &mut self.trackers;
        twin.step(&model, &missing.into());
        let frame = one.step(&model, &hostile);
        sound(&frame.estimate).map_err(|message| format!("{message} by {hostile:?}"))?;
        let is_sound = frame.cadence_per_min.is_finite() && frame.cadence_std_per_min >= 0.0;
        holds(is_sound && frame.cycle_step.advance.is_finite(), || format!("{frame:?} by {hostile:?}"))?;
        holds(one.is_finite(), || format!("the state by {hostile:?}"))
    }

    fn clean(&mut self) {
        let model = self.table.model().unwrap();
        self.frame = (self.frame + 1.0) % 60.0;
        let input = clean_input(self.frame);
        self.last = Some(self.trackers.each_mut().map(|tracker| tracker.step(&model, &input)));
    }

    fn apart(&mut self) -> f32 {
        let Some([one, twin]) = &self.last else { return f32::INFINITY };
        let [one_px, twin_px] = self.trackers.each_ref().map(T::place_px);
        let places = one_px.iter().zip(&twin_px).map(|(a, b)| (a - b).abs() / MAX_APART_PX);
        let angles = estimates_apart(&one.estimate, &twin.estimate);
        places.fold(angles, |sum, apart| if apart <= sum { sum } else { apart })
    }
}

#[test]
fn the_cyclic_tracker_survives_hostile_frames() {
    let place = PlaceOptions::of_person(100.0, 0.005, 0.05, 60.0).unwrap();
    for (name, filter) in
        [("tracker", FilterChoice::Coupled), ("tracker, paper", FilterChoice::Kalman(KalmanOptions::default()))]
    {
        drive(name, CLEAN_FRAMES, Recovery::FromAll, || {
            let table = swing_table();
            let options = CyclicTrackerOptions { filter, place: Some(place) };
            let start = FirstPhase { position: Some(0.0), velocity_per_frame: None };
            let tracker = CyclicTracker::new(&table.model().unwrap(), options, &clean_input(0.0), start).unwrap();
            Tracked { table, trackers: [tracker; 2], last: None, frame: 0.0 }
        });
    }
}

#[test]
fn the_coupled_tracker_survives_hostile_frames() {
    drive("coupled tracker", CLEAN_FRAMES, Recovery::FromAll, || {
        let table = swing_table();
        let tracker = CoupledTracker::new(&table.model().unwrap(), &seen(0.0), FirstPhase::default()).unwrap();
        Tracked { table, trackers: [tracker; 2], last: None, frame: 0.0 }
    });
}
