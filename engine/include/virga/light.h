/* virga/light.h - the light that effects show in water: the environment, and lamps. Needs no Vulkan.
 *
 * Radiance is in the unit of the host's own picture. Thread-safety: any thread.
 */
#ifndef VIRGA_LIGHT_H
#define VIRGA_LIGHT_H

#include <virga/base.h>
#include <virga/shared/light_limits.h> /* VIRGA_MAX_LIGHTS */

#ifdef __cplusplus
extern "C" {
#endif

/* A lamp that glitters in water: a point light or a spot light. It counts as 0.1 m wide: water nearer than that is lit
 * as at that distance. */
typedef struct virga_light {
    /* [-1e9; 1e9] position in the world. */
    double position_m[3];

    /* Radiant intensity on the axis (linear RGB), in the host's unit of radiance times m^2. */
    float intensity[3];

    /* Beyond this distance the light is zero; it fades smoothly before. 0: unlimited. */
    float range_m;

    /* (spot) Where it points, of any length. All zero: a point light. */
    float direction[3];

    /* (spot) Cosines of angles from its direction. Full light within the angle of cos_inner, none beyond that of
     * cos_outer, which is the smaller number. If cos_outer is the larger one, the edge is hard. */
    float cos_inner, cos_outer;
} virga_light;

/* All light at a place: a part of settings structs, so it has no size and cookie of its own. */
typedef struct virga_lighting {
    /* Radiance of all that is around the drops (RGB) as spherical harmonics of degree 2, in the real orthonormal basis
     * and in the order of virga/shared/sh.h: of the sky where it is seen, else of what hides it. One place stands for
     * all drops; take the camera's, and let it change smoothly. Between houses, drops with the light of the sky alone
     * are up to twice too bright. Leave out what is in `lights`. virga/environment.h finds it from a cube map of the
     * scene. Default: the open, grey, 0.5 above and 0.1 below. */
    float environment_sh[9][3];

    virga_light lights[VIRGA_MAX_LIGHTS];

    /* [0; 16] lights in use. Default 0. */
    uint32_t light_count;
} virga_lighting;

VIRGA_API virga_lighting virga_default_lighting(void);

#ifdef __cplusplus
}
#endif
#endif
