/* calls_axes.c - random calls of the functions that convert a host's own units and axes. */
#include "calls.h"
#include "calls_list.h"

static void fill_world(calls *c, virga_world *out)
{
    static const calls_member kept[] = {CALLS_BOOL(virga_world, left_handed)};
    *out = virga_default_world();
    out->metres_per_unit = calls_once_in(c, 2) ? 0.0254 : 1;
    out->up = (virga_axis)calls_below(c, 3);
    out->left_handed = calls_once_in(c, 2);
    out->clip = (virga_clip)calls_below(c, 3);
    CALLS_WILD(c, out, kept);
}

void call_virga_default_world(calls *c)
{
    if (virga_default_world().size != sizeof(virga_world))
        calls_wrong(c, __func__, "has the wrong size");
}

void call_virga_world_position(calls *c)
{
    virga_world world;
    double position[3], out[3];
    fill_world(c, &world);
    calls_doubles(c, position, 3, -100, 100);
    CALLS_TRY(c, 0, CALLS_SILENT, virga_world_position, calls_slip(c, 12) ? NULL : &world,
              calls_slip(c, 12) ? NULL : position, calls_slip(c, 12) ? NULL : out);
}

void call_virga_world_direction(calls *c)
{
    virga_world world;
    float direction[3], out[3];
    fill_world(c, &world);
    calls_floats(c, direction, 3, -1, 1);
    CALLS_TRY(c, 0, CALLS_SILENT, virga_world_direction, calls_slip(c, 12) ? NULL : &world,
              calls_slip(c, 12) ? NULL : direction, calls_slip(c, 12) ? NULL : out);
}

void call_virga_world_mesh(calls *c)
{
    virga_world world;
    float matrix[12], out[12];
    fill_world(c, &world);
    calls_floats(c, matrix, 12, -2, 2);
    CALLS_TRY(c, 0, CALLS_SILENT, virga_world_mesh, calls_slip(c, 12) ? NULL : &world,
              calls_slip(c, 12) ? NULL : matrix, calls_slip(c, 12) ? NULL : out);
}

#define CAMERA(name)                                                                                               \
    void call_virga_world_##name(calls *c)                                                                         \
    {                                                                                                              \
        virga_world world;                                                                                         \
        virga_view view, out = virga_default_view();                                                               \
        double position[3];                                                                                        \
        fill_world(c, &world);                                                                                     \
        calls_fill_view(c, &view);                                                                                 \
        calls_doubles(c, position, 3, -100, 100);                                                                  \
        CALLS_TRY(c, 0, CALLS_SILENT, virga_world_##name, calls_slip(c, 12) ? NULL : &world,                       \
                  calls_slip(c, 12) ? NULL : view.view_from_world, calls_slip(c, 12) ? NULL : view.clip_from_view, \
                  calls_once_in(c, 2) ? NULL : position, calls_slip(c, 12) ? NULL : &out);                         \
    }
CAMERA(camera)
CAMERA(open_camera)
