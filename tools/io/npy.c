/* npy.c - the format of NumPy's arrays: a magic number, a Python dictionary as text, and the elements
 * (numpy.lib.format). */
#include "npy.h"

#include "file.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define MAX_FILE ((size_t)2 << 30) /* bytes */
#define MAX_SIDE 16384

typedef struct array {
    const char *path;
    const uint8_t *data; /* of the whole file, with a 0 behind it */
    size_t size, begin;  /* of the elements */
    char *header;        /* the dictionary */
    uint32_t element;    /* bytes */
    uint32_t sides[2];   /* height, width */
    char *error;
    size_t error_size;
} array;

static bool refuse(const array *a, const char *what)
{
    return file_fail(a->error, a->error_size, "cannot read %s: %s", a->path, what);
}

static bool find_header(array *a)
{
    const uint8_t *d = a->data;
    if (a->size < 12 || memcmp(d, "\x93NUMPY", 6))
        return refuse(a, "not an array of NumPy");
    const bool large = d[6] > 1;
    if (d[6] < 1 || d[6] > 3)
        return refuse(a, "expected version 1, 2 or 3 of the format");
    const size_t length =
        large ? d[8] | (size_t)d[9] << 8 | (size_t)d[10] << 16 | (size_t)d[11] << 24 : d[8] | (size_t)d[9] << 8;
    a->begin = large ? 12 : 10;
    if (length > 65536 || length > a->size - a->begin)
        return refuse(a, "the file is incomplete");
    a->header = strndup((const char *)d + a->begin, length);
    a->begin += length;
    return a->header || refuse(a, "no memory");
}

/* What follows a key of the dictionary, behind the colon; NULL if it is not there. */
static const char *value_of(const array *a, const char *key)
{
    const char *at = strstr(a->header, key);
    at = at ? strchr(at, ':') : NULL;
    return at ? at + 1 + strspn(at + 1, " ") : NULL;
}

static bool read_type(array *a)
{
    char what[96];
    const char *type = value_of(a, "'descr'"), *order = value_of(a, "'fortran_order'");
    if (!type || !order)
        return refuse(a, "the header is damaged");
    if (strncmp(type, "'<f4'", 5) && strncmp(type, "'<f8'", 5)) {
        snprintf(what, sizeof what, "expected float32 or float64, got %.*s", (int)(strcspn(type + 1, "',") + 2), type);
        return refuse(a, what);
    }
    if (strncmp(order, "False", 5))
        return refuse(a, "expected C order, got Fortran's; save numpy.ascontiguousarray(a)");
    a->element = (uint32_t)(type[3] - '0');
    return true;
}

static bool read_shape(array *a)
{
    char what[96];
    const char *shape = value_of(a, "'shape'"), *at = shape ? shape + 1 : "";
    uint32_t found = 0;
    bool right = shape && shape[0] == '(';
    while (right && *at >= '0' && *at <= '9') {
        char *end;
        const unsigned long side = strtoul(at, &end, 10);
        if (side != 1 || (found == 0 && end[0] == ')')) {
            right = found < 2 && side >= 1 && side <= MAX_SIDE;
            if (right)
                a->sides[found++] = (uint32_t)side;
        }
        at = end + strspn(end, ", ");
    }
    if (right && *at == ')' && found == 2)
        return true;
    if (!shape)
        return refuse(a, "the header is damaged");
    snprintf(what, sizeof what, "expected two dimensions of at most %d, got %.*s", MAX_SIDE,
             (int)(strcspn(shape, ")") < 40 ? strcspn(shape, ")") + 1 : 40), shape);
    return refuse(a, what);
}

static bool read_elements(const array *a, float **values)
{
    const size_t count = (size_t)a->sides[0] * a->sides[1];
    if (a->size - a->begin < count * a->element)
        return refuse(a, "the file is incomplete");
    *values = malloc(count * sizeof **values);
    for (size_t i = 0; *values && i < count; i++) {
        double wide = 0;
        if (a->element == 4) {
            memcpy(*values + i, a->data + a->begin + i * 4, 4);
        } else {
            memcpy(&wide, a->data + a->begin + i * 8, 8);
            (*values)[i] = (float)wide;
        }
    }
    return *values || refuse(a, "no memory");
}

bool npy_read(const char *path, uint32_t *width, uint32_t *height, float **values, char *error, size_t error_size)
{
    array a = {.path = path, .error = error, .error_size = error_size};
    void *data;
    *values = NULL;
    if (!file_read(path, MAX_FILE, &data, &a.size, error, error_size))
        return false;
    a.data = data;
    const bool read = find_header(&a) && read_type(&a) && read_shape(&a) && read_elements(&a, values);
    *height = a.sides[0];
    *width = a.sides[1];
    free(a.header);
    free(data);
    return read;
}
