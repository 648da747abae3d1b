/* spawn.h - a drop that splashes. Ground writes it (or a host with its own ground), splash reads it. */
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
    float position[3]; /* m, of the impact */
    /* [0; 1) fraction of its tick that had passed at the impact. 1 or more: the impact is that many ticks later. */
    float share;
    float velocity[3]; /* m/s, of the drop just before the impact */
    float diameter_m;  /* m, of one drop */
    float normal[3];   /* of the surface, unit length */
    float depth_m;     /* m, of the water that it fell on */
    float weight;      /* splashes that this one represents in the picture */
    float drops;       /* number of drops that water_nl is the sum of */
    uint id;           /* of the drop */
    uint tick;         /* tick of the impact */
    uint water_nl;     /* nl that fly up, of all drops that it represents in the water balance; 0: no droplets */
    uint random;       /* a hash of its own: source of all random numbers of the splash */
    /* bits 0 to 7: state (ground_limits.h); 8 to 15: material; 16 to 23: model (splash_rule.h); 24 to 28: index among
     * the splashes of its drop, if the drop represents many; VIRGA_SPAWN_SHEET */
    uint kind;
};

/* Not a drop's splash but the sheet that a foot throws up, an oval crown on level water. Then normal is the level
 * direction of its long axis. Velocity is x: half of the long axis when it is highest, over the time until then; y:
 * minus the speed at which it rises; z: as x, of the short axis. A ball of diameter_m has a sixth of its water
 * (crown_sheet.h), and water_nl is 0: its drops are handed over (handed_droplet.h). */
#define VIRGA_SPAWN_SHEET 0x20000000u

/* Head of the spawns, 64 bytes. The spawns follow, ordered by tick. */
struct virga_spawns_gpu {
    uint count;    /* number of spawns that follow */
    uint dropped;  /* spawns that were dropped because the buffer was full */
    uint capacity; /* max number of spawns */
    /* m. All drops of 2 mm within this distance of the camera splash. For other sizes the distance grows with size^1.5.
     * Beyond it a random choice of drops splashes for all, so that the quota of the rules is met. Persists from tick to
     * tick. */
    float near_m;
    float origin[3];      /* m, of positions, in the world */
    float tick_s;         /* s, length of a tick */
    uint group_count[3];  /* ceil(count / 64), 1, 1: for an indirect dispatch */
    uint first_tick;      /* the first tick of the spawns */
    uint ticks;           /* number of ticks */
    float near_of_tick_m; /* near_m as used in the newest tick */
    uint drops_of_tick;   /* drops, or pieces of them, that splash in the newest tick */
    uint pad;
};

#ifndef VIRGA_GLSL
VIRGA_ASSERT_SIZE(virga_spawn_gpu, 76);
VIRGA_ASSERT_OFFSET(virga_spawn_gpu, weight, 48);
VIRGA_ASSERT_SIZE(virga_spawns_gpu, 64);
VIRGA_ASSERT_OFFSET(virga_spawns_gpu, group_count, 32);
#undef uint
#endif

#endif
