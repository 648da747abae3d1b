/* fluid_body.h - where a body in simulated water is, as the fluid effect writes it. */
#ifndef VIRGA_SHARED_FLUID_BODY_H
#define VIRGA_SHARED_FLUID_BODY_H

#include "types.h"

#ifndef VIRGA_GLSL
#define uint virga_uint
typedef struct virga_fluid_body_gpu virga_fluid_body_gpu;
#endif

#define VIRGA_FLUID_MAX_BODIES 8

/* 96 bytes. A point p of the mesh is at center + turn(rotation, p - the center of mass in the mesh's axes). */
struct virga_fluid_body_gpu {
    float center[3];        /* of mass (m), relative to the origin of the particles */
    uint contacts;          /* particles near its surface that act on it */
    float rotation[4];      /* quaternion x, y, z, w of length 1 */
    float velocity[3];      /* of the center of mass (m/s) */
    uint dropped;           /* contacts that found no room */
    float spin[3];          /* angular velocity about the axes of the world (rad/s) */
    float origin[3];        /* of the mesh (m) */
    float free_velocity[3]; /* without the water's pressure, in the newest substep */
    float free_spin[3];
};

#ifndef VIRGA_GLSL
VIRGA_ASSERT_SIZE(virga_fluid_body_gpu, 96);
VIRGA_ASSERT_OFFSET(virga_fluid_body_gpu, rotation, 16);
VIRGA_ASSERT_OFFSET(virga_fluid_body_gpu, spin, 48);
#undef uint
#endif

#endif
