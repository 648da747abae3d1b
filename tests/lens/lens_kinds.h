/* lens_kinds.h - a picture with tiles of all kinds: in focus, only behind it, in front of it; and layers over it. */
#ifndef VIRGA_TESTS_LENS_KINDS_H
#define VIRGA_TESTS_LENS_KINDS_H

#include "lens_fixture.h"

#define LENS_KINDS_WIDTH  224
#define LENS_KINDS_HEIGHT 96

/* Values that half floats have, so that both ways begin with the same color. */
static inline float lens_gray(uint32_t *hash)
{
    return (float)(floor(lens_random(hash) * 64) + 1) / 64;
}

/* Noise and lamps: in focus on the left, then 8 px behind it, then up to 7 px in front of it, in small steps from there
 * to the focus at the bottom. */
static inline void lens_paint_kinds(const lens_picture *scene)
{
    uint32_t hash = 11;
    for (uint32_t y = 0; y < LENS_KINDS_HEIGHT; y++)
        for (uint32_t x = 0; x < LENS_KINDS_WIDTH; x++) {
            const double near = 1 / (1 + 0.7 * (1 - (double)y / LENS_KINDS_HEIGHT));
            lens_paint(scene, x, y, lens_random(&hash) < 0.01 ? 20 : lens_gray(&hash),
                       x < 100   ? 1
                       : x < 150 ? 5
                                 : near);
        }
}

static inline void lens_paint_layers(lens_fixture *f, uint32_t count)
{
    uint32_t hash = 5;
    for (uint32_t i = 0; i < count; i++) {
        const lens_picture *layer = lens_fixture_layer(f, i == 1 ? 0 : 0.9f);
        for (uint32_t k = 0; k < LENS_KINDS_WIDTH * LENS_KINDS_HEIGHT; k++) {
            const float share = lens_random(&hash) < 0.1 ? 0.75f : 0;
            for (int c = 0; c < 4; c++)
                layer->color[4 * k + (uint32_t)c] = share * (c == 3 ? 1 : 0.5f);
            layer->depth[k] = (float)(0.5 + lens_random(&hash));
        }
    }
}

typedef struct lens_kind {
    uint32_t layers;
    float cats_eye, aperture_scale;
    bool flat;
} lens_kind;

static inline void lens_set_up(lens_fixture *f, const lens_kind *kind)
{
    lens_paint_kinds(&f->scene);
    lens_paint_layers(f, kind->layers);
    f->settings.cats_eye = kind->cats_eye;
    f->settings.blades = kind->cats_eye > 0 ? 6 : 0;
    f->settings.aperture_f /= kind->aperture_scale;
    f->flat = kind->flat;
}

#endif
