/* spawn.h - a drop that splashes: what ground writes (or a host that has a ground of its own), and splash reads. */
#ifndef VIRGA_SHARED_SPAWN_H
#define VIRGA_SHARED_SPAWN_H

#include "types.h"

#ifndef VIRGA_GLSL
#define uint virga_uint
typedef struct virga_spawn_gpu virga_spawn_gpu;
typedef struct virga_spawns_gpu virga_spawns_gpu;
#endif

/* One splash, 76 bytes. Positions are relative to virga_spawns_gpu's origin. */
struct virga_spawn_gpu {
    float position[3]; /* m, where it fell */
    float share;       /* of its tick that had passed [0; 1); 1 and more: it falls so many ticks later */
    float velocity[3]; /* m/s, of the drop on its way in */
    float diameter_m;  /* of one drop */
    float normal[3];   /* of the surface, unit length */
    float depth_m;     /* of the water that it fell on */
    float weight;      /* splashes that this one stands for in the picture */
    float drops;       /* drops that water_nl is of */
    uint id;           /* of the drop */
    uint tick;         /* that it fell in */
    uint water_nl;     /* that flies up, of all the drops that it stands for in the budget; 0: no droplets */
    uint random;       /* a hash of its own: all chance in its splash comes from it */
    /* bits 0 to 7 the state (ground_limits.h), 8 to 15 the material, 16 to 23 the model (splash_rule.h), 24 to 28 which
     * of the splashes of its drop, where that stands for many */
    uint kind;
};

/* Head of the spawns, 64 bytes; they follow, those of a tick after those of the tick before. */
struct virga_spawns_gpu {
    uint count;
    uint dropped; /* that found no room */
    uint capacity;
    /* drops of 2 mm within this of the camera all splash, larger ones farther out, by the 1.5th power of their size; of
     * others some stand for all, so that the quota of the rules is met. Kept from tick to tick */
    float near_m;
    float origin[3]; /* of positions, in the world */
    float tick_s;
    uint group_count[3]; /* ceil(count / 64), 1, 1: for an indirect dispatch */
    uint first_tick;     /* of those that are here */
    uint ticks;
    float near_of_tick_m; /* near_m as it was for the newest tick */
    uint pad[2];
};

#ifndef VIRGA_GLSL
VIRGA_ASSERT_SIZE(virga_spawn_gpu, 76);
VIRGA_ASSERT_OFFSET(virga_spawn_gpu, weight, 48);
VIRGA_ASSERT_SIZE(virga_spawns_gpu, 64);
VIRGA_ASSERT_OFFSET(virga_spawns_gpu, group_count, 32);
#undef uint
#endif

#endif
