/* gpu/context.h - the context: the host's device, and what all effects share. Internal. */
#ifndef VIRGA_GPU_CONTEXT_H
#define VIRGA_GPU_CONTEXT_H

#include "core/log.h"
#include "core/memory.h"
#include "gpu/functions.h"
#include "gpu/repeats.h"
#include "gpu/timers.h"

struct virga_context {
    virga_functions vk;
    virga_log log;      /* by default counts lines that repeat, see gpu/repeats.h */
    virga_log host_log; /* receives what is passed on */
    virga_repeat repeats[VIRGA_REPEATS];
    virga_host_heap heap;

    /* The device. */
    VkInstance instance;
    VkPhysicalDevice physical_device;
    VkDevice device;
    VkPhysicalDeviceMemoryProperties memory_properties;
    VkPhysicalDeviceProperties properties;
    bool lost;
    bool software;     /* the device is a CPU */
    bool for_software; /* run the variants of passes that are fastest on a CPU, see virga_context_def.variants */
    const char *variants_name;
    bool lines;       /* draw streaks of about one pixel as lines, see virga_context_def.wide_lines */
    bool small_views; /* buffer views are too small for pools: read storage buffers, see shaders/gpu/texels.glsl */
    bool debug_names;
    bool strict; /* see virga_context_def */

    /* Frames. */
    uint32_t frames_in_flight;
    uint64_t frame_index, completed_index;
    uint32_t ring_slot;                                /* frame_index modulo frames_in_flight */
    uint64_t lost_frames;                              /* number of frames of which something was not executed */
    uint64_t lost_of_slot[VIRGA_MAX_FRAMES_IN_FLIGHT]; /* the newest of them in each slot */
    virga_timers timers;
    struct virga_lanes *lanes; /* see gpu/lanes.h. NULL: there were none so far */

    /* Memory, see gpu/memory.c and gpu/budget.c. */
    virga_device_memory device_memory;
    struct virga_memory_page *pages;
    VkDeviceSize device_bytes, device_used;
    uint32_t device_allocations;
    VkDeviceSize memory_budget;
    VkDeviceSize budget_share; /* the part of the budget that may be used now; 0: all of it */
    bool share_is_wish;        /* exceeding the share is not logged */
    bool making;               /* an effect is being created, and no frame has used it yet */
    bool may_shrink;           /* if it exceeds the budget, it is tried again with smaller pools */
    bool over_budget;          /* the budget was exceeded */

    /* Resources. */
    struct virga_resource *retired; /* see gpu/retire.h */
    virga_result recording_failed;  /* newest failed flush or build on use, see virga_recording_result */
    VkSampler nearest, linear;      /* clamped to the edge */
    uint32_t objects;               /* number of Vulkan objects that exist */
    uint32_t effects;               /* number of effects that exist */
    uint32_t effect_serial;         /* of the newest effect */
    uint32_t class_serial;          /* of the newest class of targets */
    uint32_t members;               /* effects, targets and scenes that exist: see virga_context_leave */
    bool closed;                    /* the host has destroyed it; it ends with its last member */
    struct virga_effect *first_effect;
    virga_target *first_target;
    struct virga_target_class *first_target_class;

    /* Pipelines, see gpu/builds.c. */
    VkPipelineCache pipeline_cache;
    virga_pipeline_build_mode pipeline_build_mode;
    virga_pipeline_jobs pipeline_jobs;
    struct virga_build *builds;        /* waiting, in the order of the requests */
    struct virga_built *first_built;   /* see gpu/pipelines.h */
    struct virga_layout *first_layout; /* see gpu/layouts.h */
};

/* Lanes of a subgroup in which passes exchange values by shuffles. 0: they use shared memory.
 *
 * Only software Vulkan uses shuffles. There they were measured to be faster, and a workgroup of whole subgroups has no
 * inactive lane. Other devices may run a shader with fewer lanes than they report, or with inactive lanes. Vulkan 1.2
 * can not require full subgroups, and a value read from an inactive lane is undefined. */
uint32_t virga_shuffled_lanes(const virga_context *context);

/* An effect, target or scene begins to use the context, and ends. If the host has destroyed the context already, it is
 * freed with its last member. */
void virga_context_join(virga_context *context);
void virga_context_leave(virga_context *context);

/* The common checks of a public function that creates something: `complete` says that no argument is NULL besides the
 * context. */
virga_result virga_context_check_create(virga_context *context, bool complete, const char *call);

#endif
