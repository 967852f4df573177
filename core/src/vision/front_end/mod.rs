//! From a camera's lines, as they arrive, to blobs and temporal edge pixels: no frame buffer, no
//! mask of a frame.
//!
//! A line becomes skin bits by one look-up a pixel ([`skin_table`]). It is opened and closed four
//! lines later ([`super::line_morphology`]) and goes into the same scanner for components as the
//! host's masks ([`super::component_scanner`]). Its luminances are compared with the lines around
//! it and with the 1-bit edge map of the previous frame ([`edge_lines`]).
//!
//! ```
//! use sinew_core::vision::front_end::{
//!     QvgaFrontEnd, edge_lines::EdgeSteps, pixel_format::Rgb565, skin_table::SkinTable,
//! };
//! use sinew_core::vision::hand_likelihood::HandLikelihood;
//! use sinew_core::vision::skin::GaussianSkin;
//!
//! let mut table = SkinTable::<Rgb565>::new();
//! table.learn(&GaussianSkin::new(0.44, 0.31, [0.0030, -0.0008, 0.0010], 2.0, 60)?);
//! let mut front_end =
//!     QvgaFrontEnd::new((320, 240), HandLikelihood::default(), EdgeSteps::default())?;
//!
//! // Lines as a camera sends them, 16 bits a pixel: a hand's worth of skin in the middle.
//! let rgb565 = |[r, g, b]: [u16; 3]| (r >> 3) << 11 | (g >> 2) << 5 | b >> 3;
//! front_end.begin_frame();
//! for v in 0..240 {
//!     let line = std::array::from_fn::<u16, 320, _>(|u| {
//!         let is_skin = (130..180).contains(&u) && (100..150).contains(&v);
//!         rgb565(if is_skin { [200, 140, 110] } else { [20, 40, 90] })
//!     });
//!     front_end.line(v, &line, &table);
//! }
//! let seen = front_end.end_frame();
//! assert_eq!((seen.candidates.len(), seen.losses.missing_lines), (1, 0));
//! assert!((seen.candidates[0].centre.u_px - 154.5).abs() < 0.6);
//! # Ok::<(), sinew_core::error::ParameterError>(())
//! ```

pub mod calibration;
pub mod edge_lines;
mod frame_lines;
mod line_front_end;
pub mod moment_blob;
mod person_lines;
pub mod pixel_format;
pub mod skin_table;
#[cfg(test)]
mod tests;

pub use frame_lines::{FrameLines, FrameLosses};
pub use line_front_end::{LineFrontEnd, QvgaFrontEnd, VgaFrontEnd};
pub use person_lines::{PersonFrame, PersonHands, PersonLines};
