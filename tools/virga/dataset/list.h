/* list.h - the pictures of folders, and what belongs to each of them. */
#ifndef VIRGA_TOOL_DATASET_LIST_H
#define VIRGA_TOOL_DATASET_LIST_H

#include "camera_calibration.h"
#include "depth_map.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef enum dataset_layout {
    DATASET_FOLDER,     /* all pictures */
    DATASET_KITTI_RAW,  /* DATE/DATE_drive_N_sync/image_0N/data/NUMBER.png and what is beside them */
    DATASET_CITYSCAPES, /* leftImg8bit/SPLIT/CITY/NAME_leftImg8bit.png and what is beside them */
} dataset_layout;

typedef struct dataset_picture {
    char *path;
    char *name;  /* below the folder that was given; of several folders, with the folder's own name before it */
    char *depth; /* NULL: none */
    char *place; /* pictures with the same place see the same rain: those of two cameras side by side */
    depth_map_def depth_def;
    bool has_depth_def, fills_depth;
    camera_calibration calibration; /* focal_px 0, 0: not known */
    double right_m;                 /* of the camera, from the place */
    double speed_m_s;               /* NAN: not known */
} dataset_picture;

typedef struct dataset_list {
    dataset_picture *pictures;
    uint32_t count;
    size_t room;
} dataset_list;

typedef struct dataset_list_def {
    const char *const *folders;
    size_t folder_count;
    const char *output; /* left out where it is in one of the folders */
    const char *depths; /* a folder with depth, named as the pictures are but for the ending; NULL: by the layout */
    dataset_layout layout;
} dataset_list_def;

/* "kitti-raw", "cityscapes"; NULL: DATASET_FOLDER. False for others. */
bool dataset_layout_parse(const char *word, dataset_layout *layout);

/* Lists pictures in the order of their names. On failure there is one line in `error`. Close it in both cases. */
bool dataset_list_open(dataset_list *list, const dataset_list_def *def, char *error, size_t error_size);
void dataset_list_close(dataset_list *list);

/* layouts.c: finds what the layout has beside a picture. */
bool dataset_layout_takes(dataset_layout layout, const char *path);
bool dataset_layout_fill(const dataset_list_def *def, dataset_picture *p, char *error, size_t error_size);

#endif
