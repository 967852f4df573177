/* Starts a program on an emulated Cortex-M4F or M33 (QEMU's mps2-an386, mps2-an505), and ends the emulator with the
 * program's exit code.
 *
 * Standard output and standard error go through semihosting. At the end the most stack that was used is written to standard
 * error. A real part needs its own start-up code instead. */

#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

extern uint32_t __stack_low[], __stack_high[], __data_start[], __data_end[], __data_load[], __bss_start[], __bss_end[];
extern void initialise_monitor_handles(void);
extern int main(void);
void reset(void);
void fault(void);

enum { SYS_EXIT_EXTENDED = 0x20, APPLICATION_EXIT = 0x20026 };
static const uint32_t UNUSED_WORD = 0xA5A5A5A5U;

static __attribute__((noreturn)) void leave(uint32_t code) {
    const uint32_t block[2] = {APPLICATION_EXIT, code};
    register uint32_t operation __asm("r0") = SYS_EXIT_EXTENDED;
    register const uint32_t *argument __asm("r1") = block;
    __asm volatile("bkpt 0xab" : : "r"(operation), "r"(argument) : "memory");
    for (;;) {
    }
}

/* What newlib calls where a program ends early. */
void _exit(int code) { leave((uint32_t)code); }

void fault(void) { leave(3); }

static __attribute__((noinline)) void run(void) {
    initialise_monitor_handles();
    int code = main();
    const uint32_t *word = __stack_low;
    while (word < __stack_high && *word == UNUSED_WORD) {
        word++;
    }
    fprintf(stderr, "bytes of stack: %u\n", (unsigned)((const uint8_t *)__stack_high - (const uint8_t *)word));
    fflush(stdout);
    fflush(stderr);
    leave((uint32_t)code);
}

void reset(void) {
    /* Access to the floating-point unit (CPACR). */
    *(volatile uint32_t *)0xE000ED88U |= 0xFU << 20;
    __asm volatile("dsb\n isb");
    for (uint32_t *to = __data_start, *from = __data_load; to < __data_end;) {
        *to++ = *from++;
    }
    for (uint32_t *to = __bss_start; to < __bss_end;) {
        *to++ = 0;
    }
    register uint32_t *top __asm("r0");
    __asm volatile("mov %0, sp" : "=r"(top));
    /* Volatile, so that the loop does not become a call of memset, which would paint its own stack. */
    for (volatile uint32_t *word = __stack_low; word < top; word++) {
        *word = UNUSED_WORD;
    }
    run();
}

typedef void (*Handler)(void);

/* The stack's top, reset, and the faults. */
__attribute__((section(".vectors"), used)) static const Handler VECTORS[7] = {
    (Handler)__stack_high, reset, fault, fault, fault, fault, fault,
};
