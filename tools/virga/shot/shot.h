/* shot.h - a scene file brought to life on a device: what the commands step and draw, frame by frame. */
#ifndef VIRGA_TOOL_SHOT_H
#define VIRGA_TOOL_SHOT_H

#include "glass.h"
#include "ground.h"
#include "host.h"
#include "rain.h"
#include "scene_file.h"
#include "shot/plate.h"
#include "splash.h"

#include <virga/shared/drop.h>
#include <virga/virga.h>

#define SHOT_RIPPLES_AHEAD_M  4.6 /* of the middle of the map of ripples, which is 6 m wide */
#define SHOT_MAX_OCCLUDERS    4096
#define SHOT_MATERIAL_OF_MESH 255

typedef struct shot_options {
    const char *device; /* NULL: the best */
    uint32_t width, height;
    uint32_t samples;   /* sub-frames averaged, at least 1 */
    bool draw;          /* false: simulation only */
    bool stats;         /* sums of water are wanted */
    bool points;        /* drops and droplets of each stepped frame are read back */
    const char *plate;  /* pictures in place of the opaque scene, see plate.h; NULL: the scene is drawn */
    uint32_t frames[2]; /* (plate) first and last to be drawn */
    bool live;          /* for shot_live_record */
    bool height_maps;   /* panes make what virga_glass_map_get tells of */
    const char *const *window_extensions; /* (live) of the instance, so that the device can present */
    uint32_t window_extension_count;
    uint32_t water_velocity; /* percent of a pixel from which on water's velocity is its own; 0: it is the plate's */
} shot_options;

/* Points of the newest step, on their way to the host. */
typedef struct shot_read {
    host_buffer buffer; /* made on first use */
    uint32_t count;
    double origin_m[3]; /* that positions count from */
} shot_read;

/* A pane of the scene. */
typedef struct shot_pane {
    const scene_pane *from;
    virga_glass *glass;
    virga_glass_settings settings;
    float *positions; /* columns x rows points in its own frame, see virga_glass_shape */
    uint32_t columns, rows;
    virga_scene_pane now; /* at the frame that the simulation stands at */
    host_mesh mesh;       /* its frame and its wipers; no vertices: neither */
    shot_read read;
} shot_pane;

typedef struct shot {
    const scene_file *scene;
    shot_options options;
    host_instance instance;
    host_device_info info;
    host_device device;
    host_target target;
    host_renderer *renderer;
    host_environment environment;
    host_mesh *meshes;
    uint32_t meshes_loaded;
    virga_occluder *occluders;
    uint32_t occluder_count;
    host_image material_image;           /* of ground.material_map; none: all 0 */
    virga_ground_material_map materials; /* likewise */
    host_camera_key *camera_keys;
    uint32_t camera_key_room;
    host_camera_path path;
    host_accumulator frame; /* the newest drawn frame */

    virga_context *context;
    virga_scene *rain_scene;
    virga_rain *rain;
    virga_ground *ground; /* NULL: none */
    virga_splash *splash; /* NULL: none */
    virga_target *layer;  /* what rain, splashes and panes draw into, each into a layer of its own */
    virga_target *moving; /* of the pass that draws the velocity of water; NULL where it is not asked for */
    virga_target *mirror; /* of the pass that draws haze over what puddles mirror; NULL where there is no mirror */
    virga_result mirror_result; /* of that, in the newest plate */
    virga_rain_settings settings;
    shot_read drops_read, droplets_read;
    shot_pane *panes;            /* as many as the scene has; NULL before they are made */
    struct plate plate;          /* so called as in C++ too */
    host_buffer plate_buffer;    /* its pixels on their way to the device */
    uint32_t frame_index;        /* scene frame that the simulation stands at; first - 1 before any */
    uint32_t preroll;            /* frames of the scene's pre-roll that are still to come */
    bool began;                  /* time has begun, with the first step */
    double camera_time_s;        /* of the frame that the simulation stands at */
    host_camera_key eye_keys[2]; /* (live) a camera of its own in place of the path: a frame ago, and now */
    bool eye_free;               /* it is in use */
    char warning[512];           /* newest line that the library logged as warning or error */
    bool input_wrong;            /* shot_open failed because of what was asked for, not because of the machine */
} shot;

/* One drop of the point cache. */
typedef struct shot_point {
    float position[3], velocity[3], radius_m;
    uint32_t id;
    float age_s, weight;
} shot_point;

