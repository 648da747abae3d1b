/* car.h - the car of the sample: where it drives, and what it looks like. Knows neither Vulkan calls nor rain.
 *
 * The car's own frame: the origin on the ground under its middle, x to the right, y up, z back; it drives towards -z.
 */
#ifndef DRIVE_CAR_H
#define DRIVE_CAR_H

#include "mesh.h"

#define TRACK_LAMPS 12

/* A closed way to drive on, lamps beside it and boxes that a model lacks; read from a text file. */
typedef struct track {
    float (*points)[3]; /* at even steps */
    uint32_t count;
    double step_m;
    double half_width_m; /* how far from the way a driver may get */
    double speed_m_s;    /* of the autopilot where the way is straight */
    struct {
        double position_m[3];
        float intensity[3];
    } lamps[TRACK_LAMPS];
    uint32_t lamp_count;
    struct {
        float low[3], high[3];
    } boxes[8];
    uint32_t box_count;
} track;

/* Lines `width M`, `speed M_S`, `point X Y Z`, `lamp X Y Z R G B`, `box LOW HIGH`; # begins a comment. */
bool track_load(const char *path, track *t, char *error, size_t error_size);
void track_free(track *t);

typedef struct car_keys {
    bool gas, brake, left, right;
} car_keys;

typedef struct car {
    double position_m[3];
    double heading;          /* rad about +y; 0 looks along -z */
    double slope;            /* of the road, rise over run */
    double speed_m_s, steer; /* rad at the wheels */
    double rolled;           /* rad, of the wheels */
    bool autopilot;
    uint32_t nearest; /* point of the track */
    float axes[9];    /* columns: right, up, back in the world */
    float velocity_m_s[3], acceleration_m_s2[3], angular_velocity_rad_s[3];
} car;

/* At rest on the track, so far from its first point. */
void car_place(car *c, const track *t, double way_m);

/* Drives on for dt_s [0; 0.1], by keys or by itself. */
void car_drive(car *c, const track *t, const car_keys *keys, double dt_s);

/* A point of the car in the world. */
void car_point(const car *c, const double local[3], double world[3]);

/* ---- its body */

/* What a part of car.glb is to the game, by the name of its material; assets/make_car.py makes it. */
typedef enum car_part {
    CAR_BODY,
    CAR_CABIN,   /* seen from within: little sky comes to it */
    CAR_WINDOWS, /* not drawn from within */
    CAR_WHEEL,   /* one, about the origin, its outside towards +x */
    CAR_COVER,   /* never drawn, what keeps rain off: roof, bonnet, boot */
    CAR_SCREEN,  /* and what the windshield does */
} car_part;

car_part car_part_of(const char *material);

/* Position and axes of wheel 0 to 3 in the world, steered and rolled. */
void car_wheel(const car *c, int wheel, double position_m[3], float axes[9]);

/* The windshield: the middle of its lower edge and its size, as assets/make_car.py has them; the driver's eye. */
extern const double car_windshield_m[3], car_eye_m[3];
#define CAR_GLASS_WIDTH_M  1.45f
#define CAR_GLASS_HEIGHT_M 0.95f
#define CAR_GLASS_RAKE_DEG 55.0f
#define CAR_GLASS_BEND_M   4.0f
#define CAR_GLASS_TOP_M    1.23f /* width of its upper edge: its corners are cut off */

/* Half its width and length. */
#define CAR_HALF_WIDTH_M  0.87f
#define CAR_HALF_LENGTH_M 2.05f

/* Where its lamps shine from. */
extern const double car_head_lamps_m[2][3], car_tail_lamps_m[2][3];

#endif
