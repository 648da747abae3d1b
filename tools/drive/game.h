/* game.h - the state of the game, and the functions of its files. All calls of Virga are in drive.c. */
#ifndef DRIVE_GAME_H
#define DRIVE_GAME_H

#define GLFW_INCLUDE_VULKAN
#include <GLFW/glfw3.h>

#include <virga/virga.h>

#include "boxes.h"
#include "car.h"
#include "drips.h"
#include "place.h"
#include "stage.h"

#define PANE_POINTS   33  /* along each side of the windshield's grid */
#define PANE_TEXELS   256 /* and of its mask */
#define MAX_OCCLUDERS 4096
#define MAX_PARTS     64 /* primitives of the car */
#define WIPERS        2
#define MAX_RATE_MM_H 200
#define MAX_DRIPS     512   /* pieces of edges from which rain drips at a time ... */
#define MAX_CAR_DRIPS 128   /* ... and of the car's */
#define MAX_PLACES    16384 /* of the street's edges in all */

enum { OFF, INTERMITTENT, SLOW, FAST, WIPER_SPEEDS };
extern const char *const wiper_names[WIPER_SPEEDS];

/* The command line; options.c. */
typedef struct choices {
    bool has_quality; /* else the device decides */
    bool real_time;   /* without a window: a frame's time is that of the frame before */
    const char *model, *track, *out, *device, *pipelines;
    uint32_t frames, fps, width, height;
    double start_m;
} choices;

/* The state of the program. */
typedef struct drive {
    choices chosen;
    char error[1024];

    /* The host's own: Vulkan, a renderer, a street, a car. */
    VkInstance instance;
    host_instance listed; /* `instance`, for the list of devices */
    host_device device;
    GLFWwindow *window;
    VkSurfaceKHR surface;
    stage stage;
    host_environment environment;
    host_mesh street, blocks, body, wipers;
    boxes boxes;          /* of the wipers at their current angles */
    host_heights heights; /* of the street, for the light of a place and for what keeps rain off the car */
    track track;
    car car;
    car_keys keys;
    bool outside;
    bool focused;    /* on the windshield, else all is sharp */
    double focus;    /* how far the lens has opened for that, [0; 1] */
    double time_s;   /* since the start */
    double eye_m[3]; /* of the camera outside, which lags behind */
    stage_camera camera, last_camera;
    bool has_last_camera;
    uint32_t frame;           /* number of frames that have begun */
    double last_s;            /* when the newest one began */
    double *frame_s, *work_s; /* without a window: how long each took, and of the processor's time */
    double last_work_s;

    /* Virga's. */
    virga_context *context;
    virga_scene *rain;
    virga_target *target;
    virga_lens *lens;
    virga_lighting lighting; /* of the drawn world: the sky, and lamps */
    virga_lighting place;    /* of the water: the same lamps, and what is around the camera */
    bool placed;             /* that was found before */
    virga_glass_settings glass;
    float pane[PANE_POINTS * PANE_POINTS * 3];
    uint8_t glass_at[PANE_TEXELS * PANE_TEXELS];
    virga_occluder occluders[MAX_OCCLUDERS];
    drip_places drip_places;                          /* found in the street's mesh */
    virga_drip_site drips[MAX_DRIPS + MAX_CAR_DRIPS]; /* those near the camera; behind them the car's, now */
    virga_drip_site car_drips[MAX_CAR_DRIPS];         /* in the car's own frame */
    uint32_t drip_count, car_drip_count;
    double car_top_m;           /* over its origin */
    VkPhysicalDeviceType kind;  /* of the device ... */
    virga_quality quality;      /* ... which the definitions are for ... */
    virga_scene_costs expected; /* ... and what they may take on it */
    float budget_ms;            /* of the device's time for ticks; 0: none */
    float rate_mm_h, set_mm_h;  /* wanted, and as Virga has it */
    int wiper_speed;
    double wiper_s; /* time in the wipers' cycle */
} drive;

/* options.c: false after a line on stderr. */
bool read_command_line(drive *d, int argc, char **argv);
void print_help(void);

/* window.c: creates and destroys the instance, and the window if there is one. */
bool open_window(drive *d);
void close_window(drive *d);

/* world.c: loads street, car and sky, finds the edges that drip, and draws all into the stage's color and depth. */
bool load_world(drive *d);
void move_drips(drive *d);
void draw_world(drive *d, VkCommandBuffer cmd, const virga_ground_maps *maps, const virga_walls *walls);
void unload_world(drive *d);

/* windshield.c: fills the mask of the pane; updates the mesh of the wipers; moves the wipers by dt_s. */
void mask_pane(drive *d);
void put_wipers(drive *d);
void move_wipers(drive *d, double dt_s);

/* game.c: begins a frame, dt_s after the one before: reads the keys of the window, or takes equal steps without one.
 * Returns false after the last one. Ends frames without a window: prints how even they were,
 * and writes the last picture. */
bool next_frame(drive *d, double *dt_s);
bool finish_file(drive *d);
void move_camera(drive *d, double dt_s);
void move_focus(drive *d, double dt_s);

#endif
