/* calls_effects.c - random calls of the functions that all effects have. */
#include "calls.h"
#include "calls_list.h"

static void made(calls *c, const char *name, calls_type type, uint32_t context, virga_result result, void *object)
{
    if (!object != (result < 0))
        calls_wrong(c, name, "result and handle disagree");
    calls_keep(c, type, context, object);
}

/* A destroy of NULL, of a slot, or of what belongs to a scene: that one must live on. */
static void destroy_one(calls *c, calls_type type)
{
    void *none = NULL;
    if (calls_once_in(c, 4))
        calls_destroy(c, type, NULL);
    if (calls_once_in(c, 4))
        calls_destroy(c, type, &none);
    if (calls_once_in(c, 8))
        calls_destroy(c, type, &c->handles[type][calls_below(c, CALLS_SLOTS)].object);
    calls_handle handle = calls_pick(c, type);
    if (handle.lent) {
        c->lines = 0;
        calls_destroy(c, type, &handle.object);
        if (!c->lines)
            calls_wrong(c, "destroy of a scene's part", "no line in the log");
    }
}

#define BASIC(name, type, ...)                                                                                       \
    void call_virga_default_##name##_def(calls *c)                                                                   \
    {                                                                                                                \
        const virga_##name##_def def = virga_default_##name##_def();                                                 \
        if (def.size != sizeof def)                                                                                  \
            calls_wrong(c, __func__, "has the wrong size");                                                          \
    }                                                                                                                \
    void call_virga_default_##name##_settings(calls *c)                                                              \
    {                                                                                                                \
        const virga_##name##_settings settings = virga_default_##name##_settings();                                  \
        if (settings.size != sizeof settings)                                                                        \
            calls_wrong(c, __func__, "has the wrong size");                                                          \
    }                                                                                                                \
    void call_virga_##name##_estimate(calls *c)                                                                      \
    {                                                                                                                \
        virga_##name##_def def;                                                                                      \
        calls_fill_##name##_def(c, &def);                                                                            \
        if (virga_##name##_estimate(calls_slip(c, 8) ? NULL : &def) >> 44)                                           \
            calls_wrong(c, __func__, "is beyond all memory");                                                        \
    }                                                                                                                \
    void call_virga_##name##_create(calls *c)                                                                        \
    {                                                                                                                \
        const uint32_t index = calls_some_context(c);                                                                \
        virga_context *context = calls_slip(c, 30) ? NULL : c->contexts[index];                                      \
        virga_##name##_def def;                                                                                      \
        virga_##name *object = NULL;                                                                                 \
        calls_fill_##name##_def(c, &def);                                                                            \
        const bool wrong = calls_slip(c, 30);                                                                        \
        const uint32_t flags = calls_of(context, wrong ? CALLS_WRONG : CALLS_PLAIN);                                 \
        const virga_result result =                                                                                  \
            CALLS_TRY(c, index, flags, virga_##name##_create, context, wrong ? NULL : &def, &object);                \
        made(c, __func__, type, index, result, object);                                                              \
    }                                                                                                                \
    void call_virga_##name##_destroy(calls *c)                                                                       \
    {                                                                                                                \
        destroy_one(c, type);                                                                                        \
    }                                                                                                                \
    void call_virga_##name##_ready(calls *c)                                                                         \
    {                                                                                                                \
        const calls_handle h = calls_pick(c, type);                                                                  \
        CALLS_TRY(c, h.context, calls_of(h.object, CALLS_PLAIN), virga_##name##_ready, h.object);                    \
    }                                                                                                                \
    void call_virga_##name##_get(calls *c)                                                                           \
    {                                                                                                                \
        virga_##name##_settings settings;                                                                            \
        CALLS_DO(c, virga_##name##_get, calls_pick(c, type).object, calls_slip(c, 8) ? NULL : &settings);            \
    }                                                                                                                \
    void call_virga_##name##_set(calls *c)                                                                           \
    {                                                                                                                \
        const calls_handle h = calls_pick(c, type);                                                                  \
        virga_##name##_settings settings = virga_default_##name##_settings();                                        \
        if (h.object && calls_once_in(c, 2))                                                                         \
            virga_##name##_get(h.object, &settings);                                                                 \
        __VA_ARGS__;                                                                                                 \
        const bool wrong = calls_slip(c, 30);                                                                        \
        CALLS_TRY(c, h.context, calls_of(h.object, wrong ? CALLS_WRONG : CALLS_PLAIN), virga_##name##_set, h.object, \
                  wrong ? NULL : &settings);                                                                         \
    }

#define COMMON(name, type, ...)                                                                              \
    BASIC(name, type, __VA_ARGS__)                                                                           \
    void call_virga_##name##_stats_get(calls *c)                                                             \
    {                                                                                                        \
        virga_##name##_stats stats;                                                                          \
        CALLS_DO(c, virga_##name##_stats_get, calls_pick(c, type).object, calls_slip(c, 8) ? NULL : &stats); \
    }

#define WILD_SETTINGS(...)                                \
    do {                                                  \
        static const calls_member kept[] = {__VA_ARGS__}; \
        CALLS_WILD(c, &settings, kept);                   \
    } while (0)

static void set_rain(calls *c, virga_rain_settings *out)
{
    static const calls_member kept[] = {CALLS_KEPT(virga_rain_settings, sizes),
                                        CALLS_KEPT(virga_rain_settings, wind_texture),
                                        CALLS_BOOL(virga_rain_settings, walls.on)};
    static double diameters[4], numbers[4];
    static virga_image wind;
    memset(&out->sizes, 0, sizeof out->sizes);
    out->wind_texture = NULL;
    if (calls_once_in(c, 3))
        calls_fill_sizes(c, &out->sizes, diameters, numbers);
    if (calls_once_in(c, 6) && !c->device->honest) {
        calls_fill_image(c, VK_FORMAT_R16G16B16A16_SFLOAT, &wind);
        out->wind_texture = &wind;
    }
    CALLS_WILD(c, out, kept);
}

static void set_ground(calls *c, virga_ground_settings *out)
{
    static const calls_member kept[] = {CALLS_BOOL(virga_ground_settings, measure)};
    CALLS_WILD(c, out, kept);
    for (uint32_t i = 0; i < VIRGA_GROUND_MATERIALS; i++)
        *(char *)&out->materials[i].drain &= 1;
}

COMMON(rain, CALLS_RAIN, set_rain(c, &settings))
COMMON(ground, CALLS_GROUND, set_ground(c, &settings))
COMMON(splash, CALLS_SPLASH, CALLS_WILD_ALL(c, &settings))
COMMON(glass, CALLS_GLASS,
       WILD_SETTINGS(CALLS_BOOL(virga_glass_settings, compress), CALLS_BOOL(virga_glass_settings, opaque),
                     CALLS_BOOL(virga_glass_settings, still_behind)))
COMMON(water, CALLS_WATER, WILD_SETTINGS(CALLS_BOOL(virga_water_settings, hand_over)))
COMMON(fluid, CALLS_FLUID,
       WILD_SETTINGS(CALLS_BOOL(virga_fluid_settings, gives_back), CALLS_BOOL(virga_fluid_settings, open_sides)))
COMMON(lens, CALLS_LENS, CALLS_WILD_ALL(c, &settings))
BASIC(environment, CALLS_ENVIRONMENT, CALLS_WILD_ALL(c, &settings))

/* ---- targets */

/* A target of another context, or NULL, must be refused. */
static uint32_t with_target(calls_handle object, calls_handle target, uint32_t flags)
{
    return calls_of(object.object, target.object && target.context == object.context ? flags : flags | CALLS_WRONG);
}

#define ATTACHED(name, type)                                                                                          \
    void call_virga_##name##_attach(calls *c)                                                                         \
    {                                                                                                                 \
        const calls_handle h = calls_pick(c, type), target = calls_pick(c, CALLS_TARGET);                             \
        CALLS_TRY(c, h.context, with_target(h, target, CALLS_PLAIN), virga_##name##_attach, h.object, target.object); \
    }
#define DRAWN(name, draw, type)                                                                  \
    void call_virga_##name##_##draw(calls *c)                                                    \
    {                                                                                            \
        const calls_handle h = calls_pick(c, type), target = calls_pick(c, CALLS_TARGET);        \
        VkCommandBuffer cmd;                                                                     \
        uint32_t flags = with_target(h, target, CALLS_RECORDS | CALLS_INSIDE);                   \
        if (calls_cmd(c, h.context, &flags, &cmd))                                               \
            CALLS_TRY(c, h.context, flags, virga_##name##_##draw, h.object, cmd, target.object); \
    }

ATTACHED(rain, CALLS_RAIN)
ATTACHED(ground, CALLS_GROUND)
ATTACHED(splash, CALLS_SPLASH)
ATTACHED(glass, CALLS_GLASS)
ATTACHED(water, CALLS_WATER)
ATTACHED(lens, CALLS_LENS)
ATTACHED(scene, CALLS_SCENE)
DRAWN(rain, draw, CALLS_RAIN)
DRAWN(splash, draw, CALLS_SPLASH)
DRAWN(glass, draw, CALLS_GLASS)
DRAWN(glass, draw_refraction, CALLS_GLASS)
DRAWN(water, draw, CALLS_WATER)
DRAWN(lens, draw, CALLS_LENS)

/* ---- draws of parts */

void call_virga_rain_draw_parts(calls *c)
{
    const calls_handle h = calls_pick(c, CALLS_RAIN), target = calls_pick(c, CALLS_TARGET);
    const uint32_t parts = calls_below(c, 5);
    VkCommandBuffer cmd;
    uint32_t flags = with_target(h, target, CALLS_RECORDS | CALLS_INSIDE);
    if (calls_cmd(c, h.context, &flags, &cmd))
        CALLS_TRY(c, h.context, flags, virga_rain_draw_parts, h.object, cmd, target.object, parts);
}

void call_virga_default_ground_wet(calls *c)
{
    if (virga_default_ground_wet().size != sizeof(virga_ground_wet))
        calls_wrong(c, __func__, "has the wrong size");
}

void call_virga_ground_draw_wet(calls *c)
{
    const calls_handle h = calls_pick(c, CALLS_GROUND), target = calls_pick(c, CALLS_TARGET);
    virga_ground_wet wet = virga_default_ground_wet();
    virga_view view;
    VkCommandBuffer cmd;
    const bool wrong = calls_slip(c, 20);
    uint32_t flags = with_target(h, target, CALLS_RECORDS | CALLS_INSIDE | (wrong ? CALLS_WRONG : 0));
    calls_fill_view(c, &view);
    CALLS_WILD_ALL(c, &wet);
    if (calls_cmd(c, h.context, &flags, &cmd))
        CALLS_TRY(c, h.context, flags, virga_ground_draw_wet, h.object, cmd, &view, wrong ? NULL : &wet, target.object);
}

void call_virga_lens_draw_part(calls *c)
{
    const calls_handle h = calls_pick(c, CALLS_LENS), target = calls_pick(c, CALLS_TARGET);
    VkCommandBuffer cmd;
    uint32_t flags = with_target(h, target, CALLS_RECORDS | CALLS_INSIDE);
    if (calls_cmd(c, h.context, &flags, &cmd))
        CALLS_TRY(c, h.context, flags, virga_lens_draw_part, h.object, cmd, target.object, calls_below(c, 4));
}

/* ---- the environment */

void call_virga_environment_record(calls *c)
{
    const calls_handle h = calls_pick(c, CALLS_ENVIRONMENT);
    virga_view view;
    virga_environment_info info = {.kind = VIRGA_ENVIRONMENT_PANORAMA, .width = 8, .height = 8, .view = &view};
    VkCommandBuffer cmd;
    const bool wrong = calls_slip(c, 20);
    uint32_t flags = calls_of(h.object, CALLS_RECORDS | CALLS_OUTSIDE | (wrong ? CALLS_WRONG : 0));
    calls_fill_view(c, &view);
    calls_fill_image(c, VK_FORMAT_R16G16B16A16_SFLOAT, &info.image);
    info.kind = calls_once_in(c, 3) ? VIRGA_ENVIRONMENT_PICTURE : VIRGA_ENVIRONMENT_PANORAMA;
    info.view = calls_slip(c, 8) ? NULL : &view;
    info.width = calls_slip(c, 8) ? 0 : info.width;
    calls_floats(c, info.image_from_world, calls_once_in(c, 8) ? 9 : 0, -1, 1);
    calls_floats(c, info.rest_sh[0], 27, -1, 2);
    if (calls_cmd(c, h.context, &flags, &cmd))
        CALLS_TRY(c, h.context, flags, virga_environment_record, h.object, cmd, wrong ? NULL : &info);
}

void call_virga_environment_harmonics(calls *c)
{
    float sh[9][3];
    CALLS_DO(c, virga_environment_harmonics, calls_pick(c, CALLS_ENVIRONMENT).object, calls_slip(c, 8) ? NULL : sh);
}

void call_virga_environment_panorama(calls *c)
{
    virga_image panorama;
    CALLS_DO(c, virga_environment_panorama, calls_pick(c, CALLS_ENVIRONMENT).object,
             calls_slip(c, 8) ? NULL : &panorama);
}

/* Some effects of a scene may have recorded before one refuses. */
void call_virga_scene_draw(calls *c)
{
    const calls_handle h = calls_pick(c, CALLS_SCENE), target = calls_pick(c, CALLS_TARGET);
    VkCommandBuffer cmd;
    uint32_t flags = with_target(h, target, CALLS_INSIDE);
    if (calls_cmd(c, h.context, &flags, &cmd))
        CALLS_TRY(c, h.context, flags, virga_scene_draw, h.object, cmd, target.object);
}
