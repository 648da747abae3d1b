/* gpu/bindings.c - the binding model: an effect lists its bindings once, and all of its passes use the same set. */
#include "gpu/bindings.h"

#include "gpu/context.h"
#include "gpu/device_check.h"
#include "gpu/errors.h"
#include "gpu/layouts.h"
#include "gpu/retire.h"

static void bindings_destroy(virga_context *context, virga_resource *resource)
{
    virga_bindings *bindings = (virga_bindings *)resource;
    VIRGA_DESTROY(context, DescriptorPool, bindings->pool);
    virga_layout_release(context, bindings->shared);
    virga_free(&context->heap, bindings->sets);
    virga_free(&context->heap, bindings);
}

static virga_result create_sets(virga_context *context, virga_bindings *made)
{
    virga_result result = VIRGA_OK;
    const uint32_t sets = context->frames_in_flight * made->sets_per_frame;
    VkDescriptorPoolSize sizes[VIRGA_MAX_BINDINGS];
    VkDescriptorSetLayout *layouts = virga_alloc_array(&context->heap, sets, sizeof *layouts);
    made->sets = virga_alloc_array(&context->heap, sets, sizeof *made->sets);
    if (!layouts || !made->sets) {
        result = virga_out_of_host_memory(context, "descriptor sets");
        goto error;
    }
    for (uint32_t i = 0; i < made->count; i++)
        sizes[i] = (VkDescriptorPoolSize){made->kinds[i].type, sets};
    for (uint32_t i = 0; i < sets; i++)
        layouts[i] = made->shared->set_layout;
    const VkDescriptorPoolCreateInfo pool_info = {.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
                                                  .maxSets = sets,
                                                  .poolSizeCount = made->count,
                                                  .pPoolSizes = sizes};
    VK_TRY(context, CreateDescriptorPool(context->device, &pool_info, NULL, &made->pool));
    context->objects++;
    const VkDescriptorSetAllocateInfo info = {.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
                                              .descriptorPool = made->pool,
                                              .descriptorSetCount = sets,
                                              .pSetLayouts = layouts};
    VK_TRY(context, AllocateDescriptorSets(context->device, &info, made->sets));
error:
    virga_free(&context->heap, layouts);
    return result;
}

/* This device may allow more than others, so the guaranteed number is checked on every device. */
static virga_result check_storage(const virga_context *context, const virga_binding_kind *kinds, uint32_t count)
{
    const VkShaderStageFlags stages[] = {VK_SHADER_STAGE_COMPUTE_BIT, VK_SHADER_STAGE_VERTEX_BIT,
                                         VK_SHADER_STAGE_FRAGMENT_BIT};
    for (int stage = 0; stage < 3; stage++) {
        uint32_t seen = 0;
        for (uint32_t i = 0; i < count; i++)
            seen += (kinds[i].stages & stages[stage]) && (kinds[i].type == VK_DESCRIPTOR_TYPE_STORAGE_BUFFER ||
                                                          kinds[i].type == VK_DESCRIPTOR_TYPE_STORAGE_BUFFER_DYNAMIC);
        if (seen > VIRGA_STORAGE_BUFFERS)
            return virga_wrong_argument(&context->log, "bindings: %u storage buffers in a stage, and %d are promised",
                                        seen, VIRGA_STORAGE_BUFFERS);
    }
    return VIRGA_OK;
}

virga_result virga_bindings_create(virga_context *context, const virga_binding_kind *kinds, uint32_t count,
                                   uint32_t sets_per_frame, uint32_t push_bytes, virga_bindings **bindings)
{
    if (check_storage(context, kinds, count))
        return VIRGA_ERROR_INVALID;
    virga_bindings *made = virga_alloc(&context->heap, sizeof *made);
    if (!made)
        return virga_out_of_host_memory(context, "bindings");
    made->resource.destroy = bindings_destroy;
    made->kinds = kinds;
    made->count = count;
    made->sets_per_frame = sets_per_frame;
    virga_result result = virga_layout_hold(context, kinds, count, push_bytes, &made->shared);
    if (!result) {
        made->layout = made->shared->layout;
        result = create_sets(context, made);
    }
    if (result)
        bindings_destroy(context, &made->resource);
    else
        *bindings = made;
    return result;
}

VkDescriptorSet virga_bindings_write(virga_context *context, virga_bindings *bindings, uint32_t index,
                                     const virga_bound *bound)
{
    const VkDescriptorSet set = bindings->sets[context->ring_slot * bindings->sets_per_frame + index];
    VkWriteDescriptorSet writes[VIRGA_MAX_BINDINGS];
    VkDescriptorBufferInfo buffers[VIRGA_MAX_BINDINGS];
    VkDescriptorImageInfo images[VIRGA_MAX_BINDINGS];
    uint32_t count = 0;
    for (uint32_t i = 0; i < bindings->count; i++) {
        if (!bound[i].buffer && !bound[i].view && !bound[i].texels)
            continue; /* no pass recorded with this set reads it */
        writes[count] = (VkWriteDescriptorSet){.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                               .dstSet = set,
                                               .dstBinding = i,
                                               .descriptorCount = 1,
                                               .descriptorType = bindings->kinds[i].type};
        buffers[count] =
            (VkDescriptorBufferInfo){bound[i].buffer, bound[i].offset, bound[i].range ? bound[i].range : VK_WHOLE_SIZE};
        images[count] = (VkDescriptorImageInfo){bound[i].sampler, bound[i].view, bound[i].image_layout};
        writes[count].pBufferInfo = bound[i].buffer ? &buffers[count] : NULL;
        writes[count].pImageInfo = bound[i].view ? &images[count] : NULL;
        writes[count].pTexelBufferView = bound[i].texels ? &bound[i].texels : NULL;
        count++;
    }
    context->vk.UpdateDescriptorSets(context->device, count, writes, 0, NULL);
    return set;
}
