/* splash_rule.h - which splash a drop makes, by the material and the water that it falls on: what splash writes, and
 * ground and splash read. */
#ifndef VIRGA_SHARED_SPLASH_RULE_H
#define VIRGA_SHARED_SPLASH_RULE_H

#include "ground_limits.h"
#include "types.h"

#ifndef VIRGA_GLSL
#define uint virga_uint
typedef struct virga_splash_rule_gpu virga_splash_rule_gpu;
typedef struct virga_splash_rules_gpu virga_splash_rules_gpu;
#endif

/* Models, Mizukami et al., section 4; and what a droplet of a splash makes where it falls. */
#define VIRGA_SPLASH_NONE       0
#define VIRGA_SPLASH_SCATTERING 1
#define VIRGA_SPLASH_CROWN_CONE 2
#define VIRGA_SPLASH_DISK       3
#define VIRGA_SPLASH_DOT        4
#define VIRGA_SPLASH_MODELS     5

/* Where counts, sizes and speeds come from. */
#define VIRGA_SPLASH_PAPER    0 /* the ranges of the rule: table 1 */
#define VIRGA_SPLASH_PHYSICAL 1 /* the drop's Weber number */

/* A row of the table: a material in a state. */
struct virga_splash_rule_gpu {
    uint model;
    float min_diameter_m; /* smaller drops make none, nor do any on thinner water than */
    float min_depth_m;
    float share[2];      /* lowest and highest, of the drop's water that flies up */
    float count[2];      /* droplets */
    float angle[2];      /* rad above the surface */
    float speed[2];      /* m/s */
    float strength;      /* (physical) factor of the count */
    float circle_radius; /* radius of the circle that piles stand on, times the drop's diameter */
};

/* The whole table. */
struct virga_splash_rules_gpu {
    uint mode;                        /* VIRGA_SPLASH_PAPER or _PHYSICAL */
    float quota;                      /* splashes a tick that there is room for */
    float droplet_range_m;            /* farther than this from the camera splashes have no droplets */
    float dot_min_m;                  /* droplets that are at least as large make a dot where they fall */
    virga_splash_rule_gpu rules[192]; /* material x VIRGA_GROUND_STATES + state */
};

#ifndef VIRGA_GLSL
VIRGA_ASSERT_SIZE(virga_splash_rule_gpu, 52);
VIRGA_ASSERT_SIZE(virga_splash_rules_gpu, 16 + 52 * VIRGA_GROUND_MATERIALS * VIRGA_GROUND_STATES);
#undef uint
#endif

#endif
