//! Logging by defmt on the board, by nothing on the host; the features `log-info` and `log-debug`
//! choose the level.

macro_rules! info {
    ($($arguments:tt)*) => {
        #[cfg(all(target_os = "none", feature = "log-info"))]
        defmt::info!($($arguments)*);
    };
}

macro_rules! debug {
    ($($arguments:tt)*) => {
        #[cfg(all(target_os = "none", feature = "log-debug"))]
        defmt::debug!($($arguments)*);
    };
}

pub(crate) use {debug, info};
