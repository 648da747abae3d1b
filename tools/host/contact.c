/* contact.c - see contact.h. */
#include "contact.h"

#include <math.h>
#include <string.h>

#include "pipeline.h"

#include "contact_comp.spv.h"
#include "contact_near_comp.spv.h"
#include "contact_near_comp_tiles.spv.h"

#define MAP_SIZE 768
#define GROUP    8 /* of the gather pass, along a side: CONTACT_TILE of shaders/contact_maps.glsl */
#define TILES    (MAP_SIZE / GROUP)
#define SIDE_M   20.0
#define AHEAD_M  6.5 /* its middle is so far before the camera */
#define EYES_M   1.6 /* of the camera above the ground, about */
#define SLANT    0.25f
#define REACH_M  1.8   /* of shade: as far as shaders/contact.comp looks, and what slanted looks move things by */
#define LEVEL    0.005 /* slope of what is taken for level, at most */
#define STEEP    0.3   /* slope of what is taken for a plane, at most */
#define FLAT_M   1.0   /* ground with no more between its lowest and highest point has one height */

/* Bindings beside the maps. */
enum { WRITE_SHADE = HOST_CONTACT_MAPS, WRITE_TILES, READ_TILES, WRITE_NEAR, READ_NEAR, BINDINGS };

#define SAMPLED VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER
#define STORED  VK_DESCRIPTOR_TYPE_STORAGE_IMAGE

static const VkDescriptorType kinds[BINDINGS] = {SAMPLED, SAMPLED, SAMPLED, SAMPLED, SAMPLED,
                                                 STORED,  STORED,  SAMPLED, STORED,  SAMPLED};

static bool create_images(host_device *device, VkRenderPass pass, host_contact *c, char *error, size_t error_size)
{
    const host_image_def depth = {
        .format = VK_FORMAT_D32_SFLOAT,
        .extent = {MAP_SIZE, MAP_SIZE, 1},
        .usage = VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT,
        .name = "contact map",
    };
    const host_image_def shade = {
        .format = VK_FORMAT_R16G16B16A16_SFLOAT,
        .extent = {MAP_SIZE, MAP_SIZE, 1},
        .usage = VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT,
        .name = "contact shade",
    };
    const host_image_def tiles = {
        .format = VK_FORMAT_R32_SFLOAT,
        .extent = {TILES, TILES, 1},
        .usage = VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT,
        .name = "contact tiles",
    };
    for (int i = 0; i < HOST_CONTACT_MAPS; i++)
        if (!host_image_create(device, &depth, &c->maps[i], error, error_size) ||
            !host_slice_create(device, pass, &c->maps[i], 0, 0, &c->slices[i], error, error_size))
            return false;
    return host_image_create(device, &shade, &c->shade, error, error_size) &&
           host_image_create(device, &tiles, &c->tiles, error, error_size) &&
           host_image_create(device, &tiles, &c->near_tiles, error, error_size);
}

static bool create_passes(host_device *device, host_contact *c, char *error, size_t error_size)
{
    const VkPipelineLayout layout = c->bindings.layout;
    return host_compute_create(device, HOST_CODE(contact_near_comp_tiles), layout, &c->find_tiles, error, error_size) &&
           host_compute_create(device, HOST_CODE(contact_near_comp), layout, &c->find_near, error, error_size) &&
           host_compute_create(device, HOST_CODE(contact_comp), layout, &c->gather, error, error_size);
}

static void write_set(const host_device *device, const host_contact *c)
{
    const VkDescriptorSet set = c->bindings.sets[0];
    for (uint32_t i = 0; i < HOST_CONTACT_MAPS; i++)
        host_set_write_image(device, set, i, c->sampler, c->maps[i].view,
                             VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL);
    host_set_write_image(device, set, WRITE_SHADE, VK_NULL_HANDLE, c->shade.view, VK_IMAGE_LAYOUT_GENERAL);
    host_set_write_image(device, set, WRITE_TILES, VK_NULL_HANDLE, c->tiles.view, VK_IMAGE_LAYOUT_GENERAL);
    host_set_write_image(device, set, READ_TILES, c->sampler, c->tiles.view, VK_IMAGE_LAYOUT_GENERAL);
    host_set_write_image(device, set, WRITE_NEAR, VK_NULL_HANDLE, c->near_tiles.view, VK_IMAGE_LAYOUT_GENERAL);
    host_set_write_image(device, set, READ_NEAR, c->sampler, c->near_tiles.view, VK_IMAGE_LAYOUT_GENERAL);
}

