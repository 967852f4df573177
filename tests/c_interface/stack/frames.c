#include "frames.h"

static uint32_t random_state = 1;

static uint32_t random_bits(void) {
    random_state = random_state * 1664525U + 1013904223U;
    return random_state >> 8;
}

/* About a normal number with standard deviation one: the sum of four uniform ones. */
static float noise(void) {
    int32_t sum = 0;
    for (int i = 0; i < 4; i++) {
        sum += (int32_t)(random_bits() >> 8) - 32768;
    }
    return (float)sum / 37837.0F;
}

static float between(float low, float high) { return low + (high - low) * (float)(random_bits() >> 8) / 65536.0F; }

void walk(int frame, SinewCyclicFrame *measured) {
    const int is_hidden = frame == 0 || (frame >= 200 && frame < 260), stumbles = frame >= 400 && frame < 440;
    measured->timestamp_us = (uint64_t)frame * 16667U;
    if (frame >= 500) {
        /* A gap of twenty seconds. */
        measured->timestamp_us += 20000000U;
    }
    measured->angle_count = SINEW_MAX_ANGLES;
    for (uint32_t angle = 0; angle < SINEW_MAX_ANGLES; angle++) {
        measured->angles_rad[angle] += (stumbles ? 1.5F : 0.1F) * noise();
        measured->std_rad[angle] = 0.1F;
        if (!is_hidden && random_bits() % 8 != 0) {
            measured->seen |= 1U << angle;
        }
    }
}

static int is_in_disc(int u, int v, int centre_u, int centre_v, int radius) {
    return (u - centre_u) * (u - centre_u) + (v - centre_v) * (v - centre_v) <= radius * radius;
}

void picture_line(int frame, int row, uint16_t line[PICTURE_WIDTH]) {
    const int hand_u = 195 + 3 * frame, hand_v = 160 - 2 * frame;
    for (int u = 0; u < PICTURE_WIDTH; u++) {
        line[u] = (uint16_t)(0x6b2c + (u * 7 + row * 13 + frame * 5) % 3);
        if (u > 185 && u < 215 && row > 110 && row < 200) {
            line[u] = (uint16_t)(0x2a0a + 0x1111 * (int)(random_bits() % 8));
        }
        if (is_in_disc(u, row, 160, 50, 20) || is_in_disc(u, row, hand_u, hand_v, 13) || is_in_disc(u, row, 100, 160, 12)) {
            line[u] = 0xcc6c;
        }
    }
}

void frame_of_arms(int frame, SinewArmFrame *arm_frame) {
    *arm_frame = (SinewArmFrame){0};
    arm_frame->timestamp_us = (uint64_t)frame * 66667U;
    arm_frame->has_image = 1;
    arm_frame->shoulders_m[0][0] = 0.19F;
    arm_frame->shoulders_m[1][0] = -0.19F;
    for (int side = 0; side < 2; side++) {
        arm_frame->shoulders_m[side][1] = -0.05F;
        arm_frame->shoulders_m[side][2] = 1.25F;
    }
}

void scatter_candidates(int frame, SinewHandCandidate candidates[SINEW_MAX_CANDIDATES]) {
    for (int i = 0; i < SINEW_MAX_CANDIDATES; i++) {
        candidates[i].centre.u_px = i == 0 ? 200.0F + (float)(frame % 7) : between(0.0F, 320.0F);
        candidates[i].centre.v_px = i == 0 ? 150.0F : between(0.0F, 240.0F);
        candidates[i].moments_px2[0] = between(50.0F, 200.0F);
        candidates[i].moments_px2[1] = between(-20.0F, 20.0F);
        candidates[i].moments_px2[2] = between(50.0F, 200.0F);
        candidates[i].area_px = between(200.0F, 1500.0F);
        candidates[i].likelihood = i == 0 ? 0.9F : between(0.0F, 1.0F);
    }
}

/* Half of them along the arm that hangs from the left shoulder to the first candidate. */
void scatter_edges(int frame, SinewEdgePixel edges[SINEW_MAX_EDGES]) {
    (void)frame;
    for (int i = 0; i < SINEW_MAX_EDGES; i++) {
        const int is_of_arm = i % 2 == 0, along = (int)(random_bits() % 60);
        edges[i].u = (uint16_t)(is_of_arm ? 198 + (int)(random_bits() % 9) : (int)(random_bits() % PICTURE_WIDTH));
        edges[i].v = (uint16_t)(is_of_arm ? 100 + along : (int)(random_bits() % PICTURE_HEIGHT));
    }
}

/* CRC-32 of IEEE 802.3. */
static uint32_t checksum(const uint8_t *bytes, size_t count) {
    uint32_t sum = 0xFFFFFFFFU;
    for (size_t i = 0; i < count; i++) {
        sum ^= bytes[i];
        for (int bit = 0; bit < 8; bit++) {
            sum = (sum >> 1) ^ (0xEDB88320U & (0U - (sum & 1U)));
        }
    }
    return ~sum;
}

void break_state(uint32_t *state, size_t bytes) {
    const size_t last = bytes / sizeof(uint32_t) - 1;
    /* Header, timestamps, then numbers: one of those in the middle is one that is no number. */
    for (size_t word = last / 2; word < last / 2 + 24 && word < last; word++) {
        state[word] = 0x7FC00000U;
    }
    state[last] = checksum((const uint8_t *)state, last * sizeof(uint32_t));
}
