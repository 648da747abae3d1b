/* kept_pipelines.h - a pipeline cache that outlives contexts, so that each kind of pipeline is compiled once per
 * process.
 *
 * Software Vulkan needs 10 to 75 ms to compile a pipeline, and tests create the same hundred in every case. The first
 * of a kind is cached until kept_forget, even if its context is destroyed. Vulkan lets a pipeline outlive its layout
 * and render pass, and lets it be used with any compatible ones. Validation sees each kind once, with its shaders.
 *
 * A shader module is then a number that identifies its code. Two pipelines are of one kind if all their inputs are
 * equal: code, constants, fixed state, and the compatibility of their render passes. Layouts follow from the shaders.
 * That is enough for the library's pipelines. */
#ifndef VIRGA_TESTS_KEPT_PIPELINES_H
#define VIRGA_TESTS_KEPT_PIPELINES_H

#include <dlfcn.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <vulkan/vulkan.h>

/* A description as bytes, to compare with others. */
typedef struct kept_key {
    uint32_t size;
    unsigned char bytes[1020];
} kept_key;

typedef struct kept_pass {
    VkRenderPass pass;
    kept_key key;
} kept_pass;

static struct kept_all {
    VkDevice device;
    struct kept_code {
        uint32_t *code;
        size_t size;
    } codes[512]; /* index: number of the module - 1 */
    uint32_t code_count;
    struct kept_pipeline {
        kept_key key;
        VkPipeline pipeline;
    } pipelines[1024];
    uint32_t pipeline_count;
    kept_pass passes[256]; /* the live ones */
    uint32_t pass_count;
} kept_all;

#define KEPT_CAPACITY(array) (sizeof(array) / sizeof(array)[0])

/* A limit of this header is exceeded: increase it. */
static inline void kept_require(bool condition)
{
    if (condition)
        return;
    fprintf(stderr, "kept_pipelines.h: a table is full\n");
    abort();
}

static inline void kept_add(kept_key *key, const void *bytes, size_t size)
{
    kept_require(key->size + size <= sizeof key->bytes);
    memcpy(key->bytes + key->size, bytes, size);
    key->size += (uint32_t)size;
}

static inline void kept_add_word(kept_key *key, uint64_t word)
{
    kept_add(key, &word, sizeof word);
}

static inline bool kept_equal(const kept_key *a, const kept_key *b)
{
    return a->size == b->size && !memcmp(a->bytes, b->bytes, a->size);
}

/* ---- render passes, those of hosts included: this vkCreateRenderPass replaces the loader's */

static inline void kept_add_references(kept_key *key, const VkAttachmentReference *references, uint32_t count)
{
    kept_add_word(key, references ? count : 0);
    for (uint32_t i = 0; references && i < count; i++)
        kept_add_word(key, references[i].attachment);
}

/* The properties that compatible passes share: formats, samples, references and dependencies. */
static inline void kept_describe_pass(const VkRenderPassCreateInfo *info, kept_key *key)
{
    key->size = 0;
    for (uint32_t i = 0; i < info->attachmentCount; i++)
        kept_add_word(key, (uint64_t)info->pAttachments[i].format << 32 | info->pAttachments[i].samples);
    for (uint32_t i = 0; i < info->subpassCount; i++) {
        const VkSubpassDescription *subpass = &info->pSubpasses[i];
        kept_add_references(key, subpass->pInputAttachments, subpass->inputAttachmentCount);
        kept_add_references(key, subpass->pColorAttachments, subpass->colorAttachmentCount);
        kept_add_references(key, subpass->pResolveAttachments, subpass->colorAttachmentCount);
        kept_add_references(key, subpass->pDepthStencilAttachment, 1);
    }
    kept_add(key, info->pDependencies, info->dependencyCount * sizeof *info->pDependencies);
}

static inline kept_pass *kept_find_pass(VkRenderPass pass)
{
    for (uint32_t i = 0; i < kept_all.pass_count; i++)
        if (kept_all.passes[i].pass == pass)
            return &kept_all.passes[i];
    return NULL;
}

