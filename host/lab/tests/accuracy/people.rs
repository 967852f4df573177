//! Hands of recorded people, as recorded and changed: rows of `docs/measurements_people.md`.

use crate::shared_data::in_long_form;
use sinew_lab::people::changes::Change;
use sinew_lab::people::clips::list;
use sinew_lab::people::score::HandScore;
use sinew_lab::people::track::score;

/// Shares of all clips together after a change: rows that say `tracking`, of these on a hand, palms
/// that were found.
fn shares(change: Change) -> Option<[f64; 3]> {
    let clips = list(&in_long_form("video/asl")?).unwrap();
    let mut sum = HandScore::default();
    clips.iter().for_each(|clip| sum.plus(&score(clip, change).unwrap()[0]));
    let shares = [sum.sure_share(), sum.both().on_hand_share(), sum.found_share()];
    println!("{}: {shares:.3?}", change.name());
    Some(shares)
}

fn within(shares: [f64; 3], wanted: [f64; 3]) -> bool {
    shares.iter().zip(wanted).all(|(share, wanted)| (share - wanted).abs() < 0.05)
}

#[test]
fn hands_are_found_in_warm_light() {
    let Some(shares) = shares(Change::Warm) else { return };
    assert!(within(shares, [0.70, 0.899, 0.706]));
}

#[test]
fn hands_of_dark_skin_are_found_less() {
    let Some(shares) = shares(Change::DarkSkin) else { return };
    assert!(within(shares, [0.56, 0.636, 0.409]));
}

#[test]
fn forearms_that_leave_the_picture_are_taken_for_hands() {
    let Some(shares) = shares(Change::Seated) else { return };
    assert!(within(shares, [0.41, 0.796, 0.510]));
}
