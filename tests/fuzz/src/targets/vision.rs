//! The front end: pictures to blobs and edges. Hands over time: lines and faces to candidates.

use super::pictures::picture;
use crate::Target;
use crate::numbers::{Numbers, seeds};
use sinew::frames::FrameReader;
use sinew_core::saved_state::SavedState;
use sinew_core::vision::edges::EdgeDetector;
use sinew_core::vision::hand_likelihood::HandLikelihood;
use sinew_core::vision::objects::grid::CellGrid;
use sinew_core::vision::objects::hands::HandFinder;
use sinew_core::vision::objects::head::HeadBox;
use sinew_core::vision::skin::GaussianSkin;

/// Pictures of any size and content, two after the other.
pub const TARGETS: &[Target] = &[
    Target { name: "front_end", run: front_end, seeds: || seeds(300) },
    Target { name: "hands_over_time", run: hands_over_time, seeds: || seeds(400) },
];

/// Frames of an execution, and most lines of each.
const FRAMES: usize = 6;
const MAX_LINES: usize = 80;

fn front_end(bytes: &[u8]) {
    let mut numbers = Numbers::new(bytes);
    let skin = GaussianSkin::new(
        numbers.number(0.45),
        numbers.number(0.31),
        [numbers.number(0.001), numbers.number(0.0), numbers.number(0.0005)],
        numbers.number(2.5),
        u16::from(numbers.byte()),
    );
    let Ok(skin) = skin else { return };
    let mut reader =
        FrameReader::new(HandLikelihood::default(), EdgeDetector::default()).expect("the defaults are legal");
    for _ in 0..2 {
        let picture = picture(&mut numbers);
        let view = reader.read(&picture, &skin).expect("a picture within the limits");
        for blob in &view.candidates {
            let numbers = blob.moments_px2.iter().chain([&blob.area_px, &blob.centre.u_px, &blob.centre.v_px]);
            assert!(numbers.into_iter().all(|number| number.is_finite()), "{blob:?}");
            assert!((0.0..=1.0).contains(&blob.likelihood), "{blob:?}");
        }
        let is_inside = |u: u16, v: u16| u32::from(u) < picture.width() && u32::from(v) < picture.height();
        assert!(view.edges.iter().all(|edge| is_inside(edge.u, edge.v)), "an edge outside");
    }
}

/// Faces and lines of any length for a grid of any size.
fn hands_over_time(bytes: &[u8]) {
    let mut numbers = Numbers::new(bytes);
    let (width, height) = (4 * numbers.below(200), numbers.below(200));
    let Some(grid) = CellGrid::<80, 60>::new(width, height) else { return };
    let mut finder = HandFinder::new(grid);
    for _ in 0..FRAMES {
        let centre_px = [numbers.number(80.0), numbers.number(30.0)];
        finder.add_face(HeadBox { centre_px, width_px: numbers.number(16.0) });
        finder.grid_mut().begin();
        for line in 0..numbers.below(MAX_LINES) {
            let skin: Vec<u32> = (0..numbers.below(30)).map(|_| u32::from(numbers.byte()) * 0x0101_0101).collect();
            let level = numbers.byte();
            finder.grid_mut().line(
                line + numbers.below(3),
                &skin,
                &vec![level; 4 * numbers.below(256)],
                numbers.below(5),
            );
        }
        let hands = finder.step().clone();
        for hand in hands.iter().flatten() {
            assert!((0.0..=1.0).contains(&hand.likelihood), "{hand:?}");
            let place = [hand.centre.u_px, hand.centre.v_px, hand.area_px];
            assert!(place.iter().chain(&hand.moments_px2).all(|number| number.is_finite()), "{hand:?}");
        }
        assert!(finder.is_finite(), "the state");
    }
}