bool host_contact_create(host_device *device, VkRenderPass pass, host_contact *c, char *error, size_t error_size)
{
    const host_bindings_def def = {.shape = {kinds, BINDINGS, VK_SHADER_STAGE_COMPUTE_BIT},
                                   .set_count = 1,
                                   .push_stages = VK_SHADER_STAGE_COMPUTE_BIT,
                                   .push_bytes = sizeof(struct host_contact_gpu)};
    memset(c, 0, sizeof *c);
    c->moved = host_contact_no_box();
    if (!create_images(device, pass, c, error, error_size) ||
        !host_bindings_create(device, &def, &c->bindings, error, error_size) ||
        !host_sampler_create(device, HOST_SAMPLE_NEAREST, &c->sampler, error, error_size) ||
        !create_passes(device, c, error, error_size))
        return false;
    write_set(device, c);
    return true;
}

void host_contact_destroy(host_device *device, host_contact *c)
{
    vkDestroyPipeline(device->device, c->gather, NULL);
    vkDestroyPipeline(device->device, c->find_near, NULL);
    vkDestroyPipeline(device->device, c->find_tiles, NULL);
    host_bindings_destroy(device, &c->bindings);
    vkDestroySampler(device->device, c->sampler, NULL);
    for (int i = 0; i < HOST_CONTACT_MAPS; i++) {
        host_slice_destroy(device, &c->slices[i]);
        host_image_destroy(device, &c->maps[i]);
    }
    host_image_destroy(device, &c->near_tiles);
    host_image_destroy(device, &c->tiles);
    host_image_destroy(device, &c->shade);
    memset(c, 0, sizeof *c);
}

static bool differ(double a, double b)
{
    return a < b || a > b;
}

void host_contact_tilt(host_contact *c, const double middle_m[3], const double slope[2])
{
    const host_contact before = *c;
    const bool slopes = hypot(slope[0], slope[1]) > LEVEL;
    for (int i = 0; i < 3; i++) {
        c->tilt_m[i] = slopes ? middle_m[i] : 0;
        c->ready = c->ready && !differ(c->tilt_m[i], before.tilt_m[i]);
    }
    for (int i = 0; i < 2; i++) {
        c->slope[i] = slopes ? fmin(fmax(slope[i], -STEEP), STEEP) : 0;
        c->ready = c->ready && !differ(c->slope[i], before.slope[i]);
    }
}

bool host_contact_place(host_contact *c, const host_camera *camera, const double ground_m[2], double high_m,
                        uint32_t moving_count)
{
    const host_contact before = *c;
    const float *m = camera->view_from_world; /* its third row points back */
    const double length = hypot((double)m[2], (double)m[10]);
    for (int axis = 0; axis < 3; axis += 2) {
        const double ahead = length > 1e-3 ? -AHEAD_M * (double)m[2 + 4 * axis] / length : 0;
        c->low_m[axis] =
            floor((camera->position_m[axis] + ahead - 0.5 * SIDE_M) / HOST_CONTACT_STEP_M + 0.5) * HOST_CONTACT_STEP_M;
    }
    c->low_m[1] = ground_m[0] - 0.1;
    c->height_m = fmax(high_m - ground_m[0] + 0.2, 1);
    c->level_m = ground_m[1] - ground_m[0] < FLAT_M
                     ? 0.5 * (ground_m[0] + ground_m[1])
                     : fmin(fmax(floor(camera->position_m[1] - EYES_M + 0.5), ground_m[0]), ground_m[1]);
    c->moving_count = moving_count;
    bool moved = differ(before.height_m, c->height_m) || differ(before.level_m, c->level_m) ||
                 before.moving_count != moving_count;
    for (int axis = 0; axis < 3; axis++)
        moved = moved || differ(before.low_m[axis], c->low_m[axis]);
    return !c->ready || moved;
}

