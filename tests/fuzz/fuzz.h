/* fuzz.h - what fuzz_scene.c gives to libFuzzer, and to the program that stands in for it. */
#ifndef VIRGA_TESTS_FUZZ_H
#define VIRGA_TESTS_FUZZ_H

#include <stddef.h>
#include <stdint.h>

/* Runs one input. Aborts if a condition fails. Exits with 77 if there is no device. */
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

/* Destroys the device. Aborts if objects on it are still alive. */
void fuzz_close(void);

#endif
