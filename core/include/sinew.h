/* Sinew: how a human body moves, from a camera, in a few kilobytes.
 *
 * Made from the interface's source by `SINEW_REGENERATE=1 cargo test -p sinew-c-interface header`; do not edit.
 *
 * Nothing is allocated, nothing is global. Objects live in memory that the caller gives: SINEW_*_MAX_BYTES bytes, aligned to SINEW_ALIGN,
 * always suffice, and sinew_*_size and sinew_*_align return the exact numbers of this target. Different objects may be used by different
 * threads at the same time. All functions but sinew_*_size, sinew_*_align, sinew_version and sinew_error_text answer with a status, zero
 * for done. */

#ifndef SINEW_H
#define SINEW_H

#include <stddef.h>
#include <stdint.h>

/**
 * Most angles of a motion model.
 */
#define SINEW_MAX_ANGLES 13

/**
 * Bytes that always suffice for a cyclic tracker, on every target.
 */
#define SINEW_CYCLIC_MAX_BYTES 4608

/**
 * Bytes that always suffice for the saved state of a cyclic tracker.
 */
#define SINEW_CYCLIC_STATE_MAX_BYTES 5120

/**
 * Alignment that suffices for every object of this library.
 */
#define SINEW_ALIGN 8

/**
 * Most particles of a cyclic particle filter. Chosen: a step of so many takes a Cortex-M4F of 168
 * MHz about half of the time between two frames of 60 a second.
 */
#define SINEW_CYCLIC_PARTICLES 100

/**
 * Bytes that always suffice for a cyclic particle filter, on every target.
 */
#define SINEW_CYCLIC_PARTICLES_MAX_BYTES 33792

/**
 * Bytes that always suffice for the saved state of a cyclic particle filter.
 */
#define SINEW_CYCLIC_PARTICLES_STATE_MAX_BYTES 11776

/**
 * Most particles of an arm tracker.
 */
#define SINEW_ARM_PARTICLES 50

/**
 * Most hand candidates of a frame; the eight most likely of them are considered.
 */
#define SINEW_MAX_CANDIDATES 32

/**
 * Most edge pixels of a frame.
 */
#define SINEW_MAX_EDGES 4096

/**
 * The person's own left arm.
 */
#define SINEW_SIDE_LEFT 0

/**
 * The person's own right arm.
 */
#define SINEW_SIDE_RIGHT 1

/**
 * No blob carried the estimate for so long that the prediction means nothing.
 */
#define SINEW_ARM_LOST 0

/**
 * No blob of this frame carries the estimate; it is a prediction.
 */
#define SINEW_ARM_PREDICTED 1

/**
 * A blob of this frame that is likely a hand carries the estimate.
 */
#define SINEW_ARM_TRACKING 2

/**
 * A blob of this frame carries the estimate that is less likely a hand.
 */
#define SINEW_ARM_UNCERTAIN 3

/**
 * Blobs drive goals, inverse kinematics turns goals into poses; weights are not corrected.
 */
#define SINEW_ARM_PIK 0

/**
 * As `SINEW_ARM_PIK`, with a blob likelihood and exact importance weights.
 */
#define SINEW_ARM_PIK_WEIGHTED 1

/**
 * Goals from the motion model only, blobs in the likelihood.
 */
#define SINEW_ARM_BOOTSTRAP 2

/**
 * The arm paper: blobs correct hands, the elbow goes to the nearest point of its circle.
 */
#define SINEW_ARM_CORRECTED 3

/**
 * The arm paper's baseline: sequential Monte Carlo without blobs.
 */
#define SINEW_ARM_STANDARD 4

/**
 * Bytes that always suffice for an arm tracker, on every target.
 */
#define SINEW_ARM_MAX_BYTES 12288

/**
 * Bytes that always suffice for the saved state of an arm tracker.
 */
#define SINEW_ARM_STATE_MAX_BYTES 4096

/**
 * Bytes that always suffice for a tracker of both arms, on every target.
 */
#define SINEW_ARM_PAIR_MAX_BYTES 24576

/**
 * Bytes that always suffice for the saved state of a tracker of both arms.
 */
#define SINEW_ARM_PAIR_STATE_MAX_BYTES 8192

/**
 * Bones of an upper body: pelvis, trunk, head, left collar, upper arm, forearm, then the right
 * ones.
 */
#define SINEW_BODY_BONES 9

/**
 * Coordinates of an upper body: three shifts of the pelvis, its turn, tilt and pitch, three angles
 * of the head, then elevation, deviation and axial rotation of the shoulder and flexion of the
 * elbow, left and right.
 */
#define SINEW_BODY_COORDINATES 17

/**
 * Most points of a frame that are used.
 */
#define SINEW_BODY_POINTS 512

/**
 * The frame had no usable point: the pose is a prediction.
 */
#define SINEW_BODY_PREDICTED 0

/**
 * The frame had points.
 */
#define SINEW_BODY_TRACKING 1

/**
 * Bytes that always suffice for a body tracker, on every target.
 */
#define SINEW_BODY_MAX_BYTES 16384

/**
 * Bytes that always suffice for the saved state of a body tracker.
 */
#define SINEW_BODY_STATE_MAX_BYTES 2048

/**
 * 5 bits of red (the highest), 6 of green, 5 of blue.
 */
#define SINEW_PIXEL_RGB565 0

/**
 * The same with both bytes swapped, as cameras with an 8-bit port and a little-endian processor
 * have it.
 */
#define SINEW_PIXEL_RGB565_SWAPPED 1

/**
 * Y in the low byte; in the high byte U of a pair of pixels in the left one, V in the right one.
 */
#define SINEW_PIXEL_YUYV 2

#if !defined(SINEW_VGA)
/**
 * Bytes that always suffice for a front end, on every target.
 */
#define SINEW_VISION_MAX_BYTES 20480
#endif

#if defined(SINEW_VGA)
/**
 * Bytes that always suffice for a front end, on every target, in a library with the feature `vga`.
 */
#define SINEW_VISION_MAX_BYTES 28672
#endif

/**
 * Bytes that always suffice for the saved state of a front end.
 */
#define SINEW_VISION_STATE_MAX_BYTES 8320

/**
 * What a function answers: zero if it did what it says.
 */
