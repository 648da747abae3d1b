/* splash/splash_descriptors.c - the bindings of all passes of splashes. A frame writes the sets that it uses. */
#include "splash/splash_internal.h"

#include "gpu/record.h"

#define EFFECT splash
#include "gpu/effect_rows.h"

#include <stddef.h>

enum {
    BIND_SPAWNS = 3,
    BIND_DROPLETS = 6,
    BIND_KEPT = 12,
    BIND_DEPTH = 16,
    BIND_COLOR,
    BIND_DROPLET_TEXELS,
    BIND_HANDED = 21,
    BIND_FLOORS,
};

/* The same bindings as in shaders/splash, where each file declares those it uses. */
const virga_binding_kind splash_bindings[SPLASH_BINDINGS] = {
    RING(VIRGA_ALL_STAGES, tick_ring, virga_splash_tick_gpu),   /* 0 */
    RING(VIRGA_ALL_STAGES, view_ring, splash_view_block),       /* 1 */
    RING(VIRGA_ALL_STAGES, rules_ring, virga_splash_rules_gpu), /* 2 */
    [BIND_SPAWNS] = {STORAGE, COMPUTE},                         /* 3 */
    BUFFER_IN(VIRGA_ALL_STAGES, state),                         /* 4 */
    BUFFER_IN(COMPUTE | VERTEX, splashes),                      /* 5 */
    [BIND_DROPLETS] = {STORAGE, COMPUTE | VERTEX},              /* 6 */
    BUFFER(marks),                                              /* 7 */
    BUFFER(spawn_offsets),                                      /* 8 */
    BUFFER(returned_droplets),                                  /* 9 */
    BUFFER_IN(VIRGA_ALL_STAGES, selection),                     /* 10 */
    BUFFER_IN(VIRGA_ALL_STAGES, lists),                         /* 11 */
    [BIND_KEPT] = {STORAGE, COMPUTE},                           /* 12 droplets that stay after the tick */
    BUFFER_IN(COMPUTE | VERTEX, sprites),                       /* 13 */
    BUFFER(prepared_buffer),                                    /* 14 */
    BUFFER(index_buffer),                                       /* 15 */
    [BIND_DEPTH] = {SAMPLED, FRAGMENT},                         /* 16 */
    [BIND_COLOR] = {SAMPLED, FRAGMENT},                         /* 17 */
    [BIND_DROPLET_TEXELS] = {TEXELS, VIRGA_ALL_STAGES},         /* 18 */
    TEXEL_BUFFER_IN(VIRGA_ALL_STAGES, splashes),                /* 19 */
    TEXEL_BUFFER_IN(VIRGA_ALL_STAGES, sprites),                 /* 20 */
    [BIND_HANDED] = {STORAGE, COMPUTE},                         /* 21 */
    [BIND_FLOORS] = {STORAGE, COMPUTE},                         /* 22 */
};

/* Of the pass that ends spray, see shaders/splash/step/recall.comp. */
enum { RECALL_DROPLETS = 1, RECALL_LEAVERS, RECALL_TABLE };

const virga_binding_kind splash_recall_bindings[SPLASH_RECALL_BINDINGS] = {
    BUFFER(state),                          /* 0 */
    [RECALL_DROPLETS] = {STORAGE, COMPUTE}, /* 1 */
    [RECALL_LEAVERS] = {STORAGE, COMPUTE},  /* 2 */
    [RECALL_TABLE] = {STORAGE, COMPUTE},    /* 3 */
};

VkDescriptorSet splash_write_recall_set(virga_splash *splash, const virga_splash_step_info *info)
{
    virga_bound bound[VIRGA_MAX_BINDINGS];
    virga_effect_bound(&splash->base, splash->recall_bindings, bound);
    bound[RECALL_DROPLETS] = (virga_bound){.buffer = splash->droplet_buffers[splash->current]->buffer};
    bound[RECALL_LEAVERS] = (virga_bound){.buffer = info->leavers};
    bound[RECALL_TABLE] = (virga_bound){.buffer = info->leaver_table};
    return virga_bindings_write(splash->base.context, splash->recall_bindings, 0, bound);
}

