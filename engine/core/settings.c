/* core/settings.c - see settings.h. */
#include "core/settings.h"

#include <inttypes.h>
#include <math.h>

/* FNV-1a. */
uint32_t virga_settings_cookie(const char *name)
{
    uint32_t hash = 2166136261u;
    for (; *name; name++)
        hash = (hash ^ (unsigned char)*name) * 16777619u;
    return hash;
}

virga_result virga_settings_check(const virga_log *log, const char *name, uint32_t size, uint32_t expected_size,
                                  uint32_t cookie)
{
    const uint32_t expected_cookie = virga_settings_cookie(name);
    if (cookie != expected_cookie) {
        virga_log_write(log, VIRGA_LOG_ERROR, VIRGA_LOG_COOKIE,
                        "%s: cookie is 0x%08" PRIx32 ", expected 0x%08" PRIx32 "; fill it with virga_default_%s", name,
                        cookie, expected_cookie, name);
        return VIRGA_ERROR_INVALID;
    }
    if (size != expected_size) {
        virga_log_write(log, VIRGA_LOG_ERROR, VIRGA_LOG_COOKIE,
                        "%s: size is %" PRIu32 ", expected %" PRIu32 "; header and library are of different versions",
                        name, size, expected_size);
        return VIRGA_ERROR_INVALID;
    }
    return VIRGA_OK;
}

double virga_clamp_setting(const virga_log *log, const char *name, double value, double lo, double hi, bool *changed)
{
    if (value >= lo && value <= hi) {
        return value;
    }
    double inside = value > hi ? hi : lo;
    virga_log_write(log, VIRGA_LOG_WARNING, VIRGA_LOG_CLAMPED, "%s: %g is outside [%g; %g], %g is used", name, value,
                    lo, hi, inside);
    if (changed != NULL) {
        *changed = true;
    }
    return inside;
}

uint32_t virga_clamp_setting_u32(const virga_log *log, const char *name, uint32_t value, uint32_t lo, uint32_t hi,
                                 bool *changed)
{
    if (value >= lo && value <= hi) {
        return value;
    }
    uint32_t inside = value > hi ? hi : lo;
    virga_log_write(log, VIRGA_LOG_WARNING, VIRGA_LOG_CLAMPED,
                    "%s: %" PRIu32 " is outside [%" PRIu32 "; %" PRIu32 "], %" PRIu32 " is used", name, value, lo, hi,
                    inside);
    if (changed != NULL) {
        *changed = true;
    }
    return inside;
}

static virga_result refuse_value(const virga_log *log, const char *name, uint32_t index, uint32_t count, double value)
{
    if (count == 1) {
        virga_log_write(log, VIRGA_LOG_ERROR, VIRGA_LOG_ARGUMENT, "%s: is %g, expected a finite number", name, value);
    } else {
        virga_log_write(log, VIRGA_LOG_ERROR, VIRGA_LOG_ARGUMENT, "%s[%" PRIu32 "]: is %g, expected a finite number",
                        name, index, value);
    }
    return VIRGA_ERROR_INVALID;
}

virga_result virga_settings_check_finite(const virga_log *log, const char *name, const float *values, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) {
        if (!isfinite(values[i])) {
            return refuse_value(log, name, i, count, (double)values[i]);
        }
    }
    return VIRGA_OK;
}

virga_result virga_settings_check_finite_double(const virga_log *log, const char *name, const double *values,
                                                uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) {
        if (!isfinite(values[i])) {
            return refuse_value(log, name, i, count, values[i]);
        }
    }
    return VIRGA_OK;
}

virga_result virga_settings_check_positions(const virga_log *log, const char *name, const double *values,
                                            uint32_t count)
{
    if (virga_settings_check_finite_double(log, name, values, count)) {
        return VIRGA_ERROR_INVALID;
    }
    for (uint32_t i = 0; i < count; i++) {
        if (fabs(values[i]) > VIRGA_MAX_COORDINATE_M) {
            virga_log_write(log, VIRGA_LOG_ERROR, VIRGA_LOG_ARGUMENT,
                            "%s[%" PRIu32 "]: is %g, expected no more than %g m from the world's origin", name, i,
                            values[i], VIRGA_MAX_COORDINATE_M);
            return VIRGA_ERROR_INVALID;
        }
    }
    return VIRGA_OK;
}

