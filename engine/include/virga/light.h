/* virga/light.h - the light that effects show in water: what is all around, and lamps. Knows no Vulkan.
 *
 * Radiances are in the unit of the host's own picture. Thread-safety: any thread.
 */
#ifndef VIRGA_LIGHT_H
#define VIRGA_LIGHT_H

#include <virga/base.h>
#include <virga/shared/light_limits.h> /* VIRGA_MAX_LIGHTS */

#ifdef __cplusplus
extern "C" {
#endif

/* A light that glitters in water. It counts as 0.1 m wide: what is nearer is lit as there. */
typedef struct virga_light {
    double position_m[3];  /* [-1e9; 1e9] */
    float intensity[3];    /* radiant intensity in the host's radiance unit x m^2 (linear RGB), on the axis */
    float range_m;         /* beyond it the light is zero, faded smoothly; 0: no end */
    float direction[3];    /* (spot) where it points, any length; all zero: a point light */
    float cos_inner, cos_outer; /* (spot) cosines of angles off its direction: full within the first, none beyond the
                            * second, which is the smaller number. The other way round the edge is hard */
} virga_light;

/* All light of a place. A part of settings structs, so it has no size and cookie of its own. */
typedef struct virga_lighting {
    float environment_sh[9][3]; /* radiance of sky and scene around as spherical harmonics of degree 2 (RGB), in the
                            * real orthonormal basis in the order of virga/shared/sh.h. Default: grey 0.5 above and 0.1
                            * below */
    virga_light lights[VIRGA_MAX_LIGHTS];
    uint32_t light_count;  /* [0; 16]. Default 0 */
} virga_lighting;

VIRGA_API virga_lighting virga_default_lighting(void);

#ifdef __cplusplus
}
#endif
#endif
