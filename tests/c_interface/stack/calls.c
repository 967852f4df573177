/* Calls every function of sinew.h with frames that take their longest ways, and prints how deep each went into the stack. */

#include "frames.h"
#include "measure.h"
#include <sinew.h>

/* A motion model in flash; the test makes it. */
extern const uint32_t model[];
extern const size_t model_bytes;

static uint64_t memory[SINEW_CYCLIC_PARTICLES_MAX_BYTES / sizeof(uint64_t)];
static uint64_t vision_memory[SINEW_VISION_MAX_BYTES / sizeof(uint64_t)];
static uint32_t state[SINEW_CYCLIC_PARTICLES_STATE_MAX_BYTES / sizeof(uint32_t)];
static size_t state_bytes;

/* Fails the program where a status is not the expected one. */
static void expect(const char *what, SinewStatus expected, SinewStatus status) {
    if (status != expected) {
        print(what);
        print(": ");
        print(sinew_error_text(status));
        print("\n");
        leave(2);
    }
}

#define DONE(function, ...) expect(#function, SINEW_STATUS_OK, CALL(function, __VA_ARGS__))

/* Saves, restores, restores a state with a number that cannot be, and resets. */
#define STATES(kind, object, broken)                                                                                          \
    do {                                                                                                                     \
        DONE(sinew_##kind##_save, object, (uint8_t *)state, sizeof state, &state_bytes);                                     \
        DONE(sinew_##kind##_restore, object, (const uint8_t *)state, state_bytes);                                           \
        break_state(state, state_bytes);                                                                                     \
        expect("a broken state", broken, CALL(sinew_##kind##_restore, object, (const uint8_t *)state, state_bytes));         \
        DONE(sinew_##kind##_reset, object);                                                                                  \
    } while (0)

static void cyclic(const void *motion, size_t bytes) {
    SinewCyclic *tracker = NULL;
    SinewCyclicConfig config;
    SinewClock clock = {0};
    DONE(sinew_cyclic_default_config, &config, sizeof config);
    DONE(sinew_cyclic_init, memory, sizeof memory, motion, bytes, &config, &tracker);
    for (int frame = 0; frame < 600; frame++) {
        SinewCyclicFrame measured = {0};
        SinewCyclicResult result;
        DONE(sinew_cyclic_mean_pose, tracker, 0.015F * (float)frame, measured.angles_rad, SINEW_MAX_ANGLES);
        walk(frame, &measured);
        DONE(sinew_clock_us, &clock, (uint32_t)measured.timestamp_us, &measured.timestamp_us);
        SinewStatus status = CALL(sinew_cyclic_step, tracker, &measured, &result);
        expect("sinew_cyclic_step", frame == 0 ? SINEW_STATUS_WAITING : SINEW_STATUS_OK, status);
    }
    STATES(cyclic, tracker, SINEW_STATUS_BAD_STATE);
}

/* A walk without its last part: of the gap of twenty seconds each frame would be a step. The mean cycle comes from `poses`. */
static void particles(const void *motion, size_t bytes, uint32_t has_first_position) {
    static uint64_t poses_memory[SINEW_CYCLIC_MAX_BYTES / sizeof(uint64_t)];
    SinewCyclic *poses = NULL;
    SinewCyclicParticles *tracker = NULL;
    SinewCyclicParticlesConfig config;
    DONE(sinew_cyclic_init, poses_memory, sizeof poses_memory, NULL, 0, NULL, &poses);
    DONE(sinew_cyclic_particles_default_config, &config, sizeof config);
    config.has_first_position = has_first_position;
    DONE(sinew_cyclic_particles_init, memory, sizeof memory, motion, bytes, &config, &tracker);
    for (int frame = 0; frame < 60; frame++) {
        SinewCyclicFrame measured = {0};
        SinewCyclicResult result;
        DONE(sinew_cyclic_mean_pose, poses, 0.015F * (float)frame, measured.angles_rad, SINEW_MAX_ANGLES);
        walk(frame, &measured);
        SinewStatus status = CALL(sinew_cyclic_particles_step, tracker, &measured, &result);
        expect("sinew_cyclic_particles_step", frame == 0 ? SINEW_STATUS_WAITING : SINEW_STATUS_OK, status);
    }
    STATES(cyclic_particles, tracker, SINEW_STATUS_BAD_STATE);
}

/* A trunk and two arms that swing, dots on their front; now and then holes only, or nothing. */
static void body(void) {
    static float points[SINEW_BODY_POINTS + 20][3];
    SinewBody *tracker = NULL;
    SinewBodyConfig config;
    DONE(sinew_body_default_config, 2.0F, &config, sizeof config);
    DONE(sinew_body_init, memory, sizeof memory, &config, &tracker);
    for (int number = 0; number < 30; number++) {
        const SinewBodyFrame frame = {(uint64_t)number * 66667U, points, number % 7 == 6 ? 0U : SINEW_BODY_POINTS + 20U, 0};
        SinewBodyResult result;
        for (int i = 0; i < SINEW_BODY_POINTS + 20; i++) {
            const float side = i % 3 == 1 ? 0.21F : -0.21F, swing = 0.02F * (float)(number % 12);
            const float down = 0.0011F * (float)i;
            points[i][0] = i % 3 == 0 ? 0.02F * (float)(i / 3 % 10) - 0.09F : side;
            points[i][1] = i % 3 == 0 ? down : 0.02F + down;
            points[i][2] = i % 3 == 0 ? 1.88F : 1.96F - down * swing * 4.0F;
        }
        DONE(sinew_body_step, tracker, &frame, &result);
    }
    STATES(body, tracker, SINEW_STATUS_BAD_STATE);
}

static void vision(uint32_t pixel_format, void (*use)(const SinewVisionResult *, int frame)) {
    SinewVision *vision = NULL;
    SinewVisionConfig config;
    SinewSkin skin;
    DONE(sinew_vision_default_config, &config, sizeof config);
    config.pixel_format = pixel_format;
    config.skin_colours_per_frame = pixel_format == SINEW_PIXEL_RGB565 ? 0 : 1024;
    DONE(sinew_vision_init, vision_memory, sizeof vision_memory, &config, &vision);
    for (int frame = 0; frame < 12; frame++) {
        const SinewBox box = {190, 155, 10, 10};
        SinewVisionResult seen;
        DONE(sinew_vision_begin_frame, vision);
        if (frame == 0) {
            DONE(sinew_vision_begin_calibration, vision, &box);
        }
        for (int row = frame % 3; row < PICTURE_HEIGHT - frame % 3; row++) {
            uint16_t line[PICTURE_WIDTH];
            picture_line(frame, row, line);
            DONE(sinew_vision_line, vision, (uint32_t)row, line, PICTURE_WIDTH);
        }
        DONE(sinew_vision_end_frame, vision, &seen);
        if (frame == 0) {
            (void)CALL(sinew_vision_end_calibration, vision, &skin);
            DONE(sinew_vision_learn_skin, vision, &config.skin);
        }
        use(&seen, frame);
    }
    STATES(vision, vision, SINEW_STATUS_OK);
}

static void use_nothing(const SinewVisionResult *seen, int frame) {
    (void)seen;
    (void)frame;
}

static SinewArm *arm;
static SinewArmPair *pair;

static void step_arms(SinewArmFrame *frame) {
    SinewArmResult result, results[2];
    if (arm != NULL) {
        DONE(sinew_arm_step, arm, frame, &result);
    } else {
        DONE(sinew_arm_pair_step, pair, frame, results);
    }
}

static void use_by_arms(const SinewVisionResult *seen, int frame) {
    SinewArmFrame arm_frame;
    frame_of_arms(frame, &arm_frame);
    arm_frame.candidates = seen->candidates;
    arm_frame.candidate_count = seen->candidate_count;
    arm_frame.edges = seen->edges;
    arm_frame.edge_count = seen->edge_count;
    step_arms(&arm_frame);
}

/* Full lists, blobs that jump, and frames without any. */
static void scatter(void) {
    static SinewHandCandidate candidates[SINEW_MAX_CANDIDATES];
    static SinewEdgePixel edges[SINEW_MAX_EDGES];
    for (int frame = 100; frame < 112; frame++) {
        SinewArmFrame arm_frame;
        frame_of_arms(frame, &arm_frame);
        scatter_candidates(frame, candidates);
        scatter_edges(frame, edges);
        arm_frame.candidates = candidates;
        arm_frame.edges = edges;
        arm_frame.candidate_count = frame % 4 == 3 ? 0 : SINEW_MAX_CANDIDATES;
        arm_frame.edge_count = SINEW_MAX_EDGES;
        arm_frame.has_image = frame % 5 != 4;
        step_arms(&arm_frame);
    }
}

static void arms(void) {
    SinewArmConfig config;
    DONE(sinew_arm_default_config, PICTURE_WIDTH, PICTURE_HEIGHT, 1.0471976F, &config, sizeof config);
    DONE(sinew_arm_init, memory, sizeof memory, &config, SINEW_SIDE_LEFT, &arm);
    vision(SINEW_PIXEL_RGB565, use_by_arms);
    scatter();
    STATES(arm, arm, SINEW_STATUS_BAD_STATE);
    arm = NULL;
    DONE(sinew_arm_pair_init, memory, sizeof memory, &config, &pair);
    vision(SINEW_PIXEL_RGB565, use_by_arms);
    scatter();
    STATES(arm_pair, pair, SINEW_STATUS_BAD_STATE);
}

static void sizes(void) {
    (void)CALL(sinew_version);
    (void)CALL(sinew_error_text, -3);
    (void)CALL(sinew_cyclic_size);
    (void)CALL(sinew_cyclic_align);
    (void)CALL(sinew_cyclic_particles_size);
    (void)CALL(sinew_cyclic_particles_align);
    (void)CALL(sinew_body_size);
    (void)CALL(sinew_body_align);
    (void)CALL(sinew_vision_size);
    (void)CALL(sinew_vision_align);
    (void)CALL(sinew_arm_size);
    (void)CALL(sinew_arm_align);
    (void)CALL(sinew_arm_pair_size);
    (void)CALL(sinew_arm_pair_align);
}

int main(void) {
    sizes();
    cyclic(NULL, 0);
    cyclic(model, model_bytes);
    particles(NULL, 0, 0);
    particles(model, model_bytes, 1);
    body();
    vision(SINEW_PIXEL_RGB565_SWAPPED, use_nothing);
    vision(SINEW_PIXEL_YUYV, use_nothing);
    arms();
    note("SinewCyclic", (uint32_t)sinew_cyclic_size());
    note("SinewCyclicParticles", (uint32_t)sinew_cyclic_particles_size());
    note("SinewBody", (uint32_t)sinew_body_size());
    note("SinewVision", (uint32_t)sinew_vision_size());
    note("SinewArm", (uint32_t)sinew_arm_size());
    note("SinewArmPair", (uint32_t)sinew_arm_pair_size());
    report();
    return 0;
}