virga_result virga_settings_check_rotation(const virga_log *log, const char *name, const float *m, uint32_t stride)
{
    for (uint32_t i = 0; i < 3; i++) {
        for (uint32_t k = 0; k <= i; k++) {
            double product = 0;
            for (uint32_t axis = 0; axis < 3; axis++) {
                product += (double)m[stride * i + axis] * (double)m[stride * k + axis];
            }
            if (!(fabs(product - (i == k ? 1 : 0)) <= 0.04)) {
                virga_log_write(log, VIRGA_LOG_ERROR, VIRGA_LOG_ARGUMENT,
                                "%s: expected a rotation, columns of unit length at right angles", name);
                return VIRGA_ERROR_INVALID;
            }
        }
    }
    return VIRGA_OK;
}

void virga_clamp_vector(const virga_log *log, const char *name, float v[3], float max_magnitude, bool *changed)
{
    const float given[3] = {v[0], v[1], v[2]};
    bool moved = false;
    for (int axis = 0; axis < 3; axis++) {
        v[axis] = virga_clamp_setting_float(NULL, name, v[axis], -max_magnitude, max_magnitude, &moved);
    }
    if (!moved) {
        return;
    }
    virga_log_write(log, VIRGA_LOG_WARNING, VIRGA_LOG_CLAMPED,
                    "%s: (%g, %g, %g) is outside [%g; %g], (%g, %g, %g) is used", name, (double)given[0],
                    (double)given[1], (double)given[2], -(double)max_magnitude, (double)max_magnitude, (double)v[0],
                    (double)v[1], (double)v[2]);
    *changed = true;
}

/* ---- tables of settings */

void virga_settings_fill(const virga_setting_row *rows, size_t count, void *settings)
{
    for (size_t i = 0; i < count; i++) {
        void *value = (char *)settings + rows[i].member;
        switch (rows[i].number) {
        case VIRGA_NUMBER_FLOAT: *(float *)value = (float)rows[i].value; break;
        case VIRGA_NUMBER_DOUBLE: *(double *)value = rows[i].value; break;
        case VIRGA_NUMBER_BOOL: *(bool *)value = rows[i].value != 0; break;
        default: *(uint32_t *)value = (uint32_t)rows[i].value; break;
        }
    }
}

static virga_result check_enum(const virga_log *log, const virga_setting_row *row, uint32_t value)
{
    if (value >= row->min && value <= row->max)
        return VIRGA_OK;
    virga_log_write(log, VIRGA_LOG_ERROR, VIRGA_LOG_ARGUMENT, "%s: expected %g to %g, got %" PRId32, row->name,
                    row->min, row->max, (int32_t)value);
    return VIRGA_ERROR_INVALID;
}

static virga_result check_row(const virga_log *log, const virga_setting_row *row, const char *settings)
{
    const void *value = settings + row->member;
    switch (row->number) {
    case VIRGA_NUMBER_FLOAT: return virga_settings_check_finite(log, row->name, value, 1);
    case VIRGA_NUMBER_DOUBLE: return virga_settings_check_finite_double(log, row->name, value, 1);
    case VIRGA_NUMBER_ENUM: return check_enum(log, row, *(const uint32_t *)value);
    default: return VIRGA_OK;
    }
}

/* An earlier row's number, or `bound` if there is none. The bound is rounded to float: otherwise a value at it could be
 * out of range by rounding. */
static float bound_of(const char *settings, size_t member, double bound)
{
    return member ? *(const float *)(const void *)(settings + member) : (float)bound;
}

static void clamp_row(const virga_log *log, const virga_setting_row *row, char *settings, bool *changed)
{
    void *value = settings + row->member;
    if (row->number == VIRGA_NUMBER_FLOAT) {
        const float min = fmaxf((float)row->min, bound_of(settings, row->min_member, row->min));
        const float max = fminf((float)row->max, bound_of(settings, row->max_member, row->max));
        *(float *)value = virga_clamp_setting_float(log, row->name, *(float *)value, min, max, changed);
    } else if (row->number == VIRGA_NUMBER_DOUBLE) {
        *(double *)value = virga_clamp_setting(log, row->name, *(double *)value, row->min, row->max, changed);
    } else if (row->number == VIRGA_NUMBER_U32) {
        *(uint32_t *)value = virga_clamp_setting_u32(log, row->name, *(uint32_t *)value, (uint32_t)row->min,
                                                     (uint32_t)row->max, changed);
    }
}

virga_result virga_settings_apply_rows(const virga_log *log, const virga_setting_row *rows, size_t count,
                                       void *settings, bool *changed)
{
    for (size_t i = 0; i < count; i++)
        if (check_row(log, &rows[i], settings))
            return VIRGA_ERROR_INVALID;
    for (size_t i = 0; i < count; i++)
        clamp_row(log, &rows[i], settings, changed);
    return VIRGA_OK;
}