VKAPI_ATTR VkResult VKAPI_CALL vkCreateRenderPass(VkDevice device, const VkRenderPassCreateInfo *info,
                                                  const VkAllocationCallbacks *allocator, VkRenderPass *pass)
{
    PFN_vkCreateRenderPass create = NULL;
    void *symbol = dlsym(RTLD_NEXT, "vkCreateRenderPass");
    memcpy(&create, &symbol, sizeof create);
    const VkResult result = create(device, info, allocator, pass);
    if (result == VK_SUCCESS) {
        kept_pass *there = kept_find_pass(*pass);
        if (!there) {
            kept_require(kept_all.pass_count < KEPT_CAPACITY(kept_all.passes));
            there = &kept_all.passes[kept_all.pass_count++];
        }
        there->pass = *pass;
        kept_describe_pass(info, &there->key);
    }
    return result;
}

VKAPI_ATTR void VKAPI_CALL vkDestroyRenderPass(VkDevice device, VkRenderPass pass,
                                               const VkAllocationCallbacks *allocator)
{
    PFN_vkDestroyRenderPass destroy = NULL;
    void *symbol = dlsym(RTLD_NEXT, "vkDestroyRenderPass");
    memcpy(&destroy, &symbol, sizeof destroy);
    kept_pass *there = pass ? kept_find_pass(pass) : NULL;
    if (there)
        *there = kept_all.passes[--kept_all.pass_count];
    destroy(device, pass, allocator);
}

/* ---- modules */

static inline VkShaderModule kept_number_module(const VkShaderModuleCreateInfo *info)
{
    uint32_t i = 0;
    while (i < kept_all.code_count &&
           (kept_all.codes[i].size != info->codeSize || memcmp(kept_all.codes[i].code, info->pCode, info->codeSize)))
        i++;
    if (i == kept_all.code_count) {
        uint32_t *code = malloc(info->codeSize);
        kept_require(code && i < KEPT_CAPACITY(kept_all.codes));
        memcpy(code, info->pCode, info->codeSize);
        kept_all.codes[i].code = code;
        kept_all.codes[i].size = info->codeSize;
        kept_all.code_count++;
    }
    return (VkShaderModule)(uintptr_t)(i + 1);
}

static inline VkShaderModule kept_real_module(VkDevice device, VkShaderModule number)
{
    const struct kept_code *code = &kept_all.codes[(uintptr_t)number - 1];
    const VkShaderModuleCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO, .codeSize = code->size, .pCode = code->code};
    VkShaderModule module = VK_NULL_HANDLE;
    if (vkCreateShaderModule(device, &info, NULL, &module) != VK_SUCCESS)
        abort();
    return module;
}

/* ---- pipelines */

static inline void kept_add_stage(kept_key *key, const VkPipelineShaderStageCreateInfo *stage)
{
    const VkSpecializationInfo *constants = stage->pSpecializationInfo;
    kept_add_word(key, (uint64_t)stage->stage << 32 | (uint32_t)(uintptr_t)stage->module);
    if (constants)
        kept_add(key, constants->pData, constants->dataSize);
}

static inline void kept_add_target(kept_key *key, const VkGraphicsPipelineCreateInfo *info)
{
    const VkPipelineRenderingCreateInfo *rendering = info->pNext;
    if (info->renderPass) {
        const kept_pass *pass = kept_find_pass(info->renderPass);
        kept_require(pass); /* created by vkCreateRenderPass above, like all passes */
        kept_add(key, pass->key.bytes, pass->key.size);
        kept_add_word(key, info->subpass);
    } else {
        kept_add_word(key, (uint64_t)rendering->depthAttachmentFormat << 32 | rendering->stencilAttachmentFormat);
        for (uint32_t i = 0; i < rendering->colorAttachmentCount; i++)
            kept_add_word(key, rendering->pColorAttachmentFormats[i]);
    }
}

