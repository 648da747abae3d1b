/* calls_list.h - the random calls of all public functions, by the list of the library's exports. A function of that
 * list without its call fails the test. */
#ifndef VIRGA_TESTS_FUZZ_CALLS_LIST_H
#define VIRGA_TESTS_FUZZ_CALLS_LIST_H

#include "calls.h"

#define CALL(name) void call_##name(calls *c) __attribute__((weak));
#include "calls_exports.inc"
#undef CALL

#endif
