/* splash_rule.h - the type of splash that a drop makes, by the material and the water that it falls on. Splash writes
 * the table, ground and splash read it. */
#ifndef VIRGA_SHARED_SPLASH_RULE_H
#define VIRGA_SHARED_SPLASH_RULE_H

#include "ground_limits.h"
#include "types.h"

#ifndef VIRGA_GLSL
#define uint virga_uint
typedef struct virga_splash_rule_gpu virga_splash_rule_gpu;
typedef struct virga_splash_rules_gpu virga_splash_rules_gpu;
#endif

/* Splash models, Mizukami et al., section 4. The dot is what a droplet of a splash makes when it lands. */
#define VIRGA_SPLASH_NONE       0
#define VIRGA_SPLASH_SCATTERING 1
#define VIRGA_SPLASH_CROWN_CONE 2
#define VIRGA_SPLASH_DISK       3
#define VIRGA_SPLASH_DOT        4
#define VIRGA_SPLASH_MODELS     5

/* Source of counts, sizes and speeds. */
#define VIRGA_SPLASH_PAPER    0 /* ranges of the rule: table 1 */
#define VIRGA_SPLASH_PHYSICAL 1 /* the drop's Weber number */

/* A row of the table: one material in one state. */
struct virga_splash_rule_gpu {
    uint model;
    float min_diameter_m; /* m, smaller drops make no splash */
    float min_depth_m;    /* m, on thinner water there is no splash */
    float share[2];       /* [0; 1], min and max: fraction of the drop's water that flies up */
    float count[2];       /* min and max: droplets */
    float angle[2];       /* min and max: rad above the surface */
    float speed[2];       /* min and max: m/s */
    float strength;       /* (physical) factor of the count */
    float circle_radius;  /* radius of the circle of piles, in diameters of the drop */
};

/* The whole table. */
struct virga_splash_rules_gpu {
    uint mode;                        /* VIRGA_SPLASH_PAPER or _PHYSICAL */
    float quota;                      /* splashes per tick that the buffers have space for */
    float droplet_range_m;            /* m, splashes at a greater distance from the camera have no droplets */
    float dot_min_m;                  /* m, diameter; droplets of this size or larger make a dot where they land */
    virga_splash_rule_gpu rules[192]; /* index: material x VIRGA_GROUND_STATES + state */
};

#ifndef VIRGA_GLSL
VIRGA_ASSERT_SIZE(virga_splash_rule_gpu, 52);
VIRGA_ASSERT_SIZE(virga_splash_rules_gpu, 16 + 52 * VIRGA_GROUND_MATERIALS * VIRGA_GROUND_STATES);
#undef uint
#endif

#endif
