/* shot_state.h - a scene file on a device, as the effects of the program see it. tools/virga/shot opens, steps and
 * draws it. */
#ifndef VIRGA_EFFECTS_SHOT_STATE_H
#define VIRGA_EFFECTS_SHOT_STATE_H

#include "host.h"
#include "scene_file.h"

#include <virga/virga.h>

#ifdef __cplusplus
extern "C" {
#endif

#define SHOT_MAX_EFFECTS 32

typedef struct shot_options {
    const char *device; /* NULL: the best */
    uint32_t width, height;
    uint32_t samples;                     /* sub-frames averaged, at least 1 */
    bool draw;                            /* false: simulation only */
    bool stats;                           /* statistics are read, also those that cost time on the device */
    bool points;                          /* point caches are read back after each step */
    const char *plate;                    /* footage that replaces the opaque scene, see plate.h; NULL: none */
    uint32_t frames[2];                   /* (plate) first and last to be drawn */
    bool live;                            /* for shot_live_record */
    bool debug_maps;                      /* effects make maps that only a view of `virga view` reads */
    const char *const *window_extensions; /* (live) of the instance, so that the device can present */
    uint32_t window_extension_count;
    uint32_t water_velocity; /* percent of a pixel from which on water's velocity is its own; 0: it is the plate's */
} shot_options;

struct tool_effect;
struct tool_layer;

/* A layer that an effect draws, in the order in which they cover each other. */
typedef struct shot_layer {
    uint32_t effect; /* index in tool_effects */
    const struct tool_layer *layer;
    host_output output;
} shot_layer;

typedef struct shot {
    const scene_file *scene;
    shot_options options;
    host_instance instance;
    host_device_info info;
    host_device device;
    host_target target;
    host_renderer *renderer; /* NULL: nothing is drawn */
    host_environment environment;
    host_mesh *meshes;
    uint32_t meshes_loaded;
    virga_occluder *occluders;
    uint32_t occluder_count;
    host_camera_key *camera_keys;
    uint32_t camera_key_capacity;
    host_camera_path path;
    host_accumulator frame; /* the newest drawn frame */

    virga_context *context;
    virga_scene *simulation;
    virga_lighting lighting;        /* lamps and sky of the scene */
    void *states[SHOT_MAX_EFFECTS]; /* of each effect, see tool_effect.state_size */
    shot_layer layers[HOST_MAX_LAYERS];
    uint32_t layer_count;
    virga_target *layer_target;  /* what effects draw into, each into layers of its own */
    virga_target *moving_target; /* of the pass that draws the velocity of water; NULL where it is not wanted */

    struct plate *plate;         /* NULL: none */
    host_buffer plate_buffer;    /* its pixels on their way to the device */
    uint32_t frame_index;        /* scene frame that the simulation stands at; first - 1 before any */
    uint32_t preroll;            /* frames of the scene's pre-roll that are still to come */
    bool began;                  /* time has begun, with the first step */
    double camera_time_s;        /* of the frame that the simulation stands at */
    host_camera_key eye_keys[2]; /* (live) a camera of its own that replaces the path: a frame ago, and now */
    bool eye_free;               /* it is in use */
    char warning[512];           /* newest line that the library logged as warning or error */
    bool input_wrong;            /* opening failed because of the input, not because of the machine */
} shot;

/* A result of the library as an error line; its log says what went wrong. */
bool shot_ok(const shot *s, virga_result result, const char *what, char *error, size_t error_size);

/* Notes that what fails here is wrong input. A file that this machine has no memory for counts as such too: it will
 * not have it the next time either. Returns `right`. */
bool shot_blame_input(shot *s, bool right);

/* How long it rains before the first frame: whole frames. */
double shot_preroll_s(const shot *s);

/* The path of the eye: the scene's, or that of the free camera. */
host_camera_path shot_eye(const shot *s);

/* Row-major 3 x 4 matrix from a mesh of the scene to the world. */
void shot_mesh_transform(const scene_mesh *mesh, float out[12]);

/* ---- points that are read back after a step */

typedef struct shot_read {
    host_buffer buffer; /* created on first use */
    uint32_t count;
    double origin_m[3]; /* that positions count from */
} shot_read;

/* Records the copy of points that the step just recorded has made, to where the host reads them. */
bool shot_record_read(shot *s, VkCommandBuffer cmd, VkBuffer from, VkDeviceSize offset, VkDeviceSize size,
                      shot_read *read, char *error, size_t error_size);

/* Waits for the device; returns the points. NULL: none were read back. */
const void *shot_finish_read(shot *s, shot_read *read, char *error, size_t error_size);

/* A position of the points in the world. */
void shot_read_position(const shot_read *read, const float position[3], float out[3]);

#ifdef __cplusplus
}
#endif
#endif