host_contact_box host_contact_no_box(void)
{
    return (host_contact_box){.low_m = {1, 1}, .high_m = {-1, -1}};
}

static bool is_empty(const host_contact_box *box)
{
    return box->low_m[0] > box->high_m[0];
}

static void add_area(host_contact_box *box, const double low_m[2], const double high_m[2])
{
    const bool empty = is_empty(box);
    for (int i = 0; i < 2; i++) {
        box->low_m[i] = empty ? low_m[i] : fmin(box->low_m[i], low_m[i]);
        box->high_m[i] = empty ? high_m[i] : fmax(box->high_m[i], high_m[i]);
    }
}

void host_contact_add(const host_contact *c, const float low_m[3], const float high_m[3], uint32_t number,
                      host_contact_box *box)
{
    const double low[2] = {(double)low_m[0], (double)low_m[2]}, high[2] = {(double)high_m[0], (double)high_m[2]};
    for (int i = 0; i < 2; i++)
        if (high[i] < c->low_m[2 * i] - REACH_M || low[i] > c->low_m[2 * i] + SIDE_M + REACH_M)
            return;
    add_area(box, low, high);
    for (int axis = 0; axis < 3; axis++)
        box->places[axis] += number * ((double)low_m[axis] + (double)high_m[axis]);
}

uint32_t host_contact_looks(host_contact_map map)
{
    return map == HOST_CONTACT_UNDER || map == HOST_CONTACT_MOVING_UNDER ? HOST_CONTACT_LOOKS : 1;
}

/* From below depth rises with the height, from above it falls. Upright sides are seen from aslant only, and many things
 * have no bottom: so undersides are seen along five lines. What that moves beyond a thing has no top there. Under eaves
 * it has one: by so much as the ground is off the height where looks move nothing, what a wall has below the ground
 * would stand before it, a quarter as wide. So that height is a plane: along a street that falls, ground is off a level
 * by more than that of kerbs. */
void host_contact_look(const host_contact *c, host_contact_map map, uint32_t look, float m[16])
{
    static const float slants[HOST_CONTACT_LOOKS][2] = {{0, 0}, {SLANT, 0}, {-SLANT, 0}, {0, SLANT}, {0, -SLANT}};
    const float scale = (float)(2 / SIDE_M), rise = (float)(1 / c->height_m);
    const bool over = map == HOST_CONTACT_OVER || map == HOST_CONTACT_MOVING_OVER;
    memset(m, 0, 16 * sizeof *m);
    m[0] = m[9] = scale;
    m[6] = over ? -rise : rise;
    const bool slopes = differ(c->slope[0], 0) || differ(c->slope[1], 0);
    const double zero_m = slopes ? c->tilt_m[1] - c->slope[0] * c->tilt_m[0] - c->slope[1] * c->tilt_m[2] : c->level_m;
    for (int axis = 0; axis < 2; axis++) {
        const double slant = (double)slants[look][axis];
        m[axis] -= scale * (float)(slant * c->slope[0]);
        m[4 + axis] = scale * (float)slant;
        m[8 + axis] -= scale * (float)(slant * c->slope[1]);
        m[12 + axis] = -scale * (float)(c->low_m[2 * axis] + 0.5 * SIDE_M + slant * zero_m);
    }
    m[14] = over ? 1 + rise * (float)c->low_m[1] : -rise * (float)c->low_m[1];
    m[15] = 1;
}

void host_contact_begin(const host_contact *c, VkCommandBuffer cmd, VkRenderPass pass, host_contact_map map)
{
    host_pass_begin(cmd, pass, c->slices[map].framebuffer, MAP_SIZE, MAP_SIZE, 0);
}

void host_contact_end(VkCommandBuffer cmd)
{
    vkCmdEndRenderPass(cmd);
}

