/* A Cortex-M4F from C: QEMU's mps2-an386 with semihosting and `-icount shift=6`. `src/board/cortex_m.rs` explains the counts. */
#include "board.h"

extern uint32_t __bss[], __bss_end[], __data[], __data_end[], __data_load[], __stack[];

int main(void);
void reset(void);

static void semihosting(uint32_t operation, const void *arguments)
{
    register uint32_t r0 __asm__("r0") = operation;
    register const void *r1 __asm__("r1") = arguments;
    __asm__ volatile("bkpt 0xAB" : "+r"(r0) : "r"(r1) : "memory");
}

static void leave(uint32_t code)
{
    /* SYS_EXIT_EXTENDED with ADP_Stopped_ApplicationExit. */
    const uint32_t arguments[] = {0x20026, code};
    for (;;)
        semihosting(0x20, arguments);
}

static void hard_fault(void)
{
    leave(102);
}

/* An entry of the vector table: the first is the top of the stack. */
union vector {
    const void *stack;
    void (*handler)(void);
};

__attribute__((section(".vectors"), used)) static const union vector vectors[16] = {
    {__stack}, {.handler = reset}, {.handler = hard_fault}, {.handler = hard_fault},
    {.handler = hard_fault}, {.handler = hard_fault}, {.handler = hard_fault},
};

/* Called where the floating-point unit is already on: a compiler may use it from the first instruction of a function. */
__attribute__((noinline)) static void run(void)
{
    volatile uint32_t *to = __data;
    const uint32_t *from = __data_load;
    while (to < __data_end)
        *to++ = *from++;
    for (to = __bss; to < __bss_end; to++)
        *to = 0;
    leave((uint32_t)main());
}

void reset(void)
{
    /* CPACR: turns the floating-point unit on. */
    *(volatile uint32_t *)0xE000ED88 = UINT32_C(0xF) << 20;
    __asm__ volatile("dsb\n\tisb" : : : "memory");
    run();
}

/* Prints to QEMU's standard output: SYS_WRITE0. */
static void print(const char *text)
{
    semihosting(4, text);
}

void print_line(const char *module, const char *key, uint64_t value)
{
    char digits[] = "0000000000000000\n";
    for (int k = 15; k >= 0; k--, value >>= 4)
        digits[k] = "0123456789abcdef"[value & 15];
    print(module);
    print(" ");
    print(key);
    print(" ");
    print(digits);
}

/* SysTick: control, reload, current. */
#define SYSTICK ((volatile uint32_t *)0xE000E010)

static void nothing(void *argument)
{
    (void)argument;
}

__attribute__((noinline, noclone)) static uint32_t ticks(call_function *call, void *argument)
{
    const uint32_t before = SYSTICK[2];
    call(argument);
    return (before - SYSTICK[2]) & 0xFFFFFF;
}

uint32_t instructions_of(call_function *call, void *argument)
{
    SYSTICK[1] = 0xFFFFFF;
    SYSTICK[2] = 0;
    SYSTICK[0] = 5;
    const uint32_t all = (ticks(call, argument) * 5 + 4) / 8;
    /* The call of `nothing` is its return alone, which is not to be taken off. */
    return all - (ticks(nothing, argument) * 5 + 4) / 8 + 1;
}

#define PAINT UINT32_C(0xA5C35A3C)
/* Bytes that are painted, and those below the mark that may be of the own frame. */
#define DEPTH 16384
#define FRAME 128

__attribute__((noinline)) uint32_t stack_of(call_function *call, void *argument)
{
    volatile uint32_t mark = 0;
    const uintptr_t top = (uintptr_t)&mark & ~(uintptr_t)3, bottom = top - DEPTH;
    uintptr_t address;
    for (address = bottom; address < top - FRAME; address += 4)
        *(volatile uint32_t *)address = PAINT;
    call(argument);
    for (address = bottom; address < top - FRAME; address += 4)
        if (*(volatile uint32_t *)address != PAINT)
            break;
    return (uint32_t)(top - address);
}

uint64_t hash_of(uint64_t hash, const float *x, int count)
{
    for (int i = 0; i < count; i++) {
        const union { float number; uint32_t bits; } both = {x[i]};
        for (int byte = 0; byte < 4; byte++)
            hash = (hash ^ ((both.bits >> (8 * byte)) & 255)) * UINT64_C(0x100000001b3);
    }
    return hash;
}

/* 24 random bits: as many as a float holds. */
static uint32_t random_bits(uint64_t *state)
{
    *state = *state * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return (uint32_t)(*state >> 40);
}

float random_symmetric(uint64_t *state)
{
    return ((float)random_bits(state) - 8388608.0f) * (1.0f / 8388608.0f);
}

uint32_t random_below(uint64_t *state, uint32_t limit)
{
    return (uint32_t)(((uint64_t)random_bits(state) * limit) >> 24);
}
