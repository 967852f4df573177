//! Images for an emulated Cortex-M that track with `sinew-core`.
//!
//! An image reads recorded input record by record, tracks, and answers with records ([`port`]).
//! What it does stands in a module of its own name ([`cyclic`], [`particles`], [`arm`], [`camera`],
//! [`body`]). It runs on
//! any machine, so tests on the host run the same code. `machine` is what only the emulated board
//! has. A new image is a file `src/bin/NAME.rs` and what it has to answer, `expected/NAME.rec`
//! (records) or `expected/NAME.txt` (its standard output).

#![no_std]

pub mod arm;
pub mod body;
pub mod camera;
pub mod cyclic;
pub mod faults;
mod log;
#[cfg(target_os = "none")]
pub mod machine;
pub mod particles;
pub mod player;
pub mod port;

/// The `main` of an image that runs `$run`, a function of a [`port::Port`].
#[macro_export]
macro_rules! image {
    ($run:path) => {
        #[cfg(target_os = "none")]
        #[::cortex_m_rt::entry]
        fn main() -> ! {
            $crate::machine::run($run)
        }

        #[cfg(not(target_os = "none"))]
        fn main() {
            eprintln!(
                "this is an image for a Cortex-M: `cargo run --release --bin NAME` in the folder firmware-sim runs it"
            );
            std::process::exit(2);
        }
    };
}
