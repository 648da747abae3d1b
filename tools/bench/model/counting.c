/* counting.c - see counting.h. */
#include "bench/model/counting.h"

#include "bench/model/call_times.h"
#include "bench/model/handle_map.h"
#include "bench/model/spirv_count.h"
#include "bench/model/spirv_words.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define MAX_PASSES   2048
#define MAX_NUMBERS  (1u << 19)
#define SET_BINDINGS 64

/* ---- what is known of handles */

typedef struct module_code {
    size_t word_count;
    uint32_t words[];
} module_code;

typedef struct resource_size {
    double bytes, texel_bytes; /* texel_bytes 0: a buffer */
    uint32_t layers;           /* of an image */
} resource_size;

typedef struct set_contents {
    resource_size bindings[SET_BINDINGS];
} set_contents;

static struct {
    host_device *device;
    VkDescriptorSetLayout set_layout;
    VkDescriptorPool pool;
    VkDescriptorSet set;
    host_buffer numbers; /* of the frame that runs */
    uint32_t *kept;      /* of the newest frame of each pass */
    uint32_t number_count;
    handle_map modules, layouts, resources, sets, pipelines; /* pipelines: index of the pass */
    handle_map targets;                                      /* of render passes: target_sizes */
    counted_pass passes[MAX_PASSES];
    uint32_t pass_count;
    counted_pass *bound[2]; /* graphics, compute */
    VkDescriptorSet bound_sets[2];
    bool behind_barrier, all;
    uint32_t barriers; /* so far */
    double moved_bytes, moved_so_far;
    call_times times;
    counted_pass *timed[CALL_TIMES_MAX]; /* by the call; NULL: something in it was counted */
    struct {
        uint32_t call;
        counted_pass *first; /* pass that drew */
        const char *name;    /* of the host's; NULL: of the first pass */
        bool is_open, is_counted;
    } draws; /* a render pass that is recorded, with times */
} counting;

/* The driver's own function. */
#define DRIVER(name) ((PFN_vk##name)vkGetDeviceProcAddr(counting.device->device, "vk" #name))

static void keep(handle_map *map, uint64_t handle, const void *value, size_t size)
{
    void *copy = malloc(size);
    if (copy)
        memcpy(copy, value, size);
    handle_map_put(map, handle, copy);
}

/* ---- sizes of what is bound */

static double texel_bytes(VkFormat format)
{
    switch (format) {
    case VK_FORMAT_R8_UNORM:
    case VK_FORMAT_R8_UINT: return 1;
    case VK_FORMAT_R8G8_UNORM:
    case VK_FORMAT_R16_SFLOAT:
    case VK_FORMAT_R16_UNORM:
    case VK_FORMAT_R16_UINT: return 2;
    case VK_FORMAT_R16G16B16A16_SFLOAT:
    case VK_FORMAT_R16G16B16A16_UNORM:
    case VK_FORMAT_R16G16B16A16_SNORM:
    case VK_FORMAT_R32G32_SFLOAT:
    case VK_FORMAT_R32G32_UINT: return 8;
    case VK_FORMAT_R32G32B32A32_SFLOAT:
    case VK_FORMAT_R32G32B32A32_UINT: return 16;
    default: return 4;
    }
}

/* A view of a buffer is as large as the buffer. */
static void keep_size_of_view(uint64_t view, uint64_t of)
{
    const resource_size *size = handle_map_find(&counting.resources, of);
    if (size)
        keep(&counting.resources, view, size, sizeof *size);
}

void counting_know_image(VkImageView view, VkFormat format, VkExtent3D extent)
{
    const double bytes = texel_bytes(format);
    const resource_size size = {bytes * extent.width * extent.height * extent.depth, bytes, 1};
    keep(&counting.resources, (uint64_t)view, &size, sizeof size);
}

static VKAPI_ATTR VkResult VKAPI_CALL create_buffer(VkDevice device, const VkBufferCreateInfo *info,
                                                    const VkAllocationCallbacks *with, VkBuffer *made)
{
    const VkResult result = DRIVER(CreateBuffer)(device, info, with, made);
    const resource_size size = {.bytes = (double)info->size};
    if (!result)
        keep(&counting.resources, (uint64_t)*made, &size, sizeof size);
    return result;
}

