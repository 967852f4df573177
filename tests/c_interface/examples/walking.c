/* A walk of twelve seconds: made-up angles with noise go into the cyclic tracker, cadence and angles come out.
 *
 * After five seconds the person is hidden for one; after eight the power fails, and the tracker goes on from its saved state.
 * The same program runs on a computer and on a microcontroller, and prints the same on both. */

#include <sinew.h>
#include <stdio.h>
#include <string.h>

/* Memory of the tracker, and of its state where it outlives a loss of power. */
static uint64_t memory[SINEW_CYCLIC_MAX_BYTES / sizeof(uint64_t)];
static uint8_t saved[SINEW_CYCLIC_STATE_MAX_BYTES];

enum { FRAMES_PER_S = 60, FRAMES = 12 * FRAMES_PER_S, LEFT_HIP = 7, LEFT_KNEE = 8 };

static const float NOISE_STD_RAD = 0.1F;
static const float CYCLES_PER_FRAME = 54.0F / 60.0F / 60.0F;

/* About a normal number with standard deviation one: the sum of four uniform ones. */
static float noise(uint32_t *state) {
    int32_t sum = 0;
    for (int i = 0; i < 4; i++) {
        *state = *state * 1664525U + 1013904223U;
        sum += (int32_t)(*state >> 16) - 32768;
    }
    return (float)sum / 37837.0F;
}

/* FNV-1a, so that two outputs can be compared bit by bit. */
static uint32_t digest(uint32_t sum, const void *data, size_t bytes) {
    const unsigned char *byte = data;
    for (size_t i = 0; i < bytes; i++) {
        sum = (sum ^ byte[i]) * 16777619U;
    }
    return sum;
}

static int failed(const char *what, SinewStatus status) {
    printf("%s: %s\n", what, sinew_error_text(status));
    return 1;
}

static SinewStatus measure(SinewCyclic *tracker, int frame, uint32_t *state, SinewCyclicFrame *measured) {
    memset(measured, 0, sizeof *measured);
    measured->timestamp_us = (uint64_t)frame * 1000000U / FRAMES_PER_S;
    measured->angle_count = SINEW_MAX_ANGLES;
    SinewStatus status =
        sinew_cyclic_mean_pose(tracker, (float)frame * CYCLES_PER_FRAME, measured->angles_rad, SINEW_MAX_ANGLES);
    for (uint32_t angle = 0; angle < SINEW_MAX_ANGLES; angle++) {
        measured->angles_rad[angle] += NOISE_STD_RAD * noise(state);
        measured->std_rad[angle] = NOISE_STD_RAD;
        /* One angle in eight is not seen. */
        if ((*state >> 20) % 8 != 0) {
            measured->seen |= 1U << angle;
        }
    }
    return status;
}

static float degrees(float radians) { return radians * 57.29578F; }

int main(void) {
    SinewCyclic *tracker = NULL;
    SinewStatus status = sinew_cyclic_init(memory, sizeof memory, NULL, 0, NULL, &tracker);
    if (status != SINEW_STATUS_OK) {
        return failed("sinew_cyclic_init", status);
    }
    fprintf(stderr, "bytes of the tracker: %u\n", (unsigned)sinew_cyclic_size());
    printf("second cadence_per_min std cycles left_hip_deg left_knee_deg\n");
    uint32_t state = 1, sum = 2166136261U;
    size_t saved_bytes = 0;
    for (int frame = 0; frame < FRAMES; frame++) {
        SinewCyclicFrame measured;
        SinewCyclicResult result;
        status = measure(tracker, frame, &state, &measured);
        if (status != SINEW_STATUS_OK) {
            return failed("sinew_cyclic_mean_pose", status);
        }
        if (frame >= 5 * FRAMES_PER_S && frame < 6 * FRAMES_PER_S) {
            measured.seen = 0;
        }
        if (frame == 8 * FRAMES_PER_S) {
            memset(memory, 0, sizeof memory);
            if (sinew_cyclic_step(tracker, &measured, &result) != SINEW_STATUS_NOT_INITIALISED) {
                return failed("a step before initialisation", status);
            }
            status = sinew_cyclic_init(memory, sizeof memory, NULL, 0, NULL, &tracker);
            if (status == SINEW_STATUS_OK) {
                status = sinew_cyclic_restore(tracker, saved, saved_bytes);
            }
            if (status != SINEW_STATUS_OK) {
                return failed("sinew_cyclic_restore", status);
            }
        }
        status = sinew_cyclic_step(tracker, &measured, &result);
        if (status != SINEW_STATUS_OK) {
            return failed("sinew_cyclic_step", status);
        }
        status = sinew_cyclic_save(tracker, saved, sizeof saved, &saved_bytes);
        if (status != SINEW_STATUS_OK) {
            return failed("sinew_cyclic_save", status);
        }
        sum = digest(sum, result.angles_rad, sizeof result.angles_rad);
        sum = digest(sum, &result.cadence_per_min, sizeof result.cadence_per_min);
        if (frame % FRAMES_PER_S == FRAMES_PER_S - 1) {
            printf("%d %.1f %.1f %d %.1f %.1f\n", (frame + 1) / FRAMES_PER_S, (double)result.cadence_per_min,
                   (double)result.cadence_std_per_min, (int)result.cycles_completed,
                   (double)degrees(result.angles_rad[LEFT_HIP]), (double)degrees(result.angles_rad[LEFT_KNEE]));
        }
    }
    printf("digest %08lx\n", (unsigned long)sum);
    return 0;
}
