/* water_draw_gpu.h - what the passes that draw water share with the C code that feeds them. Internal to Virga. */
#ifndef VIRGA_SHARED_WATER_DRAW_GPU_H
#define VIRGA_SHARED_WATER_DRAW_GPU_H

#include "types.h"

#ifndef VIRGA_GLSL
#define uint virga_uint
typedef struct virga_water_look_gpu virga_water_look_gpu;
typedef struct virga_water_prepared_gpu virga_water_prepared_gpu;
typedef struct virga_water_tiles_gpu virga_water_tiles_gpu;
#endif

#define VIRGA_WATER_SURFEL_STEPS  1.2f  /* radius of a surfel, in steps of the grid that surfels are made on */
#define VIRGA_WATER_SPLAT_TEXELS  3     /* texels of a splat, see splat_write.comp */
#define VIRGA_WATER_VOLUME_LEVELS 8     /* of the pyramid that the thickness is summed up in */
#define VIRGA_WATER_VOLUME_PX     4     /* side of a texel of its finest level; each coarser one has twice as much */
#define VIRGA_WATER_VOLUME_UNITS  16e6f /* units of its sums in a metre of thickness */
#define VIRGA_WATER_LOOK_DEPTH    1u    /* bits of a draw's specialisation constant: the view has depth */
#define VIRGA_WATER_LOOK_COLOR    2u    /* it has color */
#define VIRGA_WATER_LOOK_SCALED   4u    /* the effect's images have other pixels than the target */
#define VIRGA_WATER_LOOK_CONTACT  8u    /* the surface goes on to solids. Only with VIRGA_WATER_LOOK_DEPTH */
#define VIRGA_WATER_LOOK_SURFELS  16u   /* light is computed for surfels, not for pixels */
#define VIRGA_WATER_TILE_PX       16    /* side of a tile, see contact_tiles.comp */
#define VIRGA_WATER_WIDE_TILES    4     /* tiles along each side of a wide one */
#define VIRGA_WATER_BLOCK_PX      8     /* side of a block of pixels, see gap_blocks.glsl */
#define VIRGA_WATER_OPEN_COLUMNS  16    /* blocks in a texel of the picture of open blocks */
#define VIRGA_WATER_OPEN_ROWS     8
#define VIRGA_WATER_DIVISIONS     3u     /* a surfel is divided so often at most */
#define VIRGA_WATER_PART_TEXELS   4      /* texels of a part of a surfel, see divide_write.comp */
#define VIRGA_WATER_PART_OFFSET   0.306f /* of a part's center along each axis, in radii of what is divided */

/* Values of virga_water_data. */
#define VIRGA_WATER_DATA_THICKNESS_GPU 0u
#define VIRGA_WATER_DATA_NORMAL_GPU    1u
#define VIRGA_WATER_DATA_MOTION_GPU    2u

/* A view of the water. */
struct virga_water_look_gpu {
    float axes[9];           /* the camera's right, up and back in the world; unit vectors */
    float surfel_scale;      /* factor of the radius of surfels */
    float surfel_m;          /* radius of most surfels */
    uint width;              /* pixels of the effect's images in use */
    uint height;             /* */
    float scale;             /* their pixels in a pixel of the target */
    float pixel_angle;       /* tangent of the angle of one of their pixels */
    uint max_splats;         /* */
    float volume_m3;         /* of a particle */
    float spacing_m;         /* of particles */
    uint volume_columns;     /* texels of the finest level of the pyramid */
    uint volume_rows;        /* */
    uint volume_first[8];    /* index of each level's first texel */
    float absorption_1_m[3]; /* */
    float scattering_1_m[3]; /* */
    float reflection;        /* strength of what is mirrored */
    float refraction;        /* strength of the shift of what is seen through water */
    uint panorama_given;     /* */
    float foam_coverage;     /* of one of its particles, in its center */
    float foam_late_s;       /* foam is drawn where it was so long before its newest step */
    uint divisions;          /* a surfel is divided so often at most */
    uint max_parts;          /* that all divisions may add */
    float difference;        /* of four colors, from which on what has them is divided; in parts of their mean */
};

/* Written by the passes of a prepare. */
struct virga_water_prepared_gpu {
    uint vertices; /* indirect arguments of the draw of all splats */
    uint instances;
    uint first_vertex;
    uint first_instance;
    uint word_groups[3]; /* of the pass that lists visible surfels */
    uint levels;         /* bit mask: levels of the pyramid in use */
    uint part_vertices;  /* indirect arguments of the draw of all parts of surfels */
    uint part_instances;
    uint part_first_vertex;
    uint part_first_instance;
    uint parts_added;     /* by all divisions for which there was room */
    uint block_groups[3]; /* indirect arguments: a workgroup for each block of pixels that is listed */
};

/* Where the picture is drawn: indirect arguments of two draws. Their vertices are those of a list of tiles each. */
struct virga_water_tiles_gpu {
    uint plain_vertices; /* without contact lines */
    uint plain_instances;
    uint plain_first_vertex;
    uint plain_first_instance;
    uint contact_vertices; /* with them */
    uint contact_instances;
    uint contact_first_vertex;
    uint contact_first_instance;
};

#ifndef VIRGA_GLSL
VIRGA_ASSERT_SIZE(virga_water_look_gpu, 168);
VIRGA_ASSERT_SIZE(virga_water_prepared_gpu, 64);
VIRGA_ASSERT_SIZE(virga_water_tiles_gpu, 32);
#undef uint
#endif

#endif
