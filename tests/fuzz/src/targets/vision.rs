//! The front end: pictures to blobs and edges.

use super::pictures::picture;
use crate::Target;
use crate::numbers::{Numbers, seeds};
use sinew::frames::FrameReader;
use sinew_core::vision::edges::EdgeDetector;
use sinew_core::vision::hand_likelihood::HandLikelihood;
use sinew_core::vision::skin::GaussianSkin;

/// Pictures of any size and content, two after the other.
pub const TARGETS: &[Target] = &[Target { name: "front_end", run: front_end, seeds: || seeds(300) }];

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