static VKAPI_ATTR VkResult VKAPI_CALL create_buffer_view(VkDevice device, const VkBufferViewCreateInfo *info,
                                                         const VkAllocationCallbacks *with, VkBufferView *made)
{
    const VkResult result = DRIVER(CreateBufferView)(device, info, with, made);
    if (!result)
        keep_size_of_view((uint64_t)*made, (uint64_t)info->buffer);
    return result;
}

static VKAPI_ATTR VkResult VKAPI_CALL create_image(VkDevice device, const VkImageCreateInfo *info,
                                                   const VkAllocationCallbacks *with, VkImage *made)
{
    const VkResult result = DRIVER(CreateImage)(device, info, with, made);
    resource_size size = {.texel_bytes = texel_bytes(info->format), .layers = info->arrayLayers};
    for (uint32_t level = 0; level < info->mipLevels; level++)
        size.bytes += size.texel_bytes * (info->extent.width >> level) * (info->extent.height >> level) *
                      info->extent.depth * info->arrayLayers;
    if (!result)
        keep(&counting.resources, (uint64_t)*made, &size, sizeof size);
    return result;
}

static VKAPI_ATTR VkResult VKAPI_CALL create_image_view(VkDevice device, const VkImageViewCreateInfo *info,
                                                        const VkAllocationCallbacks *with, VkImageView *made)
{
    const VkResult result = DRIVER(CreateImageView)(device, info, with, made);
    const resource_size *image = result ? NULL : handle_map_find(&counting.resources, (uint64_t)info->image);
    if (image) {
        resource_size size = *image;
        if (info->subresourceRange.layerCount < size.layers) {
            size.bytes *= (double)info->subresourceRange.layerCount / size.layers;
            size.layers = info->subresourceRange.layerCount;
        }
        keep(&counting.resources, (uint64_t)*made, &size, sizeof size);
    }
    return result;
}

static const resource_size *written(const VkWriteDescriptorSet *write)
{
    if (write->pTexelBufferView)
        return handle_map_find(&counting.resources, (uint64_t)write->pTexelBufferView[0]);
    if (write->pBufferInfo)
        return handle_map_find(&counting.resources, (uint64_t)write->pBufferInfo[0].buffer);
    return write->pImageInfo ? handle_map_find(&counting.resources, (uint64_t)write->pImageInfo[0].imageView) : NULL;
}

static VKAPI_ATTR void VKAPI_CALL update_sets(VkDevice device, uint32_t count, const VkWriteDescriptorSet *writes,
                                              uint32_t copy_count, const VkCopyDescriptorSet *copies)
{
    DRIVER(UpdateDescriptorSets)(device, count, writes, copy_count, copies);
    for (uint32_t i = 0; i < count; i++) {
        const uint64_t set = (uint64_t)writes[i].dstSet;
        const resource_size *size = written(&writes[i]);
        if (!handle_map_find(&counting.sets, set))
            keep(&counting.sets, set, &(set_contents){0}, sizeof(set_contents));
        set_contents *contents = handle_map_find(&counting.sets, set);
        if (contents && size && writes[i].dstBinding < SET_BINDINGS)
            contents->bindings[writes[i].dstBinding] = *size;
    }
}

/* ---- shaders and pipelines */

static VKAPI_ATTR VkResult VKAPI_CALL create_module(VkDevice device, const VkShaderModuleCreateInfo *info,
                                                    const VkAllocationCallbacks *with, VkShaderModule *made)
{
    const VkResult result = DRIVER(CreateShaderModule)(device, info, with, made);
    module_code *code = result ? NULL : malloc(sizeof *code + info->codeSize);
    if (code) {
        code->word_count = info->codeSize / 4;
        memcpy(code->words, info->pCode, info->codeSize);
        handle_map_put(&counting.modules, (uint64_t)*made, code);
    }
    return result;
}

/* With the numbers' set behind the others. */
static VKAPI_ATTR VkResult VKAPI_CALL create_layout(VkDevice device, const VkPipelineLayoutCreateInfo *info,
                                                    const VkAllocationCallbacks *with, VkPipelineLayout *made)
{
    VkDescriptorSetLayout sets[8];
    VkPipelineLayoutCreateInfo more = *info;
    memcpy(sets, info->pSetLayouts, info->setLayoutCount * sizeof sets[0]);
    sets[more.setLayoutCount++] = counting.set_layout;
    more.pSetLayouts = sets;
    const VkResult result = DRIVER(CreatePipelineLayout)(device, &more, with, made);
    if (!result)
        keep(&counting.layouts, (uint64_t)*made, &info->setLayoutCount, sizeof info->setLayoutCount);
    return result;
}

