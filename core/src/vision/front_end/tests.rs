//! The front end against the host's chain on the same skin bits.

use super::edge_lines::EdgeSteps;
use super::moment_blob::MomentBlob;
use super::pixel_format::{Rgb565, Yuyv};
use super::skin_table::{self, SkinTable};
use super::*;
use crate::error::{ParameterError, Rule};
use crate::vision::blobs::BlobList;
use crate::vision::component_scanner::ComponentScanner;
use crate::vision::edges::EdgePixel;
use crate::vision::hand_likelihood::HandLikelihood;
use crate::vision::mask::{Mask, MaskMut, words_per_row};
use crate::vision::morphology::{close, open, scratch_words};
use crate::vision::runs::RunPool;
use proptest::prelude::*;

/// A pixel of each kind and a table that separates them.
const SKIN: u16 = 0xb4c8;
const OTHER: u16 = 0x1234;

fn table() -> SkinTable<Rgb565> {
    let mut words = [0; skin_table::TABLE_WORDS];
    words[usize::from(SKIN / 32)] = 1 << (SKIN % 32);
    SkinTable::from_words(words)
}

fn front_end<const W: usize, const R: usize, const O: usize, const B: usize, const E: usize, const M: usize>(
    size: (usize, usize),
) -> LineFrontEnd<W, R, O, B, E, M> {
    LineFrontEnd::new(size, HandLikelihood::default(), EdgeSteps::default()).unwrap().with_min_area_fraction(0.0)
}

fn line(mask: &Mask<'_>, v: usize) -> Vec<u16> {
    (0..mask.width()).map(|u| if mask.get(u, v) { SKIN } else { OTHER }).collect()
}

fn read<'f, const W: usize, const R: usize, const O: usize, const B: usize, const E: usize, const M: usize>(
    front_end: &'f mut LineFrontEnd<W, R, O, B, E, M>,
    mask: &Mask<'_>,
) -> FrameLines<'f> {
    let table = table();
    front_end.begin_frame();
    (0..mask.height()).for_each(|v| front_end.line(v, &line(mask, v), &table));
    front_end.end_frame()
}

/// The blobs of a whole mask, opened and closed, from the scanner as the host uses it.
fn wanted(words: &mut [u32], width: usize, height: usize) -> Vec<MomentBlob> {
    let mut mask = MaskMut::new(words, width, height).unwrap();
    let mut scratch = vec![0; scratch_words(width)];
    open(&mut mask, &mut scratch).unwrap();
    close(&mut mask, &mut scratch).unwrap();
    let mut list = BlobList::<400, MomentBlob>::new();
    let likelihood = HandLikelihood::default();
    ComponentScanner::<60, 60>::new().scan(&mask.view(), &mut RunPool::new(&mut []), &mut |component, _| {
        list.insert(MomentBlob::of(component, &likelihood, (width * height) as f32));
    });
    list.as_slice().to_vec()
}

prop_compose! {
    fn any_mask()(width in 1_usize..129, height in 1_usize..40, coarse in 1_usize..6, rare in any::<bool>())
        (noise in prop::collection::vec(any::<[u32; 2]>(), 129 * 40 / 16),
         width in Just(width), height in Just(height), coarse in Just(coarse), rare in Just(rare))
        -> (Vec<u32>, usize, usize) {
        let mut words = vec![0; words_per_row(width) * height];
        let mut mask = MaskMut::new(&mut words, width, height).unwrap();
        for i in 0..width * height {
            let (u, v) = (i % width, i / width);
            let at = (v / coarse) * 129 + u / coarse;
            let [a, b] = noise[at / 32 % noise.len()].map(|word| word >> (at % 32) & 1 == 1);
            mask.set(u, v, if rare { a & b } else { a | b });
        }
        (words, width, height)
    }
}

