/* stand_in_internal.h - what the files of the stand-in share.
 *
 *   stand_in.c           objects and memory
 *   stand_in_commands.c  command buffers: what is recorded, and what of it is executed
 *   stand_in_facts.c     what the device is: properties, features, formats, queues */
#ifndef VIRGA_TESTS_STAND_IN_INTERNAL_H
#define VIRGA_TESTS_STAND_IN_INTERNAL_H

#include "stand_in.h"

#define STAND_IN_KINDS(X)  \
    X(Buffer)              \
    X(BufferView)          \
    X(Image)               \
    X(ImageView)           \
    X(Sampler)             \
    X(ShaderModule)        \
    X(DescriptorSetLayout) \
    X(DescriptorPool)      \
    X(PipelineLayout)      \
    X(PipelineCache)       \
    X(RenderPass)          \
    X(Framebuffer)         \
    X(QueryPool)           \
    X(Pipeline)            \
    X(Memory)              \
    X(Commands)
#define STAND_IN_KIND(name) STAND_IN_##name,
#define STAND_IN_NAME(name) #name,
typedef enum stand_in_kind { STAND_IN_KINDS(STAND_IN_KIND) STAND_IN_ANY } stand_in_kind;

typedef struct stand_in_thing {
    stand_in_kind kind;
    uint32_t generation, next_free;
    bool alive;
    uint64_t last_use;   /* the newest submission that uses it */
    VkDeviceSize size;   /* bytes; of a query pool, queries */
    void *data;          /* contents of mapped memory; times of a query pool; commands */
    uint64_t memory;     /* what a buffer or image is bound to */
    VkDeviceSize offset; /* in it */
} stand_in_thing;

typedef struct stand_in_entry {
    const char *name;
    PFN_vkVoidFunction function;
    bool compiles; /* may go to a real driver, see stand_in_state.through */
} stand_in_entry;

extern const stand_in_entry stand_in_commands[], stand_in_facts[];
extern const uint32_t stand_in_command_count, stand_in_fact_count;
extern uint64_t stand_in_done_submission;

uint64_t stand_in_make(stand_in_kind kind);
stand_in_thing *stand_in_find(uint64_t handle, stand_in_kind kind); /* NULL: there is none */
stand_in_thing *stand_in_need(uint64_t handle, stand_in_kind kind, const char *call);
void stand_in_destroy(uint64_t handle, stand_in_kind kind, const char *call);
void stand_in_wrong(const char *what, uint64_t handle) __attribute__((noreturn));

/* VK_SUCCESS, or the failure that the test wants here. */
VkResult stand_in_try(void);

#endif
