/* vehicles.h - declares what drives through a scene: models on paths, whose wheels throw water. */
#ifndef VIRGA_EFFECTS_VEHICLES_H
#define VIRGA_EFFECTS_VEHICLES_H

#include "water.h"

#ifdef __cplusplus
extern "C" {
#endif

#define SCENE_MAX_VEHICLES 8
#define SCENE_MAX_WHEELS   8
#define SCENE_MAX_FEET     4
#define SCENE_MAX_LAMPS    8

/* Relative to the vehicle: x to the right, y up, z back. */
typedef struct scene_wheel {
    double contact_m[3]; /* where it touches the ground */
    double radius_m, width_m, patch_m, open_deg;
} scene_wheel;

typedef struct scene_foot {
    double sole_m[3]; /* its middle, at rest */
    double lands;     /* at this part of a stride */
    double length_m, width_m;
} scene_foot;

/* A cone of light. */
typedef struct scene_lamp {
    double position_m[3], direction[3], color[3], intensity_w_sr, range_m, inner_deg, outer_deg;
} scene_lamp;

typedef struct scene_vehicle {
    char *name;
    char *file;       /* path of a model; NULL: only its wheels are there, which are not drawn */
    char *wheel_part; /* what belongs to a wheel has this in its name; NULL: wheels are part of the body */
    char **leave_out; /* what is not drawn has one of these in its name */
    uint32_t leave_out_count;
    scene_body_key *keys;
    uint32_t key_count;
    scene_wheel *wheels;
    uint32_t wheel_count;
    char *pose_part; /* poses of a stride have this and a number in their names; NULL: the model is stiff */
    double stride_m; /* two steps */
    scene_foot *feet;
    uint32_t foot_count;
    scene_lamp *lamps;
    uint32_t lamp_count;
} scene_vehicle;

typedef struct scene_vehicles {
    scene_vehicle *vehicles;
    uint32_t vehicle_count;
} scene_vehicles;

/* The vehicles of a scene. */
scene_vehicles *scene_vehicles_of(const scene_file *scene);

#ifdef __cplusplus
}
#endif
#endif
