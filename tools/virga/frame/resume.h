/* resume.h - finds the frames that an earlier run left in a folder, and checks that they match what would be rendered
 * now. */
#ifndef VIRGA_TOOL_RESUME_H
#define VIRGA_TOOL_RESUME_H

#include "picture.h"
#include "scene_file.h"

/* The frames that are to be in the folder at the end. */
typedef struct resume_request {
    const scene_file *scene;
    const char *directory;
    uint32_t first, last;
    uint32_t width, height, samples, layers;
    const char *plate, *depth, *ground_mask;      /* as given; NULL: none */
    uint32_t water_velocity;                      /* percent; 0: none */
    picture_format picture;                       /* bits 0: none */
    bool points, meshes, volumes, preview, stats; /* the files beside frame.%04d.exr */
} resume_request;

/* Finds the frames that are there with all requested files: `there` gets last - first + 1 flags, which need free().
 * Damaged pictures are reported and count as absent. False, and one line in `error`, where a frame is of another scene,
 * seed, size, number of samples, choice of layers, velocities, plate, depth or mask. Only reads. */
bool resume_find(const resume_request *request, bool **there, char *error, size_t error_size);

/* Leaves in stats.jsonl one line for each frame that is there, and lines of frames that are not requested. Damaged
 * lines are removed. A frame without a line counts as absent. Does nothing where no statistics are requested. */
bool resume_trim_stats(const resume_request *request, bool *there, char *error, size_t error_size);

#endif
