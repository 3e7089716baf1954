/* What `src/board`, `src/hash.rs`, `src/print.rs` and `src/states.rs` are in Rust: the machine, and numbers that are the same
 * on each. */
#ifndef BOARD_H
#define BOARD_H

#include <stdint.h>

/* Prints `MODULE KEY VALUE`, the value in hexadecimal. */
void print_line(const char *module, const char *key, uint64_t value);

/* A call that is measured, and what it is given. */
typedef void call_function(void *argument);

/* Instructions of `call(argument)` with its return, up to 10 million. */
uint32_t instructions_of(call_function *call, void *argument);

/* Bytes of stack that `call(argument)` uses, with an offset that is the same for every call. */
uint32_t stack_of(call_function *call, void *argument);

/* The hash that starts every other. */
#define HASH_START UINT64_C(0xcbf29ce484222325)

/* `hash` with the bits of some numbers taken in: FNV-1a in 64 bits. */
uint64_t hash_of(uint64_t hash, const float *x, int count);

/* The next random number of `state`, within [-1, 1]. */
float random_symmetric(uint64_t *state);

/* The next random number of `state`, below `limit`. */
uint32_t random_below(uint64_t *state, uint32_t limit);

#endif
