/* scene_file.h - scene files: YAML by schema, checked to the last key.
 *
 * A file names meshes, an environment, lights, the camera's path, the frames to render, and the settings of each
 * effect. All lengths in metres, angles in degrees, Y up. Every key but `virga` and those of the camera's path has a
 * default; see scene_core.c, scene_camera.c and the effects for the ranges and defaults. What is wrong is reported in
 * one line with file, line and key:
 *
 *     street.yaml:12: rain.rate_mm_h: expected a number from 0 to 200, got 'lots'
 */
#ifndef VIRGA_IO_SCENE_FILE_H
#define VIRGA_IO_SCENE_FILE_H

#include "distortion.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define SCENE_FILE_VERSION    1  /* the value of the key `virga` */
#define SCENE_FILE_MAX_LIGHTS 16 /* as many as the rain reads */

typedef struct scene_mesh {
    char *file; /* path, joined with the scene file's folder */
    double position_m[3];
    double rotation_deg[3]; /* about the world's X, then Y, then Z axis */
    double scale;
} scene_mesh;

typedef struct scene_environment {
    char *file; /* path of a panorama; NULL: the sky is a gradient of the three colours */
    double intensity;
    double rotation_deg; /* around +Y, counter-clockwise seen from above */
    double zenith[3], horizon[3], ground[3];
    double around; /* share of what meshes hide of the environment that drops lack, [0; 1] */
} scene_environment;

typedef enum scene_light_type { SCENE_LIGHT_POINT, SCENE_LIGHT_SPOT } scene_light_type;

typedef struct scene_light {
    uint32_t type; /* scene_light_type */
    double position_m[3];
    double color[3];
    double intensity_w_sr;       /* times color */
    double range_m;              /* 0: no end */
    double direction[3];         /* (spot) not all zero */
    double inner_deg, outer_deg; /* (spot) angles from the axis: full light inside the first, none outside the second */
} scene_light;

typedef struct scene_camera_key {
    double time_s;
    double position_m[3];
    double look_at_m[3];
    double roll_deg;
    bool cut; /* a new shot begins here */
} scene_camera_key;

/* Where the focus is at a time: at an object, or at a distance. */
typedef struct scene_focus_key {
    double time_s;
    double focus_m; /* 0: infinity */
    char *focus_on; /* NULL: focus_m */
} scene_focus_key;

/* How the blur of a lens is made. */
typedef enum scene_blur {
    SCENE_BLUR_GATHER, /* each sub-frame is blurred by its depth */
    SCENE_BLUR_EXACT,  /* each sub-frame looks from another point of the lens */
} scene_blur;

/* What a calibration measures, in pixels of a picture of `size_px`. */
typedef struct scene_calibration {
    char *file;           /* that the numbers come from, see camera_calibration.h; NULL: from the keys */
    char *camera;         /* in the file; NULL: the only one */
    uint32_t size_px[2];  /* 0, 0: see scene_camera_calibrated_size */
    double focal_px[2];   /* 0, 0: not calibrated */
    double center_px[2];  /* from the middle of the upper left pixel; 0, 0: the middle of the picture */
    double distortion[5]; /* k1 k2 p1 p2 k3, see distortion.h; all 0: the lens bends nothing */
    double right_m;       /* no key: (file of KITTI) how far it is to the right of camera 0, whose poses KITTI has */
} scene_calibration;

/* Where a camera was, from a file; see camera_poses.h. */
typedef struct scene_poses {
    char *file;      /* NULL: none */
    uint32_t format; /* camera_poses_format */
    char *times;     /* NULL: by rate_hz */
    double rate_hz;  /* 0: frames.fps */
    uint32_t images; /* camera_poses_images */
    double scale;
    uint32_t up; /* camera_poses_up */
} scene_poses;

typedef struct scene_camera {
    double fov_deg;   /* of the picture's height, where focal_mm is 0 */
    double focal_mm;  /* focal length; 0: from fov_deg */
    double sensor_mm; /* height of the sensor */
    scene_calibration calibration;
    double near_m, far_m;
    double aperture_f;           /* f-number; 0: everything is sharp */
    double aperture_mm;          /* for the focus of streaks alone, where aperture_f is 0 */
    double focus_m;              /* 0: infinity */
    char *focus_on;              /* name of a mesh, a material or a pane; NULL: focus_m */
    scene_focus_key *focus_keys; /* by rising time; none: focus_on or focus_m at all times */
    uint32_t focus_key_count;
    uint32_t blades;
    double blade_roundness, blade_rotation_deg, cats_eye, breathing;
    uint32_t blur; /* scene_blur */
    bool bloom;    /* wet air spreads light */
    double bloom_visibility_m, bloom_drop_um;
    scene_camera_key *keys; /* by rising time; none: a path of poses, or of a speed */
    uint32_t key_count;
    scene_poses poses;
    double *speed_m_s; /* NULL: a path of keys or poses */
    double height_m, pitch_deg;
} scene_camera;

