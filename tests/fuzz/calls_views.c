/* calls_views.c - random calls of the functions that take one of several prepared views. */
#include "calls.h"
#include "calls_list.h"

/* What was prepared last for an effect of that type; sometimes none, or a number that nobody was given. */
static virga_prepared some_view(calls *c, calls_type type)
{
    const uint32_t kind = calls_slip(c, 3) ? calls_below(c, 2) : 2;
    return kind == 0 ? 0 : kind == 1 ? calls_below(c, 100) * 0x10001ull : c->prepared[type];
}

static uint32_t with_target(calls_handle object, calls_handle target)
{
    const bool fits = target.object && target.context == object.context;
    return calls_of(object.object, CALLS_RECORDS | CALLS_INSIDE | (fits ? 0 : CALLS_WRONG));
}

/* Prepares a view, and keeps its number. `arguments` stand between the view and the number. */
#define PREPARED(name, type, ...)                                                                        \
    void call_virga_##name##_prepare_view(calls *c)                                                      \
    {                                                                                                    \
        const calls_handle h = calls_pick(c, type);                                                      \
        virga_view view;                                                                                 \
        virga_prepared made = 0;                                                                         \
        VkCommandBuffer cmd;                                                                             \
        const bool wrong = calls_slip(c, 20);                                                            \
        uint32_t flags = calls_of(h.object, CALLS_RECORDS | CALLS_OUTSIDE | (wrong ? CALLS_WRONG : 0));  \
        calls_fill_view(c, &view);                                                                       \
        if (!calls_cmd(c, h.context, &flags, &cmd))                                                      \
            return;                                                                                      \
        CALLS_TRY(c, h.context, flags, virga_##name##_prepare_view, h.object, cmd, wrong ? NULL : &view, \
                  __VA_ARGS__ &made);                                                                    \
        c->prepared[type] = made ? made : c->prepared[type];                                             \
    }