enum SinewStatus
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : int32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
  /**
   * Done.
   */
  SINEW_STATUS_OK = 0,
  /**
   * Nothing to do yet: no frame so far showed enough to begin with. No result was written.
   */
  SINEW_STATUS_WAITING = 1,
  /**
   * A pointer is null.
   */
  SINEW_STATUS_NULL_POINTER = -1,
  /**
   * A pointer is not aligned as its type asks for.
   */
  SINEW_STATUS_MISALIGNED = -2,
  /**
   * The memory or buffer given is too small.
   */
  SINEW_STATUS_TOO_SMALL = -3,
  /**
   * The object was not initialised, is of another kind, or its first or last bytes were
   * overwritten.
   */
  SINEW_STATUS_NOT_INITIALISED = -4,
  /**
   * A number is NaN or infinite.
   */
  SINEW_STATUS_NOT_FINITE = -5,
  /**
   * A number is out of its range.
   */
  SINEW_STATUS_OUT_OF_RANGE = -6,
  /**
   * A list is longer than its capacity.
   */
  SINEW_STATUS_OVER_CAPACITY = -7,
  /**
   * A timestamp does not lie after that of the frame before. A counter of 32 bits wraps:
   * `sinew_clock_us` extends it.
   */
  SINEW_STATUS_OUT_OF_ORDER = -8,
  /**
   * The bytes are no motion model that this library reads.
   */
  SINEW_STATUS_BAD_MODEL = -9,
  /**
   * The library was built without the model asked for.
   */
  SINEW_STATUS_NO_MODEL = -10,
  /**
   * The saved state is cut, was changed, or belongs to another kind of object.
   */
  SINEW_STATUS_BAD_STATE = -11,
  /**
   * The state was saved by another version of the library.
   */
  SINEW_STATUS_STATE_VERSION = -12,
  /**
   * The state was saved with another model or other options.
   */
  SINEW_STATUS_FOREIGN_STATE = -13,
  /**
   * Lines were given before a frame was begun, or a frame ended that was not begun.
   */
  SINEW_STATUS_NO_FRAME = -14,
  /**
   * A calibration ended that was not begun, or nothing of its box was seen.
   */
  SINEW_STATUS_NO_SAMPLE = -15,
  /**
   * Another call uses the object: one that an interrupt broke into, or one of another task.
   */
  SINEW_STATUS_BUSY = -16,
  /**
   * The object lies elsewhere than where it was made: it was copied or moved.
   */
  SINEW_STATUS_MOVED = -17,
  /**
   * A structure or buffer lies within the object's own memory.
   */
  SINEW_STATUS_OVERLAP = -18,
  /**
   * A configuration has not the size that this library knows: it was not filled by its default
   * function, or the program was compiled with the header of another version.
   */
  SINEW_STATUS_STRUCT_SIZE = -19,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum SinewStatus SinewStatus;
#else
typedef int32_t SinewStatus;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

/**
 * An arm tracker; see `sinew_arm_init`. Saved states fit the same configuration; seed and
 * shoulders may differ.
 */
typedef struct SinewArm SinewArm;

/**
 * A tracker of both arms; see `sinew_arm_pair_init`. Saved states fit the same configuration; seed
 * and shoulders may differ.
 */
typedef struct SinewArmPair SinewArmPair;

/**
 * A body tracker; see `sinew_body_init`. Saved states fit the same configuration; the first pose
 * may differ.
 */
typedef struct SinewBody SinewBody;

/**
 * A cyclic tracker; see `sinew_cyclic_init`. Saved states fit the same model. After a reset the
 * next frame may have any timestamp.
 */
typedef struct SinewCyclic SinewCyclic;

/**
 * A cyclic particle filter; see `sinew_cyclic_particles_init`. Saved states fit the same model,
 * number of particles and `cycle_acceleration_std`. After a reset the next frame may have any
 * timestamp.
 */
typedef struct SinewCyclicParticles SinewCyclicParticles;

/**
 * A front end; see `sinew_vision_init`. Saved states hold the skin table, no frames, and fit the
 * same pixel format.
 */
typedef struct SinewVision SinewVision;

/**
 * A time of 64 bits that follows a counter of 32 bits; one of zeros begins with the counter's
 * value. One clock serves all objects.
 */
typedef struct SinewClock {
  /**
   * The latest time, microseconds. After a restart that of the last frame before it, so that
   * time goes on: a restored state refuses frames that lie before its own.
   */
  uint64_t time_us;
  /**
   * The counter at that time.
   */
  uint32_t counter_us;
  /**
   * 1 if both are set; 0 begins anew with the next counter.
   */
  uint32_t has_begun;
} SinewClock;

/**
 * Options of a cyclic tracker; see `sinew_cyclic_default_config`.
 */
typedef struct SinewCyclicConfig {
  /**
   * Bytes of this structure, as the function that fills it writes them; any other number is
   * refused.
   */
  uint32_t struct_bytes;
  /**
   * 1 where `first_position` is known; 0: the one that fits the first frame.
   */
  uint32_t has_first_position;
  /**
   * Position in the cycle at the first frame, from 0 to 1, as a switch on a treadmill knows it.
   */
  float first_position;
  /**
   * Cadence at the first frame, cycles per minute; 0: the model's mean.
   */
  float first_cadence_per_min;
} SinewCyclicConfig;

/**
 * The angles of one frame.
 */
typedef struct SinewCyclicFrame {
  /**
   * When the frame was taken, microseconds since any start. Dropped frames are simply not given.
   * A counter of 32 bits goes through `sinew_clock_us`.
   */
  uint64_t timestamp_us;
  /**
   * Bit i is set if angle i was seen; the others' values are not looked at.
   */
  uint32_t seen;
  /**
   * Number of angles given, at most `SINEW_MAX_ANGLES` and at most those of the model.
   */
  uint32_t angle_count;
  /**
   * Angles, radians, any turn.
   */
  float angles_rad[SINEW_MAX_ANGLES];
  /**
   * Standard deviation of each angle, radians, greater than zero.
   */
  float std_rad[SINEW_MAX_ANGLES];
} SinewCyclicFrame;

/**
 * Pose, phase and cadence after a frame. Entries beyond the model's angles are zero.
 */
typedef struct SinewCyclicResult {
  /**
   * That of the frame.
   */
  uint64_t timestamp_us;
  /**
   * Angles in (-pi, pi].
   */
  float angles_rad[SINEW_MAX_ANGLES];
  /**
   * Standard deviation of each angle, radians.
   */
  float angle_std_rad[SINEW_MAX_ANGLES];
  /**
   * Whole turns of each angle since the start: the unwrapped angle is `angles_rad` + 2 pi
   * `turns`.
   */
  int32_t turns[SINEW_MAX_ANGLES];
  /**
   * Whole cycles since the first frame; a cycle of walking is two steps.
   */
  int32_t cycles_completed;
  /**
   * Position in the cycle, from 0 to 1.
   */
  float cycle_position;
  /**
   * Standard deviation of the position, cycles.
   */
  float cycle_position_std;
  /**
   * Cycles per minute.
   */
  float cadence_per_min;
  /**
   * Standard deviation of the cadence, cycles per minute.
   */
  float cadence_std_per_min;
  /**
   * Natural logarithm of the density of the frame's angles given those before.
   */
  float log_likelihood;
  /**
   * 1 if the angles are too far from what was expected to belong to the motion.
   */
  uint32_t is_outlier;
  /**
   * 1 while the position in the cycle is not known and the pose is the mean of all positions.
   */
  uint32_t is_searching;
  /**
   * 1 if the person has for a cycle or two differed from the model's mean cycle by far more than
   * people do in the training: another motion, or wrong angles.
   */
  uint32_t is_misfit;
} SinewCyclicResult;

