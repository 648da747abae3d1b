/* output.h - the files of a data set: where each is, whether it is there, and how it is written.
 *
 *     DIR/25mm/rain/NAME.png    the picture in rain, as the photograph is
 *     DIR/25mm/layer/NAME.exr   rain and haze alone
 *     DIR/25mm/mask/NAME.png    white where a streak is
 *     DIR/25mm/boxes/NAME.json  COCO: the picture, and an annotation for each streak; written as the last
 *     DIR/25mm/coco.json        all of them, when all are there */
#ifndef VIRGA_TOOL_DATASET_OUTPUT_H
#define VIRGA_TOOL_DATASET_OUTPUT_H

#include "dataset/list.h"
#include "dataset/streaks.h"
#include "picture.h"

/* What belongs to all pictures of a rate. */
typedef struct dataset_output {
    const char *directory;
    const dataset_list *list;
    const scene_file *scene;
    uint64_t scene_hash;
    double rate_mm_h, min_coverage;
    double haze;        /* factor of the extinction */
    char made[4][4096]; /* newest folder of each kind that is known to be there */
} dataset_output;

/* Weather and camera of one picture. */
typedef struct dataset_weather {
    double at_m[2]; /* where in the rain it is, to the east and the south */
    double wind_m_s[3];
    double speed_m_s;
} dataset_weather;

/* What the files of a picture depend on, as one number: its settings, not the bytes of the photograph. */
uint64_t dataset_hash(const dataset_output *out, uint32_t index);

/* Whether all files of a picture are there, with that hash. Only reads. */
bool dataset_is_done(const dataset_output *out, uint32_t index);

/* Writes the files of the picture that the shot has drawn at `frame`. */
bool dataset_write(dataset_output *out, shot *s, const host_camera *camera, uint32_t frame, uint32_t index,
                   picture_format format, const dataset_weather *weather, char *error, size_t error_size);

/* Joins boxes/... of all pictures to coco.json, if all are there. */
bool dataset_join(const dataset_output *out, char *error, size_t error_size);

/* coco.c. The file of one picture. */
bool coco_write(const dataset_output *out, const char *path, const shot *s, uint32_t index,
                const dataset_weather *weather, const streak *streaks, uint32_t count, char *error, size_t error_size);

/* One file of the files of all pictures, with annotations numbered anew. */
bool coco_join(const dataset_output *out, const char *path, char *error, size_t error_size);

/* Whether a file of one picture is whole and has this hash. */
bool coco_has_hash(const char *path, uint64_t hash);

/* The path of a file of a picture: kind "boxes", and its ending "json" in place of the photograph's; NULL: keeps it. */
bool dataset_path(const dataset_output *out, const char *kind, uint32_t index, const char *ending, char path[4096]);

#endif
