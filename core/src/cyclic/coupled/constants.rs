//! The numbers of the phase-coupled filter that are chosen and not learned, in one place.
//!
//! The book's table of them (`docs/cyclic_coupled_constants.md`) has the range of each in which
//! results hardly change.

// The person.

/// Rate per cycle at which offset, swing and a raised spread are forgotten. Chosen: they hardly
/// change within a person.
pub(super) const FORGETTING: f32 = 0.02;
/// Standard deviation of a person's speed, relative to the model's mean. Chosen: with a tenth a
/// tempo of 1.4 is lost at much noise, with 0.3 joints far elsewhere are.
pub(super) const SPEED_SPREAD: f32 = 0.15;
/// Standard deviation of the temporal acceleration, cyclic (10), cycles per frame^2.
///
/// Chosen between measurements: below it the filter follows changes of speed less well. With 3e-4
/// the cadence of an elderly walker is 1.8 % off (`docs/cyclic_coupled.md`).
pub(super) const TEMPORAL_STD: f32 = 2.0e-4;
/// Gate of a normalised innovation, standard deviations: of a single angle in filter and grid, and
/// of the mean product by which the person's spread grows.
///
/// Chosen: short links that wind in a side view would drag the phase. One of 144 long walks of the
/// training source has a mean product beyond it, and runners do in their first two cycles.
pub(super) const GATE_SIGMAS: f32 = 4.0;
/// Rate per cycle at which the spread's scale grows, relative to itself, by an excess of one.
/// Chosen: an excess of a fifth trebles it in half a cycle.
pub(super) const GROWTH: f32 = 10.0;
/// Scale of the person's spread above which the motion counts as another than the model's.
///
/// Measured at sigma 1.5 to 29 degrees: walkers of the training source reach 2.1, two of 72 with
/// twice their deviation from the mean cycle 9, and jumps, traffic signs and basketball 16.
pub(super) const MAX_FITTING_SCALE: f32 = 9.0;
/// Scale of the person's spread above which a hypothesis gives way to another place.
///
/// Chosen: above the 2.1 that walkers of the training source reach. With 9 a walk after another
/// motion is found later.
pub(super) const MAX_DEFENDED_SCALE: f32 = 3.0;

// The noise.

/// Largest normalised square or product that an innovation counts with. Chosen: three standard
/// deviations.
pub(super) const MAX_SQUARE: f32 = 9.0;
/// Smallest scale of the noise that the gains use.
///
/// Chosen: half of the stated standard deviation. With less, the bands of slow noise hold half of
/// the truth.
pub(super) const MIN_SCALE: f32 = 0.25;
/// Share of the sums over frames that stays from frame to frame. Chosen: 200 frames, a few cycles.
pub(super) const KEPT: f32 = 0.995;
/// Frames of an angle's own that weigh as much as the scale of all angles together. Chosen: a
/// second, in which an angle's own scale is known to a fifth of itself.
pub(super) const SHARED_FRAMES: f32 = 60.0;
/// Frames in which the noise was as stated, before the first one. Chosen: few, since each has many
/// angles.
pub(super) const STATED_FRAMES: f32 = 2.0;

// Evidence for the phase, of the filter and of its grid.

/// Inflation of an angle's variance as evidence for the phase. Chosen: angles deviate together, and
/// for many frames, so 13 of them carry less evidence than 13 independent ones.
pub(super) const TEMPERING: f32 = 2.5;
/// Number of angles up to which [`TEMPERING`] holds in the grid; more of them carry no more
/// evidence together. Chosen: the angles of the paper's figure.
pub(super) const TEMPERED_ANGLES: f32 = 13.0;

// Places in the cycle.

/// Distance from a place, cycles, up to which the linearisation about it holds: with a larger
/// standard deviation the filter searches by the grid, and a mode of the grid reaches so far.
/// Chosen: about a sixth of a cycle, over which the mean pose is no straight line.
pub(super) const LINEAR_CYCLES: f32 = 0.15;
/// Phase difference from which two places are not the same, cycles. Chosen: below
/// [`LINEAR_CYCLES`].
pub(super) const MIN_DIFFERENCE_CYCLES: f32 = 0.12;
/// Share of the grid's weight that moves to each neighbouring position and speed in a frame.
/// Chosen: speeds change over seconds, and a person's speed lies between those of the grid.
pub(super) const GRID_DIFFUSION: f32 = 0.02;
/// Frames between two updates of the grid while the filter is locked.
///
/// Chosen: the grid costs as much as the filter, and neighbouring frames carry nearly the same
/// evidence.
pub(super) const GRID_INTERVAL_FRAMES: f32 = 3.0;
/// Weight of a mode of the grid from which it counts as the only one. Chosen: nine to one.
pub(super) const MIN_MODE_WEIGHT: f32 = 0.9;
/// ln of the likelihood ratio from which the rival leads. Chosen: 150 to one. 3 loses three times
/// as many runs at much noise.
pub(super) const MIN_LOG_ODDS: f32 = 5.0;
/// Cycles of the model for which the rows count as another motion after a leader has given way.
/// Chosen: in one cycle the next leader shows whether it fits.
pub(super) const MISFIT_CYCLES: f32 = 1.0;

// Angles that wind.

/// Standard deviation of a person's cycle shape in a motion with a winding angle, rad: no angle
/// informs the phase better.
///
/// Chosen: in an even circle an offset and a leading phase are the same. Without it circles are a
/// third too slow.
pub(super) const WINDING_SHAPE_STD_RAD: f32 = 0.3;
/// Phase difference from which the leader moves to the grid's place in a motion with a winding
/// angle, cycles. Chosen: a quarter, half of the farthest.
pub(super) const MAX_WINDING_DIFFERENCE_CYCLES: f32 = 0.25;
/// Completed cycles for which an angle that gained or lost a turn does not inform the phase.
/// Chosen: an angle that winds in one cycle often winds in the next.
pub(super) const EXCLUDED_CYCLES: u8 = 3;
/// Longest interval between two measurements by which turns are counted, frames. Chosen: beyond it
/// the arc may exceed half a turn.
pub(super) const MAX_INTERVAL_FRAMES: f32 = 4.0;
