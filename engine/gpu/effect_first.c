/* gpu/effect_first.c - first contents of buffers and images, and uploads. */
#include "gpu/effect_first.h"

#include "gpu/builds.h"
#include "gpu/context.h"
#include "gpu/errors.h"
#include "gpu/record.h"

#include "shaders/gpu_shaders.h"

#include <string.h>

#define FILL_GROUP      256 /* as in shaders/gpu/first_fill.comp */
#define FILL_MAX_GROUPS 4096

/* ---- buffers */

/* Other rows, e.g. of uniform buffers, never change after their fill. */
static bool by_pass(const virga_effect_buffer *row)
{
    return row->first == VIRGA_FIRST_FILL && (row->usage & VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
}

virga_result virga_effect_create_fills(virga_effect *effect)
{
    static const virga_binding_kind kinds[] = {{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, VK_SHADER_STAGE_COMPUTE_BIT},
                                               {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, VK_SHADER_STAGE_COMPUTE_BIT}};
    uint32_t count = 0;
    for (uint32_t i = 0; i < effect->type->buffer_count; i++)
        if (by_pass(&effect->type->buffers[i]))
            count += virga_effect_copies(effect, effect->type->buffers[i].per_view);
    if (!count)
        return VIRGA_OK;
    const virga_result result =
        virga_bindings_create(effect->context, kinds, VIRGA_ROWS(kinds), count + VIRGA_EFFECT_MAX_READS,
                              4 * sizeof(uint32_t), &effect->fill_bindings);
    if (result)
        return result;
    const virga_compute_def def = {.shader = VIRGA_SPIRV(gpu_first_fill_comp),
                                   .layout = effect->fill_bindings->shared,
                                   .group = &effect->passes,
                                   .name = "first_fill"};
    return virga_compute_pipeline_create(effect->context, &def, &effect->fill_pass);
}

/* `owner` has the buffer. */
static void record_fill(virga_effect *effect, VkCommandBuffer cmd, const virga_effect *owner,
                        const virga_effect_buffer *row, const virga_buffer *filled, uint32_t set_index)
{
    virga_context *context = effect->context;
    const virga_bound bound[VIRGA_MAX_BINDINGS] = {
        {.buffer = filled->buffer, .range = filled->size},
        {.buffer = owner->journal.marks->buffer, .range = sizeof(uint32_t)},
    };
    const VkDescriptorSet set = virga_bindings_write(context, effect->fill_bindings, set_index, bound);
    const VkPipelineLayout layout = effect->fill_bindings->layout;
    const uint32_t words = (uint32_t)(filled->size / sizeof(uint32_t)), groups = (words + FILL_GROUP - 1) / FILL_GROUP;
    const uint32_t constants[4] = {words, row->fill, row->word, row->word_value};
    context->vk.CmdBindDescriptorSets(cmd, VK_PIPELINE_BIND_POINT_COMPUTE, layout, 0, 1, &set, 0, NULL);
    context->vk.CmdPushConstants(cmd, layout, VIRGA_ALL_STAGES, 0, sizeof constants, constants);
    virga_dispatch(context, cmd, effect->fill_pass, groups < FILL_MAX_GROUPS ? groups : FILL_MAX_GROUPS);
}

/* The same, whatever was done before. A driver fills faster than a pass: on software Vulkan by ten times. */
static void record_plain_fill(const virga_context *context, VkCommandBuffer cmd, const virga_effect_buffer *row,
                              const virga_buffer *filled)
{
    const VkDeviceSize word = row->word * sizeof(uint32_t), behind = word + sizeof(uint32_t);
    if (!word) {
        context->vk.CmdFillBuffer(cmd, filled->buffer, 0, VK_WHOLE_SIZE, row->fill);
        return;
    }
    context->vk.CmdFillBuffer(cmd, filled->buffer, 0, word, row->fill);
    context->vk.CmdFillBuffer(cmd, filled->buffer, word, sizeof(uint32_t), row->word_value);
    if (behind < filled->size)
        context->vk.CmdFillBuffer(cmd, filled->buffer, behind, VK_WHOLE_SIZE, row->fill);
}

/* The first recording of all fills in any case: nothing can have been before it. Later ones, of frames that were
 * recorded before it was known that the first was executed, do so only if it was not. */
static void record_fills(virga_effect *effect, VkCommandBuffer cmd)
{
    const bool first = !effect->contents_frame;
    uint32_t set_index = 0;
    for (uint32_t i = 0; i < effect->type->buffer_count; i++) {
        const virga_effect_buffer *row = &effect->type->buffers[i];
        for (uint32_t k = 0; k < virga_effect_copies(effect, row->per_view); k++) {
            const virga_buffer *buffer = *(virga_buffer **)virga_effect_copy(effect, row->member, row->per_view, k);
            if (buffer && by_pass(row) && !first)
                record_fill(effect, cmd, effect, row, buffer, set_index++);
            else if (buffer && by_pass(row))
                record_plain_fill(effect->context, cmd, row, buffer);
            else if (buffer && row->first == VIRGA_FIRST_FILL)
                effect->context->vk.CmdFillBuffer(cmd, buffer->buffer, 0, VK_WHOLE_SIZE, row->fill);
        }
    }
}

/* ---- images */

static void record_image(virga_effect *effect, VkCommandBuffer cmd, const virga_effect_image *row,
                         const virga_image_2d *image)
{
    const virga_image_state before = {VK_IMAGE_LAYOUT_UNDEFINED, VK_PIPELINE_STAGE_TOP_OF_PIPE_BIT, 0};
    const VkPipelineStageFlags shaders = VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT;
    const virga_image_state sampled = {VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, shaders, VK_ACCESS_SHADER_READ_BIT};
    const virga_image_state general = {VK_IMAGE_LAYOUT_GENERAL, shaders | VK_PIPELINE_STAGE_TRANSFER_BIT,
                                       READ_WRITE | VK_ACCESS_TRANSFER_WRITE_BIT};
    const VkClearColorValue zero = {.float32 = {0}};
    const VkImageSubresourceRange all = {row->aspect, 0, 1, 0, VK_REMAINING_ARRAY_LAYERS};
    virga_image_barrier(effect->context, cmd, image->image, row->aspect, before,
                        row->first == VIRGA_FIRST_SAMPLED ? sampled : general);
    if (row->first == VIRGA_FIRST_FILL)
        effect->context->vk.CmdClearColorImage(cmd, image->image, VK_IMAGE_LAYOUT_GENERAL, &zero, 1, &all);
}

/* A transition from UNDEFINED discards the contents. So an image that is kept is transitioned again only if its first
 * transition is known to be lost. */
static void record_images(virga_effect *effect, VkCommandBuffer cmd)
{
    for (uint32_t i = 0; i < effect->type->image_count; i++) {
        const virga_effect_image *row = &effect->type->images[i];
        if (row->first == VIRGA_FIRST_ANYTHING || (row->keeps && effect->images != VIRGA_NOT_RECORDED))
            continue;
        for (uint32_t k = 0; k < virga_effect_copies(effect, row->per_view); k++) {
            const virga_image_2d *image = *(virga_image_2d **)virga_effect_copy(effect, row->member, row->per_view, k);
            if (image)
                record_image(effect, cmd, row, image);
        }
    }
}

/* ---- first contents */

static void wait_for_earlier_frames(virga_context *context, VkCommandBuffer cmd)
{
    const VkAccessFlags any = VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT;
    virga_barrier(context, cmd, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, VK_ACCESS_MEMORY_WRITE_BIT,
                  VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, any);
}

static bool record_first_contents(virga_effect *effect, VkCommandBuffer cmd)
{
    virga_context *context = effect->context;
    const bool lost = effect->contents == VIRGA_NOT_RECORDED || effect->images == VIRGA_NOT_RECORDED;
    if ((effect->contents == VIRGA_EXECUTED && effect->images == VIRGA_EXECUTED) ||
        (effect->contents_frame == context->frame_index && !lost))
        return false;
    if (effect->contents_frame)
        wait_for_earlier_frames(context, cmd);
    record_images(effect, cmd);
    record_fills(effect, cmd);
    virga_wait(context, cmd, VIRGA_PASSES | VIRGA_COPIES,
               VIRGA_PASSES | VIRGA_ARGUMENTS | VIRGA_COPIES | VIRGA_FRAGMENTS);
    context->vk.CmdFillBuffer(cmd, effect->journal.marks->buffer, 0, sizeof(uint32_t), 1); /* the passes are done */
    effect->journal.doing |= VIRGA_DID_CONTENTS | (effect->images == VIRGA_NOT_RECORDED ? VIRGA_DID_IMAGES : 0);
    effect->contents = effect->contents == VIRGA_EXECUTED ? VIRGA_EXECUTED : VIRGA_RECORDED;
    effect->images = effect->images == VIRGA_EXECUTED ? VIRGA_EXECUTED : VIRGA_RECORDED;
    effect->contents_frame = context->frame_index;
    return true;
}

bool virga_effect_first_contents(virga_effect *effect, VkCommandBuffer cmd)
{
    const bool recorded = record_first_contents(effect, cmd) || effect->own_first;
    effect->own_first = false;
    return recorded;
}

/* ---- lists of other effects */

/* The effect that has a buffer, and its row; NULL: it is the host's. */
static virga_effect *owner_of(const virga_context *context, VkBuffer buffer, const virga_effect_buffer **row,
                              const virga_buffer **found)
{
    for (virga_effect *owner = context->first_effect; owner; owner = owner->next_effect)
        for (uint32_t i = 0; i < owner->type->buffer_count; i++) {
            *row = &owner->type->buffers[i];
            *found = *(virga_buffer **)virga_effect_member(owner, (*row)->member);
            if (*found && (*found)->buffer == buffer)
                return owner;
        }
    return NULL;
}

/* The fill is guarded by the mark of the owner. So it does nothing if the owner's first contents were executed, also
 * earlier in this frame, and the owner's own recording does the same. */
void virga_effect_reads(virga_effect *effect, VkCommandBuffer cmd, VkBuffer buffer)
{
    virga_context *context = effect->context;
    const virga_effect_buffer *row;
    const virga_buffer *found;
    const virga_effect *owner = buffer ? owner_of(context, buffer, &row, &found) : NULL;
    if (!owner || owner == effect || owner->contents == VIRGA_EXECUTED || !by_pass(row))
        return;
    if (effect->reads_frame != context->frame_index)
        effect->reads = 0;
    effect->reads_frame = context->frame_index;
    if (effect->reads >= VIRGA_EFFECT_MAX_READS)
        return;
    wait_for_earlier_frames(context, cmd);
    const uint32_t first_set = effect->fill_bindings->sets_per_frame - VIRGA_EFFECT_MAX_READS;
    record_fill(effect, cmd, owner, row, found, first_set + effect->reads++);
    virga_wait(context, cmd, VIRGA_PASSES, VIRGA_PASSES | VIRGA_ARGUMENTS | VIRGA_COPIES);
}

/* ---- uploads */

/* The entry of that pointer, else a free one. */
static virga_effect_upload *upload_of(virga_effect *effect, virga_buffer **staging)
{
    virga_effect_upload *free_one = &effect->uploads[0];
    for (uint32_t i = 0; i < VIRGA_EFFECT_MAX_UPLOADS; i++) {
        if (effect->uploads[i].staging == staging)
            return &effect->uploads[i];
        if (!effect->uploads[i].staging)
            free_one = &effect->uploads[i];
    }
    return free_one;
}

void virga_effect_uploaded(virga_effect *effect, virga_buffer **staging)
{
    virga_effect_upload *upload = upload_of(effect, staging);
    if (upload->staging != staging || upload->buffer != *staging)
        *upload = (virga_effect_upload){staging, *staging, effect->context->frame_index};
    effect->journal.doing |= VIRGA_DID_UPLOAD;
}