typedef struct bound_pass {
    uint32_t index;
    VkPipelineLayout layout;
    VkPipeline counting; /* the same pipeline, which counts */
} bound_pass;

/* The module's copy that counts, for stage `stage` of the pass. */
static VkShaderModule counting_module(VkDevice device, VkShaderModule module, VkPipelineLayout layout,
                                      counted_stage *stage)
{
    const module_code *code = handle_map_find(&counting.modules, (uint64_t)module);
    const uint32_t *set = handle_map_find(&counting.layouts, (uint64_t)layout);
    VkShaderModule made = VK_NULL_HANDLE;
    if (!code || !set || !block_costs_read(code->words, code->word_count, &stage->costs))
        return VK_NULL_HANDLE;
    const uint32_t needed = 2 * stage->costs.block_count;
    if (needed > stage->room) {
        stage->first = counting.number_count;
        stage->room = needed;
        counting.number_count += needed;
    }
    const spirv_count_def def = {code->words, code->word_count, &stage->costs, *set, stage->first};
    size_t word_count;
    uint32_t *words = counting.number_count <= MAX_NUMBERS ? spirv_count_blocks(&def, &word_count) : NULL;
    if (!words)
        return VK_NULL_HANDLE;
    const VkShaderModuleCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO, .codeSize = word_count * 4, .pCode = words};
    DRIVER(CreateShaderModule)(device, &info, NULL, &made);
    free(words);
    return made;
}

static void free_costs(counted_pass *pass)
{
    for (uint32_t i = 0; i < pass->stage_count; i++)
        block_costs_free(&pass->stages[i].costs);
}

/* The place of a pass that has ended and was forgotten, or a new one. */
static counted_pass *new_pass(void)
{
    counted_pass *pass = counting.passes, *end = pass + counting.pass_count;
    while (pass < end && !(pass->ended && !pass->calls && !pass->calls_so_far))
        pass++;
    if (pass == counting.passes + MAX_PASSES)
        return NULL;
    counting.pass_count += pass == end;
    free_costs(pass);
    /* Its numbers may be used again. */
    counted_pass fresh = {.stages = {{.first = pass->stages[0].first, .room = pass->stages[0].room},
                                     {.first = pass->stages[1].first, .room = pass->stages[1].room}}};
    *pass = fresh;
    return pass;
}

static void keep_pass(const counted_pass *pass, VkPipeline pipeline, VkPipelineLayout layout, VkPipeline counts)
{
    const bound_pass bound = {(uint32_t)(pass - counting.passes), layout, counts};
    keep(&counting.pipelines, (uint64_t)pipeline, &bound, sizeof bound);
}

static VKAPI_ATTR VkResult VKAPI_CALL create_compute(VkDevice device, VkPipelineCache cache, uint32_t count,
                                                     const VkComputePipelineCreateInfo *infos,
                                                     const VkAllocationCallbacks *with, VkPipeline *made)
{
    VkResult result = VK_SUCCESS;
    for (uint32_t i = 0; i < count && !result; i++) {
        VkComputePipelineCreateInfo info = infos[i];
        counted_pass *pass = new_pass();
        const VkShaderModule module =
            pass ? counting_module(device, info.stage.module, info.layout, &pass->stages[0]) : VK_NULL_HANDLE;
        if (!module)
            return VK_ERROR_OUT_OF_HOST_MEMORY;
        VkPipeline counts = VK_NULL_HANDLE;
        pass->stage_count = 1;
        result = DRIVER(CreateComputePipelines)(device, cache, 1, &info, with, &made[i]);
        info.stage.module = module;
        if (!result)
            result = DRIVER(CreateComputePipelines)(device, cache, 1, &info, with, &counts);
        DRIVER(DestroyShaderModule)(device, module, NULL);
        if (!result)
            keep_pass(pass, made[i], info.layout, counts);
    }
    return result;
}