/**
 * Seed, spreads and start of a cyclic particle filter; see
 * `sinew_cyclic_particles_default_config`.
 */
typedef struct SinewCyclicParticlesConfig {
  /**
   * Bytes of this structure, as the function that fills it writes them; any other number is
   * refused.
   */
  uint32_t struct_bytes;
  /**
   * Particles, 1 to `SINEW_CYCLIC_PARTICLES`. The time of a step grows with them.
   */
  uint32_t particles;
  /**
   * All random numbers follow from it: the same seed and frames give the same bits.
   */
  uint64_t seed;
  /**
   * 1 where `first_position` is known. 0: particles begin at all positions that fit the first
   * frame.
   */
  uint32_t has_first_position;
  /**
   * Position in the cycle at the first frame, from 0 to 1, as a switch on a treadmill knows it.
   */
  float first_position;
  /**
   * Cadence at the first frame, cycles per minute; 0: the model's mean.
   */
  float first_cadence_per_min;
  /**
   * First standard deviation of each angle, radians, 0 to 3.
   */
  float first_angle_std_rad;
  /**
   * First standard deviation of each angle's velocity, as a share of how far people differ from
   * the model's mean velocity, 0 to 10.
   */
  float first_velocity_share;
  /**
   * First standard deviation of a known position, cycles, 0 to 1.
   */
  float first_position_std;
  /**
   * First standard deviation of the velocity through the cycle, cycles per frame of the model,
   * 0 to 0.5.
   */
  float first_cycle_velocity_std;
  /**
   * Standard deviation of the acceleration through the cycle, cycles per squared frame of the
   * model, 0 to 0.1.
   */
  float cycle_acceleration_std;
} SinewCyclicParticlesConfig;

/**
 * Camera, body, seed and options of an arm tracker; see `sinew_arm_default_config`.
 */
typedef struct SinewArmConfig {
  /**
   * Bytes of this structure, as the function that fills it writes them; any other number is
   * refused.
   */
  uint32_t struct_bytes;
  /**
   * Particles, 1 to `SINEW_ARM_PARTICLES`. The time of a step grows with them.
   */
  uint32_t particles;
  /**
   * All random numbers follow from it: the same seed and frames give the same bits.
   */
  uint64_t seed;
  /**
   * Width of the image, pixels.
   */
  uint32_t image_width_px;
  /**
   * Height of the image, pixels.
   */
  uint32_t image_height_px;
  /**
   * Focal lengths along columns and rows, pixels.
   */
  float focal_px[2];
  /**
   * Column and row of the principal point, pixels.
   */
  float principal_point_px[2];
  /**
   * From shoulder to elbow, metres.
   */
  float upper_arm_m;
  /**
   * From elbow to the middle of the hand, metres.
   */
  float forearm_m;
  /**
   * Left and right shoulder, metres in camera axes: x to the right of the image, y down, z along
   * the line of sight. A tracker of one arm looks at its own side only.
   */
  float shoulders_m[2][3];
  /**
   * Which tracker: `SINEW_ARM_PIK` or another one.
   */
  uint32_t variant;
  /**
   * Most pairs of edge pixels of a limb whose orientation is looked at, 10 to 65535.
   */
  uint32_t max_pairs;
  /**
   * Steps of the pose solver, 1 to 100.
   */
  uint32_t solver_steps;
  /**
   * 1 where the shoulders are guessed and not measured; else 0.
   */
  uint32_t has_guessed_shoulders;
  /**
   * Spread of the hand's goal after one second, metres along each axis, 0.001 to 10.
   */
  float hand_std_m_per_sqrt_s;
  /**
   * Spread along the ray of a hand that a blob corrected, after one second, metres, 0.001 to 10.
   */
  float ray_std_m_per_sqrt_s;
  /**
   * Spread of each angle after one second, radians, 0.001 to 10.
   */
  float angle_std_rad_per_sqrt_s;
  /**
   * Area of the image of a hand seen from the side of its forearm, times squared depth over
   * squared focal length, square metres, 0.0001 to 1.
   */
  float hand_area_m2;
  /**
   * Standard deviation of the logarithm of that area, 0.01 to 10: how little it says of the
   * distance.
   */
  float area_log_std;
  /**
   * How far a hand may be from where it is expected, metres (standard deviation), 0.01 to 10.
   */
  float gate_std_m;
  /**
   * Growth of that with the time since the hand was last seen, metres per second, 0 to 100.
   */
  float gate_growth_m_per_s;
  /**
   * What a jump of any length keeps of its weight, 1e-9 to 1.
   */
  float gate_floor;
  /**
   * Without a blob for longer than this the arm counts as lost, seconds, 0.01 to 3600.
   */
  float lost_after_s;
  /**
   * Zero.
   */
  uint32_t reserved;
} SinewArmConfig;

/**
 * A point of the image, pixels.
 */
typedef struct SinewPixel {
  /**
   * Column, to the right.
   */
  float u_px;
  /**
   * Row, downwards.
   */
  float v_px;
} SinewPixel;

/**
 * The part of a blob that an arm tracker uses: a few numbers, so that a frame's list is small
 * state.
 */
typedef struct SinewHandCandidate {
  /**
   * Assumed centre of the hand.
   */
  struct SinewPixel centre;
  /**
   * Second central moments of the blob's pixels: uu, uv, vv, in square pixels.
   */
  float moments_px2[3];
  /**
   * Number of pixels of the blob.
   */
  float area_px;
  /**
   * p(hand | blob) in [0, 1]: arm (6) or the default form.
   */
  float likelihood;
} SinewHandCandidate;

/**
 * A temporal edge pixel: an edge of the luminance that has changed since the previous frame.
 */
typedef struct SinewEdgePixel {
  /**
   * Column.
   */
  uint16_t u;
  /**
   * Row.
   */
  uint16_t v;
} SinewEdgePixel;

/**
 * What a frame showed.
 */
typedef struct SinewArmFrame {
  /**
   * When the frame was taken, microseconds since any start. Dropped frames are simply not given.
   * A counter of 32 bits goes through `sinew_clock_us`.
   */
  uint64_t timestamp_us;
  /**
   * Blobs that may be a hand, as `sinew_vision_end_frame` gives them; not looked at if
   * `candidate_count` is zero.
   */
  const struct SinewHandCandidate *candidates;
  /**
   * Temporal edge pixels; not looked at if `edge_count` is zero.
   */
  const struct SinewEdgePixel *edges;
  /**
   * Number of candidates, at most `SINEW_MAX_CANDIDATES`.
   */
  uint32_t candidate_count;
  /**
   * Number of edge pixels, at most `SINEW_MAX_EDGES`.
   */
  uint32_t edge_count;
  /**
   * 0 where the image is missing, so that the lists say nothing; else 1.
   */
  uint32_t has_image;
  /**
   * Left and right shoulder, metres in camera axes; a tracker of one arm looks at its own side
   * only.
   */
  float shoulders_m[2][3];
} SinewArmFrame;

