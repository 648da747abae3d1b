/* check_depth.c - frames of rain of one drop size over a plate whose depth rises from 1 m at the left to 100 m at the
 * right: how much rain there is before each depth, how long its streaks are, and what its haze takes away.
 * Usage: check_depth DIR FRAMES
 * The scene: 100 mm/h of drops of 2.0 to 2.1 mm, 30 degrees, a shutter of 1/48 s, range 32 m, no fading. */
#include "exr.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>

enum { WIDTH = 256, HEIGHT = 128, BANDS = 8, PER_BAND = WIDTH / BANDS };

#define RATE_MM_H 100.0
#define SHUTTER_S (1 / 48.0)
#define NEAR_M    0.1

/* Gunn and Kinzer 1949: 6.49 m/s at 2.0 mm, 6.90 at 2.2. */
#define DIAMETER_M 2.05e-3
#define SPEED_M_S  6.5925

static int failures;

static void check(bool right, const char *what, int band, double is, double expected)
{
    printf("%s band %d: %.4f, expected %.4f%s\n", what, band, is, expected, right ? "" : "  FAILED");
    failures += !right;
}

typedef struct sums {
    double streaks[WIDTH], haze[WIDTH]; /* optical thickness, mean of the rows and frames */
    double shortest_px[WIDTH];          /* of the streaks that are whole in the picture */
    uint32_t runs[WIDTH];
} sums;

static double depth_of(int x)
{
    return pow(100, (double)x / (WIDTH - 1));
}

/* Runs of covered pixels in a column are streaks, as drops fall straight down. Their ends are covered in part: half of
 * both end pixels is counted. */
static void measure_runs(const float *alpha, int x, sums *all)
{
    for (int y = 0; y < HEIGHT; y++) {
        const int begin = y;
        double most = 0, sum = 0;
        while (y < HEIGHT && alpha[y * WIDTH + x] > 0) {
            most = fmax(most, (double)alpha[y * WIDTH + x]);
            sum += (double)alpha[y * WIDTH + x];
            y++;
        }
        if (begin == 0 || y == HEIGHT || y == begin)
            continue;
        all->shortest_px[x] = fmin(all->shortest_px[x], sum / most);
        all->runs[x]++;
    }
}

static bool add_frame(const char *directory, int frame, int frames, sums *all)
{
    char path[4096], error[512];
    uint32_t width, height;
    exr_request layers[3] = {
        {"rain.A", EXR_SAMPLE_FLOAT, NULL}, {"haze.A", EXR_SAMPLE_FLOAT, NULL}, {"Z", EXR_SAMPLE_FLOAT, NULL}};
    snprintf(path, sizeof path, "%s/frame.%04d.exr", directory, frame);
    if (!exr_read_channels(path, &width, &height, layers, 3, error, sizeof error)) {
        printf("%s\n", error);
        return false;
    }
    const float *rain = layers[0].data, *haze = layers[1].data, *z = layers[2].data;
    for (int x = 0; x < WIDTH; x++) {
        for (int y = 0; y < HEIGHT; y++) {
            all->streaks[x] -= log(1 - (double)rain[y * WIDTH + x]) / (HEIGHT * frames);
            all->haze[x] -= log(1 - (double)haze[y * WIDTH + x]) / (HEIGHT * frames);
            if (fabs((double)z[y * WIDTH + x] / depth_of(x) - 1) > 1e-4) {
                printf("Z is %g m in column %d\n", (double)z[y * WIDTH + x], x);
                failures++;
                y = HEIGHT;
            }
        }
        measure_runs(rain, x, all);
    }
    for (int i = 0; i < 3; i++)
        free(layers[i].data);
    return true;
}

/* Metres from the camera, mean of a column's rows. */
static double way_of(int x)
{
    const double pixel = 2 * tan(15 * M_PI / 180) / HEIGHT;
    double sum = 0;
    for (int y = 0; y < HEIGHT; y++)
        sum += depth_of(x) * sqrt(1 + pow((x + 0.5 - WIDTH / 2) * pixel, 2) + pow((y + 0.5 - HEIGHT / 2) * pixel, 2));
    return sum / HEIGHT;
}

/* A drop covers its disc, and rain R = N v (pi/6) D^3, so that a metre of it covers N (pi/4) D^2 = 1.5 R / (v D). What
 * is not drawn as streaks is haze, of half of 0.312 R^0.67 per km: as much is diffracted. Both together are all of the
 * rain before the plate, from the camera's near plane on. */
static void check_density(const sums *all)
{
    const double covered = 1.5 * RATE_MM_H / 3.6e6 / (SPEED_M_S * DIAMETER_M);
    const double extinction = 0.5 * 0.312e-3 * pow(RATE_MM_H, 0.67);
    for (int band = 0; band < BANDS; band++) {
        double way = -NEAR_M, found = 0;
        for (int x = band * PER_BAND; x < (band + 1) * PER_BAND; x++) {
            way += way_of(x) / PER_BAND;
            found += (all->streaks[x] / covered + all->haze[x] / extinction) / PER_BAND;
        }
        /* Some forty streaks are seen in a near band. */
        check(fabs(found / way - 1) < (band < 3 ? 0.25 : 0.1), "metres of rain in", band, found, way);
    }
}

/* Between two columns that are both beyond the range of drops there is haze alone. */
static void check_veil(const sums *all)
{
    const double extinction = 0.5 * 0.312 * pow(RATE_MM_H, 0.67);
    for (int x = 216; x < WIDTH - 8; x += 8) {
        const double per_km = 1e3 * (all->haze[x + 8] - all->haze[x]) / (way_of(x + 8) - way_of(x));
        check(fabs(per_km / extinction - 1) < 0.02, "extinction per km in", x / PER_BAND, per_km, extinction);
    }
}

/* No streak is shorter than one at the plate, and some are seen that are not much longer. */
static void check_length(const sums *all)
{
    for (int band = 0; band < 4; band++) {
        double shortest = INFINITY;
        uint32_t runs = 0;
        const int last = (band + 1) * PER_BAND - 1;
        for (int x = band * PER_BAND; x <= last; x++) {
            shortest = fmin(shortest, all->shortest_px[x]);
            runs += all->runs[x];
        }
        const double expected = HEIGHT / (2 * tan(15 * M_PI / 180)) * SPEED_M_S * SHUTTER_S / depth_of(last);
        printf("%u streaks\n", runs);
        check(runs > 20 && shortest > 0.9 * expected && shortest < 1.7 * expected, "pixels of the shortest streak in",
              band, shortest, expected);
    }
}

int main(int argc, char **argv)
{
    static sums all;
    const int frames = argc == 3 ? atoi(argv[2]) : 0;
    for (int x = 0; x < WIDTH; x++)
        all.shortest_px[x] = INFINITY;
    for (int frame = 1; frame <= frames; frame++)
        if (!add_frame(argv[1], frame, frames, &all))
            return 1;
    if (frames) {
        check_density(&all);
        check_veil(&all);
        check_length(&all);
    }
    return !frames || failures;
}
