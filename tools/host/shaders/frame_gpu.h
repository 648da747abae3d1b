/* frame_gpu.h - uniforms and push constants of the host's shaders, for C and GLSL. Their vec4s are laid out alike. */
#ifndef HOST_FRAME_GPU_H
#define HOST_FRAME_GPU_H

#ifdef VULKAN /* glslang defines it */
#define HOST_UINT  uint
#define HOST_VEC4  vec4
#define HOST_MAT4  mat4
#define HOST_LIGHT host_light_gpu
#else
typedef float host_vec4[4];
typedef float host_mat4[16];
#define HOST_UINT  unsigned int
#define HOST_VEC4  host_vec4
#define HOST_MAT4  host_mat4
#define HOST_LIGHT struct host_light_gpu
#endif

#define HOST_MAX_LIGHTS     16
#define HOST_RIPPLES_FADE   0.08   /* part of the ripple map's side along its edges in which ripples fade out */
#define HOST_LEVEL_Y        0.3    /* normals that rise less are too steep for water */
#define HOST_STEEP_Y        0.7    /* normals that rise more are no wall that water climbs, and no rain is driven at */
#define HOST_CLIMB_M        0.12   /* above the ground no pixel has water that climbs, however high it is */
#define HOST_CLIMB_CUT_M    0.15   /* where triangles are cut in two: higher */
#define HOST_WALL_MATERIALS 17     /* of virga_material */
#define HOST_WALL_ROWS      17     /* VIRGA_WALL_ROWS */
#define HOST_LOOKS          8      /* at what water mirrors, for a picture of one sample */
#define HOST_MIRROR_FAR     1000.0 /* metres: how far away all that is farther counts as */

struct host_light_gpu {
    HOST_VEC4 position;  /* position relative to the camera, 1 / range or 0 */
    HOST_VEC4 intensity; /* rgb */
    HOST_VEC4 direction; /* unit; all zero: a point light */
    HOST_VEC4 cone;      /* scale and offset of the cosine to the axis: saturate(cosine * x + y) */
};

struct host_frame_gpu {
    HOST_MAT4 clip_from_relative;     /* relative: world axes, camera at the origin; with jitter */
    HOST_MAT4 previous_from_relative; /* clip a frame ago, without jitter, of a point relative to the camera then */
    HOST_MAT4 mirror_from_relative;   /* clip of the mirror's picture, of a point of the mirrored world */
    HOST_VEC4 camera;                 /* world position */
    HOST_VEC4 moved;                  /* camera now minus camera a frame ago; w: number of lights */
    HOST_VEC4 screen;                 /* width, height, jitter x and y in pixels */
    HOST_VEC4 ray_x;                  /* direction of a pixel: ray_z + x * ray_x + y * ray_y, x and y in clip space */
    HOST_VEC4 ray_y;
    HOST_VEC4 ray_z;
    HOST_VEC4 environment;    /* rotation as a part of a full turn */
    HOST_VEC4 skylight_low;   /* low corner of the skylight volume relative to the camera, side of a voxel (m) */
    HOST_VEC4 skylight_scale; /* 1 / size of the volume; w: 1 / distance over which it fades out, 0 for never */
    HOST_VEC4 skylight_fade;  /* x: distance from the camera where that begins */
    /* x: 1 / pictures that are averaged; y and z: first and step of the looks at what water mirrors, of HOST_LOOKS;
     * w: 1: standing water climbs what stands in it */
    HOST_VEC4 sampling;
    /* low corner of the wet ground's window relative to the camera, y: height that its map counts from; w: 1 / side of
     * a cell, 0 for no ground */
    HOST_VEC4 ground_low;
    /* number of the corner's cell modulo cells; z: cells; w: how many of them the window reaches at least from the
     * camera */
    HOST_VEC4 ground_wrap;
    /* low corner of the map beyond the window relative to the camera, y: 1 / side of its cells, 0 for no map; w:
     * cells */
    HOST_VEC4 ground_far;
    HOST_VEC4 ripples; /* low corner of the ripple map relative to the camera (x, z), 1 / side; w: side, 0: none */
    /* height of the mirror's plane relative to the camera, how much smaller than the picture's its clip space is drawn;
     * z: 1, or 0 for no mirror */
    HOST_VEC4 mirror;
    /* place of the camera in the map of shelter (x and z, m), y: height of its top relative to the camera, w: metres
     * from there to its bottom; 0: all walls are dry */
    HOST_VEC4 shelter_low;
    HOST_VEC4 shelter_slant; /* of the rain, x and z; z: standard deviation; w: 1 / side of the map */
    HOST_VEC4 walls[HOST_WALL_ROWS * HOST_WALL_MATERIALS]; /* virga_wall_gpu, row by row */
    /* low corner of the map of contact shade relative to the camera, 1 / side; w 0: no map */
    HOST_VEC4 contact;
    HOST_VEC4 irradiance[9]; /* divided by pi, harmonics of degree 2 with all factors in */
    HOST_LIGHT lights[HOST_MAX_LIGHTS];
};