/**
 * An arm after a frame.
 */
typedef struct SinewArmResult {
  /**
   * That of the frame.
   */
  uint64_t timestamp_us;
  /**
   * `SINEW_SIDE_LEFT` or `SINEW_SIDE_RIGHT`.
   */
  uint32_t side;
  /**
   * `SINEW_ARM_TRACKING`, `SINEW_ARM_UNCERTAIN`, `SINEW_ARM_PREDICTED` or `SINEW_ARM_LOST`.
   */
  uint32_t state;
  /**
   * Shoulder, metres in camera axes.
   */
  float shoulder_m[3];
  /**
   * Elbow, metres in camera axes.
   */
  float elbow_m[3];
  /**
   * Middle of the hand, metres in camera axes.
   */
  float hand_m[3];
  /**
   * Image of the hand: column and row, pixels; -1 where it lies behind the camera.
   */
  float hand_px[2];
  /**
   * Elevation, deviation and axial rotation of the shoulder, flexion of the elbow, radians.
   */
  float angles_rad[4];
  /**
   * Standard deviation of the hand, metres along an axis.
   */
  float hand_std_m;
  /**
   * Effective number of particles.
   */
  float effective_sample_size;
  /**
   * Natural logarithm of the mean weight; zero where nothing was seen.
   */
  float log_evidence;
  /**
   * Likelihood of the blob that carries the estimate; zero without one.
   */
  float hand_likelihood;
  /**
   * Index of that blob in the frame's list, -1 without one.
   */
  int32_t candidate;
  /**
   * Candidates that were not considered.
   */
  uint32_t dropped_candidates;
  /**
   * 1 if all weights were zero and the frame taught nothing.
   */
  uint32_t is_degenerate;
  /**
   * Zero.
   */
  uint32_t reserved;
} SinewArmResult;

/**
 * Body, first pose and options of a body tracker; see `sinew_body_default_config`.
 */
typedef struct SinewBodyConfig {
  /**
   * Bytes of this structure, as the function that fills it writes them; any other number is
   * refused.
   */
  uint32_t struct_bytes;
  /**
   * Most steps of the pose solver, 1 to 20. The time of a frame grows with them.
   */
  uint32_t solver_steps;
  /**
   * Height of the person, metres, 0.5 to 2.5; lengths and radii of all bones follow from it.
   */
  float height_m;
  /**
   * Standard deviation of a point's distance from the skin, metres, 0.001 to 1.
   */
  float point_std_m;
  /**
   * Points farther from the skin than this count as outliers, metres, 0.001 to 1.
   */
  float outlier_m;
  /**
   * How far the pelvis may get in a second, metres (standard deviation), 0.001 to 10.
   */
  float root_shift_std_m_per_sqrt_s;
  /**
   * How far it may turn in a second, radians (standard deviation), 0.001 to 10.
   */
  float root_turn_std_rad_per_sqrt_s;
  /**
   * Deadband of the reported pose at rest, metres, 0 to 1.
   */
  float jitter_std_m;
  /**
   * The pose to begin with: three shifts, metres, then angles, radians.
   */
  float first_coordinates[SINEW_BODY_COORDINATES];
  /**
   * Zero.
   */
  uint32_t reserved;
} SinewBodyConfig;

/**
 * The points of one frame.
 */
typedef struct SinewBodyFrame {
  /**
   * When the frame was taken, microseconds since any start. Dropped frames are simply not given.
   * A counter of 32 bits goes through `sinew_clock_us`.
   */
  uint64_t timestamp_us;
  /**
   * Points in camera axes, metres: x to the right of the image, y down, z along the line of
   * sight. They are brought into another order. A point at the camera, or with a NaN, is a
   * hole. Not looked at if `point_count` is zero.
   */
  float (*points_m)[3];
  /**
   * Number of points, at most 65535; of more than `SINEW_BODY_POINTS` usable ones so many are
   * taken evenly through the list.
   */
  uint32_t point_count;
  /**
   * Zero.
   */
  uint32_t reserved;
} SinewBodyFrame;

/**
 * An upper body after a frame.
 */
typedef struct SinewBodyResult {
  /**
   * That of the frame.
   */
  uint64_t timestamp_us;
  /**
   * `SINEW_BODY_TRACKING` or `SINEW_BODY_PREDICTED`.
   */
  uint32_t state;
  /**
   * Bit i is set where the points show bone i.
   */
  uint32_t observed;
  /**
   * The end of each bone, metres in camera axes: pelvis, neck, head, left shoulder, elbow,
   * wrist, right shoulder, elbow, wrist.
   */
  float joints_m[SINEW_BODY_BONES][3];
  /**
   * Standard deviation of each, metres (root of the summed variances).
   */
  float joint_std_m[SINEW_BODY_BONES];
  /**
   * Coordinates of the pose: shifts in metres, then angles in radians.
   */
  float coordinates[SINEW_BODY_COORDINATES];
  /**
   * Natural logarithm of the density of pose and points, up to a constant.
   */
  float log_density;
  /**
   * Points that were used, and those that were left out: holes, and those over capacity.
   */
  uint32_t used_points;
  /**
   * See `used_points`.
   */
  uint32_t left_out_points;
  /**
   * Zero.
   */
  uint32_t reserved;
} SinewBodyResult;

/**
 * Skin as a normal distribution of chromaticity r = R / (R + G + B), g = G / (R + G + B).
 */
typedef struct SinewSkin {
  /**
   * Means of r and g.
   */
  float mean[2];
  /**
   * Covariance: rr, rg, gg.
   */
  float covariance[3];
  /**
   * Mahalanobis distance within which a colour counts as skin.
   */
  float threshold;
  /**
   * Least R + G + B, 0 to 765: darker pixels have no usable colour.
   */
  uint32_t min_sum;
} SinewSkin;

/**
 * Frames and skin; see `sinew_vision_default_config`.
 */