static inline void kept_describe_graphics(const VkGraphicsPipelineCreateInfo *info, kept_key *key)
{
    const VkPipelineVertexInputStateCreateInfo *input = info->pVertexInputState;
    const VkPipelineColorBlendStateCreateInfo *blend = info->pColorBlendState;
    const VkPipelineDepthStencilStateCreateInfo *depth = info->pDepthStencilState;
    key->size = 0;
    for (uint32_t i = 0; i < info->stageCount; i++)
        kept_add_stage(key, &info->pStages[i]);
    kept_add_word(key, input->vertexBindingDescriptionCount ? input->pVertexBindingDescriptions[0].stride : 0);
    kept_add_word(key, info->pInputAssemblyState->topology);
    kept_add_word(key, (uint64_t)info->pRasterizationState->cullMode << 32 | info->pDynamicState->dynamicStateCount);
    kept_add_word(key, info->pMultisampleState->rasterizationSamples);
    kept_add_word(key, (uint64_t)depth->depthCompareOp << 2 | depth->depthTestEnable << 1 | depth->depthWriteEnable);
    kept_add(key, blend->pAttachments, blend->attachmentCount * sizeof *blend->pAttachments);
    kept_add_target(key, info);
}

/* The cached pipeline of that kind, or the entry to store it in. */
static inline VkPipeline *kept_find(VkDevice device, const kept_key *key)
{
    uint32_t i = 0;
    while (i < kept_all.pipeline_count && !kept_equal(&kept_all.pipelines[i].key, key))
        i++;
    kept_require(i < KEPT_CAPACITY(kept_all.pipelines));
    kept_all.pipelines[i].key = *key;
    kept_all.pipeline_count += i == kept_all.pipeline_count;
    kept_all.device = device;
    return &kept_all.pipelines[i].pipeline;
}

static inline VkResult kept_compute(VkDevice device, VkPipelineCache cache, const VkComputePipelineCreateInfo *given,
                                    VkPipeline *made)
{
    kept_key key = {0};
    kept_add_stage(&key, &given->stage);
    VkPipeline *there = kept_find(device, &key);
    if (!*there) {
        VkComputePipelineCreateInfo info = *given;
        info.stage.module = kept_real_module(device, given->stage.module);
        const VkResult result = vkCreateComputePipelines(device, cache, 1, &info, NULL, there);
        vkDestroyShaderModule(device, info.stage.module, NULL);
        if (result != VK_SUCCESS)
            return result;
    }
    *made = *there;
    return VK_SUCCESS;
}

static inline VkResult kept_graphics(VkDevice device, VkPipelineCache cache, const VkGraphicsPipelineCreateInfo *given,
                                     VkPipeline *made)
{
    kept_key key;
    kept_describe_graphics(given, &key);
    VkPipeline *there = kept_find(device, &key);
    if (!*there) {
        VkPipelineShaderStageCreateInfo stages[2] = {given->pStages[0], given->pStages[1]};
        VkGraphicsPipelineCreateInfo info = *given;
        info.pStages = stages;
        for (int i = 0; i < 2; i++)
            stages[i].module = kept_real_module(device, stages[i].module);
        const VkResult result = vkCreateGraphicsPipelines(device, cache, 1, &info, NULL, there);
        for (int i = 0; i < 2; i++)
            vkDestroyShaderModule(device, stages[i].module, NULL);
        if (result != VK_SUCCESS)
            return result;
    }
    *made = *there;
    return VK_SUCCESS;
}

/* Call it before the device is destroyed. */
static inline void kept_forget(void)
{
    for (uint32_t i = 0; i < kept_all.pipeline_count; i++)
        vkDestroyPipeline(kept_all.device, kept_all.pipelines[i].pipeline, NULL);
    for (uint32_t i = 0; i < kept_all.code_count; i++)
        free(kept_all.codes[i].code);
    memset(kept_all.codes, 0, sizeof kept_all.codes);
    memset(kept_all.pipelines, 0, sizeof kept_all.pipelines);
    kept_all.code_count = kept_all.pipeline_count = 0;
}

/* ---- for a context: these functions replace the loader's */

