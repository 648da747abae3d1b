/* virga/condensation.h - fog on panes: the settings of virga_glass_settings.condensation, and breath.
 *
 * Cold glass takes water from the air before it. It is counted, in picolitres, beside the pane's other water (see
 * virga_glass_stats), and becomes a part of that where drops or blades take it or where droplets have grown large. */
#ifndef VIRGA_CONDENSATION_H
#define VIRGA_CONDENSATION_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define VIRGA_GLASS_MAX_BREATHS 16

/* The side of the pane that fogs. */
typedef enum virga_glass_fog_side {
    /* Nothing condenses or dries. What is on the pane stays there, and is not drawn. */
    VIRGA_GLASS_FOG_NONE = 0,

    /* The side on which it rains. Drops that land or run take the fog under them, and blades wipe it. On what is not
     * glass it is dew: it takes the gloss of metal and leaves away. */
    VIRGA_GLASS_FOG_OUTSIDE = 1,

    /* The other side, as in a car. Rain and blades do not touch it. Where droplets grow so large that they would be
     * drops of the pane, they run off. It is not seen on what is not glass (virga_glass_settings.opaque). */
    VIRGA_GLASS_FOG_INSIDE = 2,
} virga_glass_fog_side;

/* Condensation: the water that vapour leaves on glass below its dew point. Needs virga_glass_def.condensation, and no
 * VIRGA_GLASS_STYLE_FRONT: fog on a camera's front element is virga_glass_settings.veil.
 *
 * A cell has an amount of water, as a mean thickness h. It grows by h_m (vapour of the air - saturated vapour at the
 * glass), in kg per square metre and second, and shrinks by the same where that is negative. h_m is heat_w_m2_k / 1082
 * J/(m^3 K), in m/s (Lewis' analogy). The water is in droplets, caps with the contact angle at rest: droplets_per_mm2
 * of them grow alone, with a radius that goes with the cube root of h, until they cover 0.55 of the glass. From then on
 * they merge, and their radius is proportional to h (Beysens 1995); new ones cover a part of what is left bare. The
 * same holds while they dry. Costs a pass over a sixteenth of the cells in each tick, and on the outside two over the
 * drops. */
typedef struct virga_glass_condensation {
    /* Default none. */
    virga_glass_fog_side side;

    /* [-40; 60] temperature of the air on that side (Celsius). Default 20. */
    float air_c;

    /* [0; 1] its relative humidity. Default 0.5. */
    float humidity;

    /* [-40; 60] temperature of the glass where it is not heated (Celsius). It fogs below the dew point of the air,
     * which is 9.3 for the defaults. Default 15. */
    float glass_c;

    /* [0; 500] coefficient of heat transfer from the air to the glass (W per square metre and kelvin): some 4 in a
     * closed room, 10 in a car, 30 and more before a fan or in wind. Default 8. */
    float heat_w_m2_k;

    /* [1; 100000] droplets on a square millimetre of dry glass that begins to fog. Dirty glass has fewer and larger
     * ones. Default 1000. */
    float droplets_per_mm2;

    /* [0.1; 2] mean radius (mm) from which droplets are drops of the pane: they merge with others, and run. At least a
     * nanolitre. Default 0.5. */
    float drop_radius_mm;

    /* [0; 500] water on all of the glass when condensation begins: its mean thickness (micrometres). Default 0. */
    float start_um;

    /* [0; 80] rise of the glass's mean temperature that a heater reaches in the end (K). 0: off. Default 0. */
    float heater_k;

    /* [1; 3600] time constant of that rise, and of the fall when the heater is off (s): of the glass, 2.1 J/(K cm^3),
     * over its loss of heat on both sides. Default 300. */
    float heater_s;

    /* [0; 64] wires of the heater, at equal distances from the lower edge to the upper. The heat spreads between them
     * in the glass, 0.48 mm^2/s. 0: all of the glass is heated. Default 0. */
    uint32_t heater_wires;
} virga_glass_condensation;

/* Breath on the pane: saturated air of 34 degrees Celsius that mixes with the air before the glass. */
typedef struct virga_glass_breath {
    /* [0; 1e9] when it begins, in the time of virga_glass_time (s). In the past: now. */
    double start_s;

    /* (0; 60] how long it lasts (s). */
    float duration_s;

    /* [-20; 20] its middle on the pane (u, v). */
    float position_m[2];

    /* [0.001; 10] distance from the middle at which its share falls to 1 / e. */
    float radius_m;

    /* [0; 1] its share of the air before the glass in the middle, by how far away the mouth is. */
    float share;
} virga_glass_breath;

#ifdef __cplusplus
}
#endif
#endif
