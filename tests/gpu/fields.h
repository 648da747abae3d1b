/* fields.h - tests all fields of an API struct from a table with one line per field. Each field is set to valid and
 * invalid values. The expected result and the expected number of log lines follow from the table. */
#ifndef VIRGA_TESTS_FIELDS_H
#define VIRGA_TESTS_FIELDS_H

#include <float.h>
#include <math.h>

#include "gpu_fixture.h"

typedef enum field_kind { FIELD_FLOAT, FIELD_DOUBLE, FIELD_UINT } field_kind;

typedef enum field_rule {
    CLAMPED,       /* outside [low; high]: clamped, one log line, VIRGA_DEGRADED (in a definition: VIRGA_OK) */
    CLAMPED_BUT_0, /* the same, but 0 is valid and selects a default */
    REFUSED,       /* outside [low; high]: VIRGA_ERROR_INVALID, one log line */
    EMPTY,         /* below low: VIRGA_NOT_READY, one log line; above high: as REFUSED */
} field_rule;

typedef struct field {
    const char *name;
    size_t offset;
    field_kind kind;
    uint32_t count; /* elements of an array; the first and the last are tested */
    field_rule rule;
    double low, high;
} field;

#define FIELD_MEMBER(type, member) (((type *)0)->member)
#define FIELD_KIND(x) \
    _Generic((x),               \
        float: FIELD_FLOAT,     \
        float *: FIELD_FLOAT,   \
        double: FIELD_DOUBLE,   \
        double *: FIELD_DOUBLE, \
        default: FIELD_UINT)
#define FIELD_BYTES(x) (FIELD_KIND(x) == FIELD_DOUBLE ? sizeof(double) : sizeof(float))

/* A line of a table. */
#define FIELD(type, member, rule, low, high)                                                                         \
    {                                                                                                                \
#member, offsetof(type, member), FIELD_KIND(FIELD_MEMBER(type, member)),                                     \
            (uint32_t)(sizeof FIELD_MEMBER(type, member) / FIELD_BYTES(FIELD_MEMBER(type, member))), rule, low, high \
    }

enum { FIELD_MAX_BYTES = 131072 };

/* A struct, and a call that reads it. */
typedef struct field_table {
    const char *name;
    const void *good; /* valid values that cause no log line; fields are changed one at a time */
    size_t size;
    const field *fields;
    uint32_t count;
    virga_result (*call)(void *user, const void *changed);
    void (*read)(void *user, void *in_force); /* NULL if the values in effect cannot be read */
    void *user;
} field_table;

static inline double field_get(const field *f, const void *object, uint32_t index)
{
    const char *at = (const char *)object + f->offset;
    return f->kind == FIELD_FLOAT    ? (double)((const float *)at)[index]
           : f->kind == FIELD_DOUBLE ? ((const double *)at)[index]
                                     : (double)((const uint32_t *)at)[index];
}

static inline void field_put(const field *f, void *object, uint32_t index, double value)
{
    char *at = (char *)object + f->offset;
    if (f->kind == FIELD_FLOAT)
        ((float *)at)[index] = (float)value;
    else if (f->kind == FIELD_DOUBLE)
        ((double *)at)[index] = value;
    else
        ((uint32_t *)at)[index] = (uint32_t)value;
}

/* A bound of a range, rounded to the field's type. */
static inline double field_end(const field *f, double end)
{
    volatile float rounded = (float)end; /* volatile: otherwise the compiler compares with the unrounded value */
    return f->kind == FIELD_FLOAT ? (double)rounded : end;
}

/* The next larger or smaller number that the field's type can hold. */
static inline double field_beside(const field *f, double value, double towards)
{
    return f->kind == FIELD_FLOAT    ? (double)nextafterf((float)value, (float)towards)
           : f->kind == FIELD_DOUBLE ? nextafter(value, towards)
                                     : value + (towards > value ? 1 : -1);
}