/* Of the pass of drips; none of these is bound without def.max_drips. */
const virga_binding_kind splash_drip_bindings[SPLASH_DRIP_BINDINGS] = {
    RING(COMPUTE, tick_ring, virga_splash_tick_gpu), /* 0 */
    BUFFER(handed),                                  /* 1 */
    BUFFER(drip_sites),                              /* 2 */
    BUFFER(drip_waters),                             /* 3 */
    BUFFER(state),                                   /* 4 */
};

VkDescriptorSet splash_write_drip_set(virga_splash *splash)
{
    virga_bound bound[VIRGA_MAX_BINDINGS];
    virga_effect_bound(&splash->base, splash->drip_bindings, bound);
    return virga_bindings_write(splash->base.context, splash->drip_bindings, 0, bound);
}

/* Of the pass that gives hits to a pane. */
enum { HITS_LIST = 1 };

const virga_binding_kind splash_hits_bindings[SPLASH_HITS_BINDINGS] = {
    BUFFER(returned_droplets),        /* 0 */
    [HITS_LIST] = {STORAGE, COMPUTE}, /* 1 */
};

VkDescriptorSet splash_write_hits_set(virga_splash *splash, uint32_t index, VkBuffer hits, VkDeviceSize offset,
                                      VkDeviceSize size)
{
    virga_bound bound[VIRGA_MAX_BINDINGS];
    virga_effect_bound(&splash->base, splash->hits_bindings, bound);
    bound[HITS_LIST] = (virga_bound){.buffer = hits, .offset = offset, .range = size};
    return virga_bindings_write(splash->base.context, splash->hits_bindings, index, bound);
}

/* A host's buffer, or one that is bound in its place and not accessed. */
static virga_bound bound_or_marks(const virga_splash *splash, VkBuffer buffer)
{
    return (virga_bound){.buffer = buffer ? buffer : splash->marks->buffer};
}

/* What water and ground give to a step. */
static void bind_sources(const virga_splash *splash, virga_bound bound[VIRGA_MAX_BINDINGS])
{
    const virga_splash_step_info none = {.spawns_offset = 0}, *info = splash->info ? splash->info : &none;
    bound[BIND_HANDED] = bound_or_marks(splash, splash->handed ? splash->handed->buffer : VK_NULL_HANDLE);
    bound[BIND_FLOORS] = bound_or_marks(splash, info->floors.floors);
}

VkDescriptorSet splash_write_set(virga_splash *splash, uint32_t index, uint32_t current, const virga_view *view)
{
    virga_context *context = splash->base.context;
    const virga_image *depth = view ? &view->depth : NULL, *color = view ? &view->color : NULL;
    const virga_buffer *droplets = splash->droplet_buffers[current];
    virga_bound bound[VIRGA_MAX_BINDINGS];
    virga_effect_bound(&splash->base, splash->bindings, bound);
    bound[BIND_SPAWNS] =
        (virga_bound){.buffer = splash->spawns, .offset = splash->spawns_offset, .range = splash->spawns_range};
    bound[BIND_DROPLETS] = (virga_bound){.buffer = droplets->buffer};
    bound[BIND_DROPLET_TEXELS] = (virga_bound){.texels = droplets->texels};
    bound[BIND_KEPT] = (virga_bound){.buffer = splash->droplet_buffers[current ^ 1]->buffer};
    bound[BIND_DEPTH] = virga_bound_or_blank(depth, splash->blank_depth, context->nearest);
    bound[BIND_COLOR] = virga_bound_or_blank(color, splash->blank_color, virga_color_sampler(context, color));
    bind_sources(splash, bound);
    return virga_bindings_write(context, splash->bindings, index, bound);
}

void splash_bind(virga_splash *splash, VkCommandBuffer cmd, VkDescriptorSet set)
{
    const uint32_t offsets[3] = {splash->tick_offset, splash->view_offset, splash->rules_offset};
    virga_bind(splash->base.context, cmd, VK_PIPELINE_BIND_POINT_COMPUTE, splash->bindings, set, 3, offsets);
}

void splash_bind_view(virga_splash *splash, VkCommandBuffer cmd)
{
    const virga_effect_view *view = virga_effect_selected(&splash->base);
    const splash_prepared *seen = &splash->prepared[splash->base.slot];
    const uint32_t offsets[3] = {seen->tick_offset, view->offset, seen->rules_offset};
    virga_bind(splash->base.context, cmd, VK_PIPELINE_BIND_POINT_GRAPHICS, splash->bindings, view->set, 3, offsets);
}
