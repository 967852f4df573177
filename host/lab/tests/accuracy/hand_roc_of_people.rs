//! What ranks a person's hands above face, forearms and clutter: the shape of a blob, motion, or
//! the belief over time? The area under the ROC curve, at the places that the tracker is offered.
//! Runs where `../shared/data` is at hand, and says so where not.

use crate::shared_data::in_long_form;
use sinew::frames::{FrameReader, FrameView};
use sinew::person::{FaceLooks, PersonFinder};
use sinew::skin::SkinModel;
use sinew::skin::model::DEFAULT_SKIN;
use sinew::track::FrameSource;
use sinew_core::camera::{Camera, Pixel};
use sinew_core::vision::edges::EdgeDetector;
use sinew_core::vision::hand_likelihood::{
    DEFAULT_AREA_FRACTIONS, DEFAULT_SCALE, DEFAULT_WEIGHTS, HandLikelihood, LikelihoodForm,
};
use sinew_lab::hand_ranking::area_under_curve;
use sinew_lab::people::clips::{RATE_HZ, list, reference};
use sinew_lab::people::reference::{Palm, Reference};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// A place that is neither is further than this from any palm, sizes of the palm.
const FAR_FROM_PALM: f32 = 0.7;
/// A place is on a forearm within this, distances of the ears.
const NEAR_FOREARM: f32 = 0.5;
/// Ways to rank a place.
const RANKINGS: [&str; 4] = ["blob, as printed", "blob, filled", "motion", "belief over time"];

/// Scores of places by what is there.
#[derive(Default)]
struct Places {
    hands: Vec<[f32; 4]>,
    others: BTreeMap<&'static str, Vec<[f32; 4]>>,
}

/// What is at a place; none where it is not clear.
fn label(row: &Reference, place: Pixel) -> Option<&'static str> {
    let palms: Vec<Palm> = row.palms().collect();
    let ([_, _], Some(ears_px)) = (palms.as_slice(), row.ears_px()) else { return None };
    if palms.iter().any(|palm| palm.holds(place)) {
        return Some("hand");
    }
    if palms.iter().any(|palm| palm.distance(place) <= FAR_FROM_PALM) {
        return None;
    }
    row.point("nose")?;
    if row.is_on_face(place) {
        return Some("face");
    }
    let is_on = |side: &str| {
        let (elbow, wrist) = (row.point(&format!("{side}_elbow"))?, row.point(&format!("{side}_wrist"))?);
        let (du, dv) = (wrist.u_px - elbow.u_px, wrist.v_px - elbow.v_px);
        let along = (place.u_px - elbow.u_px) * du + (place.v_px - elbow.v_px) * dv;
        let part = (along / (du * du + dv * dv).max(1.0)).clamp(0.0, 1.0);
        let foot = Pixel::new(elbow.u_px + part * du, elbow.v_px + part * dv);
        Some(place.distance_px(foot) <= NEAR_FOREARM * ears_px)
    };
    let is_arm = ["l", "r"].into_iter().filter_map(is_on).any(|is_on| is_on);
    Some(if is_arm { "forearm" } else { "clutter" })
}

/// Likelihoods of the smallest blob around a place, and the motion there.
fn alone(view: &FrameView, place: Pixel, radius_px: f32, forms: &[HandLikelihood; 2], image_area_px: f32) -> [f32; 3] {
    let around = view.blobs.iter().filter(|blob| {
        let bounds = blob.blob.bounding_box;
        (f32::from(bounds.min_u)..=f32::from(bounds.max_u)).contains(&place.u_px)
            && (f32::from(bounds.min_v)..=f32::from(bounds.max_v)).contains(&place.v_px)
    });
    let blob = around.min_by_key(|blob| blob.blob.area_px);
    let [paper, filled] =
        forms.each_ref().map(|form| blob.map_or(0.0, |blob| form.evaluate(&blob.blob, image_area_px)));
    let is_near = |u: u16, v: u16| Pixel::new(f32::from(u), f32::from(v)).distance_px(place) <= radius_px;
    let moving = view.edges.iter().filter(|edge| is_near(edge.u, edge.v)).count();
    [paper, filled, moving as f32 / (radius_px * radius_px)]
}

