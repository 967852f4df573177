/* A camera that sees an arm: lines of 320 x 240 pixels (640 x 480 with SINEW_VGA) go into the front end as they arrive, its blobs and edges into the arm tracker,
 * the place of the hand comes out.
 *
 * The pictures are made up: a hand and a face before a wall. The hand is behind the back for half of a second. The same program runs on
 * a computer and on a microcontroller, and prints the same on both. */

#include <sinew.h>
#include <stdio.h>

static uint64_t vision_memory[SINEW_VISION_MAX_BYTES / sizeof(uint64_t)];
static uint64_t arm_memory[SINEW_ARM_MAX_BYTES / sizeof(uint64_t)];

#ifdef SINEW_VGA
enum { SCALE = 2 };
#else
enum { SCALE = 1 };
#endif
enum { WIDTH = 320 * SCALE, HEIGHT = 240 * SCALE, FRAMES_PER_S = 15, FRAMES = 5 * FRAMES_PER_S };

static const uint16_t SKIN = 0xcc6c, WALL = 0x6b2c, SLEEVE = 0x2a0a;

static int failed(const char *what, SinewStatus status) {
    printf("%s: %s\n", what, sinew_error_text(status));
    return 1;
}

static uint32_t digest(uint32_t sum, const void *data, size_t bytes) {
    const unsigned char *byte = data;
    for (size_t i = 0; i < bytes; i++) {
        sum = (sum ^ byte[i]) * 16777619U;
    }
    return sum;
}

/* From 0 up to `width`, down again, and so on. */
static int back_and_forth(int step, int width) {
    int phase = step % (2 * width);
    return phase < width ? phase : 2 * width - phase;
}

static int is_in_disc(int u, int v, int centre_u, int centre_v, int radius) {
    return (u - centre_u) * (u - centre_u) + (v - centre_v) * (v - centre_v) <= radius * radius;
}

static void draw_line(int frame, int v, uint16_t line[WIDTH]) {
    /* The person's left hand is on the right of the picture. */
    int hand_u = 195 + back_and_forth(2 * frame, 50), hand_v = 165 - back_and_forth(2 * frame, 40);
    int hidden = frame >= 40 && frame < 48;
    v /= SCALE;
    for (int pixel = 0; pixel < WIDTH; pixel++) {
        int u = pixel / SCALE;
        uint16_t colour = (uint16_t)(WALL + (uint16_t)((u * 7 + v * 13 + frame * 5) % 3));
        if (u > 185 && u < 215 && v > 110 && v < 200) {
            colour = SLEEVE;
        }
        if (is_in_disc(u, v, 160, 50, 20) || (!hidden && is_in_disc(u, v, hand_u, hand_v, 13))) {
            colour = SKIN;
        }
        line[pixel] = colour;
    }
}

static SinewStatus see(SinewVision *vision, int frame, SinewVisionResult *seen) {
    uint16_t line[WIDTH];
    SinewStatus status = sinew_vision_begin_frame(vision);
    for (int v = 0; v < HEIGHT && status == SINEW_STATUS_OK; v++) {
        draw_line(frame, v, line);
        status = sinew_vision_line(vision, (uint32_t)v, line, WIDTH);
    }
    return status == SINEW_STATUS_OK ? sinew_vision_end_frame(vision, seen) : status;
}

int main(void) {
    static const char *const STATES[] = {"lost", "predicted", "tracking", "uncertain"};
    SinewVision *vision = NULL;
    SinewVisionConfig vision_config;
    SinewStatus status = sinew_vision_default_config(&vision_config, sizeof vision_config);
    if (status == SINEW_STATUS_OK) {
        vision_config.width_px = WIDTH;
        vision_config.height_px = HEIGHT;
        status = sinew_vision_init(vision_memory, sizeof vision_memory, &vision_config, &vision);
    }
    if (status != SINEW_STATUS_OK) {
        return failed("sinew_vision_init", status);
    }
    SinewArm *arm = NULL;
    SinewArmConfig arm_config;
    status = sinew_arm_default_config(WIDTH, HEIGHT, 1.0471976F, &arm_config, sizeof arm_config);
    if (status == SINEW_STATUS_OK) {
        status = sinew_arm_init(arm_memory, sizeof arm_memory, &arm_config, SINEW_SIDE_LEFT, &arm);
    }
    if (status != SINEW_STATUS_OK) {
        return failed("sinew_arm_init", status);
    }
    fprintf(stderr, "bytes of the front end: %u, of the arm tracker: %u\n", (unsigned)sinew_vision_size(),
            (unsigned)sinew_arm_size());
    printf("frame state blobs edges u_px v_px x_mm y_mm z_mm\n");
    uint32_t sum = 2166136261U;
    for (int frame = 0; frame < FRAMES; frame++) {
        SinewVisionResult seen;
        SinewArmResult result;
        status = see(vision, frame, &seen);
        if (status != SINEW_STATUS_OK) {
            return failed("the front end", status);
        }
        SinewArmFrame arm_frame = {0};
        arm_frame.timestamp_us = (uint64_t)frame * 1000000U / FRAMES_PER_S;
        arm_frame.candidates = seen.candidates;
        arm_frame.candidate_count = seen.candidate_count;
        arm_frame.edges = seen.edges;
        arm_frame.edge_count = seen.edge_count;
        arm_frame.has_image = 1;
        for (int side = 0; side < 2; side++) {
            for (int axis = 0; axis < 3; axis++) {
                arm_frame.shoulders_m[side][axis] = arm_config.shoulders_m[side][axis];
            }
        }
        status = sinew_arm_step(arm, &arm_frame, &result);
        if (status != SINEW_STATUS_OK) {
            return failed("sinew_arm_step", status);
        }
        sum = digest(sum, result.hand_m, sizeof result.hand_m);
        sum = digest(sum, result.angles_rad, sizeof result.angles_rad);
        if (frame % 5 == 4) {
            printf("%d %s %u %u %.0f %.0f %.0f %.0f %.0f\n", frame, STATES[result.state], (unsigned)seen.candidate_count,
                   (unsigned)seen.edge_count, (double)result.hand_px[0], (double)result.hand_px[1],
                   (double)(1000.0F * result.hand_m[0]), (double)(1000.0F * result.hand_m[1]),
                   (double)(1000.0F * result.hand_m[2]));
        }
    }
    printf("digest %08lx\n", (unsigned long)sum);
    return 0;
}
