//! Both hands of a person over time, apart from the head and from what only has the colour of skin.
//! Beyond the arm paper, which takes each picture's blobs alone.
//!
//! The face gives the scale, the shoulders and the [colour](person_colour) of the skin. Lines of
//! pixels fill a [grid] of cells. Places that may be hands are the ends of elongated objects and
//! their thickest parts. Each frame's evidence for each side goes into a belief about the pair of
//! hands. The marginals of that belief are the likelihoods of the candidates that an arm tracker
//! takes. No picture is kept, and no work grows with the picture.
//!
//! ```
//! use sinew_core::vision::objects::grid::CellGrid;
//! use sinew_core::vision::objects::hands::HandFinder;
//! use sinew_core::vision::objects::head::HeadBox;
//!
//! let mut finder = HandFinder::<80, 60>::new(CellGrid::new(160, 120).expect("it has a size"));
//! finder.add_face(HeadBox { centre_px: [80.0, 30.0], width_px: 16.0 });
//! // The left hand, a square of skin, goes up beside the person.
//! let mut hands = Default::default();
//! for frame in 0..30 {
//!     let top = 90 - 2 * frame;
//!     finder.grid_mut().begin();
//!     for line in 0..120 {
//!         let is_hand = (top..top + 12).contains(&line);
//!         let skin = if is_hand { [0, 0, 0, 0x0fff, 0] } else { [0; 5] };
//!         let brightness: [u8; 160] =
//!             core::array::from_fn(|column| if is_hand && (96..108).contains(&column) { 160 } else { 80 });
//!         finder.grid_mut().line(line, &skin, &brightness, 1);
//!     }
//!     hands = finder.step().clone();
//! }
//! let left = &hands[0][0];
//! assert!(left.likelihood > 0.7);
//! assert!(left.centre.distance_px(sinew_core::camera::Pixel::new(102.0, 38.0)) < 4.0, "{left:?}");
//! ```

mod belief;
mod cells;
mod ends;
mod evidence;
mod find;
mod geodesic;
pub mod grid;
pub mod hands;
pub mod head;
mod labels;
mod object_table;
pub mod person_colour;
mod place;
mod saved;
