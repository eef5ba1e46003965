/* fuzz.h: what a fuzz target is: one input, which must do no harm. Driven by tests/fuzz/driver.c or, with clang, by
 * libFuzzer, whose names these are. */
#ifndef FUZZ_H
#define FUZZ_H

#include <stddef.h>
#include <stdint.h>

/* Try an input; abort where something is wrong. Returns 0. */
int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t n);

#endif
