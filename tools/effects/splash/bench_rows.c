/* bench_rows.c - the rows and columns of the table of `virga bench splash`, and its errors. */
#include "options.h"
#include "splash/bench_splash.h"

const uint32_t splash_bench_counts[COUNTS] = {100, 500, 1000, 3000, 10000, 100000, 1000000};

const splash_bench_row splash_bench_rows[ROWS] = {
    {"wet", VIRGA_GROUND_WET, 0.5e-3f, {492.61, 165.84, 85.11, 30.36}},
    {"3 mm", VIRGA_GROUND_PUDDLE_3, 4e-3f, {303.03, 81.90, 43.71, 14.96}},
    {"5 mm", VIRGA_GROUND_PUDDLE_5, 7e-3f, {204.08, 52.00, 23.30, 9.05}},
    {"crown-cone", VIRGA_GROUND_PUDDLE_10, 15e-3f, {534.73, 222.22, 124.38, 45.35}},
};

bool splash_bench_fail(const bench *b, const char *what)
{
    return options_complain("bench", "splash: %s%s%s", what, b->error[0] ? ": " : "", b->error);
}