/* One droplet of a splash. */
typedef struct shot_droplet {
    float position[3], velocity[3], radius_m;
    uint32_t id;
    float age_s;
    uint32_t model, material, state; /* of its splash, and of the cell that it came from */
    uint32_t parent, index;          /* the drop, and which of its droplets this is: id is the hash of both */
    float water_ul;
} shot_droplet;

/* One drop on a pane. */
typedef struct shot_glass_drop {
    float position[3], velocity[3], radius_m; /* of its base; of a particle */
    uint32_t id;
    float age_s;
    uint32_t kind, flags, pane; /* VIRGA_GLASS_DROP or _PARTICLE; the other bits of virga_glass_drop_gpu.kind */
    float water_ul;
} shot_glass_drop;

/* Whether the names of materials that the scene gives are known; else one line about the first that is not. */
bool shot_check_materials(const scene_file *scene, char *error, size_t error_size);

/* Likewise whether the contact angles of panes go together. */
bool shot_check_panes(const scene_file *scene, char *error, size_t error_size);

/* The picture of ground.material_map as materials, one byte a texel, SHOT_MATERIAL_OF_MESH where meshes decide: an
 * array to free(), NULL where the scene has no map. Its names must be known. */
bool shot_read_material_map(const scene_file *scene, uint32_t *width, uint32_t *height, uint8_t **texels, char *error,
                            size_t error_size);

/* Loads everything. On failure nothing is left open, `error` has one line and s->input_wrong says whose fault it is. */
bool shot_open(shot *s, const scene_file *scene, const shot_options *options, char *error, size_t error_size);
void shot_close(shot *s);

/* Time of a scene frame: the first is 0. The shutter closes then. */
double shot_time(const shot *s, uint32_t frame);

/* How long it rains before the first frame: whole frames. */
double shot_preroll_s(const shot *s);

/* One frame of the pre-roll, while s->preroll is not 0. */
bool shot_step_preroll(shot *s, char *error, size_t error_size);

/* Steps the simulation to a frame, which must not lie behind; draws nothing. Before the first one through what is left
 * of the pre-roll. */
bool shot_step(shot *s, uint32_t frame, char *error, size_t error_size);

/* Steps to a frame and draws it into s->frame. `camera` gets the camera at the shutter's end. */
bool shot_draw(shot *s, uint32_t frame, host_camera *camera, char *error, size_t error_size);

/* ---- live: time goes on as the caller wants, and settings of the scene may change between frames. s->camera_time_s is
 * where time is. Panes that go with the camera go with its path, also where the eye is free. */

/* Begins a frame of the device and of the library. */
bool shot_begin(shot *s, VkCommandBuffer *cmd, char *error, size_t error_size);

/* Records that `dt_s` of time (0: none) passes, and the picture, into s->target. The outputs but color and depth are in
 * VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL then. Begun by shot_begin, submitted by the caller. */
bool shot_live_record(shot *s, VkCommandBuffer cmd, double dt_s, host_camera *camera, char *error, size_t error_size);

/* Draws the moment that time stands at into s->frame, as shot_draw does a frame. Waits for the device. */
bool shot_live_draw(shot *s, uint32_t samples, host_camera *camera, char *error, size_t error_size);

/* Rain, ground, panes and all that the scene names, anew, at time 0. Waits for the device. */
bool shot_live_restart(shot *s, char *error, size_t error_size);

/* Another size of the picture. Waits for the device. */
bool shot_live_resize(shot *s, uint32_t width, uint32_t height, char *error, size_t error_size);

/* The path of the eye: the scene's, or of the free one. */
host_camera_path shot_eye(const shot *s);

/* The drops of the frame that the simulation stands at, under the open sky, in the world: an array to free(). Needs
 * options.points. */
bool shot_points(shot *s, shot_point **points, uint32_t *count, char *error, size_t error_size);

/* The same with the droplets, those on the tip of a pile among them. Needs splashes too. */
bool shot_droplets(shot *s, shot_droplet **droplets, uint32_t *count, char *error, size_t error_size);

/* The same with what is on the panes, pane by pane. */
bool shot_glass_drops(shot *s, shot_glass_drop **drops, uint32_t *count, char *error, size_t error_size);

/* A pane's height map of bumps in metres, rows from below, an array to free(); NULL where it has none. */
bool shot_read_bumps(const scene_file *scene, uint32_t pane, uint32_t *columns, uint32_t *rows, float **bumps_m,
                     char *error, size_t error_size);

/* Where it has no glass is 0, rows from below, an array to free(); NULL where it has no such picture. */
bool shot_read_mask(const scene_file *scene, uint32_t pane, uint32_t *columns, uint32_t *rows, uint8_t **mask,
                    char *error, size_t error_size);

#endif
