/* body_pose.h - where a body in simulated water is, or a vehicle that goes by keys as well. */
#ifndef VIRGA_EFFECTS_BODY_POSE_H
#define VIRGA_EFFECTS_BODY_POSE_H

#include "water_state.h"

typedef struct body_place {
    double position_m[3]; /* of its origin, relative to that of the water */
    double rotation[4];   /* quaternion x, y, z, w */
} body_place;

/* By its keys at a time of the scene, or where it is at the start. */
void body_place_of_keys(const scene_body *from, double time_s, body_place *out);

/* As it will have moved since a pose, up to half a second later. */
void body_place_ahead(const virga_fluid_pose *pose, double ahead_s, body_place *out);

/* The newest pose that was read back, and its time; `otherwise_s` before the first step. Costs no wait. */
bool body_known_pose(const water_solver *solver, uint32_t index, double otherwise_s, virga_fluid_pose *pose,
                     double *known_s);

/* That after the newest step; the solver's states are readable. */
void body_newest_pose(const water_solver *solver, uint32_t index, virga_fluid_pose *pose);

/* The same as three rows of a rotation and a place, seen from the world. */
void body_transform(const body_place *place, const double origin_m[3], float out[12]);

void body_copy_place(const body_place *place, float position_m[3], float rotation[4]);

#endif