static inline VKAPI_ATTR VkResult VKAPI_CALL kept_CreateShaderModule(VkDevice device,
                                                                     const VkShaderModuleCreateInfo *info,
                                                                     const VkAllocationCallbacks *allocator,
                                                                     VkShaderModule *module)
{
    (void)device, (void)allocator;
    *module = kept_number_module(info);
    return VK_SUCCESS;
}

static inline VKAPI_ATTR void VKAPI_CALL kept_DestroyShaderModule(VkDevice device, VkShaderModule module,
                                                                  const VkAllocationCallbacks *allocator)
{
    (void)device, (void)module, (void)allocator;
}

static inline VKAPI_ATTR VkResult VKAPI_CALL kept_CreateComputePipelines(VkDevice device, VkPipelineCache cache,
                                                                         uint32_t count,
                                                                         const VkComputePipelineCreateInfo *infos,
                                                                         const VkAllocationCallbacks *allocator,
                                                                         VkPipeline *made)
{
    (void)allocator;
    VkResult result = VK_SUCCESS;
    memset(made, 0, count * sizeof *made);
    for (uint32_t i = 0; i < count && result == VK_SUCCESS; i++)
        result = kept_compute(device, cache, &infos[i], &made[i]);
    return result;
}

static inline VKAPI_ATTR VkResult VKAPI_CALL kept_CreateGraphicsPipelines(VkDevice device, VkPipelineCache cache,
                                                                          uint32_t count,
                                                                          const VkGraphicsPipelineCreateInfo *infos,
                                                                          const VkAllocationCallbacks *allocator,
                                                                          VkPipeline *made)
{
    (void)allocator;
    VkResult result = VK_SUCCESS;
    memset(made, 0, count * sizeof *made);
    for (uint32_t i = 0; i < count && result == VK_SUCCESS; i++)
        result = kept_graphics(device, cache, &infos[i], &made[i]);
    return result;
}

static inline VKAPI_ATTR void VKAPI_CALL kept_DestroyPipeline(VkDevice device, VkPipeline pipeline,
                                                              const VkAllocationCallbacks *allocator)
{
    (void)device, (void)pipeline, (void)allocator;
}

static inline VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL kept_get_device_proc_addr(VkDevice device, const char *name);

static inline PFN_vkVoidFunction kept_function(const char *name)
{
    static const struct {
        const char *name;
        PFN_vkVoidFunction function;
    } functions[] = {
        {"vkCreateRenderPass", (PFN_vkVoidFunction)vkCreateRenderPass},
        {"vkDestroyRenderPass", (PFN_vkVoidFunction)vkDestroyRenderPass},
        {"vkCreateShaderModule", (PFN_vkVoidFunction)kept_CreateShaderModule},
        {"vkDestroyShaderModule", (PFN_vkVoidFunction)kept_DestroyShaderModule},
        {"vkCreateComputePipelines", (PFN_vkVoidFunction)kept_CreateComputePipelines},
        {"vkCreateGraphicsPipelines", (PFN_vkVoidFunction)kept_CreateGraphicsPipelines},
        {"vkDestroyPipeline", (PFN_vkVoidFunction)kept_DestroyPipeline},
        {"vkGetDeviceProcAddr", (PFN_vkVoidFunction)kept_get_device_proc_addr},
    };
    for (size_t i = 0; i < KEPT_CAPACITY(functions); i++)
        if (!strcmp(functions[i].name, name))
            return functions[i].function;
    return NULL;
}

static inline VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL kept_get_device_proc_addr(VkDevice device, const char *name)
{
    const PFN_vkVoidFunction function = kept_function(name);
    return function ? function : vkGetDeviceProcAddr(device, name);
}

/* The value for virga_context_def.get_instance_proc_addr. */
static inline VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL kept_get_instance_proc_addr(VkInstance instance,
                                                                                   const char *name)
{
    const PFN_vkVoidFunction function = kept_function(name);
    return function ? function : vkGetInstanceProcAddr(instance, name);
}

#endif
