/* core/settings.h - checks that every settings struct goes through. Internal.
 *
 * A settings struct starts with `uint32_t size, cookie`, which its default function sets. They catch a struct that
 * was never filled, one that was filled for something else, and one from a header of another version. */
#ifndef VIRGA_CORE_SETTINGS_H
#define VIRGA_CORE_SETTINGS_H

#include "core/log.h"

#include <stddef.h>

/* How far from the world's origin a place may lie on each axis (m): floats relative to a camera out there are finite,
 * and so are their squares and cubes. */
#define VIRGA_MAX_COORDINATE_M 1e9

/* What a host may say of the motion of panes and air, on each axis: m/s, m/s^2, rad/s. Faster is a mistake, e.g. a
 * speed taken from a cut, and its squares would leave the range of floats in what is made of them. */
#define VIRGA_MAX_SPEED_M_S           1000.0f
#define VIRGA_MAX_ACCELERATION_M_S2   1000.0f
#define VIRGA_MAX_ANGULAR_SPEED_RAD_S 100.0f

/* The cookie of the settings struct with this tag (any number, another for each struct; a constant expression).
 * An odd factor keeps different tags apart, and no small tag gives 0 or all ones, as forgotten memory would. */
#define VIRGA_COOKIE(tag) (((uint32_t)(tag)*0x9e3779b1u) ^ 0x76697267u)

/* VIRGA_OK, or VIRGA_ERROR_INVALID with one line that names the struct. `name` is the type's without its prefix, e.g.
 * "rain_def", as the line points to "virga_default_rain_def". */
virga_result virga_settings_check(const virga_log *log, const char *name, uint32_t size, uint32_t expected_size,
                                  uint32_t cookie, uint32_t expected_cookie);

/* The value moved into [lo; hi]. If it had to move, sets *changed (may be NULL; never cleared) and says so.
 * `name` is as a host would write it, e.g. "rain.rate_mm_h". A NaN becomes `lo`: check with virga_settings_check_finite
 * first. */
double virga_clamp_setting(const virga_log *log, const char *name, double value, double lo, double hi, bool *changed);

/* The same for a count. */
uint32_t virga_clamp_setting_u32(const virga_log *log, const char *name, uint32_t value, uint32_t lo, uint32_t hi,
                                 bool *changed);

/* The same for a float. The ends should be floats too, or the result may lie half a step outside. */
static inline float virga_clamp_setting_float(const virga_log *log, const char *name, float value, float lo, float hi,
                                              bool *changed)
{
    return (float)virga_clamp_setting(log, name, (double)value, (double)lo, (double)hi, changed);
}

/* VIRGA_OK if all values are finite; else VIRGA_ERROR_INVALID with one line that names the first that is not. */
virga_result virga_settings_check_finite(const virga_log *log, const char *name, const float *values, uint32_t count);
virga_result virga_settings_check_finite_double(const virga_log *log, const char *name, const double *values,
                                                uint32_t count);

/* The same for places in the world: finite, and within VIRGA_MAX_COORDINATE_M of its origin. */
virga_result virga_settings_check_positions(const virga_log *log, const char *name, const double *values,
                                            uint32_t count);

/* A number of a settings struct, and the range that it is moved into. */
typedef enum virga_number { VIRGA_NUMBER_FLOAT, VIRGA_NUMBER_DOUBLE, VIRGA_NUMBER_U32 } virga_number;

typedef struct virga_setting_row {
    const char *name; /* as a host would write it */
    virga_number number;
    size_t member; /* offset in the struct */
    double min, max;
    size_t max_member; /* (floats) offset of a number of a row before it, which bounds this one too; 0: none */
} virga_setting_row;

/* VIRGA_ERROR_INVALID where one is not finite; else all are moved into their ranges, see virga_clamp_setting. */
virga_result virga_settings_apply_rows(const virga_log *log, const virga_setting_row *rows, size_t count,
                                       void *settings, bool *changed);

/* VIRGA_OK if the columns of a 3 x 3 matrix, `stride` apart, are finite and a rotation or a mirrored one: of unit
 * length and at right angles to 2 %, which is what is left of a rotation after many products of floats. */
virga_result virga_settings_check_rotation(const virga_log *log, const char *name, const float *m, uint32_t stride);

/* The axes of a vector moved into [-most; most], with one line where any had to. It must be finite. */
void virga_clamp_vector(const virga_log *log, const char *name, float v[3], float max_magnitude, bool *changed);

#endif