proptest! {
    #[test]
    fn blobs_equal_those_of_the_whole_mask((mut words, width, height) in any_mask()) {
        let mut front_end = front_end::<4, 60, 60, 400, 64, 20>((width, height));
        let mask = words.clone();
        let mask = Mask::new(&mask, width, height).unwrap();
        let wanted = wanted(&mut words, width, height);
        for _ in 0..2 {
            let found = read(&mut front_end, &mask);
            prop_assert_eq!(found.losses, FrameLosses { dropped_edges: found.losses.dropped_edges, ..Default::default() });
            prop_assert_eq!(found.blobs, wanted.as_slice());
            let centres: Vec<_> = found.candidates.iter().map(|c| (c.centre, c.area_px as u32, c.likelihood)).collect();
            let blobs: Vec<_> = wanted.iter().map(|b| (b.centroid, b.area_px, b.moment_likelihood)).collect();
            prop_assert_eq!(centres, blobs);
        }
    }

    #[test]
    fn small_tables_report_what_they_lose((mut words, width, height) in any_mask()) {
        let mut front_end = front_end::<4, 3, 2, 2, 5, 20>((width, height));
        let mask = words.clone();
        let found = read(&mut front_end, &Mask::new(&mask, width, height).unwrap());
        let wanted = wanted(&mut words, width, height);
        let (area, kept) = (
            wanted.iter().map(|blob| blob.area_px).sum::<u32>(),
            found.blobs.iter().map(|blob| blob.area_px).sum::<u32>(),
        );
        let losses = found.losses;
        prop_assert!(kept + losses.dropped_px <= area);
        let lossless = losses.dropped_px + losses.dropped_components + losses.dropped_blobs == 0;
        prop_assert_eq!(lossless, found.blobs == wanted.as_slice());
        prop_assert!(losses.dropped_blobs > 0 || kept + losses.dropped_px == area);
    }

    #[test]
    fn any_lines_in_any_order_do_not_panic(
        width in 1_usize..70, height in 1_usize..20,
        lines in prop::collection::vec((0_usize..24, 0_usize..80), 0..40), pixels in prop::collection::vec(any::<u16>(), 80),
        begin in any::<bool>(),
    ) {
        let mut table = SkinTable::<Yuyv>::new();
        table.learn(&crate::vision::skin::GaussianSkin::new(0.44, 0.31, [0.01, 0.0, 0.01], 3.0, 20).unwrap());
        let mut front_end = front_end::<3, 4, 3, 2, 5, 10>((width, height));
        if begin {
            front_end.begin_frame();
        }
        let (mut next, mut ignored) = (0, 0);
        for (v, length) in lines {
            front_end.line(v, &pixels[..length], &table);
            if v < next || v >= height { ignored += 1 } else { next = v + 1 }
        }
        let losses = front_end.end_frame().losses;
        prop_assert_eq!(losses.ignored_lines, ignored);
        prop_assert!(losses.missing_lines as usize >= height - next);
        prop_assert!(front_end.end_frame().losses.missing_lines as usize >= height);
    }
}

/// A frame with a disc of skin.
fn disc(width: usize, height: usize, (cu, cv): (i32, i32), radius: i32) -> Vec<u32> {
    let mut words = vec![0; words_per_row(width) * height];
    let mut mask = MaskMut::new(&mut words, width, height).unwrap();
    for i in 0..width * height {
        let (u, v) = ((i % width) as i32 - cu, (i / width) as i32 - cv);
        mask.set(i % width, i / width, u * u + v * v <= radius * radius);
    }
    words
}

