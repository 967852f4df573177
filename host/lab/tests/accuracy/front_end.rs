//! The line front end of the core against the host's chain, on rendered scenes and on webcam
//! frames. Both have the same blobs, similar edges, and a likelihood that ranks them alike.
//!
//! `cargo test --release -p sinew-lab --test accuracy front_end -- --nocapture` prints what
//! `docs/front_end.md` states.

use image::RgbImage;
use image::imageops::{FilterType, resize};
use sinew::frames::{FrameReader, FrameView};
use sinew::images::folder::{list_images, load_rgb};
use sinew::scene::{Scene, SceneOptions, Sides};
use sinew::skin::SkinModel;
use sinew::skin::model::DEFAULT_SKIN;
use sinew_core::vision::edges::{EdgeDetector, EdgePixel};
use sinew_core::vision::front_end::edge_lines::EdgeSteps;
use sinew_core::vision::front_end::moment_blob::MomentBlob;
use sinew_core::vision::front_end::pixel_format::Rgb565;
use sinew_core::vision::front_end::skin_table::SkinTable;
use sinew_core::vision::front_end::{FrameLosses, LineFrontEnd};
use sinew_core::vision::hand_likelihood::HandLikelihood;
use sinew_core::vision::skin::SkinClassifier;
use sinew_lab::clips;
use std::path::Path;

/// Room for all that 320 x 252 pixels can show.
type FrontEnd = LineFrontEnd<10, 54, 54, 512, 8192, 126>;

/// The table as a classifier of ordinary pixels, so that the host sees the same mask.
struct Quantised(SkinTable<Rgb565>);

impl SkinClassifier for Quantised {
    fn classify_line(&self, rgb: &[u8], bits: &mut [u32]) {
        self.0.classify_line(&rgb565(rgb), bits);
    }
}

fn rgb565(rgb: &[u8]) -> Vec<u16> {
    let pixel = |&[r, g, b]: &[u8; 3]| u16::from(r >> 3) << 11 | u16::from(g >> 2) << 5 | u16::from(b >> 3);
    rgb.as_chunks::<3>().0.iter().map(pixel).collect()
}

/// Blobs with both likelihoods, and how well the edges agree.
#[derive(Debug, Default)]
struct Comparison {
    /// Moment likelihood and the host's likelihood of every blob of a hundred pixels and more.
    likelihoods: Vec<[f32; 2]>,
    frames: usize,
    /// Edges of the front end, and those of them with one of the host's within three pixels.
    edges: [usize; 2],
    /// The host's edges, and those of them with one of the front end's within three pixels.
    host_edges: [usize; 2],
}

/// Runs both chains on the frames of a sequence, and fails where their blobs differ by a bit.
fn compare(frames: &[RgbImage], comparison: &mut Comparison) {
    let model = SkinModel::from_option(DEFAULT_SKIN).unwrap();
    let mut skin = Quantised(SkinTable::new());
    skin.0.learn(&*model.for_image(&frames[0]).unwrap());
    let mut reader = FrameReader::new(HandLikelihood::default(), EdgeDetector::default()).unwrap();
    let size = (frames[0].width() as usize, frames[0].height() as usize);
    let mut front_end: Box<FrontEnd> =
        Box::new(LineFrontEnd::new(size, HandLikelihood::default(), EdgeSteps::default()).unwrap());
    for frame in frames {
        let view = reader.read(frame, &skin).unwrap();
        front_end.begin_frame();
        for (v, line) in frame.as_raw().chunks_exact(3 * size.0).enumerate() {
            front_end.line(v, &rgb565(line), &skin.0);
        }
        let lines = front_end.end_frame();
        assert_eq!(lines.losses, FrameLosses::default());
        comparison.likelihoods.extend(paired(lines.blobs, &view));
        comparison.frames += 1;
        let near = |pixel: &EdgePixel, others: &[EdgePixel]| {
            others.iter().any(|o| o.u.abs_diff(pixel.u) <= 3 && o.v.abs_diff(pixel.v) <= 3)
        };
        let shared = |of: &[EdgePixel], others: &[EdgePixel]| [of.len(), of.iter().filter(|p| near(p, others)).count()];
        for (sums, counts) in [
            (&mut comparison.edges, shared(lines.edges, &view.edges)),
            (&mut comparison.host_edges, shared(&view.edges, lines.edges)),
        ] {
            sums.iter_mut().zip(counts).for_each(|(sum, count)| *sum += count);
        }
    }
}

