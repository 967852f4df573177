use super::*;
use std::f64::consts::{PI, TAU};

const FRAMES: usize = 180;

/// Legs and arms of a walker in a side view, 30 frames a second; the sides cross twice a cycle.
fn walker(noise_px: f64) -> Vec<Option<Vec<Keypoint>>> {
    let mut seed = 1_u32;
    let mut random = move || {
        // Sum of four even numbers: near enough to a normal one.
        let mut sum = 0.0;
        for _ in 0..4 {
            seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            sum += f64::from(seed >> 8) / f64::from(1_u32 << 24) - 0.5;
        }
        noise_px * sum * 3.0_f64.sqrt()
    };
    (0..FRAMES)
        .map(|frame| {
            let mut person = Vec::new();
            for (side, phase) in [(0, 0.0), (3, PI)] {
                let angle = TAU * frame as f64 / 30.0 + phase;
                let (hip, swing) = ([100.0 + 5.0 * frame as f64, 300.0], 0.4 * angle.sin());
                let bend = 0.5 + 0.5 * (angle + 0.7).cos();
                let knee = [hip[0] + 120.0 * swing.sin(), hip[1] + 120.0 * swing.cos()];
                let shank = swing - bend;
                let ankle = [knee[0] + 110.0 * shank.sin(), knee[1] + 110.0 * shank.cos()];
                let shoulder = [hip[0] + 5.0, 140.0];
                let elbow = [shoulder[0] - 80.0 * (0.7 * swing).sin(), shoulder[1] + 80.0];
                let wrist = [elbow[0] - 70.0 * (0.9 * swing).sin() + 20.0, elbow[1] + 60.0];
                for (joint, place) in [(8, hip), (9, knee), (10, ankle), (2, shoulder), (3, elbow), (4, wrist)] {
                    let position_px = place.map(|coordinate| coordinate + random());
                    person.push(Keypoint { part: Part::Joint(joint + side), position_px, confidence: 0.9 });
                }
            }
            Some(person)
        })
        .collect()
}

fn numbers() -> Vec<u64> {
    (0..FRAMES as u64).collect()
}

#[test]
fn legs_that_cross_are_not_exchanged() {
    for noise_px in [0.0, 1.0, 3.0] {
        let clean = walker(noise_px);
        let mut mended = clean.clone();
        assert_eq!(mend(&numbers(), &mut mended, 160.0), Mended::default(), "{noise_px} px");
        assert_eq!(mended, clean);
    }
}

#[test]
fn exchanged_frames_are_found_for_arms_and_legs_apart() {
    for noise_px in [0.0, 1.0, 3.0] {
        let clean = walker(noise_px);
        let mut people = clean.clone();
        let (legs, arms) = (|frame: usize| frame % 16 < 4, |frame: usize| (66..86).contains(&frame));
        for (frame, person) in people.iter_mut().enumerate() {
            for keypoint in person.iter_mut().flatten() {
                if legs(frame) {
                    exchange(keypoint, &LEGS);
                }
                if arms(frame) {
                    exchange(keypoint, &ARMS);
                }
            }
        }
        let found = mend(&numbers(), &mut people, 160.0);
        assert!(found.legs.abs_diff(48) <= 4 && found.arms.abs_diff(20) <= 2, "{noise_px} px: {found:?}");
        let wrong = people.iter().zip(&clean).filter(|(mended, clean)| mended != clean).count();
        assert!(wrong <= 6, "{noise_px} px: {wrong} frames");
    }
}

#[test]
fn the_majority_between_long_gaps_is_right() {
    let mut people = walker(1.0);
    for (frame, person) in people.iter_mut().enumerate() {
        if frame >= 120 {
            person.iter_mut().flatten().for_each(|keypoint| exchange(keypoint, &LEGS));
        }
        if frame % 10 == 0 || (20..35).contains(&frame) {
            *person = None;
        }
    }
    let found = mend(&numbers(), &mut people, 160.0);
    assert!(found.legs.abs_diff(54) <= 2, "the last third, less the frames without a person: {found:?}");
}

#[test]
fn a_short_or_empty_recording_stays_as_it_is() {
    assert_eq!(mend(&[], &mut [], 100.0), Mended::default());
    let mut two = walker(0.0)[..2].to_vec();
    assert_eq!(mend(&[0, 1], &mut two, 100.0), Mended::default());
}
