/* virga/world.h - a world of your own: units, axes and projections that differ from Virga's.
 *
 * Virga has metres, right-handed axes with Y up, cameras that look along -Z, and Vulkan's clip space. A host whose
 * world has inches and Z up says so once, in a virga_world, and converts with these functions what it gives to Virga:
 *
 *     virga_world world = virga_default_world();
 *     world.metres_per_unit = 0.0254;
 *     world.up = VIRGA_AXIS_Z;
 *     world.clip = VIRGA_CLIP_GL;
 *     virga_world_camera(&world, view_matrix, projection, NULL, &view);   // as the engine has them
 *     virga_world_position(&world, player, frame.camera_m);
 *     virga_world_mesh(&world, world_from_mesh, occluder.world_from_mesh);
 *
 * They need no context and log nothing. Thread-safety: any thread. */
#ifndef VIRGA_WORLD_H
#define VIRGA_WORLD_H

#include <virga/vulkan.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef enum virga_axis {
    VIRGA_AXIS_X = 0,
    VIRGA_AXIS_Y = 1,
    VIRGA_AXIS_Z = 2,
} virga_axis;

/* The clip space of a host's projection. */
typedef enum virga_clip {
    VIRGA_CLIP_VULKAN = 0,      /* y down, depth 0 to 1 */
    VIRGA_CLIP_VULKAN_Y_UP = 1, /* y up, depth 0 to 1: with a viewport of negative height, or as in Direct3D */
    VIRGA_CLIP_GL = 2,          /* y up, depth -1 to 1 */
} virga_clip;

typedef struct virga_world {
    uint32_t size, cookie; /* set by the default function */

    /* (0; 1e6] metres in one unit of the host: 0.0254 for inches, 0.01 for centimetres. Default 1. */
    double metres_per_unit;

    /* The axis that points up. Default VIRGA_AXIS_Y. */
    virga_axis up;

    /* The axes are left-handed, as in Direct3D and Unreal. Default false. */
    bool left_handed;

    /* Default VIRGA_CLIP_VULKAN. */
    virga_clip clip;
} virga_world;

VIRGA_API virga_world virga_default_world(void);

/* Converts a position to metres and Virga's axes. With Z up and right-handed axes (x, y, z) becomes (x, z, -y); with X
 * up (-y, x, z). Left-handed axes get the opposite z after that. VIRGA_ERROR_INVALID: NULL, or a wrong virga_world. */
VIRGA_API virga_result virga_world_position(const virga_world *world, const double position[3], double position_m[3]);

/* Converts a direction or a velocity direction: the axes only, no unit. Errors as virga_world_position. */
VIRGA_API virga_result virga_world_direction(const virga_world *world, const float direction[3], float out[3]);

/* Converts a mesh's matrix (3 x 4, row-major, mesh to the host's world) for virga_occluder.world_from_mesh. The
 * vertices stay as they are. Errors as virga_world_position. */
VIRGA_API virga_result virga_world_mesh(const virga_world *world, const float world_from_mesh[12], float out[12]);

/* Sets the camera of a view: position_m, view_from_world, clip_from_view and reversed_depth; and the open camera to the
 * same, see virga_world_open_camera.
 *
 * `view_from_world` and `clip_from_view` are the host's matrices, column-major, for positions in its units. The view
 * may look along -z or +z, and its axes may have either hand. `position` is that of the camera in the host's world;
 * NULL: it is taken from view_from_world, whose floats are coarse far from the origin.
 *
 * VIRGA_ERROR_INVALID, and nothing changes: NULL, a wrong virga_world, or a projection whose w is not along z, as that
 * of an orthographic camera. */
VIRGA_API virga_result virga_world_camera(const virga_world *world, const float view_from_world[16],
                                          const float clip_from_view[16], const double *position, virga_view *view);

/* The same for the open camera, after virga_world_camera: open_position_m, open_view_from_world and
 * open_clip_from_view. */
VIRGA_API virga_result virga_world_open_camera(const virga_world *world, const float view_from_world[16],
                                               const float clip_from_view[16], const double *position,
                                               virga_view *view);

#ifdef __cplusplus
}
#endif
#endif
