/* glass_ball_fixture.h - drops at rest on a small pane, each a ball whose shape a test knows; film; and a background
 * picture whose colours encode positions. */
#ifndef VIRGA_TESTS_GLASS_BALL_FIXTURE_H
#define VIRGA_TESTS_GLASS_BALL_FIXTURE_H

#include "glass_picture_fixture.h"

#define BALLS 60
#define WATER 1.333

enum { WIDTH = 240, HEIGHT = 160 };

typedef struct ball {
    double middle[2], radius, height, sag[2];
} ball;

/* A drop at rest on an upright pane, so that it sags downwards. */
static inline ball ball_of(const shot *s, const virga_glass_drop_gpu *drop)
{
    const double angle = glass_seen_deg(&s->settings), flat = tan(angle * M_PI / 360);
    ball b = {.middle = {(double)drop->position[0], (double)drop->position[1]}};
    b.radius = cbrt(drop->water_nl * 1e-12 / glass_cap_volume(angle));
    b.height = b.radius * flat;
    b.sag[1] = -fmin(998.2 * 9.80665 * b.radius * b.radius / (8 * 0.0728 * flat), 0.6);
    return b;
}

static inline double random_in(uint32_t *state, double low, double high)
{
    *state = virga_hash1(*state);
    return low + (high - low) * (double)virga_unit(*state);
}

static inline void put_balls(shot *s, ball balls[BALLS], int count)
{
    uint32_t random = 5;
    shot_forget(s);
    for (int i = 0; i < count; i++)
        balls[i] = ball_of(s, shot_drop(s, random_in(&random, 0, 0.096), random_in(&random, 0, 0.064),
                                        shot_water(s, random_in(&random, 1e-3, 4e-3))));
}

static inline void open_small(shot *s)
{
    shot_open(s, NULL, WIDTH, HEIGHT, false);
    shot_face(s, 1, 30);
}

/* An even film of so many nanolitres per cell, which has not contracted into beads yet. */
static inline void put_film(shot *s, uint32_t nl)
{
    for (uint32_t i = 0; i < s->glass->columns * s->glass->rows; i++) {
        s->film[i] = nl;
        s->passed[i] = s->glass->last_tick;
    }
}

/* If the background's colours encode positions, they show which position a pixel reads: right and down, as fractions of
 * the picture. */
static inline void put_even_balls(shot *s)
{
    float *pixels = malloc(16ull * WIDTH * HEIGHT);
    for (int i = 0; i < WIDTH * HEIGHT; i++) {
        pixels[4 * i] = (float)((i % WIDTH + 0.5) / WIDTH);
        pixels[4 * i + 1] = (float)((i / WIDTH + 0.5) / HEIGHT);
        pixels[4 * i + 2] = pixels[4 * i + 3] = 1;
    }
    shot_plate(s, pixels);
    free(pixels);
}

static inline double sum_of_alpha(const float *pixels, int from_column, int to_column)
{
    double sum = 0;
    for (int i = 0; i < WIDTH * HEIGHT; i++)
        if (i % WIDTH >= from_column && i % WIDTH < to_column)
            sum += (double)pixels[4 * i + 3];
    return sum;
}

#endif
