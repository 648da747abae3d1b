/* ground/ground_far.c - the distant map: ground beyond the window. Its cells have eight times the side of the window's
 * cells. They store no water of their own: they show how much a cell that stood in the rain would hold, see
 * standing.c. */
#include "ground/ground_internal.h"

#include "gpu/record.h"
#include "gpu/timers.h"

#include <math.h>
#include <stdlib.h>

#define STEP      32 /* far cells: the map moves by one step when the camera is more than one step off its middle */
#define MAP_TICKS 15 /* ticks between two updates of the map, whose contents change over minutes */

static double cell_m(const virga_ground *ground)
{
    return VIRGA_GROUND_FAR_CELL * (double)ground->def.cell_m;
}

/* Half the side of the map, minus the largest distance of the camera from its middle (m). */
static double reach_m(const virga_ground *ground)
{
    return ((double)ground->def.far_cells / 2 - 1.5 * STEP) * cell_m(ground);
}

bool ground_far_follow(virga_ground *ground, const double camera_m[3])
{
    ground_far *far = &ground->far;
    int32_t low[2];
    bool moves = !far->is_placed;
    if (!ground->def.far_cells)
        return false;
    for (int axis = 0; axis < 2; axis++) {
        const double max = INT32_MAX / STEP / VIRGA_GROUND_FAR_CELL - 2.0 * ground->def.far_cells;
        const double at = floor(camera_m[axis * 2] / (STEP * cell_m(ground)));
        low[axis] = (int32_t)fmin(fmax(at, -max), max) * STEP - (int32_t)ground->def.far_cells / 2;
        moves = moves || abs(low[axis] - far->low[axis]) > STEP;
    }
    if (moves) {
        far->low[0] = low[0];
        far->low[1] = low[1];
    }
    far->is_placed = true;
    return moves;
}

void ground_far_draw_heights(virga_ground *ground, VkCommandBuffer cmd, const virga_ground_step_info *info)
{
    ground_far *far = &ground->far;
    const uint32_t cells = ground->def.far_cells;
    virga_map_view view = {.half_m = 0.5 * cells * cell_m(ground),
                           .height_m = GROUND_HEIGHT_MAP_DEPTH_M,
                           .top_m = GROUND_HEIGHT_MAP_TOP_M};
    for (int axis = 0; axis < 2; axis++)
        view.origin_m[axis * 2] = far->low[axis] * cell_m(ground) + view.half_m;
    view.origin_m[1] = ground->base_m;
    view.still_only = true;
    for (uint32_t layer = 0; layer < 2; layer++) {
        view.ground_only = layer == 0;
        virga_mesh_map_draw(ground->base.context, cmd, far->height_map, layer, &view, info->meshes, info->mesh_count);
    }
    virga_dispatch(ground->base.context, cmd, far->floor_pass, cells * cells / VIRGA_GROUND_GROUP);
    virga_compute_barrier(ground->base.context, cmd);
    far->drawn = false;
    ground->base.journal.doing |= GROUND_DID_FAR_HEIGHTS;
}

bool ground_far_is_due(const virga_ground *ground)
{
    return !ground->far.drawn || ground->ticks - ground->far.drawn_at >= MAP_TICKS;
}

void ground_far_draw(virga_ground *ground, VkCommandBuffer cmd, bool due)
{
    static const virga_image_state anything = {VK_IMAGE_LAYOUT_UNDEFINED, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, 0};
    static const virga_image_state written = {VK_IMAGE_LAYOUT_GENERAL, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT,
                                              VK_ACCESS_SHADER_WRITE_BIT};
    virga_context *context = ground->base.context;
    ground_far *far = &ground->far;
    const uint32_t cells = ground->def.far_cells;
    const virga_pass_scope scope = virga_pass_begin(context, cmd, "ground.far");
    if (far->is_uncertain)
        virga_image_barrier(context, cmd, far->map->image, VK_IMAGE_ASPECT_COLOR_BIT, anything, written);
    virga_dispatch(context, cmd, far->draw, cells * cells / VIRGA_GROUND_GROUP + 1);
    virga_pass_end(context, cmd, scope);
    if (!due)
        return;
    far->drawn = true;
    ground->base.journal.doing |= GROUND_DID_FAR_MAP;
    far->drawn_at = ground->ticks;
}

void ground_far_fill(const virga_ground *ground, virga_ground_tick_gpu *out)
{
    const virga_ground_material_map *materials = &ground->info.materials;
    const ground_far *far = &ground->far;
    out->far_cells = ground->def.far_cells;
    for (int axis = 0; axis < 2; axis++) {
        const double corner = far->low[axis] * cell_m(ground), size = materials->high_m[axis] - materials->low_m[axis];
        const bool given = materials->image.view && size > 0;
        out->far_low[axis] = far->low[axis];
        out->far_material_offset[axis] = given ? (float)((corner - materials->low_m[axis]) / size) : -1;
        out->far_camera[axis] = (float)((ground->info.camera_m[axis * 2] - corner) / cell_m(ground));
        out->far_even[axis] = (float)((0.3 + 0.6 * axis) * reach_m(ground) / cell_m(ground));
    }
}

void ground_far_maps(const virga_ground *ground, virga_ground_maps *maps)
{
    maps->far_wetness = ground->far.map->layer_views[0];
    maps->far_cells = ground->def.far_cells;
    maps->far_cell_m = (float)cell_m(ground);
    for (int axis = 0; axis < 2; axis++)
        maps->far_low_m[axis] = ground->far.low[axis] * cell_m(ground);
}
