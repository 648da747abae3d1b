/* calls_scene.c - random calls of the functions of scenes. */
#include "calls.h"
#include "calls_list.h"

/* A scene's functions call those of several effects: some may have recorded before one refuses. */
enum { SCENE_RECORDS = CALLS_OUTSIDE };

static void fill_def(calls *c, virga_scene_def *out, virga_glass_def panes[2])
{
    static const calls_member kept[] = {
        CALLS_KEPT(virga_scene_def, panes),        CALLS_KEPT(virga_scene_def, pane_count),
        CALLS_KEPT(virga_scene_def, rain),         CALLS_BOOL(virga_scene_def, with_ground),
        CALLS_BOOL(virga_scene_def, with_splash),  CALLS_BOOL(virga_scene_def, with_water),
        CALLS_BOOL(virga_scene_def, with_contacts)};
    *out = virga_default_scene_def();
    calls_fill_rain_def(c, &out->rain);
    calls_fill_ground_def(c, &out->ground);
    calls_fill_splash_def(c, &out->splash);
    calls_fill_water_def(c, &out->water);
    for (int i = 0; i < 2; i++)
        calls_fill_glass_def(c, &panes[i]);
    out->with_ground = calls_once_in(c, 2);
    out->with_splash = calls_once_in(c, 2) && (out->with_ground || calls_once_in(c, 8));
    out->with_water = calls_once_in(c, 4);
    out->with_contacts = calls_once_in(c, 2) && (out->with_splash || calls_slip(c, 8));
    out->panes = calls_slip(c, 12) ? NULL : panes;
    out->pane_count = calls_once_in(c, 2) ? 0 : calls_below(c, 3);
    if (!c->device->honest && calls_once_in(c, 4))
        CALLS_WILD(c, out, kept);
}

void call_virga_default_scene_def(calls *c)
{
    const virga_scene_def def = virga_default_scene_def();
    if (def.size != sizeof def)
        calls_wrong(c, __func__, "has the wrong size");
}

void call_virga_scene_estimate(calls *c)
{
    virga_scene_def def;
    virga_glass_def panes[2];
    fill_def(c, &def, panes);
    c->made++;
    (void)virga_scene_estimate(calls_slip(c, 8) ? NULL : &def);
}

void call_virga_scene_create(calls *c)
{
    const uint32_t index = calls_some_context(c);
    virga_context *context = calls_slip(c, 30) ? NULL : c->contexts[index];
    virga_scene_def def;
    virga_glass_def panes[2];
    virga_scene *scene = NULL;
    const bool wrong = calls_slip(c, 30);
    fill_def(c, &def, panes);
    const virga_result result = CALLS_TRY(c, index, calls_of(context, wrong ? CALLS_WRONG : CALLS_PLAIN),
                                          virga_scene_create, context, wrong ? NULL : &def, &scene);
    if (!scene != (result < 0))
        calls_wrong(c, __func__, "result and handle disagree");
    calls_keep(c, CALLS_SCENE, index, scene);
}

void call_virga_scene_destroy(calls *c)
{
    if (calls_once_in(c, 4))
        calls_destroy(c, CALLS_SCENE, NULL);
    if (calls_once_in(c, 8))
        calls_destroy(c, CALLS_SCENE, &c->handles[CALLS_SCENE][calls_below(c, CALLS_SLOTS)].object);
}

void call_virga_scene_rain(calls *c)
{
    const calls_handle h = calls_pick(c, CALLS_SCENE);
    c->made++;
    if (!virga_scene_rain(h.object) != !h.object)
        calls_wrong(c, __func__, "a scene without rain");
}

void call_virga_scene_ground(calls *c)
{
    c->made++;
    (void)virga_scene_ground(calls_pick(c, CALLS_SCENE).object);
}

void call_virga_scene_splash(calls *c)
{
    c->made++;
    (void)virga_scene_splash(calls_pick(c, CALLS_SCENE).object);
}

void call_virga_scene_water(calls *c)
{
    c->made++;
    (void)virga_scene_water(calls_pick(c, CALLS_SCENE).object);
}

void call_virga_scene_glass(calls *c)
{
    c->made++;
    (void)virga_scene_glass(calls_pick(c, CALLS_SCENE).object, calls_slip(c, 8) ? UINT32_MAX : calls_below(c, 4));
}

void call_virga_scene_lighting_set(calls *c)
{
    const calls_handle h = calls_pick(c, CALLS_SCENE);
    virga_lighting lighting;
    const bool wrong = calls_slip(c, 20);
    calls_fill_lighting(c, &lighting);
    CALLS_TRY(c, h.context, calls_of(h.object, wrong ? CALLS_WRONG : CALLS_PLAIN), virga_scene_lighting_set, h.object,
              wrong ? NULL : &lighting);
}

void call_virga_scene_ready(calls *c)
{
    const calls_handle h = calls_pick(c, CALLS_SCENE);
    CALLS_TRY(c, h.context, calls_of(h.object, CALLS_PLAIN), virga_scene_ready, h.object);
}

static void fill_panes(calls *c, virga_scene_pane panes[2])
{
    memset(panes, 0, 2 * sizeof *panes);
    for (int i = 0; i < 2; i++) {
        calls_fill_rotation(c, panes[i].pose.world_from_pane);
        if (calls_once_in(c, 4))
            CALLS_WILD_ALL(c, &panes[i]);
    }
}

