//! From a camera's pixels to blobs that may be hands and to temporal edge pixels.
//!
//! ```
//! use sinew_core::vision::blobs::{BlobFinder, BlobList, DEFAULT_MIN_AREA_FRACTION};
//! use sinew_core::vision::edges::{EdgeDetector, EdgeList};
//! use sinew_core::vision::features::{BlobMeter, DEFAULT_FILL_RATIO};
//! use sinew_core::vision::frame::{
//!     FrameAnalyser, FrameBuffers, mask_words, runs_that_suffice,
//! };
//! use sinew_core::vision::hand_likelihood::HandLikelihood;
//! use sinew_core::vision::morphology::scratch_words;
//! use sinew_core::vision::runs::Run;
//! use sinew_core::vision::skin::GaussianSkin;
//!
//! const SIZE: (usize, usize) = (160, 120);
//! const WORDS: usize = mask_words(SIZE.0, SIZE.1);
//!
//! // A square of skin before a blue wall; it moves by six pixels.
//! let frame = |left: usize| -> Vec<u8> {
//!     let skin = |i: usize| {
//!         (left..left + 30).contains(&(i % SIZE.0)) && (50..80).contains(&(i / SIZE.0))
//!     };
//!     (0..SIZE.0 * SIZE.1)
//!         .flat_map(|i| if skin(i) { [200, 140, 110] } else { [20, 40, 90] })
//!         .collect()
//! };
//!
//! // All memory is the caller's.
//! let mut runs = vec![Run::default(); runs_that_suffice(SIZE.0, SIZE.1)];
//! let mut buffers = FrameBuffers {
//!     mask: &mut [0; WORDS],
//!     edges: &mut [0; WORDS],
//!     scratch: &mut [0; scratch_words(SIZE.0)],
//!     runs: &mut runs,
//!     luminance: [&mut [0; SIZE.0 * SIZE.1], &mut [0; SIZE.0 * SIZE.1]],
//! };
//! let skin = GaussianSkin::new(0.44, 0.31, [0.0030, -0.0008, 0.0010], 2.0, 60)?;
//! let finder = BlobFinder::<128, 64>::new(
//!     BlobMeter::new(DEFAULT_FILL_RATIO)?,
//!     HandLikelihood::default(),
//!     DEFAULT_MIN_AREA_FRACTION,
//! );
//! let mut analyser = FrameAnalyser::new(finder, EdgeDetector::default());
//! let (mut blobs, mut edges) = (BlobList::<8>::new(), EdgeList::<500>::new());
//! for left in [40, 46] {
//!     analyser.analyse(&frame(left), SIZE, &skin, &mut buffers, &mut blobs, &mut edges)?;
//! }
//! let [found] = blobs.as_slice() else { panic!("one square is one blob") };
//! assert_eq!(found.blob.area_px, 900);
//! assert!((found.blob.centroid.u_px - 60.5).abs() < 0.01);
//! assert!(!edges.as_slice().is_empty(), "it moved");
//! # Ok::<(), sinew_core::error::ParameterError>(())
//! ```

pub mod blobs;
pub mod candidate;
pub mod component_scanner;
pub mod components;
pub mod distance;
pub mod edges;
pub mod ellipse;
pub mod features;
pub mod frame;
pub mod front_end;
pub mod hand_likelihood;
pub mod line_morphology;
pub mod mask;
pub mod morphology;
pub mod objects;
pub mod runs;
pub(crate) mod shape;
pub mod skin;
pub mod white_balance;