#define DRAWN(name, type)                                                                                          \
    void call_virga_##name##_view(calls *c)                                                                        \
    {                                                                                                              \
        const calls_handle h = calls_pick(c, type), target = calls_pick(c, CALLS_TARGET);                          \
        VkCommandBuffer cmd;                                                                                       \
        uint32_t flags = with_target(h, target);                                                                   \
        if (calls_cmd(c, h.context, &flags, &cmd))                                                                 \
            CALLS_TRY(c, h.context, flags, virga_##name##_view, h.object, cmd, target.object, some_view(c, type)); \
    }

PREPARED(rain, CALLS_RAIN, calls_number(c, 0, 4), )
PREPARED(splash, CALLS_SPLASH, calls_number(c, 0, 4), )
PREPARED(water, CALLS_WATER, )
PREPARED(glass, CALLS_GLASS, &(virga_glass_pose){0}, calls_number(c, 0, 4), )
PREPARED(lens, CALLS_LENS, NULL, 0, calls_number(c, 0, 4), )
DRAWN(rain_draw, CALLS_RAIN)
DRAWN(splash_draw, CALLS_SPLASH)
DRAWN(water_draw, CALLS_WATER)
DRAWN(glass_draw, CALLS_GLASS)
DRAWN(glass_draw_refraction, CALLS_GLASS)
DRAWN(lens_draw, CALLS_LENS)

void call_virga_rain_draw_parts_view(calls *c)
{
    const calls_handle h = calls_pick(c, CALLS_RAIN), target = calls_pick(c, CALLS_TARGET);
    const virga_prepared view = some_view(c, CALLS_RAIN);
    VkCommandBuffer cmd;
    uint32_t flags = with_target(h, target);
    if (calls_cmd(c, h.context, &flags, &cmd))
        CALLS_TRY(c, h.context, flags, virga_rain_draw_parts_view, h.object, cmd, target.object, view,
                  calls_below(c, 5));
}

void call_virga_lens_draw_part_view(calls *c)
{
    const calls_handle h = calls_pick(c, CALLS_LENS), target = calls_pick(c, CALLS_TARGET);
    const virga_prepared view = some_view(c, CALLS_LENS);
    VkCommandBuffer cmd;
    uint32_t flags = with_target(h, target);
    if (calls_cmd(c, h.context, &flags, &cmd))
        CALLS_TRY(c, h.context, flags, virga_lens_draw_part_view, h.object, cmd, target.object, view,
                  calls_below(c, 4));
}

void call_virga_lens_picture_view(calls *c)
{
    virga_lens_image picture;
    CALLS_DO(c, virga_lens_picture_view, calls_pick(c, CALLS_LENS).object, some_view(c, CALLS_LENS),
             calls_slip(c, 8) ? NULL : &picture);
}

void call_virga_lens_circles_view(calls *c)
{
    virga_lens_image circles;
    CALLS_DO(c, virga_lens_circles_view, calls_pick(c, CALLS_LENS).object, some_view(c, CALLS_LENS), calls_below(c, 4),
             calls_slip(c, 8) ? NULL : &circles);
}

/* A scene's functions call those of several effects: some may have recorded before one refuses. */
void call_virga_scene_draw_view(calls *c)
{
    const calls_handle h = calls_pick(c, CALLS_SCENE), target = calls_pick(c, CALLS_TARGET);
    VkCommandBuffer cmd;
    uint32_t flags = with_target(h, target) & ~(uint32_t)CALLS_RECORDS;
    if (calls_cmd(c, h.context, &flags, &cmd))
        CALLS_TRY(c, h.context, flags, virga_scene_draw_view, h.object, cmd, target.object,
                  calls_below(c, calls_slip(c, 3) ? 10 : 2));
}

void call_virga_scene_prepare_panes_view(calls *c)
{
    const calls_handle h = calls_pick(c, CALLS_SCENE);
    const virga_scene_pane panes[2] = {0};
    virga_view view;
    VkCommandBuffer cmd;
    uint32_t flags = CALLS_OUTSIDE;
    calls_fill_view(c, &view);
    if (!calls_cmd(c, h.context, &flags, &cmd))
        return;
    flags &= ~(uint32_t)CALLS_WRONG; /* a scene without panes has nothing to do, whatever it is given */
    CALLS_TRY(c, h.context, calls_of(h.object, flags), virga_scene_prepare_panes_view, h.object, cmd,
              calls_below(c, calls_slip(c, 3) ? 10 : 2), &view, panes);
}

/* Some of them twice, and now and then with one that is NULL or of another context. */
void call_virga_glass_prepare_panes(calls *c)
{
    calls_handle h[3] = {0};
    virga_glass_pane panes[3] = {0};
    virga_view view;
    VkCommandBuffer cmd;
    const uint32_t count = 1 + calls_below(c, 3);
    uint32_t flags = CALLS_RECORDS | CALLS_OUTSIDE;
    for (uint32_t i = 0; i < count; i++) {
        h[i] = i && calls_below(c, 2) ? h[0] : calls_pick(c, CALLS_GLASS);
        panes[i] = (virga_glass_pane){.glass = h[i].object, .time_s = virga_glass_time(h[i].object), .prepared = 7};
        if (!h[i].object)
            flags |= CALLS_WRONG | CALLS_SILENT;
        else if (h[0].object && h[i].context != h[0].context)
            flags |= CALLS_WRONG;
    }
    calls_fill_view(c, &view);
    if (!calls_cmd(c, h[0].context, &flags, &cmd))
        return;
    CALLS_TRY(c, h[0].context, flags, virga_glass_prepare_panes, cmd, &view, panes, count);
    for (uint32_t i = 0; i < count; i++)
        if (panes[i].prepared == 7)
            calls_wrong(c, __func__, "left a handle as it was");
    if (panes[0].prepared)
        c->prepared[CALLS_GLASS] = panes[0].prepared;
}

/* Water without foam has nothing to draw. */
void call_virga_water_draw_data(calls *c)
{
    const calls_handle h = calls_pick(c, CALLS_WATER), target = calls_pick(c, CALLS_TARGET);
    VkCommandBuffer cmd;
    uint32_t flags = with_target(h, target);
    if (calls_cmd(c, h.context, &flags, &cmd))
        CALLS_TRY(c, h.context, flags, virga_water_draw_data, h.object, cmd, target.object,
                  (virga_water_data)calls_below(c, 3));
}

void call_virga_water_draw_data_view(calls *c)
{
    const calls_handle h = calls_pick(c, CALLS_WATER), target = calls_pick(c, CALLS_TARGET);
    const virga_prepared view = some_view(c, CALLS_WATER);
    VkCommandBuffer cmd;
    uint32_t flags = with_target(h, target);
    if (calls_cmd(c, h.context, &flags, &cmd))
        CALLS_TRY(c, h.context, flags, virga_water_draw_data_view, h.object, cmd, target.object, view,
                  (virga_water_data)calls_below(c, 3));
}

void call_virga_water_draw_foam(calls *c)
{
    const calls_handle h = calls_pick(c, CALLS_WATER), target = calls_pick(c, CALLS_TARGET);
    VkCommandBuffer cmd;
    uint32_t flags = with_target(h, target) & ~(uint32_t)CALLS_RECORDS;
    if (calls_cmd(c, h.context, &flags, &cmd))
        CALLS_TRY(c, h.context, flags, virga_water_draw_foam, h.object, cmd, target.object);
}

void call_virga_water_draw_foam_view(calls *c)
{
    const calls_handle h = calls_pick(c, CALLS_WATER), target = calls_pick(c, CALLS_TARGET);
    const virga_prepared view = some_view(c, CALLS_WATER);
    VkCommandBuffer cmd;
    uint32_t flags = with_target(h, target) & ~(uint32_t)CALLS_RECORDS;
    if (calls_cmd(c, h.context, &flags, &cmd))
        CALLS_TRY(c, h.context, flags, virga_water_draw_foam_view, h.object, cmd, target.object, view);
}
