/* virga/walls.h - upright surfaces that driving rain wets: walls, trunks, posts, cars.
 *
 * Rain that slants hits what faces it. The rain counts that water for VIRGA_WALL_SIDES azimuths, and for surfaces that
 * face up, each in the open, for every material: what hits a square metre fills pores, then forms a film, and what the
 * surface cannot hold runs down. Pores lose water to the depth of the wall, and all of it dries as ground does.
 *
 * The flux is that of the drops of the field: over all sizes, number x volume x speed towards the surface. It agrees
 * with the semi-empirical J = (2/9) U R^0.88 of ISO 15927-3 (J and R in mm/h, U in m/s) in steady wind. It is that of
 * the free wind: air goes around a building, so that only 0.2 to 0.5 of it arrives there (ISO 15927-3: wall factor;
 * Blocken and Carmeliet 2004, A review of wind-driven rain research). `share` is for that.
 *
 * Shelter is the host's: it knows its walls. `slant` and `spread` say from where the rain came that wetted them; a map
 * of depth along that line (an orthographic shadow map) says what is dry below awnings and sills.
 * virga/shared/wall_map.glsl has functions for the shader of a wall.
 *
 * Costs about 10 us of host time per tick, nothing on the device. Deterministic; part of the rain's saved state.
 */
#ifndef VIRGA_WALLS_H
#define VIRGA_WALLS_H

#include <virga/shared/wall_gpu.h>

#include <stdbool.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* What an upright surface does with water. */
typedef struct virga_wall_material {
    float capacity_mm; /* [0; 100] water in the pores of the skin, when it looks as dark as it gets */
    float film_mm;     /* [0; 5] depth of the film that clings to it; more runs down */
    float sink_mm_h;   /* [0; 1000] speed at which water leaves full pores for the depth of the wall */
    float drying;      /* [0; 10] factor of the evaporation */
} virga_wall_material;

/* In virga_rain_settings. */
typedef struct virga_walls_settings {
    /* Walls get wet. false: all stays as it is, without cost. Default true. */
    bool on;

    /* [0; 2] part of the free wind's driving rain that arrives: 1 on what stands alone, 0.2 to 0.5 on a building.
     * Surfaces that face up get all rain, whatever this is. Default 0.5. */
    float share;

    /* [0; 100] evaporation from a film, as virga_ground_settings.evaporation_mm_h. Default 0.2. */
    float evaporation_mm_h;

    /* [0; 240] time (h) that it had rained before the first tick, in the weather that is set then: mean wind, gusts and
     * rate. Its water is counted as that of any other rain. Default 0: dry walls. */
    float start_h;

    /* By the number in virga_occluder.material. Numbers above 31 count as 31. The sources of the defaults are in
     * engine/rain/walls.c. */
    virga_wall_material materials[VIRGA_WALL_MATERIALS];
} virga_walls_settings;

/* How wet walls are at the newest tick. */
typedef struct virga_walls {
    virga_wall_gpu rows[VIRGA_WALL_ROWS][VIRGA_WALL_MATERIALS];

    /* Mean slant of the rain that wetted them, in x and z: horizontal metres per metre of fall, the drops weighted by
     * their water and slant. It follows the weather within five minutes. */
    float slant[2];

    /* Standard deviation of the slant, along one axis: sizes of drops and gusts. Edges of shelter are that soft: below
     * an awning by this x the height of the awning above. */
    float spread;
} virga_walls;

/* Water of one row and material, per square metre, since creation. fell = pores + film + dried + sunk + ran_off, to the
 * last nanolitre. */
typedef struct virga_wall_water {
    uint64_t fell_nl;           /* on it, before the first tick as well */
    uint64_t pores_nl, film_nl; /* now */
    uint64_t dried_nl, sunk_nl, ran_off_nl;
} virga_wall_water;

#ifdef __cplusplus
}
#endif
#endif
