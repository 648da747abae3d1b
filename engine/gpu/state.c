/* gpu/state.c - see state.h. The format is in state_bytes.h. */
#include "gpu/state.h"

#include "gpu/context.h"
#include "gpu/effect.h"
#include "gpu/errors.h"
#include "gpu/record.h"
#include "gpu/state_bytes.h"
#include "gpu/state_check.h"
#include "gpu/state_parts.h"

#include <string.h>

static VkDeviceSize image_bytes(const virga_image_2d *image)
{
    return (VkDeviceSize)image->extent.width * image->extent.height * image->layers * virga_texel_bytes(image->format);
}

static double value_of(const virga_setting_row *row, const void *settings)
{
    const void *value = (const char *)settings + row->member;
    switch (row->number) {
    case VIRGA_NUMBER_FLOAT: return (double)*(const float *)value;
    case VIRGA_NUMBER_DOUBLE: return *(const double *)value;
    case VIRGA_NUMBER_BOOL: return *(const bool *)value;
    default: return *(const uint32_t *)value;
    }
}

/* ---- a writer: records bytes into the host's buffer, or only counts them */

#define CHUNK 4096 /* bytes of one vkCmdUpdateBuffer */

typedef struct writer {
    virga_context *context;
    VkCommandBuffer cmd; /* NULL: only counts */
    VkBuffer buffer;
    VkDeviceSize offset; /* of the state in the buffer */
    VkDeviceSize at;     /* in the state */
    uint32_t used;       /* bytes of `chunk`, which begins at at - used */
    _Alignas(8) char chunk[CHUNK];
} writer;

static void flush(writer *out)
{
    if (out->cmd && out->used)
        out->context->vk.CmdUpdateBuffer(out->cmd, out->buffer, out->offset + out->at - out->used, out->used,
                                         out->chunk);
    out->used = 0;
}

static void put(writer *out, const void *bytes, VkDeviceSize size)
{
    const char *from = bytes;
    if (!out->cmd)
        out->at += size;
    else
        while (size) {
            const uint32_t room = CHUNK - out->used, part = size < room ? (uint32_t)size : room;
            memcpy(out->chunk + out->used, from, part);
            out->used += part;
            out->at += part;
            from += part;
            size -= part;
            if (out->used == CHUNK)
                flush(out);
        }
}

static void align(writer *out)
{
    static const char zero[VIRGA_STATE_ALIGNMENT];
    put(out, zero, virga_state_aligned(out->at) - out->at);
}

static void put_values(writer *out, const virga_effect_struct *kind, const virga_effect *effect)
{
    const void *settings = virga_effect_member(effect, kind->member);
    for (uint32_t i = 0; i < kind->row_count; i++) {
        const double value = value_of(&kind->rows[i], settings);
        if (!kind->rows[i].look)
            put(out, &value, sizeof value);
    }
}

static void put_host(writer *out, const virga_effect *effect)
{
    for (uint32_t i = 0; i < effect->type->state_row_count; i++) {
        put(out, virga_state_host_part(effect, &effect->type->state_rows[i]),
            virga_state_host_bytes(effect, &effect->type->state_rows[i]));
        align(out);
    }
}

/* Copies of buffers and images begin at multiples of the alignment, and leave the writer at the next one. */
static void put_device(writer *out, const virga_effect *effect)
{
    flush(out);
    for (uint32_t i = 0; i < effect->type->buffer_count; i++) {
        const virga_buffer *buffer = virga_state_buffer(effect, &effect->type->buffers[i]);
        if (!buffer)
            continue;
        const VkBufferCopy copy = {0, out->offset + out->at, buffer->size};
        if (out->cmd)
            out->context->vk.CmdCopyBuffer(out->cmd, buffer->buffer, out->buffer, 1, &copy);
        out->at = virga_state_aligned(out->at + buffer->size);
    }
    for (uint32_t i = 0; i < effect->type->image_count; i++) {
        const virga_effect_image *row = &effect->type->images[i];
        const virga_image_2d *image = virga_state_image(effect, row);
        if (!image)
            continue;
        const VkBufferImageCopy copy = {out->offset + out->at,
                                        0,
                                        0,
                                        {row->aspect, 0, 0, image->layers},
                                        {0, 0, 0},
                                        {image->extent.width, image->extent.height, 1}};
        if (out->cmd)
            out->context->vk.CmdCopyImageToBuffer(out->cmd, image->image, VK_IMAGE_LAYOUT_GENERAL, out->buffer, 1,
                                                  &copy);
        out->at = virga_state_aligned(out->at + image_bytes(image));
    }
}

