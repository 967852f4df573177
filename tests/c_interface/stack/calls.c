/* Calls every function of sinew.h with frames that take their longest ways, and prints how deep each went into the stack. */

#include "frames.h"
#include "measure.h"
#include <sinew.h>

/* A motion model in flash; the test makes it. */
extern const uint32_t model[];
extern const size_t model_bytes;

static uint64_t memory[SINEW_ARM_PAIR_MAX_BYTES / sizeof(uint64_t)];
static uint64_t vision_memory[SINEW_VISION_MAX_BYTES / sizeof(uint64_t)];
static uint32_t state[SINEW_VISION_STATE_MAX_BYTES / sizeof(uint32_t)];
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
    vision(SINEW_PIXEL_RGB565_SWAPPED, use_nothing);
    vision(SINEW_PIXEL_YUYV, use_nothing);
    arms();
    note("SinewCyclic", (uint32_t)sinew_cyclic_size());
    note("SinewVision", (uint32_t)sinew_vision_size());
    note("SinewArm", (uint32_t)sinew_arm_size());
    note("SinewArmPair", (uint32_t)sinew_arm_pair_size());
    report();
    return 0;
}
