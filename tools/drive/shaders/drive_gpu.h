/* drive_gpu.h - the data of the sample's shaders, read by C and by GLSL: vec4s only, so both lay it out alike. */
#ifndef DRIVE_GPU_H
#define DRIVE_GPU_H

#ifdef VULKAN /* glslang defines it */
#define DRIVE_VEC4  vec4
#define DRIVE_MAT4  mat4
#define DRIVE_LIGHT drive_light_gpu
#else
typedef float drive_vec4[4];
typedef float drive_mat4[16];
#define DRIVE_VEC4  drive_vec4
#define DRIVE_MAT4  drive_mat4
#define DRIVE_LIGHT struct drive_light_gpu
#endif

#define DRIVE_LIGHTS         16
#define DRIVE_WALL_ROWS      17 /* VIRGA_WALL_ROWS */
#define DRIVE_WALL_MATERIALS 17 /* of virga_material */

struct drive_light_gpu {
    DRIVE_VEC4 position;  /* relative to the camera, 1 / range or 0 */
    DRIVE_VEC4 intensity; /* rgb */
    DRIVE_VEC4 direction; /* unit; all zero: a point light */
    DRIVE_VEC4 cone;      /* scale and offset of the cosine to the axis */
};

struct drive_frame_gpu {
    DRIVE_MAT4 clip_from_relative; /* relative: the world's axes with the camera at the origin */
    DRIVE_MAT4 last_from_relative; /* clip of the frame before, for a point relative to the camera of this one */
    DRIVE_VEC4 moved;              /* this camera minus the one before; w: number of lights */
    DRIVE_VEC4 ray_x;              /* direction of a pixel: ray_z + x ray_x + y ray_y, with x and y in clip space */
    DRIVE_VEC4 ray_y;
    DRIVE_VEC4 ray_z;
    DRIVE_VEC4 ground_low;    /* low corner of the wet ground's window relative to the camera; w: 1 / side of a cell */
    DRIVE_VEC4 ground_wrap;   /* number of the corner's cell modulo cells; z: cells; w: how many the window reaches */
    DRIVE_VEC4 ground_far;    /* low corner of the map beyond the window (x, z); y: 1 / side of a cell; w: cells */
    DRIVE_VEC4 ripples;       /* low corner of the map of ripples relative to the camera (x, z), 1 / side */
    DRIVE_VEC4 irradiance[9]; /* divided by pi, harmonics of degree 2 with all factors in */
    DRIVE_VEC4 shade[3];      /* rows: a point relative to the camera as the car has it, 1 at its ends; y in metres */
    DRIVE_VEC4 shelter_low;   /* a point's place on the map of shelter, see host_shelter_coordinates; w 0: no map */
    DRIVE_VEC4 shelter_slant;
    DRIVE_LIGHT lights[DRIVE_LIGHTS];
    DRIVE_VEC4 walls[DRIVE_WALL_ROWS * DRIVE_WALL_MATERIALS]; /* virga_wall_gpu, row by row */
};

struct drive_surface_gpu {   /* push constants */
    DRIVE_VEC4 from_mesh[3]; /* rows: from a point of the mesh to a point relative to the camera */
    DRIVE_VEC4 base_color;   /* times the texture's */
    DRIVE_VEC4 emissive;     /* times the texture's; w: roughness */
    /* metallic, alpha below which it is cut out, share of the sky that it sees; 1 + the material where it is ground,
     * less than 0: -1 - the material where it is a wall, 0: neither */
    DRIVE_VEC4 traits;
};

#endif
