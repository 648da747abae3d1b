/* renderer_draw.c - records a plate: the maps of the skylight, the mirror, and the scene. */
#include <float.h>
#include <math.h>
#include <string.h>

#include "accumulate.h"
#include "renderer_internal.h"

#define MIRROR_STEP_PX  1.0
#define CLIMB_NEAR_M    (HOST_CONTACT_NEAR_M + HOST_CONTACT_STEP_M) /* the map moves in steps */
#define CONTACT_PLANE_M 0.5   /* ground that is farther off its mean plane has hills */
#define MIN_ROUGHNESS   0.04f /* below, highlights of point lights fall between pixels */

/* ---- meshes ------------------------------------------------------------------------------------------------- */

/* Updates the uniforms in the command buffer, so that it can have several plates. */
static void record_frame(const host_renderer *r, VkCommandBuffer cmd, const struct host_frame_gpu *frame)
{
    host_buffer_update(cmd, &r->frame_buffer, frame, sizeof *frame,
                       VK_PIPELINE_STAGE_VERTEX_SHADER_BIT | VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT,
                       VK_ACCESS_UNIFORM_READ_BIT);
}

static void bind_frame(const host_renderer *r, VkCommandBuffer cmd)
{
    vkCmdBindDescriptorSets(cmd, VK_PIPELINE_BIND_POINT_GRAPHICS, r->bindings.layout, 0, 1, r->bindings.sets, 0, NULL);
}

static void fill_surface(const host_primitive *primitive, const host_material *material, uint32_t id, uint32_t lamps,
                         struct host_surface_gpu *out)
{
    float bits = 0.0f;
    memset(out, 0, sizeof *out);
    bits += material->base_texture >= 0 ? HOST_HAS_BASE_TEXTURE : 0;
    bits += material->emissive_texture >= 0 ? HOST_HAS_EMISSIVE_TEXTURE : 0;
    bits += material->alpha == HOST_ALPHA_GLASS ? HOST_IS_GLASS : 0;
    bits += material->joints ? HOST_HAS_JOINTS : 0;
    bits += primitive->ground ? HOST_GROUND * (1 + primitive->surface) : 0;
    memcpy(out->base_color, material->base_color, sizeof out->base_color);
    memcpy(out->emissive, material->emissive, 3 * sizeof(float));
    out->emissive[3] = fmaxf(material->roughness, MIN_ROUGHNESS);
    out->traits[0] = material->metallic;
    out->traits[1] = material->cutoff;
    out->traits[2] = (float)id;
    out->traits[3] = bits;
    out->lamps[0] = (float)lamps;
    out->lamps[1] = (float)host_wall_material(primitive, material);
    out->lamps[2] = material->alpha == HOST_ALPHA_GLASS ? 0 : material->passes;
}

/* Whether a pipeline draws a material. */
static bool is_drawn_by(const host_material *material, host_pipeline kind)
{
    switch (kind) {
    case HOST_PIPELINE_DEPTH:
    case HOST_PIPELINE_ID: return material->alpha == HOST_ALPHA_OPAQUE;
    case HOST_PIPELINE_CUTOUT:
    case HOST_PIPELINE_CUTOUT_ID: return material->alpha == HOST_ALPHA_MASK;
    case HOST_PIPELINE_SHADE:
    case HOST_PIPELINE_DATA: return material->alpha != HOST_ALPHA_GLASS && material->alpha != HOST_ALPHA_SWEPT;
    case HOST_PIPELINE_GLASS: return material->alpha == HOST_ALPHA_GLASS;
    case HOST_PIPELINE_SWEPT:
    case HOST_PIPELINE_SWEPT_DATA:
    case HOST_PIPELINE_SWEPT_DEPTH:
    case HOST_PIPELINE_SWEPT_ID: return material->alpha == HOST_ALPHA_SWEPT;
    case HOST_PIPELINE_FOOTAGE: return true;
    default: return false;
    }
}

/* What is bound while the plate or the mirror is drawn, and whether a pipeline could not be built. */
typedef struct drawing {
    host_renderer *renderer;
    VkCommandBuffer cmd;
    VkRenderPass pass; /* of the plate or of the mirror */
    VkPipeline bound;
    const host_cull *cull; /* NULL: all is drawn */
    bool still;            /* without what moves */
    bool failed;
    char *error;
    size_t error_size;
} drawing;

static bool is_mirror(const drawing *d)
{
    return d->pass == d->renderer->mirror.pass;
}

