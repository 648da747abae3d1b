/* here.c - see here.h. */
#include "bench/model/here.h"

#include "bench/machine_limits.h"

#include "work_0_comp.spv.h"
#include "work_10_comp.spv.h"
#include "work_11_comp.spv.h"
#include "work_1_comp.spv.h"
#include "work_2_comp.spv.h"
#include "work_3_comp.spv.h"
#include "work_4_comp.spv.h"
#include "work_5_comp.spv.h"
#include "work_6_comp.spv.h"
#include "work_7_comp.spv.h"
#include "work_8_comp.spv.h"
#include "work_9_comp.spv.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define LOCAL_SIZE 64    /* of work.comp */
#define WORDS      65536 /* of work.comp */
#define SIDE       256   /* texels */

/* A kernel, and the work that its time tells. In this order each has little of what comes behind it. */
typedef struct kernel {
    const char *name;
    host_code code;
    uint32_t groups, trips;
    model_work tells;
} kernel;

#define CODE(n)                                         \
    {                                                   \
        work_##n##_comp_spv, sizeof work_##n##_comp_spv \
    }
static const kernel kernels[] = {
    {"here.call", CODE(0), 1, 0, MODEL_WORKS}, /* of nothing: what a call takes */
    {"here.start", CODE(0), 4096, 0, MODEL_START},
    {"here.full", CODE(1), 64, 400, MODEL_FULL},
    {"here.branch", CODE(9), 64, 1000, MODEL_BRANCH},
    {"here.slow", CODE(2), 64, 200, MODEL_SLOW},
    {"here.loads", CODE(3), 64, 100, MODEL_LOADS},
    {"here.shared", CODE(4), 64, 100, MODEL_SHARED},
    {"here.fetch", CODE(5), 64, 100, MODEL_FETCH},
    {"here.sample", CODE(6), 64, 100, MODEL_SAMPLE},
    {"here.atomic", CODE(7), 64, 100, MODEL_ATOMIC},
    {"here.uniform", CODE(8), 64, 400, MODEL_UNIFORM},
    {"here.constant", CODE(11), 64, 400, MODEL_CONSTANT},
    {"here.barrier", CODE(10), 64, 100, MODEL_BARRIER},
};
enum { KERNELS = sizeof kernels / sizeof kernels[0], FRAMES = 20, ROUNDS = 8 };

typedef struct workshop {
    host_device *device;
    host_buffer words, settings;
    host_image texels;
    VkSampler sampler;
    host_bindings bindings;
    VkPipelineLayout layout;
    VkPipeline pipelines[KERNELS];
} workshop;