/* Bytes of a texel of each color attachment of a render pass. */
typedef struct target_sizes {
    uint32_t count;
    double bytes[8];
} target_sizes;

static VKAPI_ATTR VkResult VKAPI_CALL create_render_pass(VkDevice device, const VkRenderPassCreateInfo *info,
                                                         const VkAllocationCallbacks *with, VkRenderPass *made)
{
    const VkResult result = DRIVER(CreateRenderPass)(device, info, with, made);
    const VkSubpassDescription *first = info->pSubpasses;
    target_sizes sizes = {0};
    for (uint32_t i = 0; !result && i < first->colorAttachmentCount && i < 8; i++) {
        const uint32_t of = first->pColorAttachments[i].attachment;
        sizes.bytes[sizes.count++] = of < info->attachmentCount ? texel_bytes(info->pAttachments[of].format) : 0;
    }
    if (!result)
        keep(&counting.targets, (uint64_t)*made, &sizes, sizeof sizes);
    return result;
}

#define USUAL_TARGET_BYTES 8 /* of four halves */

static double bytes_of_attachment(const VkGraphicsPipelineCreateInfo *info, uint32_t attachment)
{
    const target_sizes *sizes = handle_map_find(&counting.targets, (uint64_t)info->renderPass);
    const VkPipelineRenderingCreateInfo *rendering = info->pNext; /* without a render pass */
    if (sizes && attachment < sizes->count)
        return sizes->bytes[attachment];
    if (!info->renderPass && rendering && attachment < rendering->colorAttachmentCount &&
        rendering->sType == VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO)
        return texel_bytes(rendering->pColorAttachmentFormats[attachment]);
    return USUAL_TARGET_BYTES;
}

/* Attachments that are blended are read and written. */
static float bytes_of_target(const VkGraphicsPipelineCreateInfo *info)
{
    const VkPipelineColorBlendStateCreateInfo *blend = info->pColorBlendState;
    float bytes = info->pDepthStencilState && info->pDepthStencilState->depthTestEnable ? 4 : 0;
    for (uint32_t i = 0; blend && i < blend->attachmentCount; i++)
        if (blend->pAttachments[i].colorWriteMask)
            bytes += (blend->pAttachments[i].blendEnable ? 2 : 1) * (float)bytes_of_attachment(info, i);
    return bytes;
}

static VKAPI_ATTR VkResult VKAPI_CALL create_graphics(VkDevice device, VkPipelineCache cache, uint32_t count,
                                                      const VkGraphicsPipelineCreateInfo *infos,
                                                      const VkAllocationCallbacks *with, VkPipeline *made)
{
    VkResult result = VK_SUCCESS;
    for (uint32_t i = 0; i < count && !result; i++) {
        VkGraphicsPipelineCreateInfo info = infos[i];
        VkPipelineShaderStageCreateInfo stages[2] = {info.pStages[0], info.pStages[1]};
        counted_pass *pass = info.stageCount == 2 ? new_pass() : NULL;
        for (uint32_t k = 0; k < 2; k++)
            stages[k].module =
                pass ? counting_module(device, stages[k].module, info.layout, &pass->stages[k]) : VK_NULL_HANDLE;
        if (!stages[0].module || !stages[1].module)
            return VK_ERROR_OUT_OF_HOST_MEMORY;
        pass->stage_count = 2;
        pass->target_bytes = bytes_of_target(&info);
        VkPipeline counts = VK_NULL_HANDLE;
        result = DRIVER(CreateGraphicsPipelines)(device, cache, 1, &info, with, &made[i]);
        info.pStages = stages;
        if (!result)
            result = DRIVER(CreateGraphicsPipelines)(device, cache, 1, &info, with, &counts);
        for (uint32_t k = 0; k < 2; k++)
            DRIVER(DestroyShaderModule)(device, stages[k].module, NULL);
        if (!result)
            keep_pass(pass, made[i], info.layout, counts);
    }
    return result;
}

static VKAPI_ATTR VkResult VKAPI_CALL set_name(VkDevice device, const VkDebugUtilsObjectNameInfoEXT *info)
{
    const bound_pass *bound =
        info->objectType == VK_OBJECT_TYPE_PIPELINE ? handle_map_find(&counting.pipelines, info->objectHandle) : NULL;
    (void)device;
    if (bound)
        snprintf(counting.passes[bound->index].name, sizeof counting.passes[0].name, "%s", info->pObjectName);
    return VK_SUCCESS;
}