/// The same blobs of both chains, bit for bit; the host keeps the 64 likeliest.
fn paired(blobs: &[MomentBlob], view: &FrameView) -> Vec<[f32; 2]> {
    assert!(view.dropped_blobs > 0 || blobs.len() == view.blobs.len());
    let pairs = view.blobs.iter().map(|host| {
        let same = |blob: &&MomentBlob| {
            let host = &host.blob;
            (blob.area_px, blob.centroid, blob.moments_px2, blob.bounding_box, blob.perimeter_px)
                == (host.area_px, host.centroid, host.moments_px2, host.bounding_box, host.plain.perimeter_px)
        };
        let blob = blobs.iter().find(same).unwrap_or_else(|| panic!("no {host:?} in {blobs:?}"));
        (blob, [blob.moment_likelihood, host.likelihood])
    });
    pairs.filter(|(blob, _)| blob.area_px >= 100).map(|(_, likelihoods)| likelihoods).collect()
}

/// Spearman's rank correlation; ties share their mean rank.
fn spearman(pairs: &[[f32; 2]]) -> f64 {
    let ranks = |which: usize| -> Vec<f64> {
        let below = |value: f32| pairs.iter().filter(|pair| pair[which] < value).count();
        let equal = |value: f32| pairs.iter().filter(|pair| pair[which] == value).count();
        pairs.iter().map(|p| below(p[which]) as f64 + 0.5 * (equal(p[which]) as f64 + 1.0)).collect()
    };
    let (a, b) = (ranks(0), ranks(1));
    let mean = 0.5 * (pairs.len() as f64 + 1.0);
    let product = |x: &[f64], y: &[f64]| x.iter().zip(y).map(|(x, y)| (x - mean) * (y - mean)).sum::<f64>();
    product(&a, &b) / (product(&a, &a) * product(&b, &b)).sqrt()
}

/// Share of the front end's edges with one of the host's within three pixels.
fn near_the_hosts(comparison: &Comparison) -> f64 {
    let [all, near] = comparison.edges;
    near as f64 / all.max(1) as f64
}

fn report(name: &str, comparison: &Comparison) -> f64 {
    let share = |[all, near]: [usize; 2]| near as f64 / all.max(1) as f64;
    let rank = spearman(&comparison.likelihoods);
    println!(
        "{name}: {} frames, {} blobs, rank agreement {rank:.3}, edges {} ({:.3} near the host's), the host's {} ({:.3} near)",
        comparison.frames,
        comparison.likelihoods.len(),
        comparison.edges[0],
        share(comparison.edges),
        comparison.host_edges[0],
        share(comparison.host_edges),
    );
    rank
}

#[test]
fn rendered_scenes_give_the_same_blobs_in_a_similar_order() {
    let mut comparison = Comparison::default();
    for (seed, clip) in (1..).zip(clips::builtin(6)) {
        let options = SceneOptions {
            width_px: 320,
            height_px: 240,
            frames: 20,
            seed,
            sides: Sides::Both,
            ..SceneOptions::default()
        };
        let scene = Scene::new(&clip.load(options.frames_per_second, options.frames).unwrap(), &options).unwrap();
        let frames: Vec<RgbImage> = (0..scene.len()).map(|frame| scene.render(frame)).collect();
        compare(&frames, &mut comparison);
    }
    let rank = report("rendered", &comparison);
    assert!((0.92..0.98).contains(&rank), "{rank}");
    assert!(near_the_hosts(&comparison) > 0.95);
}

#[test]
fn webcam_frames_give_the_same_blobs_in_a_similar_order() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data/video/handtracking");
    if !folder.is_dir() {
        eprintln!("skipped: ../shared/data is not beside the project");
        return;
    }
    for (sequence, expected) in [("hand1", 0.92..0.98), ("hand2", 0.5..0.65)] {
        let files = list_images(&folder.join(sequence)).unwrap();
        let small = |file| resize(&load_rgb(file).unwrap(), 320, 252, FilterType::Triangle);
        let frames: Vec<RgbImage> = files.iter().map(|file| small(file)).collect();
        let mut comparison = Comparison::default();
        compare(&frames, &mut comparison);
        let rank = report(sequence, &comparison);
        assert!(expected.contains(&rank), "{sequence}: {rank}");
        assert!(near_the_hosts(&comparison) > 0.95, "{sequence}");
    }
}
