/* color_space_table.h - what the module of OpenColorIO gives to color_space.c. */
#ifndef VIRGA_IO_COLOR_SPACE_TABLE_H
#define VIRGA_IO_COLOR_SPACE_TABLE_H

#include "color_space.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct color_space_table {
    color_space *(*open)(const char *config, const char *name, char *reason, size_t reason_size); /* NULL: reason */
    void (*close)(color_space *space);
    void (*apply)(const color_space *space, bool to_light, float *values, size_t pixels, uint32_t channels);
} color_space_table;

#define COLOR_SPACE_TABLE virga_color_space
extern const color_space_table COLOR_SPACE_TABLE;

#ifdef __cplusplus
}
#endif
#endif
