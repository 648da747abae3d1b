/* glass_even_fixture.h - even glass on which drops leave nothing behind, and the amount of water in a drop. */
#ifndef VIRGA_TESTS_GLASS_EVEN_FIXTURE_H
#define VIRGA_TESTS_GLASS_EVEN_FIXTURE_H

#include "glass_fixture.h"

#include <math.h>

#define NL_OF_M3 1e12

static glass_fixture f;

/* Water (nl) of a drop whose base has that radius. */
static inline uint32_t water_of(double radius_m)
{
    return (uint32_t)(glass_cap_volume(glass_rest_deg(&f.settings)) * radius_m * radius_m * radius_m * NL_OF_M3);
}

/* Even glass on which drops leave nothing behind. */
static inline void open_even(const virga_glass_def *def)
{
    glass_fixture_open(&f, def);
    f.settings.affinity = 0;
    f.settings.tail_max_radius_mm = 0;
    f.settings.film_um = 0;
    f.settings.evaporation_mm_h = 0;
    f.settings.mist_max_mm = 0;
}

#endif
