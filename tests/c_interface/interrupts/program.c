/* An interrupt that uses a tracker while a call of the program uses it, and a small stack with canaries below it.
 *
 * Runs on the emulated Cortex-M4F with the examples' start.c; prints what the test compares. */

#include <sinew.h>
#include <stdio.h>
#include <string.h>

enum { FRAMES = 300, LINES = 240, COLUMNS = 320, EXCEPTIONS = 16, SYSTICK = 15 };

/* SysTick's control, reload and value, and the place of the vector table. */
static volatile uint32_t *const SYST = (volatile uint32_t *)0xE000E010U;
static volatile uint32_t *const VTOR = (volatile uint32_t *)0xE000ED08U;
/* Ticks of 40 ns between interrupts: 3750 instructions of 64 ns, so that a step is broken into
 * about twelve times. A refused call takes nearly half of that; where it took more, the program
 * would never run. */
enum { RELOAD = 6000 };

static uint64_t memory[2][SINEW_CYCLIC_MAX_BYTES / sizeof(uint64_t)];
static uint64_t vision_memory[SINEW_VISION_MAX_BYTES / sizeof(uint64_t)];
static uint64_t arm_memory[SINEW_ARM_MAX_BYTES / sizeof(uint64_t)];
static SinewCyclic *shared, *calm;
static volatile uint32_t busy, refused, wrong;

/* A frame from the past: it is refused where the tracker is free, and changes nothing. */
static void tick(void) {
    SinewCyclicFrame late = {0};
    SinewCyclicResult result;
    late.angle_count = SINEW_MAX_ANGLES;
    switch (sinew_cyclic_step(shared, &late, &result)) {
    case SINEW_STATUS_BUSY:
        busy++;
        break;
    case SINEW_STATUS_OUT_OF_ORDER:
        refused++;
        break;
    default:
        wrong++;
    }
}

static __attribute__((aligned(128))) void (*vectors[EXCEPTIONS])(void);

static void start_interrupts(void) {
    /* Those of start.c lie at address 0, which C takes for no address. */
    const volatile uint32_t *from;
    __asm volatile("mov %0, #0" : "=r"(from));
    for (int i = 0; i < 7; i++) {
        vectors[i] = (void (*)(void))from[i];
    }
    vectors[SYSTICK] = tick;
    *VTOR = (uint32_t)vectors;
    SYST[1] = RELOAD;
    SYST[2] = 0;
    SYST[0] = 7;
}

static void stop_interrupts(void) { SYST[0] = 0; }

static SinewStatus measure(int frame, SinewCyclicFrame *measured) {
    memset(measured, 0, sizeof *measured);
    measured->timestamp_us = (uint64_t)(frame + 1) * 16667U;
    measured->angle_count = SINEW_MAX_ANGLES;
    measured->seen = (1U << SINEW_MAX_ANGLES) - 1U;
    for (int angle = 0; angle < SINEW_MAX_ANGLES; angle++) {
        measured->std_rad[angle] = 0.1F;
    }
    return sinew_cyclic_mean_pose(calm, 0.015F * (float)frame, measured->angles_rad, SINEW_MAX_ANGLES);
}

/* 0 where a tracker that an interrupt tries to use gives the bits of one that nothing disturbs. */
static int interrupts(void) {
    SinewStatus status = sinew_cyclic_init(memory[0], sizeof memory[0], NULL, 0, NULL, &shared);
    if (status == SINEW_STATUS_OK) {
        status = sinew_cyclic_init(memory[1], sizeof memory[1], NULL, 0, NULL, &calm);
    }
    for (int frame = 0; frame < FRAMES && status == SINEW_STATUS_OK; frame++) {
        SinewCyclicFrame measured;
        SinewCyclicResult with, without;
        memset(&with, 0, sizeof with);
        memset(&without, 0, sizeof without);
        status = measure(frame, &measured);
        if (status == SINEW_STATUS_OK) {
            status = sinew_cyclic_step(calm, &measured, &without);
        }
        if (frame == 1) {
            start_interrupts();
        }
        while (status == SINEW_STATUS_OK) {
            SinewStatus of_shared = sinew_cyclic_step(shared, &measured, &with);
            if (of_shared == SINEW_STATUS_OK) {
                break;
            }
            status = of_shared;
        }
        if (memcmp(&with, &without, sizeof with) != 0) {
            return 1;
        }
    }
    stop_interrupts();
    return status != SINEW_STATUS_OK;
}

