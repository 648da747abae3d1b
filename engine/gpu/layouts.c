/* gpu/layouts.c - shared layouts of descriptor sets and pipelines. All panes of a scene have one layout, so they can
 * have one set of pipelines, see gpu/pipelines.c. */
#include "gpu/layouts.h"

#include "gpu/context.h"
#include "gpu/errors.h"

static virga_layout *find(const virga_context *context, const virga_binding_kind *kinds, uint32_t count,
                          uint32_t push_bytes)
{
    virga_layout *found = context->first_layout;
    while (found && (found->kinds != kinds || found->count != count || found->push_bytes != push_bytes))
        found = found->next;
    return found;
}

static virga_result create_set_layout(virga_context *context, virga_layout *made)
{
    virga_result result = VIRGA_OK;
    VkDescriptorSetLayoutBinding described[VIRGA_MAX_BINDINGS];
    for (uint32_t i = 0; i < made->count; i++)
        described[i] = (VkDescriptorSetLayoutBinding){.binding = i,
                                                      .descriptorType = made->kinds[i].type,
                                                      .descriptorCount = 1,
                                                      .stageFlags = made->kinds[i].stages};
    const VkDescriptorSetLayoutCreateInfo info = {.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
                                                  .bindingCount = made->count,
                                                  .pBindings = described};
    VK_TRY(context, CreateDescriptorSetLayout(context->device, &info, NULL, &made->set_layout));
    context->objects++;
error:
    return result;
}

static virga_result create_pipeline_layout(virga_context *context, virga_layout *made)
{
    virga_result result = VIRGA_OK;
    const VkPushConstantRange range = {VIRGA_ALL_STAGES, 0, made->push_bytes};
    const VkPipelineLayoutCreateInfo info = {.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
                                             .setLayoutCount = made->set_layout ? 1 : 0,
                                             .pSetLayouts = &made->set_layout,
                                             .pushConstantRangeCount = made->push_bytes ? 1 : 0,
                                             .pPushConstantRanges = &range};
    VK_TRY(context, CreatePipelineLayout(context->device, &info, NULL, &made->layout));
    context->objects++;
error:
    return result;
}

static void destroy(virga_context *context, virga_layout *layout)
{
    VIRGA_DESTROY(context, PipelineLayout, layout->layout);
    VIRGA_DESTROY(context, DescriptorSetLayout, layout->set_layout);
    virga_free(&context->heap, layout);
}

virga_result virga_layout_hold(virga_context *context, const virga_binding_kind *kinds, uint32_t count,
                               uint32_t push_bytes, virga_layout **layout)
{
    virga_layout *made = find(context, kinds, count, push_bytes);
    if (!made) {
        made = virga_alloc(&context->heap, sizeof *made);
        if (!made)
            return virga_out_of_host_memory(context, "a layout");
        made->kinds = kinds;
        made->count = count;
        made->push_bytes = push_bytes;
        virga_result result = count ? create_set_layout(context, made) : VIRGA_OK;
        if (!result)
            result = create_pipeline_layout(context, made);
        if (result) {
            destroy(context, made);
            return result;
        }
        made->next = context->first_layout;
        context->first_layout = made;
    }
    made->users++;
    *layout = made;
    return VIRGA_OK;
}

void virga_layout_share(virga_layout *layout)
{
    layout->users++;
}

void virga_layout_release(virga_context *context, virga_layout *layout)
{
    if (!layout || --layout->users)
        return;
    virga_layout **at = &context->first_layout;
    while (*at != layout)
        at = &(*at)->next;
    *at = layout->next;
    destroy(context, layout);
}
