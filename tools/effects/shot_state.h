/* shot_state.h - declares the shot: a scene file loaded on a device, as the effects see it. tools/virga/shot opens,
 * steps and draws it. */
#ifndef VIRGA_EFFECTS_SHOT_STATE_H
#define VIRGA_EFFECTS_SHOT_STATE_H

#include "heights.h"
#include "host.h"
#include "renderer.h"
#include "scene_file.h"

#include <virga/virga.h>

#ifdef __cplusplus
extern "C" {
#endif

#define SHOT_MAX_EFFECTS 32

typedef struct shot_options {
    const char *device; /* NULL: choose the best */
    uint32_t width, height;
    uint32_t samples;                     /* sub-frames averaged, at least 1 */
    bool draw;                            /* false: simulation only */
    host_plate_parts parts;               /* of the picture; layers of effects are drawn only for a whole one */
    bool stats;                           /* statistics are read, also those that cost device time */
    bool points;                          /* point caches are read back after each step */
    const char *plate;                    /* footage that replaces the opaque scene, see plate.h; NULL: none */
    bool stills;                          /* (plate) plate and depth are names of files; shot_show replaces them */
    const char *ground_mask;              /* (plate) what of it is ground; NULL: all that footage.ground has */
    const char *depth;                    /* (plate) its depth; NULL: footage.depth_m of the scene */
    uint32_t frames[2];                   /* (plate) first and last frame to be drawn */
    bool live;                            /* for shot_live_record */
    bool debug_maps;                      /* effects make maps that only debug views of `virga view` read */
    const char *const *window_extensions; /* (live) instance extensions needed to present */
    uint32_t window_extension_count;
    const char *checkpoints;   /* folder of checkpoints; NULL: none are written */
    uint32_t checkpoint_every; /* frames; 0: none are written */
    uint32_t water_velocity;   /* min coverage (percent) at which a pixel gets the water's velocity; 0: the plate's */
} shot_options;

struct tool_effect;
struct tool_layer;

/* A layer that an effect draws. Layers are in drawing order: later ones cover earlier ones. */
typedef struct shot_layer {
    uint32_t effect; /* index in tool_effects */
    const struct tool_layer *layer;
    host_output output;
} shot_layer;

#define SHOT_MAX_OCCLUDERS 4096

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
    virga_occluder *occluders; /* room for SHOT_MAX_OCCLUDERS; effects may add theirs when they open */
    uint32_t occluder_count;
    struct host_drip_edges *drip_edges; /* while meshes are loaded; NULL: nothing drips */
    host_heights roofs;                 /* of what keeps rain off vehicles that drip; all zero: none */
    struct tool_drips *drips;           /* all places that drip; NULL: nothing drips */
    host_camera_key *camera_keys;
    uint32_t camera_key_count;
    bool keys_from_file;
    host_camera_path path;
    host_accumulator sums; /* of the sub-frames of a frame */
    host_drawn frame;      /* the newest drawn frame */

    virga_context *context;
    virga_scene *simulation;
    virga_lighting lighting;        /* lamps and sky of the scene */
    void *states[SHOT_MAX_EFFECTS]; /* of each effect, see tool_effect.state_size */
    shot_layer layers[HOST_MAX_LAYERS];
    uint32_t layer_count;
    virga_target *layer_target;  /* effects draw into it, each into its own layers */
    virga_target *moving_target; /* target of the pass that draws the velocity of water; NULL: not requested */

    /* Of a lens that bends lines, see distort.h; NULL: none. `options` has the pinhole's size then; `pinhole` is the
     * newest drawn frame before it is distorted. */
    struct shot_distortion *distortion;
    host_drawn pinhole;

    struct plate *plate;               /* NULL: none */
    struct color_space *color_space;   /* of the plate, in place of its curve; NULL: the curve */
    struct plate_ground *plate_ground; /* NULL: it has none */
    host_buffer plate_buffer;          /* uploads its pixels */
    host_buffer plate_depth_buffer;    /* uploads its depth; none without depth */
    host_buffer state;                 /* a saved state, see checkpoint.h; created on first use */
    uint32_t kept_frame;               /* frame of the state that checkpoint_keep has kept in it */
    uint32_t frame_index;              /* the simulation's current scene frame; first - 1 before the first step */
    uint64_t step_frame;               /* frame of the device in which the newest step was recorded */
    uint32_t preroll;                  /* remaining frames of the scene's pre-roll */
    bool began;                        /* the first step was done */
    bool is_unseen;                    /* no picture is drawn of the step that is recorded */
    double camera_time_s;              /* time of the simulation's current frame */
    host_camera_key eye_keys[2];       /* (live) the free camera, which replaces the path: a frame ago, and now */
    bool eye_free;                     /* (live) the free camera is in use */
    bool focus_picked;                 /* (live) the user has picked a focus, which replaces that of the scene: */
    double picked_inv_m;               /* (live) 1 / its view depth; 0: infinity */
    struct shot_place *place;          /* the light of the camera's place; NULL: that of the environment */
    struct shot_lens *lens;            /* blurs sub-frames by depth; NULL: none does */
    char warning[512];                 /* newest line that the library logged as warning or error */
    bool input_wrong;                  /* opening failed because of the input, not because of the machine */
} shot;

/* Returns whether a library call succeeded. If not, writes an error line with the library's log message. */
bool shot_ok(const shot *s, virga_result result, const char *what, char *error, size_t error_size);

/* If `right` is false, notes that the input is wrong. This includes a file that is too large for the machine's memory,
 * because a retry would fail too. Returns `right`. */
bool shot_blame_input(shot *s, bool right);

/* Time of a scene frame: the first is 0. The shutter closes then. */
double shot_time(const shot *s, uint32_t frame);

/* Length of the pre-roll (rain before the first frame). It is a whole number of frames. */
double shot_preroll_s(const shot *s);

/* The camera path: the scene's, or that of the free camera. */
host_camera_path shot_eye(const shot *s);

/* Row-major 3 x 4 matrix from a mesh of the scene to the world. */
void shot_mesh_transform(const scene_mesh *mesh, float out[12]);

/* ---- points that are read back after a step */

typedef struct shot_read {
    host_buffer buffer; /* created on first use */
    uint32_t count;
    double origin_m[3]; /* positions are relative to it */
} shot_read;

/* Records a copy of the newest step's points into a buffer that the CPU can read. */
bool shot_record_read(shot *s, VkCommandBuffer cmd, VkBuffer from, VkDeviceSize offset, VkDeviceSize size,
                      shot_read *read, char *error, size_t error_size);

/* Waits for the device; returns the points. NULL: none were read back. */
const void *shot_finish_read(shot *s, shot_read *read, char *error, size_t error_size);

/* The same, and allocates `stride` bytes for a row of each point. NULL with a line in `error` on failure. */
void *shot_finish_rows(shot *s, shot_read *read, size_t stride, char *error, size_t error_size);

/* Converts the position of a point to the world. */
void shot_read_position(const shot_read *read, const float position[3], float out[3]);

#ifdef __cplusplus
}
#endif
#endif