/* ---- commands */

static VKAPI_ATTR void VKAPI_CALL destroy_pipeline(VkDevice device, VkPipeline pipeline,
                                                   const VkAllocationCallbacks *with)
{
    bound_pass *bound = handle_map_find(&counting.pipelines, (uint64_t)pipeline);
    if (bound) {
        DRIVER(DestroyPipeline)(device, bound->counting, with);
        bound->counting = VK_NULL_HANDLE;
        counting.passes[bound->index].ended = true;
    }
    DRIVER(DestroyPipeline)(device, pipeline, with);
}

/* Whether a pass counts in this frame, which its first call decides. */
static bool is_counted(counted_pass *pass)
{
    if (!pass->calls_so_far && !pass->counts) {
        const uint32_t frame = ++pass->frames;
        pass->counts = counting.all || !(frame & (frame - 1));
    }
    return pass->counts;
}

static VKAPI_ATTR void VKAPI_CALL bind_pipeline(VkCommandBuffer cmd, VkPipelineBindPoint point, VkPipeline pipeline)
{
    const bound_pass *bound = handle_map_find(&counting.pipelines, (uint64_t)pipeline);
    counted_pass *pass = bound ? &counting.passes[bound->index] : NULL;
    const bool counts = pass && is_counted(pass);
    DRIVER(CmdBindPipeline)(cmd, point, counts ? bound->counting : pipeline);
    counting.bound[point] = pass;
    const uint32_t *set = bound ? handle_map_find(&counting.layouts, (uint64_t)bound->layout) : NULL;
    if (set)
        DRIVER(CmdBindDescriptorSets)(cmd, point, bound->layout, *set, 1, &counting.set, 0, NULL);
}

static VKAPI_ATTR void VKAPI_CALL bind_sets(VkCommandBuffer cmd, VkPipelineBindPoint point, VkPipelineLayout layout,
                                            uint32_t first, uint32_t count, const VkDescriptorSet *sets,
                                            uint32_t offset_count, const uint32_t *offsets)
{
    const uint32_t *own = handle_map_find(&counting.layouts, (uint64_t)layout);
    DRIVER(CmdBindDescriptorSets)(cmd, point, layout, first, count, sets, offset_count, offsets);
    counting.bound_sets[point] = count ? sets[0] : VK_NULL_HANDLE;
    if (own) /* a layout of other push constants takes the set away */
        DRIVER(CmdBindDescriptorSets)(cmd, point, layout, *own, 1, &counting.set, 0, NULL);
}

static void note_sizes(counted_stage *stage, const set_contents *contents)
{
    for (uint32_t i = 0; i < stage->costs.resource_count; i++) {
        const uint32_t binding = stage->costs.resources[i].binding;
        const resource_size *size = binding < SET_BINDINGS ? &contents->bindings[binding] : NULL;
        if (!size || size->bytes <= stage->sizes[i])
            continue;
        stage->sizes[i] = size->bytes;
        stage->texel_share[i] = size->texel_bytes ? size->texel_bytes / 8 : 1;
    }
}

static void forget_sizes(counted_pass *pass)
{
    for (uint32_t i = 0; i < pass->stage_count; i++)
        memset(pass->stages[i].sizes, 0, sizeof pass->stages[i].sizes);
}

static void note_call(VkPipelineBindPoint point)
{
    counted_pass *pass = counting.bound[point];
    const set_contents *contents = handle_map_find(&counting.sets, (uint64_t)counting.bound_sets[point]);
    if (!pass)
        return;
    if (!pass->calls_so_far)
        forget_sizes(pass);
    pass->times_so_far += !pass->calls_so_far || pass->last_barrier != counting.barriers;
    pass->last_barrier = counting.barriers;
    pass->calls_so_far++;
    pass->waits_so_far += counting.behind_barrier;
    counting.behind_barrier = false;
    for (uint32_t i = 0; i < pass->stage_count && contents; i++)
        note_sizes(&pass->stages[i], contents);
}

/* ---- times */

static void begin_draws(VkCommandBuffer cmd, const char *name)
{
    counting.draws.call = call_times_begin(&counting.times, cmd);
    counting.draws.first = NULL;
    counting.draws.name = name;
    counting.draws.is_open = true;
    counting.draws.is_counted = false;
}

