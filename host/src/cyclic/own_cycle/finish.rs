//! A recording that has been tracked, as an estimate that has seen all of it.

use super::course::Course;
use super::noise;
use super::phase::{self, Unevenness};
use super::seen::Seen;
use super::shape::Shape;
use super::standing::standing;
use crate::cyclic::angle_table::{ANGLES, SPACE_ANGLES};
use crate::cyclic::stops::LONGEST_BRIDGE_CYCLES;
use crate::cyclic::tracking::{Tracked, TrackedFrame, TrackingOptions};
use crate::cyclic::turns::least_angle;
use crate::cyclic::{AngleTable, CyclicModel};
use crate::error::{Context, Result};
use rayon::prelude::*;
use std::f64::consts::TAU;

/// The run of a filter over a table with angles and phases of the whole recording. The angles are
/// what was measured, filtered, and in gaps the person's own cycle. Rows in which nothing is known
/// say so. `noise_rad` is the standard deviation of a measured angle where it is known from
/// elsewhere; else each angle shows its own.
///
/// # Errors
/// Frame numbers that jump too far.
pub fn finish(
    table: &AngleTable,
    model: &CyclicModel,
    tracked: Tracked,
    options: &TrackingOptions,
    noise_rad: Option<f64>,
) -> Result<Tracked> {
    let finish =
        if model.numbers().angle_count > ANGLES { finish_angles::<SPACE_ANGLES> } else { finish_angles::<ANGLES> };
    finish(table, model, tracked, options, noise_rad)
}

fn finish_angles<const N: usize>(
    table: &AngleTable,
    model: &CyclicModel,
    mut tracked: Tracked,
    options: &TrackingOptions,
    noise_rad: Option<f64>,
) -> Result<Tracked> {
    let seen = Seen::<N>::of_table(table, &options.updates).context(
        "frame numbers jump over more than a hundred frames for each row; cut the recording where it jumps, or track it with --online",
    )?;
    let first = phases_of(&tracked);
    let stands = standing(&seen, &first);
    let phased = phase::fitted(&seen, first, &Shape::of_model(model), &stands);
    let moving = stands.iter().filter(|stands| !**stands).count();
    let cycle_frames = moving as f64 / (phased.phases[phased.phases.len() - 1] - phased.phases[0]).abs();
    let stretches = seen.stretches(LONGEST_BRIDGE_CYCLES * cycle_frames);
    let mut is_known = vec![false; seen.angles_rad.len()];
    stretches.iter().for_each(|[first, last]| is_known[*first..=*last].fill(true));
    let stride = noise::thirtieth_frames(tracked.rate_hz);
    let course = |angle| {
        let found_rad = || noise::of_angle(&seen, angle, stride).unwrap_or(phased.std_rad[angle]);
        Course::new(&seen, angle, &phased, (&is_known, noise_rad.unwrap_or_else(found_rad)))
    };
    let courses: Vec<Course> = (0..N).into_par_iter().map(course).collect();
    let (origin, uneven) = (phased.phases[0], phase::unevenness(&phased.phases, &stands));
    for row in &mut tracked.frames {
        let frame = (row.frame - seen.first_frame) as usize;
        row.is_known = is_known[frame];
        row.estimate.outlier = courses.iter().any(|course| course.is_outlier[frame]);
        set_angles(row, &courses, frame);
        set_phase(row, &phased.phases, frame, (tracked.step_frames, uneven.as_ref().map(|uneven| uneven[frame])));
        row.cycles = phased.phases[frame] - origin;
    }
    Ok(tracked)
}

/// The phase of every frame, those between rows on the straight line.
fn phases_of(tracked: &Tracked) -> Vec<f64> {
    let origin = f64::from(tracked.frames[0].estimate.cycle_position);
    let mut phases = vec![origin + tracked.frames[0].cycles];
    for pair in tracked.frames.windows(2) {
        let step = pair[1].frame - pair[0].frame;
        let way = pair[1].cycles - pair[0].cycles;
        phases.extend((1..=step).map(|k| origin + pair[0].cycles + way * k as f64 / step as f64));
    }
    phases
}

fn set_angles(row: &mut TrackedFrame, courses: &[Course], frame: usize) {
    let estimate = &mut row.estimate;
    for (angle, course) in courses.iter().enumerate() {
        let (angle_rad, std_rad) = (course.angles_rad[frame], course.std_rad[frame]);
        let turns = ((angle_rad - least_angle(angle_rad)) / TAU).round();
        match angle.checked_sub(ANGLES) {
            None => {
                row.angles_rad[angle] = angle_rad;
                estimate.angles_rad[angle] = least_angle(angle_rad) as f32;
                estimate.turns[angle] = turns as i32;
                estimate.angle_variance_rad2[angle] = (std_rad * std_rad) as f32;
            }
            Some(index) => {
                if let Some(side) = &mut row.side {
                    side.angles_rad[index] = angle_rad;
                    side.angle_variance_rad2[index] = (std_rad * std_rad) as f32;
                }
            }
        }
    }
}

fn set_phase(row: &mut TrackedFrame, phases: &[f64], frame: usize, (step_frames, uneven): (f64, Option<Unevenness>)) {
    let estimate = &mut row.estimate;
    estimate.cycle_position = phases[frame].rem_euclid(1.0) as f32;
    estimate.cycle_velocity_per_frame = (phase::velocity(phases, frame) / step_frames) as f32;
    if let Some(uneven) = uneven {
        estimate.cycle_position_variance = uneven.position_std.powi(2) as f32;
        estimate.cycle_velocity_variance = (uneven.velocity_std_per_frame / step_frames).powi(2) as f32;
    }
}
