/* resume.h - what an earlier run has left in a folder: which of its frames can stay, and that they are the same
 * picture that would be rendered now. */
#ifndef VIRGA_TOOL_RESUME_H
#define VIRGA_TOOL_RESUME_H

#include "scene_file.h"

/* The frames that are to be in the folder in the end. */
typedef struct resume_wish {
    const scene_file *scene;
    const char *directory;
    uint32_t first, last;
    uint32_t width, height, samples, layers;
    const char *plate;           /* as given; NULL: none */
    uint32_t water_velocity;     /* percent; 0: not asked for */
    bool points, preview, stats; /* the files beside frame.%04d.exr */
} resume_wish;

/* Tells frames that are there, with all files wished for, from those to be rendered: `there` gets last - first + 1
 * flags, to be freed. Damaged pictures are told and count as absent. False, and one line in `error`, if a frame is of
 * another scene, seed, size, number of samples, choice of layers, velocities or plate. Only reads. */
bool resume_find(const resume_wish *wish, bool **there, char *error, size_t error_size);

/* Leaves in stats.jsonl one line for each frame that is there, and lines of frames that are not wished for; what is
 * torn goes. A frame that has no line is no longer there. Nothing where no stats are wished for. */
bool resume_trim_stats(const resume_wish *wish, bool *there, char *error, size_t error_size);

#endif