struct host_surface_gpu { /* push constants */
    HOST_VEC4 base_color; /* alpha: times the texture's */
    HOST_VEC4 emissive;   /* w: roughness */
    /* metallic, alpha cutoff, primitive + 1, bits: 1 base texture, 2 emissive texture, 4 glass, 8 joints; from 16 on,
     * for ground, 1 + its material */
    HOST_VEC4 traits;
    HOST_VEC4 lamps; /* x: bits of the lights that may reach it; y: material as a wall, -1: it stays dry;
                         * z: part of its diffuse light that comes through */
};

/* ---- skylight: how much of the sky is visible around the camera ---------------------------------------- */

#define HOST_SKYLIGHT_DIRECTIONS 40 /* over the upper half of all directions */
#define HOST_SKYLIGHT_SIDE       96 /* voxels along x and z */
#define HOST_SKYLIGHT_HEIGHT     32 /* and along y */
#define HOST_SKYLIGHT_RUN        4  /* of them that one invocation fills, along y */

struct host_skylight_gpu {
    HOST_MAT4 map_from_world[HOST_SKYLIGHT_DIRECTIONS];
    HOST_VEC4 direction[HOST_SKYLIGHT_DIRECTIONS]; /* towards the sky */
    HOST_VEC4 low;                                 /* corner of the volume in the world; w: bias in depth */
    HOST_VEC4 voxel;                               /* size of one */
};

struct host_skylight_draw_gpu { /* push constants */
    HOST_MAT4 map_from_world;
    HOST_VEC4 cutout; /* alpha of the material, cutoff */
};

/* ---- bloom of wet air --------------------------------------------------------------------------------------- */

#define HOST_BLOOM_LEVELS 9 /* at most: the widest is a Gaussian of 362 pixels */

struct host_bloom_gpu { /* push constants */
    /* x and y: elements 10 and 14 of clip_from_view; z: metres of such air before what has no depth; w: optical depth
     * of a metre, of light that is diffracted */
    HOST_VEC4 depth;
    HOST_VEC4 ray; /* x and y: 1 / elements 0 and 5 of clip_from_view; z and w: its elements 8 and 9 */
    /* rgb: weight of this level, in the draw of what is kept, for light that is diffracted once; w: what makes `more`
     * whole */
    HOST_VEC4 single;
    HOST_VEC4 more;  /* rgb: what is added to it for light that is diffracted more often */
    HOST_UINT width; /* texels of what is written */
    HOST_UINT height;
    HOST_UINT columns; /* texels of what is read; 0: nothing is */
    HOST_UINT rows;
};

/* ---- shade where things stand on the ground ----------------------------------------------------------------- */

#define HOST_CONTACT_FAR 4.0 /* metres above the ground: what is higher is not told apart */

struct host_contact_gpu { /* push constants */
    float height_m;       /* from depth 0 to depth 1 of its maps */
    float texel_m;
    HOST_UINT first_x; /* texel of the first invocation */
    HOST_UINT first_y;
};

/* ---- shading that sub-frames share -------------------------------------------------------------------------- */

#define HOST_REUSE_SIDE  4 /* pixels along a side of a block */
#define HOST_REUSE_RECTS 8

/* Kinds of blocks. Of the last, each pixel takes one of the sub-frame that was shaded everywhere, or is shaded. */
#define HOST_REUSE_KEPT   0
#define HOST_REUSE_SHADED 1
#define HOST_REUSE_PIXELS 2
#define HOST_REUSE_MOVES  16777215 /* as an id: of what moves by itself, whose pixels are shaded each time */
#define HOST_REUSE_SWEPT  16777214 /* likewise: of what is behind something that moves while the shutter is open */

/* Depths at which pixels are drawn that are not shaded: no surface is so near. The test for those between lets only
 * pixels that are taken pass. */
#define HOST_REUSE_AT_TAKEN 0.0
#define HOST_REUSE_BETWEEN  1e-6
#define HOST_REUSE_AT_KEPT  2e-6

struct host_reuse_gpu { /* push constants */
    HOST_UINT width;
    HOST_UINT height;
    float contrast; /* share of the brighter one that neighbours on a surface may differ by */
    float edge;     /* and where a surface ends */
    float dark;     /* color that is compared as if it was so bright */
    float moved2;   /* square of the pixels that it may move in a frame */
    float shift_x;  /* pixels from where the sub-frame sees a point to where that did which it shares with */
    float shift_y;
    HOST_UINT rect_count;                  /* where something moves by itself: nothing is shared there */
    HOST_UINT rects[2 * HOST_REUSE_RECTS]; /* low and high corners: x, and y from bit 16 on */
};

/* ---- sums of sub-frames ------------------------------------------------------------------------------------- */

struct host_accumulate_gpu { /* push constants */
    HOST_UINT width;
    HOST_UINT is_weighed; /* each pixel counts by its weight */
};

/* ---- a draw ------------------------------------------------------------------------------------------------- */

#define HOST_HAS_BASE_TEXTURE     1
#define HOST_HAS_EMISSIVE_TEXTURE 2
#define HOST_IS_GLASS             4
#define HOST_HAS_JOINTS           8  /* in the base texture's alpha */
#define HOST_GROUND               16 /* times 1 + the material */

#endif