/* Stack of a task, and below it what another task would have. */
enum { TASK_BYTES = 9 * 1024, SMALL_BYTES = 2 * 1024, CANARY = 0x5AC3E1B7 };
static __attribute__((aligned(8))) volatile uint32_t task[3 * TASK_BYTES / 2 / sizeof(uint32_t)];
static SinewStatus of_task;

static __attribute__((naked)) void run_on(void (*work)(void), volatile uint32_t *top) {
    (void)work;
    (void)top;
    __asm volatile("push {r4, lr}\n mov r4, sp\n mov sp, r1\n blx r0\n mov sp, r4\n pop {r4, pc}");
}

static SinewStatus see(SinewVision *vision, int frame, SinewVisionResult *seen) {
    static uint16_t line[COLUMNS];
    SinewStatus status = sinew_vision_begin_frame(vision);
    for (int row = 0; row < LINES && status == SINEW_STATUS_OK; row++) {
        for (int column = 0; column < COLUMNS; column++) {
            const int across = column - 200 - 3 * frame, down = row - 150;
            line[column] = across * across + down * down < 200 ? 0xcc6c : 0x39c7;
        }
        status = sinew_vision_line(vision, (uint32_t)row, line, COLUMNS);
    }
    return status == SINEW_STATUS_OK ? sinew_vision_end_frame(vision, seen) : status;
}

/* All three objects from their configuration to a result. */
static void work(void) {
    static SinewVisionConfig vision_config;
    static SinewArmConfig arm_config;
    static SinewArmFrame frame;
    static SinewArmResult result;
    static SinewVisionResult seen;
    static SinewCyclicFrame measured;
    static SinewCyclicResult walked;
    SinewVision *vision = NULL;
    SinewArm *arm = NULL;
    SinewStatus status = sinew_vision_default_config(&vision_config, sizeof vision_config);
    status = status ? status : sinew_vision_init(vision_memory, sizeof vision_memory, &vision_config, &vision);
    status = status ? status : sinew_arm_default_config(COLUMNS, LINES, 1.0471976F, &arm_config, sizeof arm_config);
    status = status ? status : sinew_arm_init(arm_memory, sizeof arm_memory, &arm_config, SINEW_SIDE_LEFT, &arm);
    status = status ? status : sinew_cyclic_init(memory[0], sizeof memory[0], NULL, 0, NULL, &shared);
    for (int step = 0; step < 4 && status == SINEW_STATUS_OK; step++) {
        status = see(vision, step, &seen);
        frame.timestamp_us = (uint64_t)step * 66667U;
        frame.candidates = seen.candidates;
        frame.candidate_count = seen.candidate_count;
        frame.edges = seen.edges;
        frame.edge_count = seen.edge_count;
        frame.has_image = 1;
        memcpy(frame.shoulders_m, arm_config.shoulders_m, sizeof frame.shoulders_m);
        status = status ? status : sinew_arm_step(arm, &frame, &result);
        status = status ? status : measure(step, &measured);
        status = status ? status : sinew_cyclic_step(shared, &measured, &walked);
    }
    of_task = status;
}

/* Whether the canaries below a stack of `bytes` are as they were. */
static int canaries_live(size_t bytes) {
    const size_t words = sizeof task / sizeof *task, below = words - bytes / sizeof *task;
    size_t word = 0;
    while (word < below && task[word] == CANARY) {
        word++;
    }
    return word == below;
}

int main(void) {
    const int disturbed = interrupts();
    printf("results differ: %d, wrong answers: %u\n", disturbed, (unsigned)wrong);
    printf("busy: %s, refused as late: %s\n", busy > FRAMES ? "often" : "seldom", refused > 0 ? "yes" : "no");
    fprintf(stderr, "busy %u, refused %u\n", (unsigned)busy, (unsigned)refused);
    for (size_t word = 0; word < sizeof task / sizeof *task; word++) {
        task[word] = CANARY;
    }
    run_on(work, task + sizeof task / sizeof *task);
    printf("on a stack of its own: %s\n", sinew_error_text(of_task));
    printf("canaries below %d bytes: %s\n", TASK_BYTES, canaries_live(TASK_BYTES) ? "alive" : "dead");
    printf("canaries below %d bytes: %s\n", SMALL_BYTES, canaries_live(SMALL_BYTES) ? "alive" : "dead");
    return 0;
}
