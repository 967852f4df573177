/* How deep a call goes: the free stack is painted before it and looked through after it. */

#ifndef MEASURE_H
#define MEASURE_H

#include <stddef.h>
#include <stdint.h>

extern volatile uint32_t __stack_low[];

#ifdef __riscv
#define STACK_POINTER_TO "mv "
#else
#define STACK_POINTER_TO "mov "
#endif
#define STACK_POINTER ", sp"

enum { PAINT = 0x5AC3E1B7 };

/* Has to be inlined, and its loop must not become a call of memset: both would use the stack that is painted. */
static inline __attribute__((always_inline)) void paint(void) {
    volatile uint32_t *top;
    __asm volatile(STACK_POINTER_TO "%0" STACK_POINTER : "=r"(top));
    for (volatile uint32_t *word = __stack_low; word < top; word++) {
        *word = PAINT;
    }
}

/* Bytes between the stack pointer and the deepest word that changed. */
static inline __attribute__((always_inline)) uint32_t depth(void) {
    volatile uint32_t *top, *word = __stack_low;
    __asm volatile(STACK_POINTER_TO "%0" STACK_POINTER : "=r"(top));
    while (word < top && *word == PAINT) {
        word++;
    }
    return (uint32_t)((uintptr_t)top - (uintptr_t)word);
}

/* Keeps the deepest call of each function. */
void note(const char *function, uint32_t bytes);
/* Prints a line for each function. */
void report(void);
/* Writes to the standard output of the emulator. */
void print(const char *text);
/* Ends the emulator with this code. */
__attribute__((noreturn)) void leave(uint32_t code);
int main(void);

#define CALL(function, ...)                                                                                                   \
    __extension__({                                                                                                          \
        paint();                                                                                                             \
        __typeof__(function(__VA_ARGS__)) answer = function(__VA_ARGS__);                                                    \
        note(#function, depth());                                                                                            \
        answer;                                                                                                              \
    })

#endif
