//! Which of several people is followed.
//!
//! People are followed from frame to frame by nearness; each gets a track. Then one track is taken.

use super::layout::{DetectedFrame, Keypoint, Part};
use crate::cyclic::image_joints::Point;
use std::str::FromStr;

/// How far a person may move between frames, in their own height, before another one is believed to
/// be seen.
const MAX_STEP: f64 = 0.25;
/// How much farther for each frame in which the person was not seen, and at most.
const MORE_PER_FRAME: f64 = 0.05;
const MAX_REACH: f64 = 1.0;
/// Most people of a frame that are followed, the largest. Chosen: more are a crowd, of which a
/// detector finds no limbs.
const MAX_PEOPLE: usize = 32;
/// Fewest frames of a track that is somebody. Chosen: shorter ones are false detections, and no
/// angles over time.
pub const MIN_TRACK_FRAMES: usize = 10;

/// Which person.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum PersonChoice {
    /// The one that takes the most room, summed over all frames.
    #[default]
    Largest,
    /// The one that is seen in the most frames.
    Longest,
    /// A number from 1: people are counted by the frames in which they are seen, most first.
    Number(usize),
}

impl FromStr for PersonChoice {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text {
            "largest" => Ok(Self::Largest),
            "longest" => Ok(Self::Longest),
            number => match number.parse() {
                Ok(number) if number > 0 => Ok(Self::Number(number)),
                _ => Err("it has to be `largest`, `longest` or a number from 1".to_owned()),
            },
        }
    }
}

/// One person over all frames.
#[derive(Debug, Clone, PartialEq)]
pub struct PersonTrack {
    /// Indices of the frames in which the person is seen, each with the index among its people.
    pub seen: Vec<(usize, usize)>,
    /// Area of the person's box, summed over frames.
    area_px2: f64,
}

impl PersonTrack {
    /// For each of `count` frames the index of the person in it.
    #[must_use]
    pub fn choices(&self, count: usize) -> Vec<Option<usize>> {
        let mut choices = vec![None; count];
        self.seen.iter().for_each(|(frame, person)| choices[*frame] = Some(*person));
        choices
    }
}

/// A track that may go on.
struct Open<'a> {
    track: PersonTrack,
    last: (usize, &'a Vec<Keypoint>),
}

/// Everybody's track, the longest first. Where no frame has more than one person it is one track,
/// since there is no other person to confuse. A box of few visible points says nothing about a
/// person's size.
#[must_use]
pub fn tracks(frames: &[DetectedFrame]) -> Vec<PersonTrack> {
    if frames.iter().all(|frame| frame.people.len() <= 1) {
        let with_person = frames.iter().enumerate().filter(|(_, frame)| !frame.people.is_empty());
        let seen: Vec<(usize, usize)> = with_person.map(|(index, _)| (index, 0)).collect();
        return if seen.is_empty() { Vec::new() } else { vec![PersonTrack { seen, area_px2: 0.0 }] };
    }
    let mut open: Vec<Open> = Vec::new();
    for (now, frame) in frames.iter().enumerate() {
        let people = &frame.people;
        let mut free: Vec<usize> = (0..people.len()).collect();
        free.sort_by(|a, b| area(&people[*b]).total_cmp(&area(&people[*a])));
        free.truncate(MAX_PEOPLE);
        let mut pairs: Vec<(f64, usize, usize)> = Vec::new();
        for (index, track) in open.iter().enumerate() {
            let reach = reach(track, now);
            let near = free.iter().map(|person| (distance(track.last.1, &people[*person]), index, *person));
            pairs.extend(near.filter(|(distance, ..)| *distance <= reach));
        }
        pairs.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut is_taken = vec![false; open.len()];
        for (_, index, person) in pairs {
            if !is_taken[index] && free.contains(&person) {
                is_taken[index] = true;
                free.retain(|other| *other != person);
                add(&mut open[index].track, now, person, &people[person]);
                open[index].last = (now, &people[person]);
            }
        }
        for person in free {
            let mut track = PersonTrack { seen: Vec::new(), area_px2: 0.0 };
            add(&mut track, now, person, &people[person]);
            open.push(Open { track, last: (now, &people[person]) });
        }
        forget(&mut open, now);
    }
    let mut tracks: Vec<PersonTrack> = open.into_iter().map(|open| open.track).collect();
    tracks.sort_by(|a, b| b.seen.len().cmp(&a.seen.len()).then(b.area_px2.total_cmp(&a.area_px2)));
    tracks
}

/// Most tracks that are kept. Chosen: with more, those of fewest frames are false detections.
const MAX_TRACKS: usize = 256;

/// Drops the shortest of too many tracks that were not seen now.
fn forget(open: &mut Vec<Open>, now: usize) {
    if open.len() > MAX_TRACKS {
        open.sort_by(|a, b| {
            (b.last.0 == now).cmp(&(a.last.0 == now)).then(b.track.seen.len().cmp(&a.track.seen.len()))
        });
        open.truncate(MAX_TRACKS);
    }
}

fn add(track: &mut PersonTrack, now: usize, person: usize, points: &[Keypoint]) {
    track.seen.push((now, person));
    track.area_px2 += area(points);
}

fn reach(track: &Open, now: usize) -> f64 {
    let unseen = (now - track.last.0 - 1) as f64;
    height(track.last.1) * (MAX_STEP + MORE_PER_FRAME * unseen).min(MAX_REACH)
}

/// Index of the track that is chosen; `None` where there is none of that number.
#[must_use]
pub fn choose(tracks: &[PersonTrack], choice: PersonChoice) -> Option<usize> {
    match choice {
        PersonChoice::Largest => {
            (0..tracks.len()).rev().max_by(|a, b| tracks[*a].area_px2.total_cmp(&tracks[*b].area_px2))
        }
        PersonChoice::Longest => (!tracks.is_empty()).then_some(0),
        PersonChoice::Number(number) => number.checked_sub(1).filter(|index| *index < tracks.len()),
    }
}

fn area(person: &[Keypoint]) -> f64 {
    let [width, height] = extent(person);
    width * height
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
    fn people_are_followed_though_their_order_changes_and_they_pass() {
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
        let tracks = tracks(&frames);
        let chosen = &tracks[choose(&tracks, PersonChoice::Largest).unwrap()].choices(40);
        let longest = &tracks[choose(&tracks, PersonChoice::Longest).unwrap()];
        assert_eq!((longest.seen.len(), tracks.len()), (40, 2), "the short one is in all frames");
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
        assert_eq!(tracks(&frames)[0].choices(4), [Some(0), Some(0), None, Some(0)]);
    }

    #[test]
    fn people_are_chosen_by_name_or_number() {
        assert_eq!(tracks(&[DetectedFrame { frame: 0, people: Vec::new() }]), []);
        let track = |seen: usize, area_px2: f64| PersonTrack { seen: vec![(0, 0); seen], area_px2 };
        let people = [track(9, 5.0), track(7, 8.0)];
        let index = |text: &str| choose(&people, text.parse().unwrap());
        assert_eq!((index("largest"), index("longest"), index("2"), index("3")), (Some(1), Some(0), Some(1), None));
        assert!("0".parse::<PersonChoice>().is_err() && "x".parse::<PersonChoice>().is_err());
    }
}