static uint32_t count_values(const virga_effect_struct *kind)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < kind->row_count; i++)
        count += !kind->rows[i].look;
    return count;
}

static virga_state_section section_of(const virga_state_effect *one)
{
    const virga_effect *effect = one->effect;
    const virga_effect_type *type = effect->type;
    writer host = {0}, device = {0};
    virga_state_section section = {
        .index = one->index, .def_values = count_values(&type->def), .setting_values = count_values(&type->settings)};
    put_host(&host, effect);
    put_device(&device, effect);
    section.host_bytes = host.at;
    section.device_bytes = device.at;
    for (size_t i = 0; i < sizeof section.name - 1 && type->def.name[i]; i++)
        section.name[i] = type->def.name[i];
    return section;
}

static void put_section(writer *out, const virga_state_effect *one)
{
    const virga_state_section section = section_of(one);
    put(out, &section, sizeof section);
    put_values(out, &one->effect->type->def, one->effect);
    put_values(out, &one->effect->type->settings, one->effect);
    align(out);
    put_host(out, one->effect);
    put_device(out, one->effect);
}

VkDeviceSize virga_effects_state_bytes(const virga_state_effect *effects, uint32_t count)
{
    writer out = {.at = sizeof(virga_state_header)};
    for (uint32_t i = 0; i < count; i++)
        put_section(&out, &effects[i]);
    return out.at;
}

/* ---- save */

static virga_result check_save(const virga_state_effect *effects, uint32_t count, const char *call, VkCommandBuffer cmd,
                               const virga_state_range *to)
{
    const virga_effect *first = effects[0].effect;
    const virga_log *log = &first->context->log;
    const virga_result result = virga_effect_check_step(first, call, cmd, to && to->buffer ? to : NULL);
    if (result)
        return result;
    const VkDeviceSize bytes = virga_effects_state_bytes(effects, count);
    if (to->offset % VIRGA_STATE_ALIGNMENT)
        return virga_wrong_argument(log, "%s: offset: expected a multiple of %u, got %llu", call, VIRGA_STATE_ALIGNMENT,
                                    (unsigned long long)to->offset);
    if (to->size < bytes)
        return virga_wrong_argument(log, "%s: size: expected %llu bytes or more, got %llu", call,
                                    (unsigned long long)bytes, (unsigned long long)to->size);
    for (uint32_t i = 0; i < count; i++)
        if (effects[i].effect->contents == VIRGA_NOT_RECORDED)
            return VIRGA_NOT_READY;
    return VIRGA_OK;
}

static virga_state_header header_of(const virga_context *context, uint32_t count, VkDeviceSize bytes)
{
    return (virga_state_header){.magic = VIRGA_STATE_MAGIC,
                                .version = VIRGA_STATE_VERSION,
                                .effects = count,
                                .bytes = bytes,
                                .frame_index = context->frame_index,
                                .vendor_id = context->properties.vendorID,
                                .device_id = context->properties.deviceID,
                                .driver_version = context->properties.driverVersion};
}

virga_result virga_effects_save(const virga_state_effect *effects, uint32_t count, const char *call,
                                VkCommandBuffer cmd, const virga_state_range *to)
{
    const virga_result result = check_save(effects, count, call, cmd, to);
    if (result)
        return result;
    virga_context *context = effects[0].effect->context;
    const virga_state_header header = header_of(context, count, virga_effects_state_bytes(effects, count));
    writer out = {.context = context, .cmd = cmd, .buffer = to->buffer, .offset = to->offset};
    virga_barrier(context, cmd,
                  VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_TRANSFER_BIT | VK_PIPELINE_STAGE_HOST_BIT,
                  VK_ACCESS_SHADER_WRITE_BIT | VK_ACCESS_TRANSFER_WRITE_BIT, VK_PIPELINE_STAGE_TRANSFER_BIT,
                  VK_ACCESS_TRANSFER_READ_BIT | VK_ACCESS_TRANSFER_WRITE_BIT);
    put(&out, &header, sizeof header);
    for (uint32_t i = 0; i < count; i++)
        put_section(&out, &effects[i]);
    flush(&out);
    /* Later passes wait for the copies, before they write what these read. */
    virga_barrier(context, cmd, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT,
                  VK_PIPELINE_STAGE_HOST_BIT | VK_PIPELINE_STAGE_TRANSFER_BIT | VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT,
                  VK_ACCESS_HOST_READ_BIT | VK_ACCESS_TRANSFER_READ_BIT | VK_ACCESS_TRANSFER_WRITE_BIT |
                      VK_ACCESS_SHADER_WRITE_BIT);
    return VIRGA_OK;
}