static void end_draws(VkCommandBuffer cmd)
{
    call_times_end(&counting.times, cmd, counting.draws.call);
    if (counting.draws.call < CALL_TIMES_MAX)
        counting.timed[counting.draws.call] = counting.draws.is_counted ? NULL : counting.draws.first;
    counting.draws.is_open = false;
}

static void note_draw(void)
{
    counted_pass *pass = counting.bound[VK_PIPELINE_BIND_POINT_GRAPHICS];
    if (!counting.draws.is_open || !pass)
        return;
    counting.draws.first = counting.draws.first ? counting.draws.first : pass;
    counting.draws.is_counted |= pass->counts;
    snprintf(pass->row, sizeof pass->row, "%s", counting.draws.name ? counting.draws.name : counting.draws.first->name);
}

static uint32_t begin_dispatch(VkCommandBuffer cmd)
{
    counted_pass *pass = counting.bound[VK_PIPELINE_BIND_POINT_COMPUTE];
    const uint32_t call = pass && !pass->counts ? call_times_begin(&counting.times, cmd) : CALL_TIMES_MAX;
    if (call < CALL_TIMES_MAX)
        counting.timed[call] = pass;
    return call;
}

static void keep_time(counted_pass *pass, double seconds)
{
    pass->seconds[pass->time_count++ % COUNTED_TIMES] = seconds;
}

static void read_times(void)
{
    if (!counting.times.pool)
        return;
    const uint32_t count = call_times_read(&counting.times);
    for (uint32_t i = 0; i < count; i++)
        if (counting.timed[i])
            counting.timed[i]->seconds_so_far += counting.times.seconds[i];
    for (uint32_t i = 0; i < counting.pass_count; i++) {
        counted_pass *pass = &counting.passes[i];
        if (pass->calls_so_far && !pass->counts && pass->seconds_so_far > 0)
            keep_time(pass, pass->seconds_so_far);
        pass->seconds_so_far = 0;
    }
}

bool counting_time_calls(char *error, size_t error_size)
{
    return call_times_open(&counting.times, counting.device, error, error_size);
}

void counting_begin_draws(VkCommandBuffer cmd, const char *name)
{
    if (counting.times.pool)
        begin_draws(cmd, name);
}

void counting_end_draws(VkCommandBuffer cmd)
{
    if (counting.times.pool)
        end_draws(cmd);
}

static VKAPI_ATTR void VKAPI_CALL begin_render_pass(VkCommandBuffer cmd, const VkRenderPassBeginInfo *info,
                                                    VkSubpassContents contents)
{
    counting_begin_draws(cmd, NULL);
    DRIVER(CmdBeginRenderPass)(cmd, info, contents);
}

static VKAPI_ATTR void VKAPI_CALL end_render_pass(VkCommandBuffer cmd)
{
    DRIVER(CmdEndRenderPass)(cmd);
    counting_end_draws(cmd);
}

/* ---- calls */

#define DISPATCH(name, parameters, arguments)                   \
    static VKAPI_ATTR void VKAPI_CALL through_##name parameters \
    {                                                           \
        note_call(VK_PIPELINE_BIND_POINT_COMPUTE);              \
        const uint32_t call = begin_dispatch(c);                \
        DRIVER(name) arguments;                                 \
        call_times_end(&counting.times, c, call);               \
    }
DISPATCH(CmdDispatch, (VkCommandBuffer c, uint32_t x, uint32_t y, uint32_t z), (c, x, y, z))
DISPATCH(CmdDispatchIndirect, (VkCommandBuffer c, VkBuffer b, VkDeviceSize at), (c, b, at))

#define DRAW(name, parameters, arguments)                       \
    static VKAPI_ATTR void VKAPI_CALL through_##name parameters \
    {                                                           \
        note_call(VK_PIPELINE_BIND_POINT_GRAPHICS);             \
        note_draw();                                            \
        DRIVER(name) arguments;                                 \
    }
