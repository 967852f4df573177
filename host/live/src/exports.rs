//! The module's functions. Numbers go in, addresses and counts come out; the page reads and writes
//! the memory at the addresses between calls.
//!
//! Functions that can be refused give 0 for success and else the length of a text at [`text`] that
//! says what is wrong.

// Names are exported as they are in the module only, which has nothing else that they could clash
// with. The state is in locks that have no other user.
#![allow(unsafe_code)]
// A page gives numbers one by one.
#![allow(clippy::too_many_arguments)]

use crate::frame::Frame;
use crate::person::Shoulder;
use crate::session::{Choice, Session};
use core::fmt::Write;
use heapless::String;
use sinew_core::camera::Pixel;
use sinew_core::error::ParameterError;
use sinew_core::skeleton::Side;
use sinew_core::slot::Slot;
use spin::mutex::{SpinMutex, SpinMutexGuard};

/// Colour of the painted skin mask: red, green, blue, opacity.
const SKIN_COLOUR: [u8; 4] = [20, 210, 190, 110];
/// Room for a text, bytes.
const TEXT_BYTES: usize = 160;

static FRAME: SpinMutex<Frame> = SpinMutex::new(Frame::new());
static SESSION: SpinMutex<Slot<Session>> = SpinMutex::new(Slot::Empty);
static TEXT: SpinMutex<String<TEXT_BYTES>> = SpinMutex::new(String::new());

/// Calls `what` on the session and the picture; without a session it is refused.
fn with_session(what: impl FnOnce(&mut Session, &mut Frame) -> Result<(), ParameterError>) -> u32 {
    let mut session = SESSION.lock();
    let Some(session) = session.get_mut() else { return refused(&"no session was begun") };
    status_code(what(session, &mut FRAME.lock()))
}

/// Asks the session for something; the default without one.
fn ask<T: Default>(what: impl FnOnce(&mut Session) -> T) -> T {
    SESSION.lock().get_mut().map_or_else(T::default, what)
}

fn status_code(outcome: Result<(), ParameterError>) -> u32 {
    outcome.map_or_else(|error| refused(&error), |()| 0)
}

fn refused(why: &dyn core::fmt::Display) -> u32 {
    let mut text = TEXT.lock();
    text.clear();
    // What finds no room is cut off.
    let _ = write!(text, "{why}");
    text.len().max(1) as u32
}

/// Where the text of the last refusal lies.
#[cfg_attr(target_arch = "wasm32", unsafe(no_mangle))]
pub extern "C" fn text() -> *const u8 {
    TEXT.lock().as_ptr()
}

/// Where the page writes a picture: four bytes a pixel, red, green, blue and one that is not read.
#[cfg_attr(target_arch = "wasm32", unsafe(no_mangle))]
pub extern "C" fn picture() -> *mut u8 {
    FRAME.lock().rgba.as_mut_ptr()
}

/// Begins a session, or begins it anew for another choice. A choice is the size of all pictures,
/// side of the arm (0 is right), particles, seed, and the shoulder's distance (metres) and pixel.
/// Distance and pixel are NaN where they are not known. The person is looked for again, and
/// what a click has taught stays.
#[cfg_attr(target_arch = "wasm32", unsafe(no_mangle))]
pub extern "C" fn begin(
    width: u32,
    height: u32,
    is_left: u32,
    particles: u32,
    seed: u32,
    distance_m: f32,
    shoulder_u: f32,
    shoulder_v: f32,
) -> u32 {
    let shoulder = if shoulder_u.is_nan() && shoulder_v.is_nan() {
        Shoulder::Guessed { distance_m }
    } else {
        Shoulder::At { pixel: Pixel::new(shoulder_u, shoulder_v), distance_m }
    };
    let choice = Choice {
        size_px: (width as usize, height as usize),
        side: if is_left == 0 { Side::Right } else { Side::Left },
        particles: particles as usize,
        seed: u64::from(seed),
        shoulder,
    };
    let mut slot = SESSION.lock();
    status_code(begin_in(&mut slot, choice))
}

fn begin_in(slot: &mut SpinMutexGuard<'_, Slot<Session>>, choice: Choice) -> Result<(), ParameterError> {
    if let Some(session) = slot.get_mut() {
        return session.begin_again(choice);
    }
    **slot = Slot::Full(Session::new(choice)?);
    Ok(())
}

/// Looks for a face if it is time, and finds candidates and edges of the picture.
#[cfg_attr(target_arch = "wasm32", unsafe(no_mangle))]
pub extern "C" fn see() -> u32 {
    with_session(Session::see)
}

/// Moves the arm on to the picture that was seen last, taken at `timestamp_us`, microseconds since
/// any start.
#[cfg_attr(target_arch = "wasm32", unsafe(no_mangle))]
pub extern "C" fn track(timestamp_us: f64) -> u32 {
    with_session(|session, _| {
        // Negative numbers and those that are none become zero.
        session.track(timestamp_us as u64);
        Ok(())
    })
}

/// Learns the skin in a box around a pixel of the picture that was seen last.
#[cfg_attr(target_arch = "wasm32", unsafe(no_mangle))]
pub extern "C" fn calibrate(u: u32, v: u32) -> u32 {
    with_session(|session, frame| session.calibrate(frame, u as usize, v as usize))
}

/// Goes back to the skin of the face, or the shipped model.
#[cfg_attr(target_arch = "wasm32", unsafe(no_mangle))]
pub extern "C" fn forget_calibration() -> u32 {
    with_session(|session, _| {
        session.forget_calibration();
        Ok(())
    })
}

/// Where the answer to the last frame lies, see [`crate::answer::answer`].
#[cfg_attr(target_arch = "wasm32", unsafe(no_mangle))]
pub extern "C" fn answer() -> *const f32 {
    ask(|session| session.answer.as_ptr() as usize) as *const f32
}

/// Number of blobs of the last frame; of places of the hand once a face is known.
#[cfg_attr(target_arch = "wasm32", unsafe(no_mangle))]
pub extern "C" fn blob_count() -> u32 {
    ask(|session| session.candidates.len() as u32)
}

/// Where they lie, the most likely first, seven numbers each: centre u and v, moments uu, uv and
/// vv, area, likelihood.
#[cfg_attr(target_arch = "wasm32", unsafe(no_mangle))]
pub extern "C" fn blobs() -> *const f32 {
    ask(|session| session.candidates.as_ptr() as usize) as *const f32
}

/// Number of particles of the last frame.
#[cfg_attr(target_arch = "wasm32", unsafe(no_mangle))]
pub extern "C" fn particle_count() -> u32 {
    ask(|session| session.particles.len() as u32)
}

/// Where they lie, five numbers each, see [`crate::answer::particle`].
#[cfg_attr(target_arch = "wasm32", unsafe(no_mangle))]
pub extern "C" fn particles() -> *const f32 {
    ask(|session| session.particles.as_ptr() as usize) as *const f32
}

/// Paints the last skin mask and returns its address: four bytes a pixel, transparent where no skin
/// is.
#[cfg_attr(target_arch = "wasm32", unsafe(no_mangle))]
pub extern "C" fn skin() -> *const u8 {
    let size = ask(|session| session.size_px());
    let mut frame = FRAME.lock();
    frame.paint_skin(size, SKIN_COLOUR);
    frame.skin_rgba.as_ptr()
}
