/* fuzz.h - what fuzz_scene.c gives to libFuzzer, and to the program that stands in for it. */
#ifndef VIRGA_TESTS_FUZZ_H
#define VIRGA_TESTS_FUZZ_H

#include <stddef.h>
#include <stdint.h>

/* Runs one input; aborts where something does not hold. Exits with 77 where there is no device. */
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

/* Lets go of the device; aborts where something is left on it. */
void fuzz_close(void);

#endif
