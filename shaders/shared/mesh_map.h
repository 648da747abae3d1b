/* mesh_map.h - push constants of a draw into a mesh map. Internal to Virga. */
#ifndef VIRGA_SHARED_MESH_MAP_H
#define VIRGA_SHARED_MESH_MAP_H

#include "types.h"

#ifndef VIRGA_GLSL
#define uint virga_uint
typedef struct virga_map_push virga_map_push;
#endif

/* Push constants of one mesh in one map, 96 bytes. Lengths are in metres. The map is an orthographic view along the
 * direction of the slant. */
struct virga_map_push {
    float rel_from_mesh[12]; /* 3 x 4 matrix, row-major: from the mesh to the map's origin */
    float center[2];         /* m, centre of the map: x and z after the shear by slant */
    float inv_half_m;        /* 1/m, 1 / half of the map's side */
    float inv_height;        /* 1/m, 1 / metres from depth 0 to depth 1 */
    float slant[2];          /* shear of x and z per metre of height */
    float top_m;             /* m, height of depth 0 */
    float cover;             /* (0; 1], probability that a texel is covered */
    uint material;           /* [0; 255] */
    uint texels;             /* along the map's side; (holes) hash seed */
    uint pad[2];
};

#ifndef VIRGA_GLSL
VIRGA_ASSERT_SIZE(virga_map_push, 96);
#undef uint
#endif

#endif