typedef struct SinewVisionConfig {
  /**
   * Bytes of this structure, as the function that fills it writes them; any other number is
   * refused.
   */
  uint32_t struct_bytes;
  /**
   * Width of a frame, 1 to 320 pixels; to 640 with SINEW_VGA.
   */
  uint32_t width_px;
  /**
   * Height of a frame, 1 to 240 pixels; to 480 with SINEW_VGA.
   */
  uint32_t height_px;
  /**
   * `SINEW_PIXEL_RGB565`, `SINEW_PIXEL_RGB565_SWAPPED` or `SINEW_PIXEL_YUYV`.
   */
  uint32_t pixel_format;
  /**
   * Which colours count as skin.
   */
  struct SinewSkin skin;
  /**
   * Least step of a new edge, grey levels, 5 to 255.
   */
  float new_step;
  /**
   * Least step of an edge of the last frame, grey levels, from 5 to `new_step`.
   */
  float known_step;
  /**
   * Least area of a blob, as a share of the image, 0 to 1.
   */
  float min_area_share;
  /**
   * Colours that are judged at the beginning of a frame while another skin is learned; 0 learns
   * it at once, in the call that gives it.
   */
  uint32_t skin_colours_per_frame;
} SinewVisionConfig;

/**
 * A box of pixels.
 */
typedef struct SinewBox {
  /**
   * Its first column.
   */
  uint32_t left_px;
  /**
   * Its first row.
   */
  uint32_t top_px;
  /**
   * Columns, at least 1.
   */
  uint32_t width_px;
  /**
   * Rows, at least 1.
   */
  uint32_t height_px;
} SinewBox;

/**
 * What a frame showed; all losses zero means that it is exact.
 */
typedef struct SinewVisionResult {
  /**
   * Blobs that may be a hand, the most likely first; null where there are none.
   */
  const struct SinewHandCandidate *candidates;
  /**
   * Temporal edge pixels in the order of rows; null where there are none.
   */
  const struct SinewEdgePixel *edges;
  /**
   * Number of candidates.
   */
  uint32_t candidate_count;
  /**
   * Number of edge pixels.
   */
  uint32_t edge_count;
  /**
   * Components that found no room among those that grew at the same time.
   */
  uint32_t dropped_components;
  /**
   * Pixels of those, and of runs that found no room in their line.
   */
  uint32_t dropped_px;
  /**
   * Blobs less likely than all in the list.
   */
  uint32_t dropped_blobs;
  /**
   * Temporal edge pixels that were thinned out.
   */
  uint32_t dropped_edges;
  /**
   * Lines that did not come, or were too short.
   */
  uint32_t missing_lines;
  /**
   * Lines that came twice or too late.
   */
  uint32_t ignored_lines;
} SinewVisionResult;

