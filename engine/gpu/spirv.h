/* gpu/spirv.h - a shader that is compiled into the library. Internal. */
#ifndef VIRGA_GPU_SPIRV_H
#define VIRGA_GPU_SPIRV_H

#include <stddef.h>
#include <stdint.h>

typedef struct virga_spirv {
    const uint32_t *code;
    size_t size; /* bytes */
} virga_spirv;

/* The one that the build makes of shaders/<effect>/<pass>, see shaders/<effect>_shaders.h. */
#define VIRGA_SPIRV(name) (&name##_shader)

#endif
