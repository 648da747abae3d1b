/* check.h - cmocka, and a comparison of numbers that prints both values. */
#ifndef VIRGA_TESTS_CORE_CHECK_H
#define VIRGA_TESTS_CORE_CHECK_H

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#define assert_near(value, expected, epsilon)                                                                \
    do {                                                                                                     \
        double value_ = (value);                                                                             \
        double expected_ = (expected);                                                                       \
        if (!(fabs(value_ - expected_) <= (epsilon))) {                                                      \
            fail_msg("%s is %.9g, expected %.9g within %.3g", #value, value_, expected_, (double)(epsilon)); \
        }                                                                                                    \
    } while (0)

/* Within a relative tolerance of the expected value. */
#define assert_ratio(value, expected, share) assert_near((value) / (expected), 1.0, share)

#endif