/* As a context finds them: counted. */
#define COUNTED(w, name)                                                                                               \
    ((PFN_vk##name)((PFN_vkGetDeviceProcAddr)counting_get(VK_NULL_HANDLE, "vkGetDeviceProcAddr"))((w)->device->device, \
                                                                                                  "vk" #name))

static bool open_resources(workshop *w, char *error, size_t size)
{
    static const VkDescriptorType types[] = {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                                             VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
                                             VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER};
    const host_bindings_def bindings = {.shape = {types, 4, VK_SHADER_STAGE_COMPUTE_BIT}, .set_count = 1};
    const host_image_def image = {
        .format = VK_FORMAT_R16G16B16A16_SFLOAT, .extent = {SIDE, SIDE, 1}, .name = "texels of a bench"};
    const VkBufferUsageFlags usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
    const size_t bytes = (size_t)8 * SIDE * SIDE;
    void *zeros = calloc(1, bytes);
    const bool good =
        zeros && host_image_create_with(w->device, &image, zeros, bytes, 8, &w->texels, error, size) &&
        host_buffer_create_with(w->device, zeros, WORDS * 4, usage, "words of a bench", &w->words, error, size) &&
        host_buffer_create(w->device, 32, usage | VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT, HOST_BUFFER_UPLOAD,
                           "settings of a bench", &w->settings, error, size) &&
        host_sampler_create(w->device, HOST_SAMPLE_LINEAR, &w->sampler, error, size) &&
        host_bindings_create(w->device, &bindings, &w->bindings, error, size);
    free(zeros);
    if (!good)
        return false;
    host_set_write_buffer(w->device, w->bindings.sets[0], 0, types[0], w->words.buffer);
    host_set_write_buffer(w->device, w->bindings.sets[0], 1, types[1], w->settings.buffer);
    host_set_write_buffer(w->device, w->bindings.sets[0], 3, types[3], w->settings.buffer);
    host_set_write_image(w->device, w->bindings.sets[0], 2, w->sampler, w->texels.view,
                         VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
    return true;
}

static bool open_kernel(workshop *w, int i)
{
    const VkShaderModuleCreateInfo code = {.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO,
                                           .codeSize = kernels[i].code.size,
                                           .pCode = kernels[i].code.spirv};
    VkComputePipelineCreateInfo info = {.sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO,
                                        .stage = {.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
                                                  .stage = VK_SHADER_STAGE_COMPUTE_BIT,
                                                  .pName = "main"},
                                        .layout = w->layout};
    if (COUNTED(w, CreateShaderModule)(w->device->device, &code, NULL, &info.stage.module))
        return false;
    const VkResult result =
        COUNTED(w, CreateComputePipelines)(w->device->device, VK_NULL_HANDLE, 1, &info, NULL, &w->pipelines[i]);
    vkDestroyShaderModule(w->device->device, info.stage.module, NULL);
    const VkDebugUtilsObjectNameInfoEXT name = {.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_OBJECT_NAME_INFO_EXT,
                                                .objectType = VK_OBJECT_TYPE_PIPELINE,
                                                .objectHandle = (uint64_t)w->pipelines[i],
                                                .pObjectName = kernels[i].name};
    COUNTED(w, SetDebugUtilsObjectNameEXT)(w->device->device, &name);
    return result == VK_SUCCESS;
}

static bool open_kernels(workshop *w, char *error, size_t size)
{
    const VkPipelineLayoutCreateInfo layout = {.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
                                               .setLayoutCount = 1,
                                               .pSetLayouts = &w->bindings.set_layout};
    bool good = COUNTED(w, CreatePipelineLayout)(w->device->device, &layout, NULL, &w->layout) == VK_SUCCESS;
    for (int i = 0; i < KERNELS && good; i++)
        good = open_kernel(w, i);
    return good || host_fail(error, size, "kernels of the bench cannot be made");
}

static bool run_kernel(workshop *w, int i, char *error, size_t size)
{
    VkCommandBuffer cmd;
    if (!host_begin_frame(w->device, &cmd, error, size))
        return false;
    counting_end_frame();
    memcpy(w->settings.mapped, &kernels[i].trips, sizeof kernels[i].trips);
    COUNTED(w, CmdBindPipeline)(cmd, VK_PIPELINE_BIND_POINT_COMPUTE, w->pipelines[i]);
    COUNTED(w, CmdBindDescriptorSets)
    (cmd, VK_PIPELINE_BIND_POINT_COMPUTE, w->layout, 0, 1, w->bindings.sets, 0, NULL);
    COUNTED(w, CmdDispatch)(cmd, kernels[i].groups, 1, 1);
    return host_submit(w->device, error, size) && host_wait(w->device, error, size);
}

/* What the time of a kernel leaves for the work that it tells. Kernels have some of each other's work, so all are gone
 * through until nothing changes. */
static void solve(const model_pass *passes)
{
    for (int round = 0; round < ROUNDS; round++)
        for (int i = 0; i < KERNELS; i++) {
            const model_pass *p = &passes[i];
            const model_work tells = kernels[i].tells;
            double others = tells == MODEL_WORKS ? 0 : model_here.call_s;
            if (tells == MODEL_WORKS) {
                model_here.call_s = p->measured_s;
                continue;
            }
            for (int k = 0; k < MODEL_WORKS; k++)
                others += k == (int)tells ? 0 : p->work[k] * model_here.issue[k] / model_here.clock_hz;
            model_here.issue[tells] = fmax(0, p->measured_s - others) * model_here.clock_hz / p->work[tells];
        }
}

static bool measure_kernels(workshop *w, char *error, size_t size)
{
    static model_pass passes[MODEL_MAX_PASSES];
    for (int i = 0; i < KERNELS; i++)
        for (int frame = 0; frame < FRAMES; frame++)
            if (!run_kernel(w, i, error, size))
                return false;
    counting_end_frame();
    if (model_passes(&model_here, passes) != KERNELS)
        return host_fail(error, size, "kernels of the bench were not counted");
    solve(passes);
    return true;
}

/* Memory by a copy, which reads and writes, of more than caches hold; fragments by filling a picture. */
static bool measure_limits(host_device *device, const host_target *target, char *error, size_t size)
{
    enum { DROPS = 1 << 22 };
    limits *l;
    if (!limits_create(device, target, DROPS, &l, error, size))
        return false;
    const double copy_s = 1e-3 * limits_copy_ms(device, l), fill_s = 1e-3 * limits_fill_ms(device, l, target);
    const double waves = (double)target->width * target->height / model_here.lanes;
    limits_destroy(device, &l);
    if (copy_s <= 0 || fill_s <= 0)
        return host_fail(error, size, "the device could not be measured");
    model_here.memory_bytes_s = 2.0 * 16 * DROPS / copy_s;
    model_here.issue[MODEL_FRAGMENT] = fill_s * model_here.clock_hz / waves;
    return true;
}

static void close_workshop(workshop *w)
{
    for (int i = 0; i < KERNELS; i++)
        if (w->pipelines[i])
            COUNTED(w, DestroyPipeline)(w->device->device, w->pipelines[i], NULL);
    vkDestroyPipelineLayout(w->device->device, w->layout, NULL);
    host_bindings_destroy(w->device, &w->bindings);
    vkDestroySampler(w->device->device, w->sampler, NULL);
    host_image_destroy(w->device, &w->texels);
    host_buffer_destroy(w->device, &w->words);
    host_buffer_destroy(w->device, &w->settings);
    counting_forget();
}

bool model_here_measure(host_device *device, const host_target *target, char *error, size_t error_size)
{
    workshop w = {.device = device};
    const bool good = measure_limits(device, target, error, error_size) && open_resources(&w, error, error_size) &&
                      open_kernels(&w, error, error_size) && measure_kernels(&w, error, error_size);
    close_workshop(&w);
    return good;
}