typedef struct scene_frames {
    double fps;
    uint32_t first, last; /* frame `first` is at time 0 */
    double shutter_deg;
    uint32_t size[2];
    double preroll_s; /* length of the rain before the first frame, rounded to whole frames */
    bool warm_start;  /* at least a second of it, on ground that is wet from the start */
} scene_frames;

typedef struct scene_preview {
    double exposure_ev;
    uint32_t curve; /* png_curve */
} scene_preview;

/* Where the light comes from that drops before a plate refract. */
typedef enum scene_footage_light {
    SCENE_LIGHT_OF_PLATE, /* from the plate; where environment.file is given, from that */
    SCENE_LIGHT_OF_SCENE, /* from environment */
} scene_footage_light;

/* Where the ground is that a plate shows. */
typedef enum scene_footage_ground {
    SCENE_FOOTAGE_NO_GROUND,
    SCENE_FOOTAGE_GROUND_PLANE, /* y = 0 */
    SCENE_FOOTAGE_GROUND_DEPTH, /* where --depth has it */
} scene_footage_ground;

/* What the pictures of a plate mean, see --plate. */
typedef struct scene_footage {
    uint32_t curve;            /* transfer_curve */
    char *ocio_config;         /* file; NULL: the one that the environment variable OCIO names */
    char *color_space;         /* of the config, in place of the curve; NULL: the curve */
    uint32_t light;            /* scene_footage_light */
    uint32_t ground;           /* scene_footage_ground */
    double depth_m;            /* where --depth gives none; 0: nothing is there, as in the sky */
    uint32_t depth_kind;       /* depth_map_kind */
    double depth_scale;        /* of a value; 0: by the format */
    double disparity_base_m;   /* (disparity) between the two cameras */
    double disparity_focal_px; /* (disparity) focal length in pixels of the depth's picture */
    uint32_t plate_px[2];      /* no key: size of the plate's pictures, set by who reads them; 0, 0: no plate */
} scene_footage;

/* The keys that one effect adds, see scene_schema.h. */
typedef struct scene_section scene_section;
typedef struct scene_format scene_format;

typedef struct scene_file {
    uint32_t virga; /* version of the format */
    scene_mesh *meshes;
    uint32_t mesh_count;
    scene_environment environment;
    scene_light *lights;
    uint32_t light_count;
    scene_camera camera;
    scene_frames frames;
    scene_preview preview;
    scene_footage footage;
    uint64_t hash;                 /* see scene_file_hash */
    struct scene_document *source; /* for scene_file_refuse */
    scene_format *format;          /* the format that it was loaded with */
} scene_file;                      /* settings of effects follow, see scene_file_section */

/* Loads and checks a scene. `sections` are the keys of effects; the list ends with NULL and outlives the scene.
 * `overrides` are texts like "rain.rate_mm_h=50", "frames.size=[640, 360]" or "lights.0.range_m=20", applied in order
 * before the check. The index behind a list's last adds an entry. On failure *scene is NULL and `error` gets one
 * line. */
bool scene_file_load(const char *path, const scene_section *const *sections, const char *const *overrides,
                     size_t override_count, scene_file **scene, char *error, size_t error_size);

/* Accepts NULL. */
void scene_file_free(scene_file *scene);

/* Writes one line about the value of a key ("ground.materials.0.material") that the schema can not check, in the format
 * of scene_file_load: with file and line, or with the override that set it. Returns false. */
bool scene_file_refuse(const scene_file *scene, const char *key, char *error, size_t error_size, const char *format,
                       ...) __attribute__((format(printf, 5, 6)));

/* 64-bit FNV-1a of the file's bytes, the overrides, and the bytes of the files that it names: meshes, environment,
 * material map, pictures of panes. It does not depend on where the files are. Files that a mesh includes (textures
 * beside it) are not hashed. Of each file of a sequence of particles, the size and three parts of 4096 bytes are. */
uint64_t scene_file_hash(const scene_file *scene);

/* Angle of view of the picture's height, with the focus at infinity; focal length, and diameter of the aperture. */
double scene_camera_fov_deg(const scene_file *scene);
double scene_camera_focal_m(const scene_file *scene);
double scene_camera_aperture_m(const scene_file *scene); /* 0: a pinhole */

/* Whether camera.calibration gives the angle of view. If so: the size of the picture that its numbers are for, and
 * where the camera's axis meets that picture, from its upper left corner, and how its lens bends lines. */
bool scene_camera_is_calibrated(const scene_file *scene);
void scene_camera_calibrated_size(const scene_file *scene, uint32_t size_px[2]);
void scene_camera_calibrated_center(const scene_file *scene, double center_px[2]);
distortion scene_camera_distortion(const scene_file *scene);

/* The settings of an effect: a struct of the section's size. NULL if the scene was loaded without the section. */
void *scene_file_section(const scene_file *scene, const scene_section *section);

#ifdef __cplusplus
}
#endif
#endif