static bool bind(drawing *d, host_pipeline kind, bool two_sided)
{
    VkPipeline pipeline;
    if (d->failed ||
        !host_renderer_pipeline(d->renderer, d->pass, kind, two_sided, &pipeline, d->error, d->error_size)) {
        d->failed = true;
        return false;
    }
    if (d->bound != pipeline)
        vkCmdBindPipeline(d->cmd, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
    d->bound = pipeline;
    return true;
}

static void draw_indices(drawing *d, host_pipeline kind, bool two_sided, uint32_t first, uint32_t count)
{
    if (count && bind(d, kind, two_sided))
        vkCmdDrawIndexed(d->cmd, count, 1, first, 0, 0);
}

/* Whether the contact map, where the ground's height is looked up for water that climbs, may reach a primitive. */
static bool is_near(const host_renderer *r, const host_mesh *mesh, const host_primitive *primitive)
{
    const float *low, *high;
    bool near = true;
    if (!host_mesh_bounds(mesh, primitive, &low, &high))
        return true;
    for (int axis = 0; axis < 3; axis += 2)
        near = near && (double)low[axis] < r->cull.eye_m[axis] + CLIMB_NEAR_M &&
               (double)high[axis] > r->cull.eye_m[axis] - CLIMB_NEAR_M;
    return near;
}

/* Triangles of one kind: those that begin near the ground, and the others, of both pipelines. */
static void draw_by_feet(drawing *d, const host_mesh *mesh, const host_primitive *primitive, uint32_t first,
                         uint32_t count, const host_pipeline kinds[2])
{
    const host_renderer *r = d->renderer;
    const bool two_sided = mesh->materials[primitive->material].two_sided;
    uint32_t low = 0;
    if (r->foot_m > -DBL_MAX && is_near(r, mesh, primitive))
        low = host_mesh_low_count(mesh, primitive, first, count, (float)r->foot_m);
    draw_indices(d, kinds[0], two_sided, primitive->first_index + first, low);
    draw_indices(d, kinds[1], two_sided, primitive->first_index + first + low, count - low);
}

/* Smaller shaders come to the same bits where it is told from the triangles what they have no need for. */
static void shade_primitive(drawing *d, const host_mesh *mesh, const host_primitive *primitive,
                            const host_material *material)
{
    static const host_pipeline level_kinds[2] = {HOST_PIPELINE_FOOT, HOST_PIPELINE_SHADE};
    static const host_pipeline steep_kinds[2] = {HOST_PIPELINE_DRY_FOOT, HOST_PIPELINE_DRY};
    const uint32_t first = primitive->first_index, count = primitive->index_count;
    const uint32_t ground = primitive->ground_count, level = primitive->level_count;
    const bool two_sided = material->two_sided;
    if (is_mirror(d)) {
        draw_indices(d, HOST_PIPELINE_SHADE, two_sided, first, count);
    } else if (material->passes > 0) {
        draw_indices(d, HOST_PIPELINE_CLOTH, two_sided, first, count);
    } else if (!d->renderer->ground.cells) {
        draw_indices(d, HOST_PIPELINE_DRY, two_sided, first, count);
    } else {
        if (primitive->ground)
            draw_indices(d, HOST_PIPELINE_GROUND, two_sided, first, ground);
        else /* a scene says that it is none */
            draw_by_feet(d, mesh, primitive, 0, ground, level_kinds);
        draw_by_feet(d, mesh, primitive, ground, level - ground, level_kinds);
        draw_by_feet(d, mesh, primitive, level, count - level, steep_kinds);
    }
}

/* Glass stays in its order: either none of it is wet, or all may be. */
static void draw_primitive(drawing *d, const host_mesh *mesh, const host_primitive *primitive,
                           const host_material *material, host_pipeline kind)
{
    if (kind == HOST_PIPELINE_SHADE) {
        shade_primitive(d, mesh, primitive, material);
        return;
    }
    const bool dry = !is_mirror(d) && !(d->renderer->ground.cells && primitive->level_count);
    draw_indices(d, kind == HOST_PIPELINE_GLASS && dry ? HOST_PIPELINE_DRY_GLASS : kind, material->two_sided,
                 primitive->first_index, primitive->index_count);
}

static bool is_hidden(const drawing *d, const host_mesh *mesh, const host_primitive *primitive)
{
    const float *low, *high;
    return d->cull && host_mesh_bounds(mesh, primitive, &low, &high) && host_cull_hides(d->cull, low, high);
}

/* As which a primitive is drawn. */
static uint32_t id_of(const host_entry *entry, uint32_t primitive, host_pipeline kind)
{
    const bool shares = kind == HOST_PIPELINE_ID || kind == HOST_PIPELINE_CUTOUT_ID;
    if (kind == HOST_PIPELINE_SWEPT_ID)
        return HOST_REUSE_SWEPT;
    return shares && entry->mesh->moves ? HOST_REUSE_MOVES : entry->first_id + primitive;
}

static void draw_entry(drawing *d, const host_entry *entry, host_pipeline kind)
{
    const host_renderer *r = d->renderer;
    const host_mesh *mesh = entry->mesh;
    const VkDeviceSize offset = 0;
    vkCmdBindVertexBuffers(d->cmd, 0, 1, &mesh->vertices.buffer, &offset);
    vkCmdBindIndexBuffer(d->cmd, mesh->indices.buffer, 0, VK_INDEX_TYPE_UINT32);
    for (uint32_t i = 0; i < mesh->primitive_count; i++) {
        const host_primitive *primitive = &mesh->primitives[i];
        const host_material *material = &mesh->materials[primitive->material];
        if (!is_drawn_by(material, kind) || is_hidden(d, mesh, primitive))
            continue;
        struct host_surface_gpu surface;
        fill_surface(primitive, material, id_of(entry, i, kind), host_renderer_lamps(r, mesh, primitive), &surface);
        vkCmdPushConstants(d->cmd, r->bindings.layout, VK_SHADER_STAGE_FRAGMENT_BIT, 0, sizeof surface, &surface);
        vkCmdBindDescriptorSets(d->cmd, VK_PIPELINE_BIND_POINT_GRAPHICS, r->bindings.layout, 1, 1,
                                &entry->sets[primitive->material], 0, NULL);
        draw_primitive(d, mesh, primitive, material, kind);
    }
}

static void draw_entries(drawing *d, host_pipeline kind)
{
    const host_renderer *r = d->renderer;
    for (uint32_t i = 0; i < r->entry_count; i++) {
        const host_mesh *mesh = r->entries[i].mesh;
        if (!(mesh->apart && (is_mirror(d) || d->still)) && !(mesh->moves && d->still))
            draw_entry(d, &r->entries[i], kind);
    }
}

static void draw_depth(drawing *d)
{
    draw_entries(d, HOST_PIPELINE_DEPTH);
    draw_entries(d, HOST_PIPELINE_CUTOUT);
}

/* Where the depth is that of draw_depth. */
static void shade(drawing *d)
{
    const host_renderer *r = d->renderer;
    const bool data_only = r->parts == HOST_PLATE_DATA;
    draw_entries(d, data_only ? HOST_PIPELINE_DATA : HOST_PIPELINE_SHADE);
    if (r->footage)
        vkCmdBindDescriptorSets(d->cmd, VK_PIPELINE_BIND_POINT_GRAPHICS, r->bindings.layout, 1, 1, &r->footage_set, 0,
                                NULL);
    if (bind(d, r->footage ? HOST_PIPELINE_FOOTAGE_MIRROR : HOST_PIPELINE_SKY, true))
        vkCmdDraw(d->cmd, 3, 1, 0, 0);
    if (!data_only)
        draw_entries(d, HOST_PIPELINE_GLASS);
}

static void draw_scene(drawing *d)
{
    draw_depth(d);
    if (d->renderer->parts != HOST_PLATE_DEPTH)
        shade(d);
}

/* ---- skylight ----------------------------------------------------------------------------------------------- */

/* Of all that stands still. */
static void find_bounds(const host_renderer *r, float low[3], float high[3])
{
    for (int c = 0; c < 3; c++) {
        low[c] = FLT_MAX;
        high[c] = -FLT_MAX;
        for (uint32_t i = 0; i < r->entry_count; i++) {
            const host_mesh *mesh = r->entries[i].mesh;
            if (mesh->apart || mesh->moves)
                continue;
            low[c] = fminf(low[c], mesh->low[c]);
            high[c] = fmaxf(high[c], mesh->high[c]);
        }
        if (low[c] > high[c]) { /* nothing does */
            low[c] = -1.0f;
            high[c] = 1.0f;
        }
    }
}

enum { DRAW_CUTOUTS = 1, DRAW_NO_LEAVES = 2, DRAW_GROUND = 4, DRAW_NO_GROUND = 8, DRAW_MOVING = 16 };

/* Thin cloth and leaves let a part T of the sky's light through (KHR_materials_diffuse_transmission: T of the
 * irradiance comes out below, the same to all sides; under an even sky that is the sky itself, T times as bright). A
 * depth map has all or nothing, so they are left out of the maps of a share T of the directions: the k-th whose k
 * sqrt(3) has a fractional part below T. Such multiples are even over each part of the sky (Weyl; sqrt(3), as the
 * directions turn by the golden angle and another ratio must not repeat it). It is T to 0.045, by adding up the cosines
 * of the 40 directions for each T. */
static double share_number(uint32_t direction)
{
    const double all = (direction + 0.5) * 1.7320508075688772;
    return all - floor(all);
}

/* Draws everything but glass into a depth map, of one direction of the sky or of the rain; not what lets more than the
 * share `light` of the sky's light through. */
static void draw_map(const host_renderer *r, VkCommandBuffer cmd, const float map_from_world[16], int parts,
                     double light)
{
    const host_skylight *s = &r->skylight;
    const VkDeviceSize offset = 0;
    vkCmdBindPipeline(cmd, VK_PIPELINE_BIND_POINT_GRAPHICS, parts & DRAW_CUTOUTS ? s->cutout : s->opaque);
    host_skylight_push(s, cmd, map_from_world, 1.0f, 0.0f);
    for (uint32_t e = 0; e < r->entry_count; e++) {
        const host_entry *entry = &r->entries[e];
        const host_mesh *mesh = entry->mesh;
        if (mesh->apart || mesh->moves != ((parts & DRAW_MOVING) != 0))
            continue;
        vkCmdBindVertexBuffers(cmd, 0, 1, &mesh->vertices.buffer, &offset);
        vkCmdBindIndexBuffer(cmd, mesh->indices.buffer, 0, VK_INDEX_TYPE_UINT32);
        for (uint32_t i = 0; i < mesh->primitive_count; i++) {
            const host_primitive *primitive = &mesh->primitives[i];
            const host_material *material = &mesh->materials[primitive->material];
            if (!is_drawn_by(material, parts & DRAW_CUTOUTS ? HOST_PIPELINE_CUTOUT : HOST_PIPELINE_DEPTH) ||
                (double)material->sky_passes > light ||
                ((parts & DRAW_NO_LEAVES) && primitive->surface == VIRGA_MATERIAL_LEAVES) ||
                (parts & (primitive->ground ? DRAW_NO_GROUND : DRAW_GROUND)))
                continue;
            if (parts & DRAW_CUTOUTS) {
                host_skylight_push(s, cmd, map_from_world, material->base_color[3], material->cutoff);
                vkCmdBindDescriptorSets(cmd, VK_PIPELINE_BIND_POINT_GRAPHICS, s->draw_layout, 0, 1,
                                        &entry->sets[primitive->material], 0, NULL);
            }
            vkCmdDrawIndexed(cmd, primitive->index_count, 1, primitive->first_index, 0, 0);
        }
    }
}

static void update_skylight(host_renderer *r, VkCommandBuffer cmd, const host_camera *camera)
{
    float low[3], high[3];
    find_bounds(r, low, high);
    if (!host_skylight_place(&r->skylight, camera->position_m, low, high))
        return;
    host_label_begin(r->device, cmd, "skylight");
    host_skylight_begin(&r->skylight, cmd);
    for (uint32_t i = 0; i < HOST_SKYLIGHT_DIRECTIONS; i++) {
        host_skylight_begin_map(&r->skylight, cmd, i);
        draw_map(r, cmd, r->skylight.gpu.map_from_world[i], 0, share_number(i));
        draw_map(r, cmd, r->skylight.gpu.map_from_world[i], DRAW_CUTOUTS, share_number(i));
        host_skylight_end_map(&r->skylight, cmd);
    }
    host_skylight_gather(&r->skylight, cmd);
    host_label_end(r->device, cmd);
}

/* Without walls the map is cleared once, because the plate's shaders need it in its layout. */
static void update_shelter(host_renderer *r, VkCommandBuffer cmd, const host_camera *camera)
{
    host_shelter *s = &r->shelter;
    float low[3], high[3];
    find_bounds(r, low, high);
    if (!s->slice.framebuffer || (!r->has_walls && s->ready) ||
        (r->has_walls && !host_shelter_place(s, &r->walls, camera, (double)low[1], (double)high[1])))
        return;
    host_label_begin(r->device, cmd, "shelter");
    host_shelter_begin(s, cmd, r->skylight.pass);
    if (r->has_walls)
        draw_map(r, cmd, s->map_from_world, DRAW_NO_LEAVES, 1); /* these let rain through, soon as drips */
    host_shelter_end(s, cmd);
    host_label_end(r->device, cmd);
}

/* The lowest and the highest point of ground within `near_m` of the camera on the map; of all ground if there is none.
 */
static void find_ground(const host_renderer *r, const double camera_m[3], double near_m, double heights_m[2])
{
    double found[2][2] = {{DBL_MAX, -DBL_MAX}, {DBL_MAX, -DBL_MAX}}; /* of all, and near */
    for (uint32_t e = 0; e < r->entry_count; e++)
        for (uint32_t i = 0; i < r->entries[e].mesh->primitive_count; i++) {
            const host_primitive *p = &r->entries[e].mesh->primitives[i];
            bool near = true;
            for (int axis = 0; axis < 3; axis += 2)
                near = near && (double)p->low[axis] < camera_m[axis] + near_m &&
                       (double)p->high[axis] > camera_m[axis] - near_m;
            for (int set = 0; p->ground && set < 1 + near; set++) {
                found[set][0] = fmin(found[set][0], (double)p->low[1]);
                found[set][1] = fmax(found[set][1], (double)p->high[1]);
            }
        }
    const double *best = found[1][0] <= found[1][1] ? found[1] : found[0];
    for (int i = 0; i < 2; i++)
        heights_m[i] = best[0] <= best[1] ? best[i] : 0;
}

/* Area of a part of the ground within `near_m` of a place; 0 for others. */
static double area_near(const host_primitive *p, const double at_m[3], double near_m)
{
    double area = p->ground ? 1 : 0;
    for (int k = 0; k < 3; k += 2) {
        const double low = (double)p->low[k], high = (double)p->high[k];
        area *= low < at_m[k] + near_m && high > at_m[k] - near_m ? high - low : 0;
    }
    return area;
}

/* The mean of the ground's parts near a place, by their areas: its middle and its slope. */
static void mean_ground(const host_renderer *r, const double at_m[3], double middle_m[3], double slope[2])
{
    double sum[6] = {0};
    for (uint32_t e = 0; e < r->entry_count; e++)
        for (uint32_t i = 0; i < r->entries[e].mesh->primitive_count; i++) {
            const host_primitive *p = &r->entries[e].mesh->primitives[i];
            const double area = area_near(p, at_m, HOST_CONTACT_NEAR_M);
            for (int k = 0; k < 3; k++)
                sum[k] += area * (double)p->middle[k];
            for (int k = 0; k < 2; k++)
                sum[3 + k] += area * (double)p->slope[k];
            sum[5] += area;
        }
    for (int k = 0; k < 5; k++)
        sum[k] /= sum[5] > 0 ? sum[5] : 1;
    memcpy(middle_m, sum, 3 * sizeof *sum);
    memcpy(slope, sum + 3, 2 * sizeof *sum);
}

/* How far from that plane the ground near a place is, at most. */
static double off_plane(const host_renderer *r, const double at_m[3], const double middle_m[3], const double slope[2])
{
    double most_m = 0;
    for (uint32_t e = 0; e < r->entry_count; e++)
        for (uint32_t i = 0; i < r->entries[e].mesh->primitive_count; i++) {
            const host_primitive *p = &r->entries[e].mesh->primitives[i];
            const double plane_m = middle_m[1] + slope[0] * ((double)p->middle[0] - middle_m[0]) +
                                   slope[1] * ((double)p->middle[2] - middle_m[2]);
            if (area_near(p, at_m, HOST_CONTACT_NEAR_M) > 0)
                most_m = fmax(most_m, (double)p->off + fabs((double)p->middle[1] - plane_m));
        }
    return most_m;
}

/* The plane of the ground around the camera, or none on hills. It changes where the map may move, as it is made anew
 * then. */
static void tilt_contact(host_renderer *r, const double camera_m[3])
{
    double at_m[3], middle_m[3], slope[2];
    for (int k = 0; k < 3; k++)
        at_m[k] = floor(camera_m[k] / HOST_CONTACT_STEP_M + 0.5) * HOST_CONTACT_STEP_M;
    mean_ground(r, at_m, middle_m, slope);
    if (off_plane(r, at_m, middle_m, slope) > CONTACT_PLANE_M)
        slope[0] = slope[1] = 0;
    host_contact_tilt(&r->contact, middle_m, slope);
}

/* Around what moves by itself on the map. */
static host_contact_box moving_on_contact(const host_renderer *r)
{
    host_contact_box box = host_contact_no_box();
    for (uint32_t e = 0; e < r->entry_count; e++) {
        const host_mesh *mesh = r->entries[e].mesh;
        if (mesh->moves)
            host_contact_add(&r->contact, mesh->low, mesh->high, 1 + e, &box);
    }
    return box;
}

/* Only wet ground has it. Sub-frames of a frame share it, wherever things are at their times. */
static void update_contact(host_renderer *r, VkCommandBuffer cmd, const host_camera *camera)
{
    static const int parts[HOST_CONTACT_MAPS] = {[HOST_CONTACT_GROUND] = DRAW_GROUND,
                                                 [HOST_CONTACT_UNDER] = DRAW_NO_GROUND,
                                                 [HOST_CONTACT_OVER] = DRAW_NO_GROUND,
                                                 [HOST_CONTACT_MOVING_UNDER] = DRAW_NO_GROUND | DRAW_MOVING,
                                                 [HOST_CONTACT_MOVING_OVER] = DRAW_NO_GROUND | DRAW_MOVING};
    float low[3], high[3], map_from_world[16];
    double ground_m[2];
    find_bounds(r, low, high);
    find_ground(r, camera->position_m, HOST_CONTACT_NEAR_M, ground_m);
    if (!r->ground.cells || !r->has_contact)
        return;
    uint32_t moving_count = 0;
    for (uint32_t e = 0; e < r->entry_count; e++) {
        if (!r->entries[e].mesh->moves)
            continue;
        high[1] = fmaxf(high[1], ceilf(r->entries[e].mesh->high[1])); /* not in the bounds; whole metres, as it bobs */
        moving_count++;
    }
    tilt_contact(r, camera->position_m);
    const bool placed = host_contact_place(&r->contact, camera, ground_m, (double)high[1], moving_count);
    const host_contact_box moving = moving_on_contact(r);
    const bool moved = memcmp(moving.places, r->contact.moved.places, sizeof moving.places) != 0;
    if (!placed && (!moved || camera->sample > 0))
        return;
    host_label_begin(r->device, cmd, "contact");
    for (int i = placed ? 0 : HOST_CONTACT_MOVING_UNDER; i < HOST_CONTACT_MAPS; i++) {
        host_contact_begin(&r->contact, cmd, r->skylight.pass, (host_contact_map)i);
        for (uint32_t look = 0; look < host_contact_looks((host_contact_map)i); look++) {
            host_contact_look(&r->contact, (host_contact_map)i, look, map_from_world);
            draw_map(r, cmd, map_from_world, parts[i], 1);
        }
        host_contact_end(cmd);
    }
    host_contact_gather(&r->contact, cmd, placed, &moving);
    host_label_end(r->device, cmd);
}

/* ---- the plate ---------------------------------------------------------------------------------------------- */

/* The mirrored view, as in shaders/scene.vert and mirror_jitter.glsl. */
static virga_view view_of_mirror(const host_renderer *r, const host_camera *camera)
{
    virga_view view = virga_default_view();
    const float sides[2] = {(float)r->mirror.width, (float)r->mirror.height};
    const float plate[2] = {(float)camera->width, (float)camera->height}, small = 1.0f / HOST_MIRROR_MARGIN;
    host_camera_view(camera, camera, 0, &view);
    view.position_m[1] = 2 * r->mirror_m - camera->position_m[1];
    view.open_position_m[1] = view.position_m[1];
    for (int row = 0; row < 3; row++)
        view.view_from_world[4 + row] = view.open_view_from_world[4 + row] = -camera->view_from_world[4 + row];
    for (int axis = 0; axis < 2; axis++) {
        const float jitter = camera->jitter_px[axis] * (2.0f / sides[axis] - 2.0f * small / plate[axis]);
        view.clip_from_view[axis * 5] *= small;
        view.clip_from_view[8 + axis] = view.clip_from_view[8 + axis] * small - jitter; /* times -w */
        view.viewport[2 + axis] = sides[axis];
    }
    memcpy(view.open_clip_from_view, view.clip_from_view, sizeof view.clip_from_view);
    view.depth = (virga_image){
        .image = r->mirror.depth.image,
        .view = r->mirror.depth.view,
        .format = r->mirror.depth.format,
        .extent = {r->mirror.width, r->mirror.height, 1},
        .before = {VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL, VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT,
                   VK_ACCESS_SHADER_READ_BIT},
    };
    return view;
}

static void record_mirror_haze(const host_renderer *r, VkCommandBuffer cmd, const host_camera *camera)
{
    const double plane[4] = {0, 1, 0, r->mirror_m};
    const virga_view view = view_of_mirror(r, camera);
    host_mirror_begin_haze(&r->mirror, cmd);
    r->draw_haze(r->haze_user, cmd, &view, plane);
    vkCmdEndRenderPass(cmd);
}

/* Sub-frames that look into one picture of the mirror. Water blurs its detail. What moves in it must be as smooth as
 * the same in front of it: from one picture to the next it goes no farther than a pixel. */
static uint32_t mirror_share(const host_renderer *r, const host_camera *camera)
{
    const uint32_t share = host_accumulator_share(camera->samples);
    double most_px = 0;
    for (uint32_t i = 0; i < r->entry_count; i++)
        most_px = fmax(most_px, host_moving_travel_px(r->entries[i].mesh, camera));
    return most_px * share <= camera->samples * MIRROR_STEP_PX ? share : 1;
}

/* The sub-frame's camera with a jitter of its own: those of every second or fourth sub-frame are alike. */
static host_camera mirror_camera(const host_camera *camera, uint32_t share)
{
    host_camera own = *camera;
    const float sides[2] = {(float)camera->width, (float)camera->height};
    if (share == 1)
        return own;
    host_camera_jitter(camera->sample / share, camera->samples / share, own.jitter_px);
    for (int axis = 0; axis < 2; axis++)
        own.clip_from_view[8 + axis] = own.clip_from_view_plain[8 + axis] - 2.0f * own.jitter_px[axis] / sides[axis];
    return own;
}

/* The pass is begun even if nothing is drawn, because the plate's shaders need the images in their layouts. */
static bool draw_mirror(host_renderer *r, VkCommandBuffer cmd, const struct host_frame_gpu *frame,
                        const host_camera *camera, char *error, size_t error_size)
{
    host_cull cull = {.mirrored = true, .mirror_m = r->mirror_m};
    drawing d = {
        .renderer = r, .cmd = cmd, .pass = r->mirror.pass, .cull = &cull, .error = error, .error_size = error_size};
    memcpy(cull.clip_from_relative, r->mirror_clip, sizeof cull.clip_from_relative);
    memcpy(cull.eye_m, r->mirror_eye_m, sizeof cull.eye_m);
    host_label_begin(r->device, cmd, "mirror");
    bind_frame(r, cmd);
    host_mirror_begin(&r->mirror, cmd);
    if (frame->mirror[2] > 0.0f)
        draw_scene(&d);
    vkCmdEndRenderPass(cmd);
    if (frame->mirror[2] > 0.0f && r->draw_haze)
        record_mirror_haze(r, cmd, camera);
    host_mirror_copy_down(&r->mirror, cmd);
    host_label_end(r->device, cmd);
    return !d.failed;
}

static bool record_mirror(host_renderer *r, VkCommandBuffer cmd, const host_target *target, const host_camera *camera,
                          const host_camera *previous, char *error, size_t error_size)
{
    struct host_frame_gpu frame;
    if (camera->sample == 0 || !r->mirror_drawn)
        r->mirror_share = mirror_share(r, camera);
    const uint32_t share = r->mirror_share;
    if (!r->mirror.width || (r->mirror_drawn && camera->sample % share))
        return true;
    const host_camera own = mirror_camera(camera, share);
    host_renderer_fill_frame(r, target, &own, previous, &frame);
    record_frame(r, cmd, &frame);
    host_renderer_place_mirror(r, &own, &frame);
    r->mirror_drawn = draw_mirror(r, cmd, &frame, &own, error, error_size);
    return r->mirror_drawn;
}

/* What the frame's camera sees. */
static void look(host_renderer *r, const host_camera *camera, const struct host_frame_gpu *frame)
{
    r->cull = (host_cull){.mirrored = false};
    memcpy(r->cull.clip_from_relative, frame->clip_from_relative, sizeof r->cull.clip_from_relative);
    memcpy(r->cull.eye_m, camera->position_m, sizeof r->cull.eye_m);
}

/* Up to where water may climb: a little above the highest ground that is near. */
static void find_foot(host_renderer *r, const host_camera *camera)
{
    double ground_m[2];
    r->foot_m = -DBL_MAX;
    if (!r->ground.cells || !r->has_contact || !r->has_meniscus)
        return;
    find_ground(r, camera->position_m, CLIMB_NEAR_M, ground_m);
    r->foot_m = ground_m[1] + HOST_CLIMB_M;
}

/* What both draws over a plate begin with: buffers of the frame, the mirror, and the descriptors. */
static bool begin_plate(host_renderer *r, VkCommandBuffer cmd, const host_target *target, const host_camera *camera,
                        const host_camera *previous, const char *label, char *error, size_t error_size)
{
    struct host_frame_gpu frame;
    if (r->parts == HOST_PLATE_WHOLE) {
        update_skylight(r, cmd, camera);
        update_shelter(r, cmd, camera);
        update_contact(r, cmd, camera);
        host_contact_bind(&r->contact, cmd);
        if (!record_mirror(r, cmd, target, camera, previous, error, error_size))
            return false;
    }
    find_foot(r, camera);
    host_renderer_fill_frame(r, target, camera, previous, &frame);
    host_renderer_look_at_mirror(r, camera, &frame);
    look(r, camera, &frame);
    record_frame(r, cmd, &frame);
    host_label_begin(r->device, cmd, label);
    bind_frame(r, cmd);
    return true;
}

bool host_renderer_footage(host_renderer *r, VkCommandBuffer cmd, const host_target *target, const host_camera *camera,
                           const host_camera *previous, char *error, size_t error_size)
{
    if (!r->footage || !r->ground.cells)
        return true;
    drawing d = {.renderer = r, .cmd = cmd, .pass = target->plate_pass, .error = error, .error_size = error_size};
    if (!begin_plate(r, cmd, target, camera, previous, "footage", error, error_size))
        return false;
    host_target_begin_over(target, cmd);
    for (uint32_t i = 0; i < r->entry_count; i++)
        if (r->entries[i].mesh == r->footage)
            draw_entry(&d, &r->entries[i], HOST_PIPELINE_FOOTAGE);
    host_target_end_plate(target, cmd);
    host_label_end(r->device, cmd);
    return !d.failed;
}

static bool may_share(const host_renderer *r, const host_target *target, const host_camera *camera)
{
    return camera->shares > 1 && r->parts == HOST_PLATE_WHOLE && r->reuse.width == target->width &&
           r->reuse.height == target->height;
}

/* Velocities are the camera's: what moves by itself is told apart by its id. That does not do where it shows what is
 * behind it, and where each sub-frame has a mirror's picture of its own. */
static host_moving find_moving(const host_renderer *r, const host_camera *camera)
{
    host_moving moving = {0};
    for (uint32_t i = 0; i < r->entry_count; i++) {
        const host_mesh *mesh = r->entries[i].mesh;
        if (mesh->moves && host_moving_shows_behind(mesh))
            host_moving_add(&moving, mesh, camera);
        if (mesh->moves && r->mirror_share < camera->shares)
            host_moving_add_mirrored(&moving, mesh, camera, r->mirror_m);
    }
    return moving;
}

/* What moves is drawn over what is behind it, which so has to be known wherever it may have been: there nothing of the
 * sub-frame before is kept. */
static void draw_ids(drawing *d)
{
    host_reuse_begin_depth(&d->renderer->reuse, d->cmd);
    draw_entries(d, HOST_PIPELINE_ID);
    draw_entries(d, HOST_PIPELINE_CUTOUT_ID);
    draw_entries(d, HOST_PIPELINE_SWEPT_ID);
}

/* Over the plate of the sub-frame before. See reuse.h. */
static void draw_following(drawing *d, const host_camera *camera)
{
    const host_renderer *r = d->renderer;
    const float shift_px[2] = {r->found_px[0] - camera->jitter_px[0], r->found_px[1] - camera->jitter_px[1]};
    draw_ids(d);
    const host_moving moving = find_moving(r, camera);
    host_reuse_end_depth(&r->reuse, d->cmd, shift_px, &moving);
    host_reuse_begin_shade(&r->reuse, d->cmd, shift_px);
    bind_frame(r, d->cmd);
    d->bound = VK_NULL_HANDLE;
    shade(d);
    vkCmdEndRenderPass(d->cmd);
}

static void draw_first(drawing *d, const host_target *target, const host_camera *camera, bool shares)
{
    host_renderer *r = d->renderer;
    host_target_begin_plate(target, d->cmd);
    draw_scene(d);
    host_target_end_plate(target, d->cmd);
    if (shares) {
        r->reuse.white = host_environment_white(r->environment);
        const host_moving moving = find_moving(r, camera);
        host_reuse_find(&r->reuse, d->cmd, target, camera->part, &moving);
    }
    r->found = shares;
    memcpy(r->found_px, camera->jitter_px, sizeof r->found_px);
}

/* Whether something moves while the shutter is open. */
static bool sweeps(const host_renderer *r)
{
    bool found = false;
    for (uint32_t i = 0; i < r->entry_count; i++)
        for (uint32_t m = 0; m < r->entries[i].mesh->material_count; m++)
            found = found || r->entries[i].mesh->materials[m].alpha == HOST_ALPHA_SWEPT;
    return found;
}

/* Over all of it, also where sub-frames share it: see swept.h. None hides another before both have their colors: they
 * are in one place at different times. */
static void draw_swept(drawing *d, const host_target *target)
{
    const host_plate_parts parts = d->renderer->parts;
    if (!sweeps(d->renderer))
        return;
    host_target_begin_over(target, d->cmd);
    bind_frame(d->renderer, d->cmd);
    d->bound = VK_NULL_HANDLE;
    if (parts == HOST_PLATE_WHOLE)
        draw_entries(d, HOST_PIPELINE_SWEPT);
    draw_entries(d, parts == HOST_PLATE_DEPTH ? HOST_PIPELINE_SWEPT_DEPTH : HOST_PIPELINE_SWEPT_DATA);
    host_target_end_plate(target, d->cmd);
}

bool host_renderer_plate(host_renderer *r, VkCommandBuffer cmd, const host_target *target, const host_camera *camera,
                         const host_camera *previous, char *error, size_t error_size)
{
    drawing d = {.renderer = r,
                 .cmd = cmd,
                 .pass = target->plate_pass,
                 .cull = &r->cull,
                 .error = error,
                 .error_size = error_size};
    if (!begin_plate(r, cmd, target, camera, previous, "plate", error, error_size))
        return false;
    const bool shares = may_share(r, target, camera);
    if (shares && camera->follows && r->found)
        draw_following(&d, camera);
    else
        draw_first(&d, target, camera, shares);
    draw_swept(&d, target);
    host_label_end(r->device, cmd);
    return !d.failed;
}

bool host_renderer_draw_still(host_renderer *r, VkCommandBuffer cmd, const host_target *target,
                              const host_camera *camera, bool scene, char *error, size_t error_size)
{
    drawing d = {.renderer = r,
                 .cmd = cmd,
                 .pass = target->plate_pass,
                 .cull = &r->cull,
                 .still = true,
                 .error = error,
                 .error_size = error_size};
    struct host_frame_gpu frame;
    const uint32_t cells = r->ground.cells;
    const bool has_walls = r->has_walls;
    r->ground.cells = 0;
    r->has_walls = false;
    update_shelter(r, cmd, camera);
    host_contact_bind(&r->contact, cmd);
    if (scene)
        update_skylight(r, cmd, camera);
    host_renderer_fill_frame(r, target, camera, camera, &frame);
    look(r, camera, &frame);
    record_frame(r, cmd, &frame);
    host_label_begin(r->device, cmd, "surroundings");
    bind_frame(r, cmd);
    host_target_begin_plate(target, cmd);
    if (scene)
        draw_scene(&d);
    else if (bind(&d, HOST_PIPELINE_SKY, true))
        vkCmdDraw(cmd, 3, 1, 0, 0);
    host_target_end_plate(target, cmd);
    host_label_end(r->device, cmd);
    r->ground.cells = cells;
    r->has_walls = has_walls;
    return !d.failed;
}