void call_virga_scene_record(calls *c)
{
    static const calls_member kept[] = {
        CALLS_KEPT(virga_scene_frame, occluders),  CALLS_KEPT(virga_scene_frame, occluder_count),
        CALLS_KEPT(virga_scene_frame, materials),  CALLS_KEPT(virga_scene_frame, view),
        CALLS_KEPT(virga_scene_frame, views),      CALLS_KEPT(virga_scene_frame, view_count),
        CALLS_KEPT(virga_scene_frame, panes),      CALLS_KEPT(virga_scene_frame, water),
        CALLS_KEPT(virga_scene_frame, exchange),   CALLS_KEPT(virga_scene_frame, wheels),
        CALLS_KEPT(virga_scene_frame, feet),       CALLS_KEPT(virga_scene_frame, wheel_count),
        CALLS_KEPT(virga_scene_frame, foot_count), CALLS_BOOL(virga_scene_frame, defer_panes),
        CALLS_BOOL(virga_scene_frame, is_unseen)};
    const calls_handle h = calls_pick(c, CALLS_SCENE);
    virga_view view, views[2];
    virga_scene_pane panes[2];
    virga_occluder occluders[2];
    virga_wheel wheels[3];
    virga_foot feet[3];
    VkCommandBuffer cmd;
    const bool wrong = calls_slip(c, 20);
    uint32_t flags = calls_of(h.object, SCENE_RECORDS | (wrong ? CALLS_WRONG : 0));
    virga_scene_frame frame = {
        .dt_s = calls_number(c, 0, 0.05), .defer_panes = calls_once_in(c, 3), .is_unseen = calls_once_in(c, 3)};
    fill_panes(c, panes);
    calls_fill_view(c, &view);
    frame.view = calls_once_in(c, 3) ? NULL : &view;
    if (!frame.view && calls_once_in(c, 2)) {
        calls_fill_view(c, &views[0]);
        calls_fill_view(c, &views[1]);
        frame.views = views;
        frame.view_count = calls_below(c, 3);
    }
    frame.panes = calls_slip(c, 8) ? NULL : panes;
    frame.occluder_count = calls_fill_occluders(c, occluders, 2);
    frame.occluders = calls_slip(c, 4) && !c->device->honest ? NULL : occluders;
    frame.wheel_count = calls_fill_wheels(c, wheels, 3);
    frame.foot_count = calls_fill_feet(c, feet, 3);
    frame.wheels = calls_slip(c, 12) ? NULL : wheels;
    frame.feet = calls_slip(c, 12) ? NULL : feet;
    frame.water.particles = c->device->buffer(c);
    frame.water.count = calls_below(c, 100);
    if (calls_once_in(c, 2))
        frame.exchange.fluid = calls_pick(c, CALLS_FLUID).object; /* that of another context is refused */
    CALLS_WILD(c, &frame, kept);
    if (calls_cmd(c, h.context, &flags, &cmd))
        CALLS_TRY(c, h.context, flags | CALLS_SILENT, virga_scene_record, h.object, cmd, wrong ? NULL : &frame);
}

void call_virga_scene_prepare_panes(calls *c)
{
    const calls_handle h = calls_pick(c, CALLS_SCENE);
    virga_view view;
    virga_scene_pane panes[2];
    VkCommandBuffer cmd;
    const bool wrong = calls_slip(c, 20);
    uint32_t flags = SCENE_RECORDS;
    fill_panes(c, panes);
    calls_fill_view(c, &view);
    if (!calls_cmd(c, h.context, &flags, &cmd))
        return;
    flags &= ~(uint32_t)CALLS_WRONG; /* a scene without panes has nothing to do, whatever it is given */
    CALLS_TRY(c, h.context, calls_of(h.object, flags), virga_scene_prepare_panes, h.object, cmd, wrong ? NULL : &view,
              panes);
}

/* ---- presets */

static virga_quality some_quality(calls *c)
{
    return (virga_quality)((int)calls_below(c, 6) - 1);
}

void call_virga_quality_name(calls *c)
{
    if (!virga_quality_name(some_quality(c)))
        calls_wrong(c, __func__, "is NULL");
}

#define APPLY(name)                                                                                 \
    void call_virga_##name##_apply_quality(calls *c)                                                \
    {                                                                                               \
        virga_##name##_def def = virga_default_##name##_def();                                      \
        CALLS_DO(c, virga_##name##_apply_quality, some_quality(c), calls_slip(c, 8) ? NULL : &def); \
    }
APPLY(rain)
APPLY(ground)
APPLY(splash)
APPLY(glass)
APPLY(water)
APPLY(fluid)
APPLY(lens)
APPLY(scene)

void call_virga_scene_cost(calls *c)
{
    virga_scene_def def;
    virga_glass_def panes[2];
    virga_scene_costs costs;
    fill_def(c, &def, panes);
    const bool wrong = calls_slip(c, 8);
    CALLS_TRY(c, 0, CALLS_SILENT | (wrong ? CALLS_WRONG : 0), virga_scene_cost, wrong ? NULL : &def,
              (VkPhysicalDeviceType)((int)calls_below(c, 8) - 1), calls_below(c, 4000), calls_below(c, 4000),
              calls_slip(c, 8) ? NULL : &costs);
}
