//! Which of several people is followed: the one that takes the most room at first, then the nearest
//! from frame to frame.

use super::layout::{DetectedFrame, Keypoint, Part};
use crate::cyclic::image_joints::Point;

/// How far a person may move between frames, in their own height, before another one is believed to
/// be seen.
const FARTHEST_STEP: f64 = 0.25;
/// How much farther for each frame in which the person was not seen, and at most.
const FARTHER_PER_FRAME: f64 = 0.05;
const FARTHEST: f64 = 1.0;

/// For each frame the index of the person that is followed, or `None` where no person is near
/// enough. Where no frame has more than one person it is that one. No other person can be confused
/// with them, and a box of few visible points says nothing about a person's size.
#[must_use]
pub fn follow(frames: &[DetectedFrame]) -> Vec<Option<usize>> {
    if frames.iter().all(|frame| frame.people.len() <= 1) {
        return frames.iter().map(|frame| (!frame.people.is_empty()).then_some(0)).collect();
    }
    let mut last: Option<(usize, &Vec<Keypoint>)> = None;
    let mut chosen = Vec::with_capacity(frames.len());
    for (now, frame) in frames.iter().enumerate() {
        let choice = match last {
            None => largest(&frame.people),
            Some((before, person)) => {
                let unseen = (now - before - 1) as f64;
                let reach = height(person) * (FARTHEST_STEP + FARTHER_PER_FRAME * unseen).min(FARTHEST);
                nearest(person, &frame.people, reach)
            }
        };
        if let Some(index) = choice {
            last = Some((now, &frame.people[index]));
        }
        chosen.push(choice);
    }
    chosen
}

/// The person with the largest box.
fn largest(people: &[Vec<Keypoint>]) -> Option<usize> {
    let area = |person: &Vec<Keypoint>| {
        let [width, height] = extent(person);
        width * height
    };
    let mut best: Option<(usize, f64)> = None;
    for (index, person) in people.iter().enumerate() {
        let area = area(person);
        if best.is_none_or(|(_, most)| area > most) {
            best = Some((index, area));
        }
    }
    best.map(|(index, _)| index)
}

fn extent(person: &[Keypoint]) -> Point {
    [0, 1].map(|axis| {
        let places = person.iter().map(|keypoint| keypoint.position_px[axis]);
        let (low, high) = places.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), x| (l.min(x), h.max(x)));
        (high - low).max(0.0)
    })
}

/// Size of a person: the diagonal of their box, at least 20 pixels.
fn height(person: &[Keypoint]) -> f64 {
    let [width, height] = extent(person);
    width.hypot(height).max(20.0)
}

/// The person whose points moved least since `before`, if on the mean not farther than `reach`
/// pixels.
fn nearest(before: &[Keypoint], people: &[Vec<Keypoint>], reach: f64) -> Option<usize> {
    let mut best: Option<(usize, f64)> = None;
    for (index, person) in people.iter().enumerate() {
        let distance = distance(before, person);
        if distance <= reach && best.is_none_or(|(_, least)| distance < least) {
            best = Some((index, distance));
        }
    }
    best.map(|(index, _)| index)
}

/// Mean distance of the points that both have; of the centres where they share none.
fn distance(a: &[Keypoint], b: &[Keypoint]) -> f64 {
    let find = |part: Part| b.iter().find(|other| other.part == part);
    let shared: Vec<f64> =
        a.iter().filter_map(|one| Some(apart(one.position_px, find(one.part)?.position_px))).collect();
    if shared.is_empty() {
        return apart(centre(a), centre(b));
    }
    shared.iter().sum::<f64>() / shared.len() as f64
}

fn apart(a: Point, b: Point) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}

fn centre(person: &[Keypoint]) -> Point {
    [0, 1].map(|axis| person.iter().map(|keypoint| keypoint.position_px[axis]).sum::<f64>() / person.len() as f64)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn person(u: f64, size: f64) -> Vec<Keypoint> {
        let point = |joint: usize, dv: f64| Keypoint {
            part: Part::Joint(joint),
            position_px: [u + dv * 0.1, 100.0 + dv],
            confidence: 1.0,
        };
        vec![point(1, 0.0), point(8, size * 0.5), point(10, size)]
    }

    #[test]
    fn the_largest_is_followed_though_the_order_changes_and_another_one_passes() {
        let frames: Vec<DetectedFrame> = (0..40)
            .map(|frame| {
                let (tall, short) =
                    (person(50.0 + 5.0 * f64::from(frame), 200.0), person(450.0 - 5.0 * f64::from(frame), 120.0));
                let people = match frame {
                    10..15 => vec![short],
                    _ if frame % 2 == 0 => vec![tall, short],
                    _ => vec![short, tall],
                };
                DetectedFrame { frame: frame as u64, people }
            })
            .collect();
        let chosen = follow(&frames);
        for (frame, choice) in chosen.iter().enumerate() {
            let wanted = if (10..15).contains(&frame) { None } else { Some(frame % 2) };
            assert_eq!(*choice, wanted, "frame {frame}");
        }
    }

    /// A swimmer of whom a wrist is seen, then the other, then nothing.
    #[test]
    fn the_only_person_is_never_lost() {
        let point =
            |joint: usize, u: f64| Keypoint { part: Part::Joint(joint), position_px: [u, 9.0], confidence: 1.0 };
        let people = [vec![vec![point(4, 10.0)]], vec![vec![point(7, 300.0)]], Vec::new(), vec![vec![point(4, 600.0)]]];
        let frames: Vec<DetectedFrame> =
            (0..).zip(people).map(|(frame, people)| DetectedFrame { frame, people }).collect();
        assert_eq!(follow(&frames), [Some(0), Some(0), None, Some(0)]);
    }

    #[test]
    fn a_frame_without_people_has_no_person() {
        assert_eq!(follow(&[DetectedFrame { frame: 0, people: Vec::new() }]), [None]);
    }
}