#[test]
fn a_moving_disc_is_a_blob_with_edges_on_its_outline() {
    let mut front_end: QvgaFrontEnd = front_end((320, 240));
    let frames = [(150, 120), (150, 120), (158, 120)].map(|centre| disc(320, 240, centre, 30));
    let mut edges = Vec::new();
    for (frame, left) in frames.iter().zip([150.0, 150.0, 158.0]) {
        let found = read(&mut front_end, &Mask::new(frame, 320, 240).unwrap());
        assert_eq!(found.losses, FrameLosses::default());
        let [blob] = found.blobs else { panic!("{:?}", found.blobs) };
        assert!((blob.centroid.u_px - left).abs() < 1.0e-3 && blob.moment_likelihood > 0.8, "{blob:?}");
        assert!(blob.ellipse_fill() > 0.97 && blob.roundness() > 0.95, "{blob:?}");
        edges = found.edges.to_vec();
        let far = |pixel: &EdgePixel| {
            let (u, v) = (f32::from(pixel.u) - left, f32::from(pixel.v) - 120.0);
            ((u * u + v * v).sqrt() - 30.0).abs() > 4.0
        };
        assert!(!edges.iter().any(far), "{edges:?}");
    }
    assert!((30..200).contains(&edges.len()), "{}", edges.len());
}

#[test]
fn missing_late_and_short_lines_are_counted() {
    let (table, mut front_end) = (table(), front_end::<1, 8, 8, 4, 16, 6>((20, 12)));
    front_end.begin_frame();
    for v in [2, 3, 4, 5, 9, 7, 5, 12, 10] {
        front_end.line(v, &[SKIN; 20][..if v == 10 { 12 } else { 20 }], &table);
    }
    let found = front_end.end_frame();
    assert_eq!((found.losses.missing_lines, found.losses.ignored_lines), (2 + 3 + 1 + 1, 3));
    assert_eq!(found.blobs.iter().map(|blob| blob.area_px).collect::<Vec<_>>(), [80]);
    assert!(found.edges.is_empty());
}

#[test]
fn a_frame_that_did_not_end_is_dropped() {
    let mut front_end = front_end::<2, 8, 8, 4, 99, 20>((64, 40));
    let [first, second] = [20, 28].map(|u| disc(64, 40, (u, 20), 10));
    let [first, second] = [&first, &second].map(|words| Mask::new(words, 64, 40).unwrap());
    read(&mut front_end, &first);
    assert!(!read(&mut front_end, &second).edges.is_empty());
    front_end.begin_frame();
    (0..25).for_each(|v| front_end.line(v, &line(&first, v), &table()));
    let found = read(&mut front_end, &second);
    assert_eq!((found.blobs.len(), found.edges.len()), (1, 0));
}

#[test]
fn sizes_without_room_are_refused_by_name() {
    let new = |size| QvgaFrontEnd::new(size, HandLikelihood::default(), EdgeSteps::default()).unwrap_err();
    assert_eq!(new((0, 1)).parameter, "width");
    assert_eq!(new((321, 1)), ParameterError::new("width", Rule::Capacity { capacity: 320 }));
    assert_eq!(new((320, 241)), ParameterError::new("height", Rule::Capacity { capacity: 240 }));
}

#[test]
fn a_front_end_that_begins_anew_is_a_new_one() {
    let size = (64, 20);
    let square = |first: usize| -> Vec<u32> {
        (0..20).flat_map(|v| [if (4..14).contains(&v) { 0x3ff << first } else { 0 }, 0]).collect()
    };
    let (before, after) = (square(2), square(9));
    let mask = |words| Mask::new(words, 64, 20).unwrap();
    let mut used = front_end::<2, 12, 12, 4, 64, 10>((33, 20));
    read(&mut used, &mask(&before));
    used.begin_frame();
    used.line(0, &[SKIN; 33], &table());
    assert!(used.begin((65, 20), HandLikelihood::default(), EdgeSteps::default()).is_err());
    used.begin(size, HandLikelihood::default(), EdgeSteps::default()).unwrap();
    let mut new = LineFrontEnd::<2, 12, 12, 4, 64, 10>::new(size, HandLikelihood::default(), EdgeSteps::default());
    let new = new.as_mut().unwrap();
    for words in [&before, &after, &before] {
        let (found, wanted) = (read(&mut used, &mask(words)), read(new, &mask(words)));
        assert_eq!((found.blobs, found.candidates, found.edges), (wanted.blobs, wanted.candidates, wanted.edges));
        assert_eq!(found.blobs.len(), 1);
    }
}
