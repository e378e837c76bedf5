/* The entry point that a fuzz target defines and libFuzzer, or driver.c, calls. */
#ifndef ENF_TESTS_FUZZ_H
#define ENF_TESTS_FUZZ_H

#include <stddef.h>
#include <stdint.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

#endif
