/* rain_live_fixture.h - rain over a floor, with points, whose settings a test changes in mid-run. */
#ifndef VIRGA_TESTS_RAIN_LIVE_FIXTURE_H
#define VIRGA_TESTS_RAIN_LIVE_FIXTURE_H

#include "rain_fixture.h"

#include <math.h>

static const double tick_s = 1.0 / 60;

static inline void open_live(rain_fixture *f)
{
    virga_rain_def def = virga_default_rain_def();
    def.max_drops = 16384;
    def.range_m = 8;
    def.occlusion_size = 256;
    def.points = true;
    rain_fixture_open(f);
    rain_fixture_floor(f);
    rain_fixture_rain(f, &def);
    f->settings.rate_mm_h = 20;
    f->settings.wind_m_s[0] = 2;
    f->settings.gust_m_s = 1;
    f->camera[1] = 1.7;
    assert_int_equal(virga_rain_set(f->rain, &f->settings), VIRGA_OK);
}

static inline void set(rain_fixture *f)
{
    assert_int_equal(virga_rain_set(f->rain, &f->settings), VIRGA_OK);
}

#endif
