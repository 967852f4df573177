//! Do hands rank above other blobs on real webcam sequences? Runs where `../shared/data` is at
//! hand, and says so where not.

use sinew::skin::SkinModel;
use sinew::skin::model::DEFAULT_SKIN;
use sinew_lab::{hand_ranking, hands::load_frames, hands::read_boxes};
use std::path::{Path, PathBuf};

fn data() -> Option<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data/video/handtracking");
    folder.is_dir().then_some(folder)
}

#[test]
fn the_default_form_ranks_hands_above_other_blobs() {
    let Some(folder) = data() else {
        eprintln!("skipped: ../shared/data is not beside the project");
        return;
    };
    let skin = SkinModel::from_option(DEFAULT_SKIN).unwrap();
    for sequence in ["hand1", "hand2"] {
        let frames = load_frames(&folder.join(sequence)).unwrap();
        let boxes = read_boxes(&folder.join(format!("{sequence}_boxes.csv"))).unwrap();
        let ranking = hand_ranking::rank(&frames, &boxes, &skin).unwrap();
        println!("{sequence}: {ranking:?}");
        assert!(ranking.hands >= 70 && ranking.others >= 30);
        let (filled, printed) = (ranking.filled_area.unwrap(), ranking.paper_area.unwrap());
        assert!((0.85..1.0).contains(&filled), "{sequence}: {filled}");
        assert!(printed < 0.65, "{sequence}: the printed form has become better, {printed}: is it still as printed?");
    }
}