/* Workgroups from `first` on, `count` along each axis, that cover an area and what its shade reaches. */
static void groups_of(const host_contact *c, const host_contact_box *area, uint32_t first[2], uint32_t count[2])
{
    const double group_m = SIDE_M / MAP_SIZE * GROUP, groups = MAP_SIZE / GROUP;
    for (int i = 0; i < 2; i++) {
        const double low = floor((area->low_m[i] - REACH_M - c->low_m[2 * i]) / group_m);
        const double high = ceil((area->high_m[i] + REACH_M - c->low_m[2 * i]) / group_m);
        first[i] = (uint32_t)fmin(fmax(low, 0), groups);
        count[i] = (uint32_t)fmin(fmax(high, 0), groups) - first[i];
    }
}

/* What the pass before wrote is complete. */
static void between(VkCommandBuffer cmd)
{
    host_memory_barrier(cmd, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, VK_ACCESS_SHADER_WRITE_BIT,
                        VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, VK_ACCESS_SHADER_READ_BIT);
}

/* The highest tops near each workgroup of the gather pass, all over the map: a hundredth of its work. */
static void find_highest(const host_contact *c, VkCommandBuffer cmd)
{
    const host_image *images[2] = {&c->tiles, &c->near_tiles};
    for (int i = 0; i < 2; i++)
        host_image_barrier(cmd, images[i], VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_GENERAL,
                           VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, 0, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT,
                           VK_ACCESS_SHADER_WRITE_BIT);
    vkCmdBindPipeline(cmd, VK_PIPELINE_BIND_POINT_COMPUTE, c->find_tiles);
    vkCmdDispatch(cmd, TILES / GROUP, TILES / GROUP, 1);
    between(cmd);
    vkCmdBindPipeline(cmd, VK_PIPELINE_BIND_POINT_COMPUTE, c->find_near);
    vkCmdDispatch(cmd, TILES / GROUP, TILES / GROUP, 1);
    between(cmd);
}

void host_contact_gather(host_contact *c, VkCommandBuffer cmd, bool placed, const host_contact_box *moving)
{
    uint32_t first[2] = {0}, count[2] = {MAP_SIZE / GROUP, MAP_SIZE / GROUP};
    host_contact_box area = c->moved;
    if (!is_empty(moving))
        add_area(&area, moving->low_m, moving->high_m);
    if (!placed)
        groups_of(c, &area, first, count);
    const struct host_contact_gpu push = {.height_m = (float)c->height_m,
                                          .texel_m = (float)(SIDE_M / MAP_SIZE),
                                          .first_x = first[0] * GROUP,
                                          .first_y = first[1] * GROUP};
    host_image_barrier(cmd, &c->shade, placed ? VK_IMAGE_LAYOUT_UNDEFINED : VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
                       VK_IMAGE_LAYOUT_GENERAL, VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT, 0,
                       VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, VK_ACCESS_SHADER_WRITE_BIT);
    vkCmdBindDescriptorSets(cmd, VK_PIPELINE_BIND_POINT_COMPUTE, c->bindings.layout, 0, 1, c->bindings.sets, 0, NULL);
    vkCmdPushConstants(cmd, c->bindings.layout, VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof push, &push);
    find_highest(c, cmd);
    vkCmdBindPipeline(cmd, VK_PIPELINE_BIND_POINT_COMPUTE, c->gather);
    vkCmdDispatch(cmd, count[0], count[1], 1);
    host_image_barrier(cmd, &c->shade, VK_IMAGE_LAYOUT_GENERAL, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
                       VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, VK_ACCESS_SHADER_WRITE_BIT,
                       VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT, VK_ACCESS_SHADER_READ_BIT);
    c->moved = *moving;
    c->ready = c->has_layout = true;
}

void host_contact_bind(host_contact *c, VkCommandBuffer cmd)
{
    if (!c->has_layout)
        host_image_barrier(cmd, &c->shade, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
                           VK_PIPELINE_STAGE_TOP_OF_PIPE_BIT, 0, VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT,
                           VK_ACCESS_SHADER_READ_BIT);
    c->has_layout = true;
}

void host_contact_frame(const host_contact *c, const double camera_m[3], struct host_frame_gpu *frame)
{
    for (int axis = 0; axis < 3; axis++)
        frame->contact[axis] = (float)(c->low_m[axis] - camera_m[axis]);
    frame->contact[3] = (float)(1 / SIDE_M);
}
