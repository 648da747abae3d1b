/* calls_state.c - random calls of the functions that save and load states. */
#include "calls.h"
#include "calls_list.h"

enum { STATE_BYTES = 4096 };

/* Bytes that are no state, or begin like one. */
static const void *random_state(calls *c)
{
    static uint64_t bytes[STATE_BYTES / 8];
    for (uint32_t i = 0; i < STATE_BYTES / 8; i++)
        bytes[i] = calls_once_in(c, 3) ? calls_below(c, UINT32_MAX) : calls_below(c, 8);
    return bytes;
}

void call_virga_state_seal(calls *c)
{
    virga_state_info info;
    void *bytes = (void *)(uintptr_t)random_state(c);
    CALLS_TRY(c, 0, CALLS_SILENT, virga_state_seal, calls_slip(c, 8) ? NULL : bytes, calls_below(c, STATE_BYTES + 1),
              calls_below(c, 10), calls_once_in(c, 2) ? NULL : &info);
}

void call_virga_state_read(calls *c)
{
    virga_state_info info;
    char reason[40];
    CALLS_TRY(c, 0, CALLS_SILENT, virga_state_read, calls_slip(c, 8) ? NULL : random_state(c),
              calls_below(c, STATE_BYTES + 1), calls_once_in(c, 2) ? NULL : &info, calls_once_in(c, 2) ? NULL : reason,
              calls_below(c, sizeof reason + 1));
}

static virga_state_range fill_range(calls *c, VkDeviceSize size)
{
    return (virga_state_range){.buffer = calls_slip(c, 12) ? VK_NULL_HANDLE : c->device->state_buffer(c),
                               .offset = calls_once_in(c, 8) ? calls_below(c, 64) : 0,
                               .size = c->device->honest ? CALLS_BUFFER_BYTES
                                                         : size - (calls_once_in(c, 8) ? calls_below(c, 100) : 0)};
}

static virga_state_source fill_source(calls *c)
{
    return (virga_state_source){.bytes = calls_slip(c, 12) ? NULL : random_state(c),
                                .size = calls_below(c, STATE_BYTES + 1),
                                .buffer = calls_slip(c, 12) ? VK_NULL_HANDLE : c->device->state_buffer(c),
                                .offset = calls_once_in(c, 8) ? calls_below(c, 64) : 0};
}

#define STATE(name, type)                                                                                          \
    void call_virga_##name##_state_bytes(calls *c)                                                                 \
    {                                                                                                              \
        const calls_handle h = calls_pick(c, type);                                                                \
        c->made++;                                                                                                 \
        if (!virga_##name##_state_bytes(h.object) != !h.object)                                                    \
            calls_wrong(c, __func__, "has no bytes");                                                              \
    }                                                                                                              \
    void call_virga_##name##_save(calls *c)                                                                        \
    {                                                                                                              \
        const calls_handle h = calls_pick(c, type);                                                                \
        const virga_state_range range = fill_range(c, virga_##name##_state_bytes(h.object));                       \
        const bool wrong = calls_slip(c, 20);                                                                      \
        VkCommandBuffer cmd;                                                                                       \
        uint32_t flags = calls_of(h.object, CALLS_RECORDS | CALLS_OUTSIDE | (wrong ? CALLS_WRONG : 0));            \
        if (calls_cmd(c, h.context, &flags, &cmd))                                                                 \
            CALLS_TRY(c, h.context, flags, virga_##name##_save, h.object, cmd, wrong ? NULL : &range);             \
    }                                                                                                              \
    void call_virga_##name##_load(calls *c)                                                                        \
    {                                                                                                              \
        const calls_handle h = calls_pick(c, type);                                                                \
        const virga_state_source source = fill_source(c);                                                          \
        VkCommandBuffer cmd;                                                                                       \
        uint32_t flags = calls_of(h.object, CALLS_RECORDS | CALLS_OUTSIDE);                                        \
        if (calls_cmd(c, h.context, &flags, &cmd))                                                                 \
            CALLS_TRY(c, h.context, flags, virga_##name##_load, h.object, cmd, calls_slip(c, 8) ? NULL : &source); \
    }

STATE(scene, CALLS_SCENE)
STATE(rain, CALLS_RAIN)
STATE(ground, CALLS_GROUND)
STATE(splash, CALLS_SPLASH)
STATE(glass, CALLS_GLASS)
STATE(water, CALLS_WATER)
STATE(fluid, CALLS_FLUID)
