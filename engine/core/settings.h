/* core/settings.h - the checks of all settings structs. Internal.
 *
 * A settings struct starts with `uint32_t size, cookie`, which its default function sets. They detect a struct that was
 * never filled, one that was filled for another type, and one from a header of another version. */
#ifndef VIRGA_CORE_SETTINGS_H
#define VIRGA_CORE_SETTINGS_H

#include "core/log.h"

#include <stddef.h>

/* Largest distance of a position from the world's origin on each axis (m). At this distance, floats relative to the
 * camera are finite, and so are their squares and cubes. */
#define VIRGA_MAX_COORDINATE_M 1e9

/* Largest motion of panes and air on each axis: m/s, m/s^2, rad/s. Larger values are errors of the host, e.g. a speed
 * computed across a camera cut. Their squares would exceed the range of floats in later computations. */
#define VIRGA_MAX_SPEED_M_S           1000.0f
#define VIRGA_MAX_ACCELERATION_M_S2   1000.0f
#define VIRGA_MAX_ANGULAR_SPEED_RAD_S 100.0f

/* The cookie of a settings struct: a hash of the name of the type without its prefix, e.g. "rain_def". */
uint32_t virga_settings_cookie(const char *name);

/* VIRGA_OK, or VIRGA_ERROR_INVALID with one log line that names the struct. It mentions "virga_default_<name>". */
virga_result virga_settings_check(const virga_log *log, const char *name, uint32_t size, uint32_t expected_size,
                                  uint32_t cookie);

/* Clamps a value to [lo; hi]. If it changed, sets *changed (may be NULL; never cleared) and logs it. `name` is the
 * host's name of the setting, e.g. "rain.rate_mm_h". NaN becomes `lo`: check with virga_settings_check_finite first. */
double virga_clamp_setting(const virga_log *log, const char *name, double value, double lo, double hi, bool *changed);

/* The same for a count. */
uint32_t virga_clamp_setting_u32(const virga_log *log, const char *name, uint32_t value, uint32_t lo, uint32_t hi,
                                 bool *changed);

/* The same for a float. `lo` and `hi` should be exact floats too. Otherwise rounding may move the result out of the
 * range. */
static inline float virga_clamp_setting_float(const virga_log *log, const char *name, float value, float lo, float hi,
                                              bool *changed)
{
    return (float)virga_clamp_setting(log, name, (double)value, (double)lo, (double)hi, changed);
}

/* VIRGA_OK if all values are finite. Otherwise VIRGA_ERROR_INVALID, with one log line that names the first value that
 * is not. */
virga_result virga_settings_check_finite(const virga_log *log, const char *name, const float *values, uint32_t count);
virga_result virga_settings_check_finite_double(const virga_log *log, const char *name, const double *values,
                                                uint32_t count);

/* The same for positions in the world: finite, and within VIRGA_MAX_COORDINATE_M of its origin. */
virga_result virga_settings_check_positions(const virga_log *log, const char *name, const double *values,
                                            uint32_t count);

/* The type of a setting. An enum outside its range is an error; the other types are clamped. */
typedef enum virga_number {
    VIRGA_NUMBER_FLOAT,
    VIRGA_NUMBER_DOUBLE,
    VIRGA_NUMBER_U32,
    VIRGA_NUMBER_ENUM,
    VIRGA_NUMBER_BOOL,
} virga_number;

/* A setting: its type, range and default. */
typedef struct virga_setting_row {
    const char *name; /* the host's name of the setting */
    virga_number number;
    size_t member; /* offset in the struct */
    double min, max, value;
    /* (floats) Offsets of earlier rows' numbers, which bound this one too; 0: none. */
    size_t max_member, min_member;
    bool look; /* changes pictures only, not what is simulated */
} virga_setting_row;

/* The row of a member of `type`, named "prefix.member". The arguments after `member`: minimum, maximum, default (0 if
 * left out), and the other members of the row. */
/* clang-format off */
#define VIRGA_SETTING_ROW(prefix, type, kind, member, ...) \
    {#prefix "." #member, VIRGA_NUMBER_##kind, offsetof(type, member), __VA_ARGS__}
/* clang-format on */

/* Sets all rows to their defaults. */
void virga_settings_fill(const virga_setting_row *rows, size_t count, void *settings);

/* VIRGA_ERROR_INVALID if a number is not finite or an enum not in its range. Otherwise all numbers are clamped, see
 * virga_clamp_setting. */
virga_result virga_settings_apply_rows(const virga_log *log, const virga_setting_row *rows, size_t count,
                                       void *settings, bool *changed);

/* VIRGA_OK if the columns of a 3 x 3 matrix, `stride` apart, are finite and form a rotation, which may be mirrored.
 * They must have unit length and be orthogonal to 2 %: rounding may add up to that in a product of many float
 * matrices. */
virga_result virga_settings_check_rotation(const virga_log *log, const char *name, const float *m, uint32_t stride);

/* Clamps each axis of a vector to [-max_magnitude; max_magnitude], with one log line if any changed. The vector must be
 * finite. */
void virga_clamp_vector(const virga_log *log, const char *name, float v[3], float max_magnitude, bool *changed);

#endif
