/* Start, output and end of the program in QEMU: mps2-an385, mps2-an386 and virt (riscv32), through semihosting. */

#include "measure.h"

extern uint32_t __stack_high[];
void start(void);

enum { SYS_OPEN = 1, SYS_WRITE = 5, SYS_EXIT_EXTENDED = 0x20, APPLICATION_EXIT = 0x20026, WRITE_MODE = 4, MAX_FUNCTIONS = 64 };

static struct {
    const char *function;
    uint32_t bytes;
} deepest[MAX_FUNCTIONS];

static uint32_t semihosting(uint32_t operation, const void *argument) {
#ifdef __riscv
    register uint32_t a0 __asm("a0") = operation;
    register const void *a1 __asm("a1") = argument;
    __asm volatile(".balign 16\n.option push\n.option norvc\nslli x0, x0, 0x1f\nebreak\nsrai x0, x0, 7\n.option pop"
                   : "+r"(a0)
                   : "r"(a1)
                   : "memory");
    return a0;
#else
    register uint32_t r0 __asm("r0") = operation;
    register const void *r1 __asm("r1") = argument;
    __asm volatile("bkpt 0xab" : "+r"(r0) : "r"(r1) : "memory");
    return r0;
#endif
}

static uint32_t length(const char *text) {
    uint32_t bytes = 0;
    while (text[bytes] != 0) {
        bytes++;
    }
    return bytes;
}

static int is_same(const char *one, const char *other) {
    while (*one != 0 && *one == *other) {
        one++;
        other++;
    }
    return *one == *other;
}

void print(const char *text) {
    static uint32_t handle;
    if (handle == 0) {
        const uint32_t terminal[3] = {(uint32_t)(uintptr_t) ":tt", WRITE_MODE, 3};
        handle = semihosting(SYS_OPEN, terminal);
    }
    const uint32_t block[3] = {handle, (uint32_t)(uintptr_t)text, length(text)};
    semihosting(SYS_WRITE, block);
}

void note(const char *function, uint32_t bytes) {
    uint32_t at = 0;
    while (at < MAX_FUNCTIONS && deepest[at].function != NULL && !is_same(deepest[at].function, function)) {
        at++;
    }
    if (at == MAX_FUNCTIONS) {
        print("too many functions\n");
        leave(5);
    }
    deepest[at].function = function;
    if (bytes > deepest[at].bytes) {
        deepest[at].bytes = bytes;
    }
}

void report(void) {
    for (uint32_t at = 0; at < MAX_FUNCTIONS && deepest[at].function != NULL; at++) {
        char digits[] = "        \n";
        uint32_t rest = deepest[at].bytes;
        for (uint32_t place = 8; place > 0 && (rest > 0 || place == 8); place--, rest /= 10) {
            digits[place - 1] = (char)('0' + rest % 10);
        }
        print(deepest[at].function);
        print(" ");
        print(digits);
    }
}

void leave(uint32_t code) {
    const uint32_t block[2] = {APPLICATION_EXIT, code};
    semihosting(SYS_EXIT_EXTENDED, block);
    for (;;) {
    }
}

/* The library is that of the proof: a panic would be missing at link time, and ends the program here. */
void sinew_panic_is_reachable(void);
void sinew_panic_is_reachable(void) {
    print("a panic\n");
    leave(4);
}

void start(void) {
#ifdef __ARM_FP
    /* Access to the floating-point unit (CPACR). */
    *(volatile uint32_t *)0xE000ED88U |= 0xFU << 20;
    __asm volatile("dsb\n isb");
#endif
    leave((uint32_t)main());
}

#ifdef __riscv
/* The machine begins at the first address. */
__asm(".section .vectors, \"ax\"\nla sp, __stack_high\ncall start\n");
#else
static void fault(void) { leave(3); }
typedef void (*Handler)(void);
__attribute__((section(".vectors"), used)) static const Handler VECTORS[7] = {
    (Handler)__stack_high, start, fault, fault, fault, fault, fault,
};
#endif
