//! Do hands rank above other blobs on real webcam sequences? Runs where `../shared/data` is at hand, and says so where not.

use sinew::frames::FrameReader;
use sinew_core::vision::blobs::LikelyBlob;
use sinew_core::vision::edges::EdgeDetector;
use sinew_core::vision::hand_likelihood::{
    DEFAULT_AREA_FRACTIONS, DEFAULT_SCALE, DEFAULT_WEIGHTS, HandLikelihood, LikelihoodForm,
};
use sinew_core::vision::skin::GaussianSkin;
use std::path::{Path, PathBuf};

/// Left, top, width, height of a reference box, pixels.
type ReferenceBox = [f32; 4];

fn data() -> Option<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shared/data/video/handtracking");
    folder.is_dir().then_some(folder)
}

fn boxes(file: &Path) -> Vec<(usize, ReferenceBox)> {
    let mut reader = csv::Reader::from_path(file).unwrap();
    let rows = reader.deserialize::<(usize, f32, f32, f32, f32)>().map(Result::unwrap);
    rows.map(|(frame, x, y, w, h)| (frame, [x, y, w, h])).collect()
}

fn holds([x, y, w, h]: &ReferenceBox, blob: &LikelyBlob) -> bool {
    let centre = blob.blob.centroid;
    (*x..=x + w).contains(&centre.u_px) && (*y..=y + h).contains(&centre.v_px)
}

/// Part of all pairs in which the hand has the greater score, ties by half.
fn area_under_curve(hands: &[f32], others: &[f32]) -> f64 {
    let pairs = hands.iter().flat_map(|h| others.iter().map(move |o| h.total_cmp(o)));
    let wins: f64 = pairs.map(|order| 0.5 * f64::from(order as i8 + 1)).sum();
    wins / (hands.len() * others.len()) as f64
}

/// Hands and other blobs of one sequence, and the area of its images in pixels.
fn sorted_blobs(folder: &Path, sequence: &str) -> (Vec<LikelyBlob>, Vec<LikelyBlob>, f32) {
    let skin = GaussianSkin::new(0.451_82, 0.315_68, [0.001_659_2, 0.000_035_8, 0.000_184_1], 2.25, 215).unwrap();
    let reference = boxes(&folder.join(format!("{sequence}_boxes.csv")));
    let mut reader = FrameReader::new(HandLikelihood::default(), EdgeDetector::default()).unwrap();
    let (mut hands, mut others, mut image_area_px) = (Vec::new(), Vec::new(), 0.0);
    for frame in 0.. {
        let Ok(image) = image::open(folder.join(sequence).join(format!("frame_{frame:04}.png"))) else { break };
        let image = image.to_rgb8();
        image_area_px = (image.width() * image.height()) as f32;
        let blobs = reader.read(&image, &skin).unwrap().blobs;
        let here: Vec<ReferenceBox> = reference.iter().filter(|(at, _)| *at == frame).map(|(_, b)| *b).collect();
        for wanted in &here {
            hands.extend(blobs.iter().filter(|blob| holds(wanted, blob)).max_by_key(|blob| blob.blob.area_px).copied());
        }
        let outside = |blob: &&LikelyBlob| blob.blob.area_px > 300 && !here.iter().any(|b| holds(b, blob));
        others.extend(blobs.iter().filter(outside).copied());
    }
    (hands, others, image_area_px)
}

#[test]
fn the_default_form_ranks_hands_above_other_blobs() {
    let Some(folder) = data() else {
        eprintln!("skipped: ../shared/data is not beside the project");
        return;
    };
    let paper = HandLikelihood::new(LikelihoodForm::Paper, DEFAULT_WEIGHTS, DEFAULT_AREA_FRACTIONS, DEFAULT_SCALE);
    let forms = [HandLikelihood::default(), paper.unwrap()];
    for sequence in ["hand1", "hand2"] {
        let (hands, others, image_area_px) = sorted_blobs(&folder, sequence);
        let [filled, printed] = forms.map(|form| {
            let scores = |blobs: &[LikelyBlob]| -> Vec<f32> {
                blobs.iter().map(|blob| form.evaluate(&blob.blob, image_area_px)).collect()
            };
            area_under_curve(&scores(&hands), &scores(&others))
        });
        println!("{sequence}: {} hands, {} others, filled {filled:.3}, paper {printed:.3}", hands.len(), others.len());
        assert!(hands.len() >= 70 && others.len() >= 30);
        assert!((0.85..1.0).contains(&filled), "{sequence}: {filled}");
        assert!(printed < 0.65, "{sequence}: the printed form has become better, {printed}: is it still as printed?");
    }
}