DRAW(CmdDraw, (VkCommandBuffer c, uint32_t n, uint32_t i, uint32_t f, uint32_t k), (c, n, i, f, k))
DRAW(CmdDrawIndexed, (VkCommandBuffer c, uint32_t n, uint32_t i, uint32_t f, int32_t v, uint32_t k), (c, n, i, f, v, k))
DRAW(CmdDrawIndirect, (VkCommandBuffer c, VkBuffer b, VkDeviceSize at, uint32_t n, uint32_t s), (c, b, at, n, s))
DRAW(CmdDrawIndexedIndirect, (VkCommandBuffer c, VkBuffer b, VkDeviceSize at, uint32_t n, uint32_t s), (c, b, at, n, s))

static VKAPI_ATTR void VKAPI_CALL barrier(VkCommandBuffer cmd, VkPipelineStageFlags before, VkPipelineStageFlags after,
                                          VkDependencyFlags flags, uint32_t count, const VkMemoryBarrier *barriers,
                                          uint32_t buffer_count, const VkBufferMemoryBarrier *buffers,
                                          uint32_t image_count, const VkImageMemoryBarrier *images)
{
    counting.behind_barrier = true;
    counting.barriers++;
    DRIVER(CmdPipelineBarrier)
    (cmd, before, after, flags, count, barriers, buffer_count, buffers, image_count, images);
}

static VKAPI_ATTR void VKAPI_CALL fill_buffer(VkCommandBuffer cmd, VkBuffer to, VkDeviceSize at, VkDeviceSize size,
                                              uint32_t value)
{
    const resource_size *whole = handle_map_find(&counting.resources, (uint64_t)to);
    counting.moved_so_far += size == VK_WHOLE_SIZE ? whole ? whole->bytes : 0 : (double)size;
    DRIVER(CmdFillBuffer)(cmd, to, at, size, value);
}

static VKAPI_ATTR void VKAPI_CALL copy_buffer(VkCommandBuffer cmd, VkBuffer from, VkBuffer to, uint32_t count,
                                              const VkBufferCopy *regions)
{
    for (uint32_t i = 0; i < count; i++)
        counting.moved_so_far += 2 * (double)regions[i].size;
    DRIVER(CmdCopyBuffer)(cmd, from, to, count, regions);
}

static VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL get_of_device(VkDevice device, const char *name)
{
#define COUNTED(call, function)              \
    {                                        \
        call, (PFN_vkVoidFunction)(function) \
    }
    static const struct {
        const char *name;
        PFN_vkVoidFunction function;
    } counted[] = {COUNTED("vkCreateBuffer", create_buffer),
                   COUNTED("vkCreateBufferView", create_buffer_view),
                   COUNTED("vkCreateImage", create_image),
                   COUNTED("vkCreateImageView", create_image_view),
                   COUNTED("vkUpdateDescriptorSets", update_sets),
                   COUNTED("vkCreateShaderModule", create_module),
                   COUNTED("vkCreatePipelineLayout", create_layout),
                   COUNTED("vkCreateComputePipelines", create_compute),
                   COUNTED("vkCreateGraphicsPipelines", create_graphics),
                   COUNTED("vkCreateRenderPass", create_render_pass),
                   COUNTED("vkSetDebugUtilsObjectNameEXT", set_name),
                   COUNTED("vkDestroyPipeline", destroy_pipeline),
                   COUNTED("vkCmdBindPipeline", bind_pipeline),
                   COUNTED("vkCmdBindDescriptorSets", bind_sets),
                   COUNTED("vkCmdDispatch", through_CmdDispatch),
                   COUNTED("vkCmdDispatchIndirect", through_CmdDispatchIndirect),
                   COUNTED("vkCmdDraw", through_CmdDraw),
                   COUNTED("vkCmdDrawIndexed", through_CmdDrawIndexed),
                   COUNTED("vkCmdDrawIndirect", through_CmdDrawIndirect),
                   COUNTED("vkCmdDrawIndexedIndirect", through_CmdDrawIndexedIndirect),
                   COUNTED("vkCmdBeginRenderPass", begin_render_pass),
                   COUNTED("vkCmdEndRenderPass", end_render_pass),
                   COUNTED("vkCmdPipelineBarrier", barrier),
                   COUNTED("vkCmdFillBuffer", fill_buffer),
                   COUNTED("vkCmdCopyBuffer", copy_buffer)};
    for (size_t i = 0; i < sizeof counted / sizeof counted[0]; i++)
        if (!strcmp(counted[i].name, name))
            return counted[i].function;
    return vkGetDeviceProcAddr(device, name);
}

