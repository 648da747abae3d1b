/* view_gpu.h - what the shaders of `virga view` are told, read by C and by GLSL: vec4s only, so both
 * lay it out alike. */
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

/* What is shown; modes.c names them. */
#define VIEW_PICTURE     0
#define VIEW_PLATE       1
#define VIEW_RAIN        2
#define VIEW_SPLASH      3
#define VIEW_GLASS       4
#define VIEW_REFRACTION  5
#define VIEW_DEPTH       6
#define VIEW_NORMAL      7
#define VIEW_VELOCITY    8
#define VIEW_ID          9
#define VIEW_WETNESS     10
#define VIEW_WATER_DEPTH 11
#define VIEW_CELL_STATE  12
#define VIEW_MATERIAL    13
#define VIEW_OCCLUSION   14
#define VIEW_PANE        15
#define VIEW_PANE_HEIGHT 16
#define VIEW_MODES       17

#define VIEW_PALETTE 32
#define VIEW_BLADES  8

struct view_gpu {
    VIEW_VEC4 area;       /* of the picture in the window, pixels: low corner, size */
    VIEW_VEC4 picture;    /* its own size, exposure as a factor, far plane or range of what is shown */
    VIEW_UVEC4 mode;      /* VIEW_..., layer, whether layers are there: 1 splash, 2 glass, 4 ground, 8 maps, 16
                          * heights */
    VIEW_VEC4 projection; /* P00, P11, P22, P32 */
    VIEW_VEC4 jitter;     /* P20, P21; height of the camera above the base of the ground's floors */
    VIEW_VEC4 right;      /* axes of the camera in the world */
    VIEW_VEC4 up;
    VIEW_VEC4 back;
    VIEW_VEC4 ground;       /* low corner of the window of cells relative to the camera (x, z), 1 / side of a cell,
                          * cells */
    VIEW_IVEC4 cells;       /* first tile of the window (x, z), tiles, nl of a micrometre on a cell */
    VIEW_UVEC4 capacity[8]; /* nl that pores hold, by material */
    VIEW_VEC4 palette[VIEW_PALETTE]; /* by state or material */
    VIEW_VEC4 pane;                  /* width, height (m), side of a cell (m), width of the particles' band (m) */
    VIEW_UVEC4 pane_cells;           /* columns, rows, blades; places for drops */
    VIEW_VEC4 pane_drop;             /* water (nl) of a drop with a base of 1 m radius, radius of a particle (m) */
    VIEW_VEC4 blades[VIEW_BLADES];   /* both ends, metres on the pane */
    VIEW_VEC4 heights;    /* of occlusion maps: top, from there to the bottom; lowest that is told apart (m) */
    VIEW_VEC4 height_map; /* columns and rows in use, threshold */
};

#endif
