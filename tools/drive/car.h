/* car.h - the car of the sample: where it drives, and what it looks like. Knows neither Vulkan calls nor rain.
 *
 * The car's own frame: the origin on the ground under its middle, x to the right, y up, z back; it drives towards -z.
 */
#ifndef DRIVE_CAR_H
#define DRIVE_CAR_H

#include "mesh.h"

#define TRACK_LAMPS 12

/* A closed track, with lamps beside it, and boxes that the model does not have. Read from a text file. */
typedef struct track {
    float (*points)[3]; /* at equal distances */
    uint32_t count;
    double step_m;
    double half_width_m; /* largest distance of a driver from the track */
    double speed_m_s;    /* of the autopilot on a straight track */
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
    double rolled;           /* rad; rotation of the wheels */
    bool autopilot;
    uint32_t nearest; /* index of the nearest point of the track */
    float axes[9];    /* columns: right, up, back in the world */
    float velocity_m_s[3], acceleration_m_s2[3], angular_velocity_rad_s[3];
} car;

/* Places the car at rest on the track, at a distance from its first point. */
void car_place(car *c, const track *t, double way_m);

/* Drives for dt_s in [0; 0.1], by keys or by the autopilot. */
void car_drive(car *c, const track *t, const car_keys *keys, double dt_s);

/* A point of the car in the world. */
void car_point(const car *c, const double local[3], double world[3]);

/* ---- its body */

/* The kinds of parts of car.glb, by the name of their material. assets/make_car.py makes the model. */
typedef enum car_part {
    CAR_BODY,
    CAR_CABIN,   /* interior: it sees little of the sky */
    CAR_WINDOWS, /* not drawn from inside */
    CAR_WHEEL,   /* one wheel around the origin, its outer side towards +x */
    CAR_COVER,   /* never drawn; keeps rain off: roof, bonnet, boot */
    CAR_SCREEN,  /* likewise, for the windshield */
} car_part;

car_part car_part_of(const char *material);

/* Position and axes of wheels 0 to 3 in the world, with steering and rolling. */
void car_wheel(const car *c, int wheel, double position_m[3], float axes[9]);

#define CAR_WHEEL_RADIUS_M 0.315f
#define CAR_WHEEL_WIDTH_M  0.19f

/* The windshield: the middle of its lower edge and its size, as assets/make_car.py has them; the driver's eye. */
extern const double car_windshield_m[3], car_eye_m[3];
#define CAR_GLASS_WIDTH_M  1.45f
#define CAR_GLASS_HEIGHT_M 0.95f
#define CAR_GLASS_RAKE_DEG 55.0f
#define CAR_GLASS_BEND_M   4.0f
#define CAR_GLASS_TOP_M    1.23f /* width of its upper edge, which is shorter than the lower one */

/* Half its width and length. */
#define CAR_HALF_WIDTH_M  0.87f
#define CAR_HALF_LENGTH_M 2.05f

/* Positions of its lamps. */
extern const double car_head_lamps_m[2][3], car_tail_lamps_m[2][3];

#endif