/* ---- load */

/* Reads a state's bytes, which have their hash. Sizes may still be wrong, if somebody made them so. */
typedef struct reader {
    const char *bytes;
    VkDeviceSize size, at;
} reader;

/* NULL: there are not that many. */
static const void *take(reader *in, VkDeviceSize size)
{
    if (size > in->size - in->at)
        return NULL;
    const void *bytes = in->bytes + in->at;
    in->at = virga_state_aligned(in->at + size) < in->size ? virga_state_aligned(in->at + size) : in->size;
    return bytes;
}

static virga_result check_values(const virga_log *log, const char *call, const virga_effect *effect,
                                 const virga_effect_struct *kind, const double **values)
{
    const void *settings = virga_effect_member(effect, kind->member);
    for (uint32_t i = 0; i < kind->row_count; i++) {
        if (kind->rows[i].look)
            continue;
        const double now = value_of(&kind->rows[i], settings), saved = *(*values)++;
        if (now < saved || now > saved || saved != saved)
            return virga_wrong_argument(log, "%s: %s: the state has %.9g, this scene %.9g", call, kind->rows[i].name,
                                        saved, now);
    }
    return VIRGA_OK;
}

static virga_result check_matches(const virga_log *log, const char *call, const virga_effect *effect, const char *saved)
{
    for (uint32_t i = 0; i < effect->type->state_row_count; i++) {
        const virga_effect_state_row *row = &effect->type->state_rows[i];
        const VkDeviceSize bytes = virga_state_host_bytes(effect, row);
        if (row->must_match && memcmp(saved, virga_state_host_part(effect, row), bytes))
            return virga_wrong_argument(log, "%s: %s: the state was saved with other values", call, row->name);
        saved += virga_state_aligned(bytes);
    }
    return VIRGA_OK;
}

/* The parts of a section. */
typedef struct section_parts {
    const char *host;
    VkDeviceSize device_offset; /* in the state */
} section_parts;

static virga_result check_section(const char *call, const virga_state_effect *one, reader *in, section_parts *parts)
{
    const virga_effect *effect = one->effect;
    const virga_log *log = &effect->context->log;
    const virga_state_section expected = section_of(one), *section = take(in, sizeof *section);
    if (!section || memcmp(section->name, expected.name, sizeof section->name) || section->index != expected.index)
        return virga_wrong_argument(log, "%s: expected the state of %s %u there, got that of %.15s", call,
                                    expected.name, expected.index, section ? section->name : "nothing");
    if (section->def_values != expected.def_values || section->setting_values != expected.setting_values)
        return virga_wrong_argument(log, "%s: the state of %s is of another version of the library", call,
                                    expected.name);
    const double *values = take(in, (expected.def_values + (VkDeviceSize)expected.setting_values) * sizeof *values);
    if (!values)
        return virga_wrong_argument(log, "%s: the state ends within %s", call, expected.name);
    if (check_values(log, call, effect, &effect->type->def, &values) ||
        check_values(log, call, effect, &effect->type->settings, &values))
        return VIRGA_ERROR_INVALID;
    parts->host = take(in, expected.host_bytes);
    parts->device_offset = in->at;
    if (section->host_bytes != expected.host_bytes || section->device_bytes != expected.device_bytes || !parts->host ||
        !take(in, expected.device_bytes))
        return virga_wrong_argument(log, "%s: the state of %s has %llu bytes, expected %llu", call, expected.name,
                                    (unsigned long long)section->host_bytes + section->device_bytes,
                                    (unsigned long long)expected.host_bytes + expected.device_bytes);
    return check_matches(log, call, effect, parts->host);
}

static virga_result check_contents(const char *call, const virga_effect *effect, const section_parts *parts,
                                   const void *bytes)
{
    virga_state_check check = {
        .effect = effect, .call = call, .host = parts->host, .device = (const char *)bytes + parts->device_offset};
    virga_state_check_rows(&check);
    if (effect->type->check_state && !check.failed)
        effect->type->check_state(effect, &check);
    return check.failed ? VIRGA_ERROR_INVALID : VIRGA_OK;
}

static void apply_host(virga_effect *effect, const section_parts *parts)
{
    const char *saved = parts->host;
    for (uint32_t i = 0; i < effect->type->state_row_count; i++) {
        const virga_effect_state_row *row = &effect->type->state_rows[i];
        const VkDeviceSize bytes = virga_state_host_bytes(effect, row);
        memcpy(virga_state_host_part(effect, row), saved, bytes);
        saved += virga_state_aligned(bytes);
    }
    effect->load_frame = effect->context->frame_index;
    virga_effect_forget_views(effect, 0);
    if (effect->type->state_loaded)
        effect->type->state_loaded(effect);
}

