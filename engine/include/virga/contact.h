/* virga/contact.h - what rolls and walks over wet ground: wheels and feet. They take water from the cells of the ground
 * and give it back: pushed aside, or as spray.
 *
 * A host names its wheels and feet in each frame (virga_scene_frame, or virga_ground_step_info). They need no handle
 * and no mesh, and cost as little as an occluder: a few hundred cells are looked at in each tick. What is far from all
 * water costs the same. Wheels and feet outside of the window of the ground do nothing.
 *
 * The water under a wheel goes four ways (the mechanisms of Weir, Strange and Heffley 1978, Reduction of adverse
 * aerodynamic effects of large trucks, FHWA-RD-79-84):
 *  - The tread carries up to 2.1 mm of it through the patch: 0.1 mm sticks to three quarters of the tread, and the
 *    grooves, a quarter, are 8 mm deep. It leaves the tread behind the wheel as spray, the more of it the faster the
 *    tread; slow ones lay it down again.
 *  - What is deeper is pushed ahead and to the sides. Where it is fast and deep enough it flies, as a sheet that breaks
 *    into drops. The rest raises the water beside the wheel.
 *  - A film of 0.05 mm stays, and what grass and soil hide. So the track is dry until water flows or rains into it.
 *
 * The water under a foot that treads down is pressed out of its patch on all sides. Where it is fast enough it runs
 * against the water beside and rises as a sheet: at 0.7 m/s a quarter of 14 mm of water and a half of 8 mm. 2 mm fit
 * into the sole's profile. Of so thin a film, as on a pavement in the rain, a twentieth rises around the edge. A fifth
 * of the sheet flies off as drops of 1 to 6 mm, the rest falls back. The splash effect draws a sheet of 3 ml or more as
 * an oval crown, without a cost of its own.
 *
 * Where water of a puddle is moved, waves begin (virga_ground_settings.wake_waves): rings around a step, and behind a
 * wheel that is faster than sqrt(g h), 0.3 m/s in 8 mm of water, a wedge.
 *
 * The droplets fly as those of splashes (virga/splash.h): wind, panes, ground. Their water is counted all the way. */
#ifndef VIRGA_CONTACT_H
#define VIRGA_CONTACT_H

#include <virga/vulkan.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Wheels and feet in one step. */
#define VIRGA_GROUND_MAX_CONTACTS 64

/* A wheel of a car, a bicycle, a pushchair. Start from virga_default_wheel. A field out of its range refuses the whole
 * call that takes the wheel. */
typedef struct virga_wheel {
    /* Of this wheel, the same in each frame: random numbers of its spray come from it. Default 0. */
    uint32_t id;

    /* [-1e9; 1e9] where it touches the ground (m): the middle of its contact patch, at the end of the frame. A wheel
     * more than 0.1 m above or below the ground does nothing. */
    double contact_m[3];

    /* [-1000; 1000] of its axle. It says which way the patch came in each tick, so it should fit to where the wheel was
     * in the frame before. At most 64 cells are covered in a tick. */
    float velocity_m_s[3];

    /* Direction of its axle, to either side, of any length; not vertical. Default {1, 0, 0}. */
    float axle[3];

    /* [0.01; 3] default 0.32. */
    float radius_m;

    /* [0.01; 2] of the tread. Default 0.19. */
    float width_m;

    /* [0.01; 2] length of the contact patch: load / (pressure of the tire x width). Default 0.12, a car of 1.6 t. */
    float patch_m;

    /* [-1; 20] speed of the tread over that of a wheel that rolls freely, minus 1. -1: it is locked, and throws nothing
     * behind it. Default 0. */
    float slip;

    /* [0; 180] angle of the tread behind the patch at which a mudguard or the body begins (deg). What leaves the tread
     * there drips back on the track. 180: none. Default 35, the arch of a car. */
    float open_deg;
} virga_wheel;

VIRGA_API virga_wheel virga_default_wheel(void);

/* A foot, paw or hoof. Start from virga_default_foot. A field out of its range refuses the whole call that takes it. */
typedef struct virga_foot {
    /* As virga_wheel.id. */
    uint32_t id;

    /* [-1e9; 1e9] middle of the sole (m), at the end of the frame. While it is above the water, it does nothing. */
    double sole_m[3];

    /* [-1000; 1000] of the sole. Downwards: it presses water out. */
    float velocity_m_s[3];

    /* Direction from heel to toe, of any length; not vertical. Default {0, 0, -1}. */
    float heading[3];

    /* [0.01; 2] default 0.28 and 0.1. */
    float length_m, width_m;
} virga_foot;

VIRGA_API virga_foot virga_default_foot(void);

#ifdef __cplusplus
}
#endif
#endif