/* The values that a field is tested with. */
static inline uint32_t field_values(const field *f, double values[16])
{
    const double max = f->kind == FIELD_FLOAT ? (double)FLT_MAX : DBL_MAX;
    const double low = field_end(f, f->low);
    const double high = field_end(f, f->high);
    const double floats[] = {low,
                             high,
                             field_beside(f, low, -max),
                             field_beside(f, high, max),
                             (double)NAN,
                             (double)INFINITY,
                             -(double)INFINITY,
                             -1,
                             0,
                             max,
                             -max,
                             f->kind == FIELD_FLOAT ? 1e-42 : 1e-310,
                             1e30};
    const double uints[] = {low,         high,      low > 0 ? low - 1 : 0, fmin(high + 1, UINT32_MAX), 0, 1, 0x7fffffff,
                            0x80000000u, UINT32_MAX};
    const uint32_t count = f->kind == FIELD_UINT ? 9 : 13;
    memcpy(values, f->kind == FIELD_UINT ? uints : floats, count * sizeof *values);
    return count;
}

static inline virga_result field_expected(const field *f, double value, uint32_t *lines)
{
    const double low = field_end(f, f->low);
    const double high = field_end(f, f->high);
    *lines = 1;
    if (!isfinite(value))
        return VIRGA_ERROR_INVALID;
    if ((value >= low && value <= high) || (f->rule == CLAMPED_BUT_0 && value == 0)) {
        *lines = 0;
        return VIRGA_OK;
    }
    if (f->rule == EMPTY)
        return value < low ? VIRGA_NOT_READY : VIRGA_ERROR_INVALID;
    return f->rule == REFUSED ? VIRGA_ERROR_INVALID : VIRGA_DEGRADED;
}

/* Log lines, without those about created objects and about positions where no drops are drawn. */
static inline uint32_t field_lines(const gpu_fixture *f)
{
    uint32_t lines = 0;
    for (int i = 0; i < LOG_IDS; i++)
        lines += i == VIRGA_LOG_CREATED || i == VIRGA_LOG_NOT_DRAWN ? 0 : f->lines[i];
    return lines;
}

static inline void field_try(gpu_fixture *fixture, const field_table *table, const field *f, uint32_t index,
                             double value)
{
    static _Alignas(16) char changed[FIELD_MAX_BYTES], in_force[FIELD_MAX_BYTES];
    uint32_t expected_lines;
    REQUIRE(table->size <= sizeof changed);
    memcpy(changed, table->good, table->size);
    field_put(f, changed, index, value);
    const virga_result expected = field_expected(f, value, &expected_lines);
    gpu_forget_log(fixture);
    const virga_result result = table->call(table->user, changed);
    const uint32_t lines = field_lines(fixture);
    if (result != expected || lines != expected_lines)
        fail_msg("%s.%s[%u] = %.9g: %s with %u lines, expected %s with %u; the last: %s", table->name, f->name, index,
                 value, virga_result_name(result), lines, virga_result_name(expected), expected_lines, fixture->last);
    if (!table->read)
        return;
    table->read(table->user, in_force);
    const double now = field_get(f, in_force, index);
    if (!(now >= field_end(f, f->low) && now <= field_end(f, f->high)))
        fail_msg("%s.%s[%u] = %g: %g is in force", table->name, f->name, index, value, now);
}

/* Tests every field of a table with every value, and the valid struct in between. */
static inline void fields_try(gpu_fixture *fixture, const field_table *table)
{
    for (uint32_t i = 0; i < table->count; i++) {
        const field *f = &table->fields[i];
        double values[16];
        const uint32_t count = field_values(f, values);
        for (uint32_t k = 0; k < count; k++) {
            field_try(fixture, table, f, 0, values[k]);
            if (f->count > 1)
                field_try(fixture, table, f, f->count - 1, values[k]);
        }
    }
    gpu_forget_log(fixture);
    const virga_result result = table->call(table->user, table->good);
    if (result || field_lines(fixture))
        fail_msg("%s as it should be: %s; %s", table->name, virga_result_name(result), fixture->last);
}

#endif