static void copy_to_device(virga_effect *effect, VkCommandBuffer cmd, VkBuffer from, VkDeviceSize at)
{
    const virga_context *context = effect->context;
    for (uint32_t i = 0; i < effect->type->buffer_count; i++) {
        const virga_buffer *buffer = virga_state_buffer(effect, &effect->type->buffers[i]);
        if (!buffer)
            continue;
        const VkBufferCopy copy = {at, 0, buffer->size};
        context->vk.CmdCopyBuffer(cmd, from, buffer->buffer, 1, &copy);
        at += virga_state_aligned(buffer->size);
    }
    for (uint32_t i = 0; i < effect->type->image_count; i++) {
        const virga_effect_image *row = &effect->type->images[i];
        const virga_image_2d *image = virga_state_image(effect, row);
        if (!image)
            continue;
        const VkBufferImageCopy copy = {
            at, 0, 0, {row->aspect, 0, 0, image->layers}, {0, 0, 0}, {image->extent.width, image->extent.height, 1}};
        context->vk.CmdCopyBufferToImage(cmd, from, image->image, VK_IMAGE_LAYOUT_GENERAL, 1, &copy);
        at += virga_state_aligned(image_bytes(image));
    }
}

/* Images have their layouts, and buffers that are no part of the state their first contents, before the copies. */
static void apply_device(virga_effect *effect, VkCommandBuffer cmd, const section_parts *parts,
                         const virga_state_source *from)
{
    const VkAccessFlags any = VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT;
    effect->own_first = virga_effect_first_contents(effect, cmd);
    virga_barrier(effect->context, cmd, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, VK_ACCESS_MEMORY_WRITE_BIT,
                  VK_PIPELINE_STAGE_TRANSFER_BIT, any);
    copy_to_device(effect, cmd, from->buffer, from->offset + parts->device_offset);
    virga_barrier(effect->context, cmd, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT,
                  VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, any);
    virga_effect_note(effect, cmd, VIRGA_DID_LOAD);
}

static virga_result check_load(const virga_state_effect *effects, uint32_t count, const char *call, VkCommandBuffer cmd,
                               const virga_state_source *from)
{
    const virga_context *context = effects[0].effect->context;
    char reason[160];
    virga_state_info info;
    const virga_result result =
        virga_effect_check_step(effects[0].effect, call, cmd, from && from->buffer && from->bytes ? from : NULL);
    if (result)
        return result;
    for (uint32_t i = 0; i < count; i++)
        if (virga_effect_ready(effects[i].effect))
            return virga_effect_ready(effects[i].effect);
    if (from->offset % VIRGA_STATE_ALIGNMENT)
        return virga_wrong_argument(&context->log, "%s: offset: expected a multiple of %u, got %llu", call,
                                    VIRGA_STATE_ALIGNMENT, (unsigned long long)from->offset);
    for (uint32_t i = 0; i < count; i++)
        if (effects[i].effect->step_frame == context->frame_index)
            return virga_wrong_argument(&context->log, "%s: expected it before the step of the frame", call);
    if (virga_state_read(from->bytes, from->size, &info, reason, sizeof reason))
        return virga_wrong_argument(&context->log, "%s: %s", call, reason);
    if (info.effects != count)
        return virga_wrong_argument(&context->log, "%s: the state is of %u effects, expected %u", call, info.effects,
                                    count);
    return VIRGA_OK;
}

virga_result virga_effects_load(const virga_state_effect *effects, uint32_t count, const char *call,
                                VkCommandBuffer cmd, const virga_state_source *from)
{
    section_parts parts[VIRGA_STATE_MAX_EFFECTS];
    const virga_result result = check_load(effects, count, call, cmd, from);
    if (result)
        return result;
    const virga_state_header *header = from->bytes;
    reader in = {from->bytes, header->bytes, sizeof *header};
    for (uint32_t i = 0; i < count; i++)
        if (check_section(call, &effects[i], &in, &parts[i]) ||
            check_contents(call, effects[i].effect, &parts[i], from->bytes))
            return VIRGA_ERROR_INVALID;
    for (uint32_t i = 0; i < count; i++)
        apply_host(effects[i].effect, &parts[i]);
    for (uint32_t i = 0; i < count; i++)
        apply_device(effects[i].effect, cmd, &parts[i], from);
    return VIRGA_OK;
}
