/* mesh_map.h - what a draw into a mesh map is told. Internal to Virga. */
#ifndef VIRGA_SHARED_MESH_MAP_H
#define VIRGA_SHARED_MESH_MAP_H

#include "types.h"

#ifndef VIRGA_GLSL
#define uint virga_uint
typedef struct virga_map_push virga_map_push;
#endif

/* Push constants of one mesh in one map, 96 bytes. */
struct virga_map_push {
    float rel_from_mesh[12]; /* 3 x 4, relative to the map's origin */
    float center[2];
    float inv_half_m;
    float inv_height;
    float slant[2];
    float top_m;
    float cover;
    uint material;
    uint texels;
    uint pad[2];
};

#ifndef VIRGA_GLSL
VIRGA_ASSERT_SIZE(virga_map_push, 96);
#undef uint
#endif

#endif