fn add(clip: &Path, places: &mut Places) {
    let mut frames = FrameSource::open(clip, false, RATE_HZ).unwrap();
    let (width, height) = frames.size_px();
    let camera = Camera::from_field_of_view(width, height, 1.05).unwrap();
    let mut finder = PersonFinder::new((width, height), camera, FaceLooks::new(RATE_HZ, 1, None).unwrap());
    let mut reader = FrameReader::new(HandLikelihood::default(), EdgeDetector::default()).unwrap();
    let anyone = SkinModel::from_option(DEFAULT_SKIN).unwrap();
    let paper = HandLikelihood::new(LikelihoodForm::Paper, DEFAULT_WEIGHTS, DEFAULT_AREA_FRACTIONS, DEFAULT_SCALE);
    let forms = [paper.unwrap(), HandLikelihood::default()];
    for (frame, row) in reference(clip).unwrap().iter().enumerate() {
        let Some(Ok(image)) = frames.load(frame, 1).unwrap().pop() else { break };
        finder.look(frame, &image, None);
        let view = match finder.skin().cloned() {
            Some(skin) => reader.read(&image, &skin).unwrap(),
            None => reader.read(&image, &anyone).unwrap(),
        };
        let Some(person) = finder.see(&mut reader) else { continue };
        let mut seen: Vec<(Pixel, f32)> = Vec::new();
        for hand in person.hands.iter().flatten() {
            match seen.iter_mut().find(|(place, _)| place.distance_px(hand.centre) < 1.0) {
                Some((_, likelihood)) => *likelihood = likelihood.max(hand.likelihood),
                None => seen.push((hand.centre, hand.likelihood)),
            }
        }
        let radius_px = 0.5 * row.ears_px().unwrap_or(60.0);
        for (place, belief) in seen {
            let Some(what) = label(row, place) else { continue };
            let [paper, filled, moving] = alone(&view, place, radius_px, &forms, (width * height) as f32);
            let scores = [paper, filled, moving, belief];
            if what == "hand" {
                places.hands.push(scores);
            } else {
                places.others.entry(what).or_default().push(scores);
            }
        }
    }
}

/// Areas under the curve of all rankings, of hands against `others`.
fn areas(hands: &[[f32; 4]], others: &[[f32; 4]]) -> [f64; 4] {
    core::array::from_fn(|ranking| {
        let of = |places: &[[f32; 4]]| -> Vec<f32> { places.iter().map(|scores| scores[ranking]).collect() };
        area_under_curve(&of(hands), &of(others)).unwrap_or(f64::NAN)
    })
}

#[test]
fn the_belief_ranks_hands_above_all_else() {
    let given = std::env::var_os("SINEW_CLIPS").map(PathBuf::from);
    let Some(folder) = given.or_else(|| in_long_form("video/asl")) else { return };
    let clips = list(&folder).unwrap();
    let mut places = Places::default();
    clips.iter().for_each(|clip| add(clip, &mut places));
    println!("{} places on hands; rankings {RANKINGS:?}", places.hands.len());
    for (what, others) in &places.others {
        println!("{what}, {} places: {:.2?}", others.len(), areas(&places.hands, others));
    }
    let all: Vec<[f32; 4]> = places.others.into_values().flatten().collect();
    let [paper, filled, motion, belief] = areas(&places.hands, &all);
    println!("all, {} places: {paper:.2} {filled:.2} {motion:.2} {belief:.2}", all.len());
    assert!(places.hands.len() > 500 && all.len() > 500);
    // The numbers of docs/hands_over_time.md.
    assert!((0.86..0.92).contains(&belief) && (0.70..0.78).contains(&motion), "{belief} {motion}");
    assert!(paper.max(filled) < 0.65, "{paper} {filled}");
}
