//! Numbers that the papers print.

/// Cyclic paper, table 1: measurement noises, degrees.
pub const CYCLIC_SIGMAS_DEG: [f64; 6] = [1.0, 3.0, 6.0, 29.0, 57.0, 115.0];
/// Cyclic paper, table 1, test sets 1 and 2: mean absolute error, degrees.
pub const CYCLIC_TABLE_1_DEG: [[f64; 6]; 2] =
    [[2.8110, 4.3950, 5.3210, 8.0852, 9.5177, 11.1174], [2.8865, 4.6235, 5.5994, 8.2082, 9.5934, 11.1659]];
/// Cyclic paper, table 2: numbers of samples.
pub const CYCLIC_SAMPLES: [usize; 6] = [500, 1_000, 5_000, 10_000, 50_000, 100_000];
/// Cyclic paper, table 2, test sets 1 and 2: mean absolute error, degrees.
pub const CYCLIC_TABLE_2_DEG: [[f64; 6]; 2] =
    [[25.7307, 23.7371, 9.3002, 9.6875, 5.5931, 4.8555], [25.1875, 30.3826, 11.3332, 9.4183, 5.5368, 4.7666]];
/// Cyclic paper, section 3.2: error where two frames are skipped at sigma 29, degrees.
pub const CYCLIC_SKIP_2_DEG: f64 = 12.12;
/// PIK paper, caption of figure 15: time of goals over that of angles.
pub const PIK_TIME_RATIO: f64 = 1.4;
/// PIK paper, figures 9 to 12 and 16: the frames that are shown.
pub const PIK_FRAMES: [usize; 3] = [91, 159, 268];
/// Arm paper, section 5: particles of both trackers.
pub const ARM_PARTICLES: usize = 50;