#ifdef __cplusplus
extern "C" {
#endif // __cplusplus

/**
 * A short English text for a status, for people; `status` may be any number.
 *
 * The text is constant and ends with a zero byte.
 */
const char *sinew_error_text(int32_t status);

/**
 * Version of the library: major * 65536 + minor * 256 + patch.
 */
uint32_t sinew_version(void);

/**
 * Writes the time of 64 bits for a counter of microseconds that wraps after 2^32, 71.6 minutes.
 *
 * Call it at least every half hour, also while no frames come: wraps that it does not see are
 * lost. A counter that lies before the latest one, as that of a frame that was taken before
 * another call, gives its own time and does not turn the clock back.
 *
 * Caller's duty:
 * No other task uses `clock` at the same time.
 */
SinewStatus sinew_clock_us(struct SinewClock *clock, uint32_t counter_us, uint64_t *timestamp_us);

/**
 * Writes options: position and cadence are found.
 *
 * `config_bytes` is `sizeof *config`: SINEW_STATUS_STRUCT_SIZE says that the program was compiled
 * with the header of another version.
 *
 * Caller's duty:
 * `config` points at room of the size that is said.
 */
SinewStatus sinew_cyclic_default_config(struct SinewCyclicConfig *config, size_t config_bytes);

/**
 * Bytes that this object takes on this target; the constant MAX_BYTES of its kind at most.
 */
size_t sinew_cyclic_size(void);

/**
 * Alignment that the memory of this object needs; `SINEW_ALIGN` at most.
 */
size_t sinew_cyclic_align(void);

/**
 * Makes a cyclic tracker in `memory`, which it needs as long as it is used; there is nothing to
 * free.
 *
 * `model` is a motion model in bytes (the command `sinew export` makes one), aligned to four,
 * which has to stay where it is as long as the tracker is used. The form for the coupled filter
 * suffices (`--form coupled-c`, 5.5 KB); of the form for all filters the rest is not read. Null
 * and zero bytes stand for the walking model that the library was built with. All numbers that the
 * tracker reads are checked once, here.
 *
 * `config` is copied; null stands for what `sinew_cyclic_default_config` writes.
 *
 * Returns SINEW_STATUS_BAD_MODEL for bytes that are no model of at most `SINEW_MAX_ANGLES` angles,
 * SINEW_STATUS_NO_MODEL if the library was built without the walking model. `tracker` is written
 * only if the status is SINEW_STATUS_OK.
 *
 * Caller's duty:
 * `memory` and `model` have the sizes that are said.
 */
SinewStatus sinew_cyclic_init(void *memory,
                              size_t memory_bytes,
                              const void *model,
                              size_t model_bytes,
                              const struct SinewCyclicConfig *config,
                              struct SinewCyclic **tracker);

/**
 * Takes in one frame, and writes what is known then.
 *
 * A frame more than 600 frames of the model after the last counts as that much later. Returns
 * SINEW_STATUS_WAITING, and writes no result, until a first frame shows an angle. Every other
 * status but SINEW_STATUS_OK leaves the tracker as it was: a number that is NaN, infinite or
 * out of range, more angles than the model has, a timestamp not after the last one.
 *
 * Caller's duty:
 * `tracker` comes from `sinew_cyclic_init`.
 */
SinewStatus sinew_cyclic_step(struct SinewCyclic *tracker,
                              const struct SinewCyclicFrame *frame,
                              struct SinewCyclicResult *result);

/**
 * Writes the model's mean pose at a position of the cycle (any number; 1 is one cycle on) into the
 * first `angle_count` of `angles_rad`, radians.
 *
 * Returns SINEW_STATUS_OVER_CAPACITY for more angles than the model has.
 *
 * Caller's duty:
 * `tracker` comes from `sinew_cyclic_init`, `angles_rad` has room for as many numbers as is said.
 */
SinewStatus sinew_cyclic_mean_pose(struct SinewCyclic *tracker, float cycle_position, float *angles_rad, size_t angle_count);

/**
 * Forgets all frames, as after the object's `init` with the same configuration. A front
 * end keeps its skin table.
 *
 * Caller's duty:
 * `tracker` comes from the object's `init`.
 */
SinewStatus sinew_cyclic_reset(struct SinewCyclic *tracker);

/**
 * Writes the state into `buffer`. An object of the same kind and configuration can go on
 * from it, on this processor or another. The object's type says what is saved, and which
 * of its configuration may differ.
 *
 * Writes into `written` how many bytes the state takes, also where the buffer is too
 * small. The object is not changed.
 *
 * Caller's duty:
 * `tracker` comes from the object's `init`, `buffer` has the size that is said.
 */
SinewStatus sinew_cyclic_save(struct SinewCyclic *tracker, uint8_t *buffer, size_t buffer_bytes, size_t *written);

/**
 * Goes on from a state that was saved, all of `state_bytes`.
 *
 * A state that is not whole, of another version or configuration is refused, and the
 * object is as before. A whole state may hold a number that cannot be
 * (SINEW_STATUS_BAD_STATE too). Its object begins anew, a front end with the skin table of
 * its configuration.
 *
 * Caller's duty:
 * `tracker` comes from the object's `init`, `state` has the size that is said.
 */
SinewStatus sinew_cyclic_restore(struct SinewCyclic *tracker, const uint8_t *state, size_t state_bytes);

/**
 * Writes options: seed 1, `SINEW_CYCLIC_PARTICLES` particles at any position that fits the first
 * frame, and the spreads that the host's command has.
 *
 * `config_bytes` is `sizeof *config`: SINEW_STATUS_STRUCT_SIZE says that the program was compiled
 * with the header of another version.
 *
 * Caller's duty:
 * `config` points at room of the size that is said.
 */
SinewStatus sinew_cyclic_particles_default_config(struct SinewCyclicParticlesConfig *config, size_t config_bytes);

/**
 * Bytes that this object takes on this target; the constant MAX_BYTES of its kind at most.
 */
size_t sinew_cyclic_particles_size(void);

/**
 * Alignment that the memory of this object needs; `SINEW_ALIGN` at most.
 */
size_t sinew_cyclic_particles_align(void);

/**
 * Makes a cyclic particle filter in `memory`, which it needs as long as it is used; there is
 * nothing to free.
 *
 * `model` is a motion model in bytes for all filters (`sinew export WHICH --form c`, 52 KB),
 * aligned to four, which has to stay where it is as long as the filter is used. Null and zero
 * bytes stand for the walking model that the library was built with. All its numbers are checked
 * once, here, which takes some time.
 *
 * `config` is copied; null stands for what `sinew_cyclic_particles_default_config` writes.
 *
 * Returns SINEW_STATUS_BAD_MODEL for bytes that are no model of at most `SINEW_MAX_ANGLES` angles,
 * or one for the coupled filter alone; SINEW_STATUS_NO_MODEL if the library was built without the
 * walking model. `tracker` is written only if the status is SINEW_STATUS_OK.
 *
 * Caller's duty:
 * `memory` and `model` have the sizes that are said.
 */
SinewStatus sinew_cyclic_particles_init(void *memory,
                                        size_t memory_bytes,
                                        const void *model,
                                        size_t model_bytes,
                                        const struct SinewCyclicParticlesConfig *config,
                                        struct SinewCyclicParticles **tracker);

/**
 * Takes in one frame, and writes what is known then. The result's `is_searching`, `is_outlier` and
 * `is_misfit` are zero.
 *
 * A frame more than 600 frames of the model after the last counts as that much later. A frame n
 * frames of the model after the last takes the time of n steps. Returns SINEW_STATUS_WAITING, and
 * writes no result, until a first frame shows an angle. Every other status but SINEW_STATUS_OK
 * leaves the filter as it was: a number that is NaN, infinite or out of range, more angles than
 * the model has, a timestamp not after the last one.
 *
 * Caller's duty:
 * `tracker` comes from `sinew_cyclic_particles_init`.
 */
SinewStatus sinew_cyclic_particles_step(struct SinewCyclicParticles *tracker,
                                        const struct SinewCyclicFrame *frame,
                                        struct SinewCyclicResult *result);

/**
 * Forgets all frames, as after the object's `init` with the same configuration. A front
 * end keeps its skin table.
 *
 * Caller's duty:
 * `tracker` comes from the object's `init`.
 */
SinewStatus sinew_cyclic_particles_reset(struct SinewCyclicParticles *tracker);

/**
 * Writes the state into `buffer`. An object of the same kind and configuration can go on
 * from it, on this processor or another. The object's type says what is saved, and which
 * of its configuration may differ.
 *
 * Writes into `written` how many bytes the state takes, also where the buffer is too
 * small. The object is not changed.
 *
 * Caller's duty:
 * `tracker` comes from the object's `init`, `buffer` has the size that is said.
 */
SinewStatus sinew_cyclic_particles_save(struct SinewCyclicParticles *tracker,
                                        uint8_t *buffer,
                                        size_t buffer_bytes,
                                        size_t *written);

/**
 * Goes on from a state that was saved, all of `state_bytes`.
 *
 * A state that is not whole, of another version or configuration is refused, and the
 * object is as before. A whole state may hold a number that cannot be
 * (SINEW_STATUS_BAD_STATE too). Its object begins anew, a front end with the skin table of
 * its configuration.
 *
 * Caller's duty:
 * `tracker` comes from the object's `init`, `state` has the size that is said.
 */
SinewStatus sinew_cyclic_particles_restore(struct SinewCyclicParticles *tracker, const uint8_t *state, size_t state_bytes);

/**
 * Writes a configuration: a camera with square pixels, an adult who faces it at 1.25 metres, seed
 * 1, `SINEW_ARM_PARTICLES` particles, and the options that the host's command has.
 *
 * `config_bytes` is `sizeof *config`: SINEW_STATUS_STRUCT_SIZE says that the program was compiled
 * with the header of another version. Returns SINEW_STATUS_OUT_OF_RANGE for a field of view that
 * does not lie between 0 and pi.
 *
 * Caller's duty:
 * `config` points at room of the size that is said.
 */
SinewStatus sinew_arm_default_config(uint32_t image_width_px,
                                     uint32_t image_height_px,
                                     float horizontal_field_of_view_rad,
                                     struct SinewArmConfig *config,
                                     size_t config_bytes);

/**
 * Bytes that this object takes on this target; the constant MAX_BYTES of its kind at most.
 */
size_t sinew_arm_size(void);

/**
 * Alignment that the memory of this object needs; `SINEW_ALIGN` at most.
 */
size_t sinew_arm_align(void);

/**
 * Makes an arm tracker in `memory`, which it needs as long as it is used; there is nothing to
 * free. `config` is copied.
 *
 * `side` is SINEW_SIDE_LEFT or SINEW_SIDE_RIGHT, the person's own.
 * `tracker` is written only if the status is SINEW_STATUS_OK.
 *
 * Caller's duty:
 * `memory` has the size that is said.
 */
SinewStatus sinew_arm_init(void *memory,
                           size_t memory_bytes,
                           const struct SinewArmConfig *config,
                           uint32_t side,
                           struct SinewArm **tracker);

/**
 * Takes in one frame, and writes where the arm is then.
 *
 * Every status but SINEW_STATUS_OK leaves the tracker as it was: a number that is NaN, infinite or
 * out of range, lists over capacity, a timestamp not after the last one.
 *
 * Caller's duty:
 * `tracker` comes from `sinew_arm_init`; the frame's lists have as many elements as it says.
 */
SinewStatus sinew_arm_step(struct SinewArm *tracker, const struct SinewArmFrame *frame, struct SinewArmResult *result);

/**
 * Forgets all frames, as after the object's `init` with the same configuration. A front
 * end keeps its skin table.
 *
 * Caller's duty:
 * `tracker` comes from the object's `init`.
 */
SinewStatus sinew_arm_reset(struct SinewArm *tracker);

/**
 * Writes the state into `buffer`. An object of the same kind and configuration can go on
 * from it, on this processor or another. The object's type says what is saved, and which
 * of its configuration may differ.
 *
 * Writes into `written` how many bytes the state takes, also where the buffer is too
 * small. The object is not changed.
 *
 * Caller's duty:
 * `tracker` comes from the object's `init`, `buffer` has the size that is said.
 */
SinewStatus sinew_arm_save(struct SinewArm *tracker, uint8_t *buffer, size_t buffer_bytes, size_t *written);

/**
 * Goes on from a state that was saved, all of `state_bytes`.
 *
 * A state that is not whole, of another version or configuration is refused, and the
 * object is as before. A whole state may hold a number that cannot be
 * (SINEW_STATUS_BAD_STATE too). Its object begins anew, a front end with the skin table of
 * its configuration.
 *
 * Caller's duty:
 * `tracker` comes from the object's `init`, `state` has the size that is said.
 */
SinewStatus sinew_arm_restore(struct SinewArm *tracker, const uint8_t *state, size_t state_bytes);

/**
 * Bytes that this object takes on this target; the constant MAX_BYTES of its kind at most.
 */
size_t sinew_arm_pair_size(void);

/**
 * Alignment that the memory of this object needs; `SINEW_ALIGN` at most.
 */
size_t sinew_arm_pair_align(void);

/**
 * Makes a tracker of both arms in `memory`, which it needs as long as it is used; there is nothing
 * to free. `config` is copied.
 *
 * `tracker` is written only if the status is SINEW_STATUS_OK.
 *
 * Caller's duty:
 * `memory` has the size that is said.
 */
SinewStatus sinew_arm_pair_init(void *memory,
                                size_t memory_bytes,
                                const struct SinewArmConfig *config,
                                struct SinewArmPair **tracker);

/**
 * Takes in one frame, and writes where both arms are then, left and right.
 *
 * Every status but SINEW_STATUS_OK leaves the tracker as it was: a number that is NaN, infinite or
 * out of range, lists over capacity, a timestamp not after the last one.
 *
 * Caller's duty:
 * `tracker` comes from `sinew_arm_pair_init`; the frame's lists have as many elements as it says.
 * `results` has room for two.
 */
SinewStatus sinew_arm_pair_step(struct SinewArmPair *tracker, const struct SinewArmFrame *frame, struct SinewArmResult *results);

/**
 * Forgets all frames, as after the object's `init` with the same configuration. A front
 * end keeps its skin table.
 *
 * Caller's duty:
 * `tracker` comes from the object's `init`.
 */
SinewStatus sinew_arm_pair_reset(struct SinewArmPair *tracker);

/**
 * Writes the state into `buffer`. An object of the same kind and configuration can go on
 * from it, on this processor or another. The object's type says what is saved, and which
 * of its configuration may differ.
 *
 * Writes into `written` how many bytes the state takes, also where the buffer is too
 * small. The object is not changed.
 *
 * Caller's duty:
 * `tracker` comes from the object's `init`, `buffer` has the size that is said.
 */
SinewStatus sinew_arm_pair_save(struct SinewArmPair *tracker, uint8_t *buffer, size_t buffer_bytes, size_t *written);

/**
 * Goes on from a state that was saved, all of `state_bytes`.
 *
 * A state that is not whole, of another version or configuration is refused, and the
 * object is as before. A whole state may hold a number that cannot be
 * (SINEW_STATUS_BAD_STATE too). Its object begins anew, a front end with the skin table of
 * its configuration.
 *
 * Caller's duty:
 * `tracker` comes from the object's `init`, `state` has the size that is said.
 */
SinewStatus sinew_arm_pair_restore(struct SinewArmPair *tracker, const uint8_t *state, size_t state_bytes);

/**
 * Writes a configuration: an adult of 1.75 metres who faces the camera with hanging arms, the
 * pelvis `distance_m` before it and half a metre below its axis, and the options that the host's
 * command has.
 *
 * `config_bytes` is `sizeof *config`: SINEW_STATUS_STRUCT_SIZE says that the program was compiled
 * with the header of another version. Returns SINEW_STATUS_OUT_OF_RANGE for a distance that does
 * not lie between 0.2 and 20.
 *
 * Caller's duty:
 * `config` points at room of the size that is said.
 */
SinewStatus sinew_body_default_config(float distance_m, struct SinewBodyConfig *config, size_t config_bytes);

/**
 * Bytes that this object takes on this target; the constant MAX_BYTES of its kind at most.
 */
size_t sinew_body_size(void);

/**
 * Alignment that the memory of this object needs; `SINEW_ALIGN` at most.
 */
size_t sinew_body_align(void);

/**
 * Makes a tracker of an upper body in `memory`, which it needs as long as it is used; there is
 * nothing to free. `config` is copied. `tracker` is written only if the status is SINEW_STATUS_OK.
 *
 * Caller's duty:
 * `memory` has the size that is said.
 */
SinewStatus sinew_body_init(void *memory, size_t memory_bytes, const struct SinewBodyConfig *config, struct SinewBody **tracker);

/**
 * Takes in one frame, and writes where the upper body is then. The frame's points are brought into
 * another order.
 *
 * Every status but SINEW_STATUS_OK leaves the tracker as it was: too many points, a timestamp not
 * after the last one.
 *
 * Caller's duty:
 * `tracker` comes from `sinew_body_init`; the frame has as many points as it says, which no other
 * code uses.
 */
SinewStatus sinew_body_step(struct SinewBody *tracker, const struct SinewBodyFrame *frame, struct SinewBodyResult *result);

/**
 * Forgets all frames, as after the object's `init` with the same configuration. A front
 * end keeps its skin table.
 *
 * Caller's duty:
 * `tracker` comes from the object's `init`.
 */
SinewStatus sinew_body_reset(struct SinewBody *tracker);

/**
 * Writes the state into `buffer`. An object of the same kind and configuration can go on
 * from it, on this processor or another. The object's type says what is saved, and which
 * of its configuration may differ.
 *
 * Writes into `written` how many bytes the state takes, also where the buffer is too
 * small. The object is not changed.
 *
 * Caller's duty:
 * `tracker` comes from the object's `init`, `buffer` has the size that is said.
 */
SinewStatus sinew_body_save(struct SinewBody *tracker, uint8_t *buffer, size_t buffer_bytes, size_t *written);

/**
 * Goes on from a state that was saved, all of `state_bytes`.
 *
 * A state that is not whole, of another version or configuration is refused, and the
 * object is as before. A whole state may hold a number that cannot be
 * (SINEW_STATUS_BAD_STATE too). Its object begins anew, a front end with the skin table of
 * its configuration.
 *
 * Caller's duty:
 * `tracker` comes from the object's `init`, `state` has the size that is said.
 */
SinewStatus sinew_body_restore(struct SinewBody *tracker, const uint8_t *state, size_t state_bytes);

/**
 * Writes a configuration: 320 x 240 pixels of RGB565, skin of many people under many lights.
 *
 * `config_bytes` is `sizeof *config`: SINEW_STATUS_STRUCT_SIZE says that the program was compiled
 * with the header of another version.
 *
 * Caller's duty:
 * `config` points at room of the size that is said.
 */
SinewStatus sinew_vision_default_config(struct SinewVisionConfig *config, size_t config_bytes);

/**
 * Bytes that this object takes on this target; the constant MAX_BYTES of its kind at most.
 */
size_t sinew_vision_size(void);

/**
 * Alignment that the memory of this object needs; `SINEW_ALIGN` at most.
 */
size_t sinew_vision_align(void);

/**
 * Makes a front end in `memory`, which it needs as long as it is used; there is nothing to free.
 * `config` is copied.
 *
 * Fills the skin table, one decision for each of 65536 colours, which takes some time. `vision` is
 * written only if the status is SINEW_STATUS_OK. Returns SINEW_STATUS_OVER_CAPACITY for frames
 * larger than 320 x 240, or 640 x 480 in a library with the feature `vga`.
 *
 * Caller's duty:
 * `memory` has the size that is said.
 */
SinewStatus sinew_vision_init(void *memory,
                              size_t memory_bytes,
                              const struct SinewVisionConfig *config,
                              struct SinewVision **vision);

/**
 * Takes over another skin model, from the next line on, or over some frames where the
 * configuration has `skin_colours_per_frame`.
 *
 * Caller's duty:
 * `vision` comes from `sinew_vision_init`.
 */
SinewStatus sinew_vision_learn_skin(struct SinewVision *vision, const struct SinewSkin *skin);

/**
 * Begins to calibrate: from the next line on, until `sinew_vision_end_calibration`, the pixels
 * inside of `box_px` are looked at, 256 of them, evenly. It has to show nothing but skin, a hand
 * held into it; the lines of one frame suffice.
 *
 * A calibration that was begun before is given up. Returns SINEW_STATUS_OUT_OF_RANGE for a box
 * that is empty or reaches beyond the frame.
 *
 * Caller's duty:
 * `vision` comes from `sinew_vision_init`.
 */
SinewStatus sinew_vision_begin_calibration(struct SinewVision *vision, const struct SinewBox *box_px);

/**
 * Ends a calibration: adapts the skin of the configuration, or the last one of
 * `sinew_vision_learn_skin`, to what the box showed, takes it over as that function does, and
 * writes it into `skin`, which may be null.
 *
 * Returns SINEW_STATUS_NO_SAMPLE where no calibration was begun or no line of the box came since,
 * SINEW_STATUS_OUT_OF_RANGE where all of its pixels were black; the skin is as before then.
 *
 * Caller's duty:
 * `vision` comes from `sinew_vision_init`.
 */
SinewStatus sinew_vision_end_calibration(struct SinewVision *vision, struct SinewSkin *skin);

/**
 * Begins a frame; what was read of one that did not end is dropped.
 *
 * Caller's duty:
 * `vision` comes from `sinew_vision_init`.
 */
SinewStatus sinew_vision_begin_frame(struct SinewVision *vision);

/**
 * Reads a line of the frame: `row` from 0 at the top, `pixel_count` pixels of 16 bits from the
 * left.
 *
 * Lines come in order. A line that is left out or too short counts as without skin where pixels
 * are missing, one that comes twice or too late is ignored; the frame's result says how many.
 * Returns SINEW_STATUS_NO_FRAME before `sinew_vision_begin_frame`, and SINEW_STATUS_OUT_OF_RANGE
 * for a row or pixels beyond the frame, which change nothing.
 *
 * Caller's duty:
 * `vision` comes from `sinew_vision_init`, `pixels` points at as many as is said.
 */
SinewStatus sinew_vision_line(struct SinewVision *vision, uint32_t row, const uint16_t *pixels, size_t pixel_count);

/**
 * Ends the frame, and writes what it showed. The lists of the result lie in the front end's memory
 * and are good until the next frame begins.
 *
 * Returns SINEW_STATUS_NO_FRAME before `sinew_vision_begin_frame`.
 *
 * Caller's duty:
 * `vision` comes from `sinew_vision_init`.
 */
SinewStatus sinew_vision_end_frame(struct SinewVision *vision, struct SinewVisionResult *result);

/**
 * Forgets all frames, as after the object's `init` with the same configuration. A front
 * end keeps its skin table.
 *
 * Caller's duty:
 * `vision` comes from the object's `init`.
 */
SinewStatus sinew_vision_reset(struct SinewVision *vision);

/**
 * Writes the state into `buffer`. An object of the same kind and configuration can go on
 * from it, on this processor or another. The object's type says what is saved, and which
 * of its configuration may differ.
 *
 * Writes into `written` how many bytes the state takes, also where the buffer is too
 * small. The object is not changed.
 *
 * Caller's duty:
 * `vision` comes from the object's `init`, `buffer` has the size that is said.
 */
SinewStatus sinew_vision_save(struct SinewVision *vision, uint8_t *buffer, size_t buffer_bytes, size_t *written);

/**
 * Goes on from a state that was saved, all of `state_bytes`.
 *
 * A state that is not whole, of another version or configuration is refused, and the
 * object is as before. A whole state may hold a number that cannot be
 * (SINEW_STATUS_BAD_STATE too). Its object begins anew, a front end with the skin table of
 * its configuration.
 *
 * Caller's duty:
 * `vision` comes from the object's `init`, `state` has the size that is said.
 */
SinewStatus sinew_vision_restore(struct SinewVision *vision, const uint8_t *state, size_t state_bytes);

/**
 * Is called where the library panics: define it to stop motors, to log or to reset. Where the
 * program defines none, or it returns, the library loops for ever.
 *
 * It has to stand in an object file of the program; one in an archive may not be taken. In a
 * library that was built without `panic-handler` the program's own handler runs instead.
 */
extern void sinew_on_panic(void);

#ifdef __cplusplus
}  // extern "C"
#endif  // __cplusplus

#endif  /* SINEW_H */
