/* wall_gpu.h - how wet upright surfaces are, by the side that they face. Hosts upload it, see virga/walls.h. */
#ifndef VIRGA_SHARED_WALL_GPU_H
#define VIRGA_SHARED_WALL_GPU_H

#include "types.h"

#ifndef VIRGA_GLSL
#define uint virga_uint
typedef struct virga_wall_gpu virga_wall_gpu;
#endif

#define VIRGA_WALL_SIDES     16 /* azimuths: side i faces (cos, sin)(i / 16 of a turn) in x and z */
#define VIRGA_WALL_LEVEL     16 /* one more row, for what faces up */
#define VIRGA_WALL_ROWS      17
#define VIRGA_WALL_MATERIALS 32 /* virga_occluder.material */

/* A surface of one material that faces one side, in the open. */
struct virga_wall_gpu {
    float wet;       /* [0; 1] filled fraction of the pores; of a material without pores: of the film that it holds */
    float film_mm;   /* mm, water on the surface */
    float run_mm_h;  /* mm/h, water that runs off it: times the height that it has run down, the flow per width */
    float fall_mm_h; /* mm/h, rain that hits it at present */
};

#ifndef VIRGA_GLSL
VIRGA_ASSERT_SIZE(virga_wall_gpu, 16);
#undef uint
#endif

#endif
