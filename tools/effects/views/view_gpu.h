/* view_gpu.h - what all shaders of `virga view` read, for C and for GLSL: vec4s only, so both lay it out alike. */
#ifndef VIEW_GPU_H
#define VIEW_GPU_H

#ifdef VULKAN /* glslang defines it */
#define VIEW_VEC4  vec4
#define VIEW_UVEC4 uvec4
#define VIEW_IVEC4 ivec4
#else
#include <stdint.h>
typedef float view_vec4[4];
typedef uint32_t view_uvec4[4];
typedef int32_t view_ivec4[4];
#define VIEW_VEC4  view_vec4
#define VIEW_UVEC4 view_uvec4
#define VIEW_IVEC4 view_ivec4
#endif

/* Bindings. */
#define VIEW_AT_UNIFORMS 0
#define VIEW_AT_COLOR    1
#define VIEW_AT_NORMAL   2
#define VIEW_AT_VELOCITY 3
#define VIEW_AT_WATER    4
#define VIEW_AT_ID       5
#define VIEW_AT_DEPTH    6
#define VIEW_AT_LAYERS   7 /* to 14 */
#define VIEW_AT_ARRAY    15
#define VIEW_AT_IMAGE    16
#define VIEW_AT_BUFFERS  17 /* and 18 */
#define VIEW_BINDINGS    19

#define VIEW_LAYERS 8

struct view_gpu {
    VIEW_VEC4 area;       /* of the picture in the window, pixels: low corner, size */
    VIEW_VEC4 picture;    /* its own size, exposure as a factor, pixels a frame that show in full */
    VIEW_UVEC4 mode;      /* of the shader; item of the view; colors over the plate; png_curve */
    VIEW_VEC4 projection; /* P00, P11, P22, P32 */
    VIEW_VEC4 jitter;     /* P20, P21 */
    VIEW_VEC4 right;      /* axes of the camera in the world */
    VIEW_VEC4 up;
    VIEW_VEC4 back;
    VIEW_UVEC4 over[2]; /* layers of the colors, the lowest first */
};

#endif
