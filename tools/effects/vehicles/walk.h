/* walk.h - declares poses of a model, which it goes through as it walks, and where its feet are.
 *
 * A model has the same triangles once for each pose of a stride, which is two steps. Between poses each of its points
 * is on a smooth curve. */
#ifndef VIRGA_EFFECTS_VEHICLES_WALK_H
#define VIRGA_EFFECTS_VEHICLES_WALK_H

#include "host.h"

#ifdef __cplusplus
extern "C" {
#endif

#define WALK_MAX_POSES 32

typedef struct walk_part {
    uint32_t vertex_count;
    uint32_t first_vertex[WALK_MAX_POSES]; /* in each pose */
} walk_part;

typedef struct walk_poses {
    uint32_t pose_count; /* 0: the model has none */
    walk_part *parts;
    uint32_t part_count;
} walk_poses;

/* Takes those of a mesh whose name has `part` and a number from 0 on behind it, and leaves pose 0 alone in the mesh. */
bool walk_poses_take(host_mesh *mesh, const uint32_t *indices, const char *part, walk_poses *poses, char *error,
                     size_t error_size);
void walk_poses_free(walk_poses *poses);

/* Writes the vertices of pose 0 as they are at a part of the stride, [0; 1). `out` has all vertices of `in`. */
void walk_poses_blend(const walk_poses *poses, const host_vertex *in, double part, host_vertex *out);

/* Where the middle of a sole is, from where it is at rest: back and up (m), at a part of the stride since it landed. */
void walk_foot_at(double part, double stride_m, double offset_m[2]);

#ifdef __cplusplus
}
#endif
#endif
