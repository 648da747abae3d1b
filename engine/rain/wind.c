/* rain/wind.c - the uniform wind: a mean plus gusts, which are smooth noise in time. */
#include "rain/rain_internal.h"

#include <virga/shared/random.h>

#include <math.h>

#define WIND_STREAM 0x77696e64u /* stream of random numbers */
/* Of a gust, relative to the horizontal components: smaller, as the ground limits vertical motion. */
#define VERTICAL_SHARE 0.4

/* An approximately normal random number for a knot of the noise: the sum of twelve uniform numbers minus six (Irwin and
 * Hall). It has the same bits on every machine. */
static double knot(uint32_t seed, uint32_t axis, int64_t index)
{
    double sum = -6;
    for (uint32_t i = 0; i < 12; i++)
        sum += (double)virga_unit(
            virga_hash4(seed ^ WIND_STREAM, axis * 12 + i, (uint32_t)(index >> 32), (uint32_t)index));
    return sum;
}

/* Noise of variance 1 at any time: a cubic B-spline through random knots, divided by the root of the sum of its squared
 * weights. This root is the standard deviation of the blend of independent knots. */
static double noise(uint32_t seed, uint32_t axis, double phase)
{
    const double base = floor(phase), t = phase - base;
    const double weights[4] = {(1 - t) * (1 - t) * (1 - t) / 6, (3 * t * t * t - 6 * t * t + 4) / 6,
                               (-3 * t * t * t + 3 * t * t + 3 * t + 1) / 6, t * t * t / 6};
    double sum = 0, squares = 0;
    for (int i = 0; i < 4; i++) {
        sum += weights[i] * knot(seed, axis, (int64_t)base + i - 1);
        squares += weights[i] * weights[i];
    }
    return sum / sqrt(squares);
}

void rain_wind_tick(rain_wind *wind, double tick_s, double gust_time_s)
{
    wind->phase += tick_s / gust_time_s;
}

void rain_wind_at(const rain_wind *wind, const virga_rain_settings *settings, uint32_t seed, double velocity[3])
{
    for (uint32_t axis = 0; axis < 3; axis++) {
        const double gust = settings->gust_m_s > 0 ? (double)settings->gust_m_s * noise(seed, axis, wind->phase) : 0;
        velocity[axis] = (double)settings->wind_m_s[axis] + (axis == 1 ? VERTICAL_SHARE * gust : gust);
    }
}
