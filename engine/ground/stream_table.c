/* ground/stream_table.c - see stream_table.h. */
#include "ground/stream_table.h"

#include <virga/shared/random.h>

#include <math.h>
#include <string.h>

#define TAU       6.28318530717958647692
#define LOW_WAVES 7.0
#define TOP_WAVES 9.5
#define MOST      10 /* whole numbers are below this */
#define MAX_WAVES 256

typedef struct stream_mode {
    int m, n;
    float cosine[2], sine[2]; /* of the phases in A and in B */
} stream_mode;

/* One of each pair of opposite waves. */
static int find_modes(stream_mode modes[MAX_WAVES])
{
    int count = 0;
    for (int m = 0; m < MOST; m++)
        for (int n = m ? -MOST : 1; n < MOST; n++) {
            const double waves = hypot(m, n);
            if (waves < LOW_WAVES || waves > TOP_WAVES)
                continue;
            stream_mode *mode = &modes[count++];
            *mode = (stream_mode){.m = m, .n = n};
            for (uint32_t i = 0; i < 2; i++) {
                const double phase = TAU * (double)virga_unit(virga_hash4(0x77617665u, (uint32_t)m, (uint32_t)n, i));
                mode->cosine[i] = (float)cos(phase);
                mode->sine[i] = (float)sin(phase);
            }
        }
    return count;
}

/* Four standard deviations are below the largest: what is beyond is cut. */
static uint8_t to_byte(float slope)
{
    const double share = fmin(fmax((double)slope / VIRGA_STREAM_TILE_SLOPE, -1), 1);
    return (uint8_t)(128 + (int)floor(127 * share + 0.5));
}

/* Of the modes of one m and one surface, in a row of the picture: the sums of exp(i (2 pi n y + phase)), and of n times
 * that. */
typedef struct row_sums {
    float real, imaginary, real_n, imaginary_n;
} row_sums;

/* Phases within the picture are whole parts of a turn, of which there are as many as texels. */
static void sum_row(const stream_mode *modes, int count, const float *cosines, const float *sines, int y,
                    row_sums sums[MOST][2])
{
    memset(sums, 0, MOST * sizeof *sums);
    for (int i = 0; i < count; i++) {
        const stream_mode *mode = &modes[i];
        const int turn = (mode->n * y) & (VIRGA_STREAM_TILE - 1);
        for (int surface = 0; surface < 2; surface++) {
            const float c = cosines[turn] * mode->cosine[surface] - sines[turn] * mode->sine[surface];
            const float s = sines[turn] * mode->cosine[surface] + cosines[turn] * mode->sine[surface];
            row_sums *sum = &sums[mode->m][surface];
            sum->real += c;
            sum->imaginary += s;
            sum->real_n += (float)mode->n * c;
            sum->imaginary_n += (float)mode->n * s;
        }
    }
}

/* The slope of cos(2 pi (m x + n y) + phase) is -2 pi (m, n) times its sine, the imaginary part of
 * exp(i 2 pi m x) exp(i (2 pi n y + phase)). */
void stream_table_fill(uint8_t texels[VIRGA_STREAM_TILE][VIRGA_STREAM_TILE][4])
{
    stream_mode modes[MAX_WAVES];
    row_sums sums[MOST][2];
    float cosines[VIRGA_STREAM_TILE], sines[VIRGA_STREAM_TILE];
    const int count = find_modes(modes);
    const float amplitude = (float)sqrt(2.0 / count);
    for (int i = 0; i < VIRGA_STREAM_TILE; i++) {
        cosines[i] = (float)cos(TAU * i / VIRGA_STREAM_TILE);
        sines[i] = (float)sin(TAU * i / VIRGA_STREAM_TILE);
    }
    for (int y = 0; y < VIRGA_STREAM_TILE; y++) {
        sum_row(modes, count, cosines, sines, y, sums);
        for (int x = 0; x < VIRGA_STREAM_TILE; x++) {
            float slopes[4] = {0};
            for (int m = 0; m < MOST; m++) {
                const int turn = (m * x) & (VIRGA_STREAM_TILE - 1);
                for (int surface = 0; surface < 2; surface++) {
                    const row_sums *sum = &sums[m][surface];
                    slopes[2 * surface] -= (float)m * (sines[turn] * sum->real + cosines[turn] * sum->imaginary);
                    slopes[2 * surface + 1] -= sines[turn] * sum->real_n + cosines[turn] * sum->imaginary_n;
                }
            }
            for (int i = 0; i < 4; i++)
                texels[y][x][i] = to_byte((float)TAU * amplitude * slopes[i]);
        }
    }
}
