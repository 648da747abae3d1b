/* handed_droplet.h - droplets that leave the water: the water effect writes them (or wheels and feet on the ground, or
 * a host with its own spray), splash takes them and lets them fly. */
#ifndef VIRGA_SHARED_HANDED_DROPLET_H
#define VIRGA_SHARED_HANDED_DROPLET_H

#include "types.h"

#ifndef VIRGA_GLSL
#define uint virga_uint
typedef struct virga_handed_droplet_gpu virga_handed_droplet_gpu;
typedef struct virga_handed_droplets_gpu virga_handed_droplets_gpu;
#endif

/* One droplet, 48 bytes. */
struct virga_handed_droplet_gpu {
    float position[3]; /* m, relative to the origin that the host gives (virga_splash_step_info.handed_origin_m) */
    float age_s;       /* s, > 0, since it left the water */
    float velocity[3]; /* m/s */
    float diameter_m;  /* m */
    uint id;           /* of the particle that it comes from; its own is virga_hash2(id, number) */
    uint number;       /* [0; 255], among the droplets of the particle */
    uint water_nl;     /* nl, > 0 */
    float drops;       /* how many of this size it stands for in the picture; 0: one */
};

/* Head of the list, 32 bytes. The droplets follow. Splash owns the list: at the end of each step it empties it, and
 * says how many droplets it has room for in the next one. Whoever writes to the list appends, and keeps what does not
 * fit. So no droplet is ever dropped. */
struct virga_handed_droplets_gpu {
    uint count;          /* droplets that follow */
    uint capacity;       /* how many there may be in all; 0 before splash's first step */
    uint group_count[3]; /* ceil(count / 64), 1, 1: for an indirect dispatch; the writer keeps it up to date */
    uint drips; /* splash's own: drops that were due at edges in a tick of the step before, for which it keeps slots */
    uint pad[2];
};

#ifndef VIRGA_GLSL
VIRGA_ASSERT_SIZE(virga_handed_droplet_gpu, 48);
VIRGA_ASSERT_SIZE(virga_handed_droplets_gpu, 32);
#undef uint
#endif

#endif