PFN_vkVoidFunction VKAPI_CALL counting_get(VkInstance instance, const char *name)
{
    return !strcmp(name, "vkGetDeviceProcAddr") ? (PFN_vkVoidFunction)get_of_device
                                                : vkGetInstanceProcAddr(instance, name);
}

/* ---- the numbers */

void counting_prepare(void)
{
    setenv("LP_NUM_THREADS", "1", 1);
}

bool counting_open(host_device *device, char *error, size_t error_size)
{
    static const VkDescriptorType type = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
    const host_set_shape shape = {&type, 1, VK_SHADER_STAGE_ALL};
    memset(&counting, 0, sizeof counting);
    counting.device = device;
    if (device->properties.deviceType != VK_PHYSICAL_DEVICE_TYPE_CPU)
        return host_fail(error, error_size, "passes are counted on software Vulkan only: --device cpu");
    if (!host_set_layout_create(device, &shape, &counting.set_layout, error, error_size) ||
        !host_set_pool_create(device, &shape, 1, &counting.pool, error, error_size) ||
        !host_sets_allocate(device, counting.pool, counting.set_layout, 1, &counting.set, error, error_size) ||
        !host_buffer_create(device, MAX_NUMBERS * sizeof(uint32_t), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
                            HOST_BUFFER_READBACK, "counts of blocks", &counting.numbers, error, error_size))
        return false;
    host_set_write_buffer(device, counting.set, 0, type, counting.numbers.buffer);
    memset(counting.numbers.mapped, 0, counting.numbers.size);
    counting.kept = calloc(MAX_NUMBERS, sizeof *counting.kept);
    return counting.kept || host_fail(error, error_size, "no memory for counts");
}

void counting_close(host_device *device)
{
    for (uint32_t i = 0; i < counting.pass_count; i++)
        free_costs(&counting.passes[i]);
    handle_map *maps[] = {&counting.modules, &counting.layouts,   &counting.resources,
                          &counting.sets,    &counting.pipelines, &counting.targets};
    for (size_t i = 0; i < sizeof maps / sizeof maps[0]; i++)
        handle_map_free(maps[i]);
    free(counting.kept);
    host_buffer_destroy(device, &counting.numbers);
    call_times_close(&counting.times);
    vkDestroyDescriptorPool(device->device, counting.pool, NULL);
    vkDestroyDescriptorSetLayout(device->device, counting.set_layout, NULL);
    memset(&counting, 0, sizeof counting);
}

static void keep_numbers(const counted_stage *stage)
{
    const uint32_t count = 2 * stage->costs.block_count;
    uint32_t *numbers = (uint32_t *)counting.numbers.mapped + stage->first;
    memcpy(counting.kept + stage->first, numbers, count * sizeof *numbers);
    memset(numbers, 0, count * sizeof *numbers);
}

void counting_end_frame(void)
{
    host_buffer_invalidate(counting.device, &counting.numbers);
    read_times();
    for (uint32_t i = 0; i < counting.pass_count; i++) {
        counted_pass *pass = &counting.passes[i];
        const bool counted = pass->counts && pass->calls_so_far;
        if (counted) {
            pass->calls = pass->calls_so_far;
            pass->waits = pass->waits_so_far;
            pass->times = pass->times_so_far;
        }
        pass->calls_so_far = pass->waits_so_far = pass->times_so_far = 0;
        pass->counts = false;
        for (uint32_t k = 0; counted && k < pass->stage_count; k++)
            keep_numbers(&pass->stages[k]);
    }
    counting.moved_bytes = counting.moved_so_far;
    counting.moved_so_far = 0;
    counting.all = false;
}

void counting_all_of_next(void)
{
    counting.all = true;
}

void counting_forget(void)
{
    for (uint32_t i = 0; i < counting.pass_count; i++)
        counting.passes[i].calls = counting.passes[i].frames = counting.passes[i].time_count = 0;
}

uint32_t counting_pass_count(void)
{
    return counting.pass_count;
}

const counted_pass *counting_pass(uint32_t index)
{
    return &counting.passes[index];
}

const uint32_t *counting_numbers(void)
{
    return counting.kept;
}

double counting_moved_bytes(void)
{
    return counting.moved_bytes;
}
