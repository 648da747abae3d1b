/* calls_water.c - random calls of the functions that only water, the solver and the lens have. */
#include "calls.h"
#include "calls_list.h"

/* ---- water */

/* Particles of a solver, and the list of splashes that spray is handed to: of some of the steps. */
static void fill_lists(calls *c, uint32_t context, virga_water_step_info *info)
{
    const calls_handle fluid = calls_pick(c, CALLS_FLUID), splash = calls_pick(c, CALLS_SPLASH);
    virga_fluid_buffer particles = {0}, near = {0};
    virga_splash_buffer handed = {0};
    if (splash.object && splash.context == context && calls_once_in(c, 2))
        virga_splash_handed(splash.object, &handed);
    info->handed = handed.buffer;
    info->handed_size = handed.size;
    if (!fluid.object || fluid.context != context || calls_once_in(c, 2))
        return;
    virga_fluid_particles(fluid.object, &particles, &info->count);
    info->particles = particles.buffer;
    virga_fluid_bodies_near(fluid.object, &near);
    info->bodies = near.buffer;
}

static void fill_water_step(calls *c, uint32_t context, virga_water_step_info *info)
{
    static const calls_member kept[] = {
        CALLS_KEPT(virga_water_step_info, particles), CALLS_KEPT(virga_water_step_info, handed),
        CALLS_KEPT(virga_water_step_info, bodies), CALLS_BOOL(virga_water_step_info, sub_frame)};
    *info = (virga_water_step_info){.particles = calls_once_in(c, 6) ? VK_NULL_HANDLE : c->device->buffer(c),
                                    .count = calls_below(c, 200),
                                    .time_s = calls_number(c, 0, 10)};
    fill_lists(c, context, info);
    if (!c->device->honest)
        CALLS_WILD(c, info, kept);
}

void call_virga_water_step(calls *c)
{
    const calls_handle h = calls_pick(c, CALLS_WATER);
    virga_water_step_info info;
    VkCommandBuffer cmd;
    const bool wrong = calls_slip(c, 20);
    uint32_t flags = calls_of(h.object, CALLS_RECORDS | CALLS_OUTSIDE | (wrong ? CALLS_WRONG : 0));
    fill_water_step(c, h.context, &info);
    if (calls_cmd(c, h.context, &flags, &cmd))
        CALLS_TRY(c, h.context, flags, virga_water_step, h.object, cmd, wrong ? NULL : &info);
}

void call_virga_water_environment(calls *c)
{
    const calls_handle h = calls_pick(c, CALLS_WATER);
    virga_image image;
    calls_fill_image(c, VK_FORMAT_R16G16B16A16_SFLOAT, &image);
    CALLS_TRY(c, h.context, calls_of(h.object, CALLS_PLAIN), virga_water_environment, h.object,
              calls_once_in(c, 4) ? NULL : &image);
}

void call_virga_water_prepare(calls *c)
{
    const calls_handle h = calls_pick(c, CALLS_WATER);
    virga_view view;
    VkCommandBuffer cmd;
    const bool wrong = calls_slip(c, 20);
    uint32_t flags = calls_of(h.object, CALLS_RECORDS | CALLS_OUTSIDE | (wrong ? CALLS_WRONG : 0));
    calls_fill_view(c, &view);
    if (calls_cmd(c, h.context, &flags, &cmd))
        CALLS_TRY(c, h.context, flags, virga_water_prepare, h.object, cmd, wrong ? NULL : &view);
}

void call_virga_water_surfels(calls *c)
{
    virga_water_buffer surfels;
    double origin[3];
    CALLS_DO(c, virga_water_surfels, calls_pick(c, CALLS_WATER).object, calls_slip(c, 8) ? NULL : &surfels,
             calls_slip(c, 8) ? NULL : origin);
}

void call_virga_water_spray(calls *c)
{
    virga_water_buffer spray;
    double origin[3];
    CALLS_DO(c, virga_water_spray, calls_pick(c, CALLS_WATER).object, calls_slip(c, 8) ? NULL : &spray,
             calls_slip(c, 8) ? NULL : origin);
}

void call_virga_water_foam(calls *c)
{
    virga_water_buffer foam;
    double origin[3];
    CALLS_DO(c, virga_water_foam, calls_pick(c, CALLS_WATER).object, calls_slip(c, 8) ? NULL : &foam,
             calls_slip(c, 8) ? NULL : origin);
}

void call_virga_water_densities(calls *c)
{
    virga_water_buffer densities;
    CALLS_DO(c, virga_water_densities, calls_pick(c, CALLS_WATER).object, calls_slip(c, 8) ? NULL : &densities);
}

void call_virga_water_leavers_get(calls *c)
{
    virga_water_leavers leavers;
    CALLS_DO(c, virga_water_leavers_get, calls_pick(c, CALLS_WATER).object, calls_slip(c, 8) ? NULL : &leavers);
}

/* ---- the solver */

void call_virga_fluid_add(calls *c)
{
    const calls_handle h = calls_pick(c, CALLS_FLUID);
    virga_fluid_block block = {.low_m = {0.1f, 0.1f, 0.1f}, .high_m = {0.2f, 0.2f, 0.2f}};
    const bool wrong = calls_slip(c, 20);
    CALLS_WILD_ALL(c, &block);
    CALLS_TRY(c, h.context, calls_of(h.object, wrong ? CALLS_WRONG : CALLS_PLAIN), virga_fluid_add, h.object,
              wrong ? NULL : &block);
}

void call_virga_fluid_clear(calls *c)
{
    const calls_handle h = calls_pick(c, CALLS_FLUID);
    CALLS_TRY(c, h.context, calls_of(h.object, CALLS_PLAIN), virga_fluid_clear, h.object);
}

/* Those of water of the same context. */
static void fill_leavers(calls *c, uint32_t context, virga_fluid_step_info *info)
{
    const calls_handle water = calls_pick(c, CALLS_WATER);
    virga_water_leavers leavers = {0};
    if (water.object && water.context == context && calls_once_in(c, 2))
        virga_water_leavers_get(water.object, &leavers);
    info->leavers = leavers.leavers;
    info->leavers_size = leavers.size;
}

void call_virga_fluid_step(calls *c)
{
    static const calls_member kept[] = {CALLS_KEPT(virga_fluid_step_info, particles),
                                        CALLS_KEPT(virga_fluid_step_info, leavers)};
    const calls_handle h = calls_pick(c, CALLS_FLUID);
    virga_fluid_step_info info = {.dt_s = 0.01f};
    VkCommandBuffer cmd;
    const bool wrong = calls_slip(c, 20);
    uint32_t flags = calls_of(h.object, CALLS_RECORDS | CALLS_OUTSIDE | (wrong ? CALLS_WRONG : 0));
    if (calls_once_in(c, 3)) {
        info.particles = c->device->buffer(c);
        info.count = calls_below(c, 200);
    }
    fill_leavers(c, h.context, &info);
    if (!c->device->honest)
        CALLS_WILD(c, &info, kept);
    if (calls_cmd(c, h.context, &flags, &cmd))
        CALLS_TRY(c, h.context, flags, virga_fluid_step, h.object, cmd, wrong ? NULL : &info);
}

void call_virga_fluid_exchange_get(calls *c)
{
    virga_fluid_exchange exchange;
    CALLS_DO(c, virga_fluid_exchange_get, calls_pick(c, CALLS_FLUID).object, calls_slip(c, 8) ? NULL : &exchange);
}

void call_virga_fluid_particles(calls *c)
{
    virga_fluid_buffer particles;
    uint32_t count;
    CALLS_DO(c, virga_fluid_particles, calls_pick(c, CALLS_FLUID).object, calls_slip(c, 8) ? NULL : &particles,
             calls_slip(c, 8) ? NULL : &count);
}

void call_virga_fluid_pressures(calls *c)
{
    virga_fluid_buffer pressures;
    CALLS_DO(c, virga_fluid_pressures, calls_pick(c, CALLS_FLUID).object, calls_slip(c, 8) ? NULL : &pressures);
}

/* ---- bodies in the fluid */

/* A cube of 0.2 m. */
static const float cube[24] = {-0.1f, -0.1f, -0.1f, 0.1f, -0.1f, -0.1f, -0.1f, 0.1f, -0.1f, 0.1f, 0.1f, -0.1f,
                               -0.1f, -0.1f, 0.1f,  0.1f, -0.1f, 0.1f,  -0.1f, 0.1f, 0.1f,  0.1f, 0.1f, 0.1f};
static const uint32_t cube_indices[36] = {0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4,
                                          2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5};

/* What is refused depends on the definition and on the mesh, which may be wild: no result is promised. */
void call_virga_fluid_body_add(calls *c)
{
    virga_fluid_body body = {
        .density = calls_once_in(c, 2) ? 0.5f : 0, .friction = 0.4f, .position_m = {0.2f, 0.2f, 0.2f}};
    uint32_t index;
    CALLS_WILD_ALL(c, &body);
    body.positions = calls_slip(c, 8) ? NULL : cube;
    body.indices = calls_slip(c, 8) ? NULL : cube_indices;
    body.stride = calls_once_in(c, 8) ? 4 : 12;
    body.vertex_count = calls_once_in(c, 8) ? 3 : 8;
    body.index_count = calls_once_in(c, 8) ? 33 : 36;
    CALLS_DO(c, virga_fluid_body_add, calls_pick(c, CALLS_FLUID).object, calls_slip(c, 20) ? NULL : &body,
             calls_slip(c, 8) ? NULL : &index);
}

void call_virga_fluid_body_drive(calls *c)
{
    virga_fluid_pose pose = {.position_m = {0.2f, 0.2f, 0.2f}};
    CALLS_WILD_ALL(c, &pose);
    CALLS_DO(c, virga_fluid_body_drive, calls_pick(c, CALLS_FLUID).object, calls_below(c, 4),
             calls_slip(c, 20) ? NULL : &pose);
}

void call_virga_fluid_body_get(calls *c)
{
    virga_fluid_pose pose;
    CALLS_DO(c, virga_fluid_body_get, calls_pick(c, CALLS_FLUID).object, calls_below(c, 4),
             calls_slip(c, 8) ? NULL : &pose);
}

void call_virga_fluid_bodies(calls *c)
{
    virga_fluid_buffer bodies;
    CALLS_DO(c, virga_fluid_bodies, calls_pick(c, CALLS_FLUID).object, calls_slip(c, 8) ? NULL : &bodies);
}

void call_virga_fluid_bodies_near(calls *c)
{
    virga_fluid_buffer bodies;
    CALLS_DO(c, virga_fluid_bodies_near, calls_pick(c, CALLS_FLUID).object, calls_slip(c, 8) ? NULL : &bodies);
}

/* ---- the lens */

void call_virga_lens_prepare(calls *c)
{
    const calls_handle h = calls_pick(c, CALLS_LENS);
    virga_view view;
    virga_lens_layer layers[2] = {0};
    VkCommandBuffer cmd;
    const uint32_t count = calls_below(c, 3);
    const bool wrong = calls_slip(c, 20);
    uint32_t flags = calls_of(h.object, CALLS_RECORDS | CALLS_OUTSIDE | (wrong ? CALLS_WRONG : 0));
    calls_fill_view(c, &view);
    for (uint32_t i = 0; i < count; i++) {
        calls_fill_image(c, VK_FORMAT_R16G16B16A16_SFLOAT, &layers[i].color);
        calls_fill_image(c, VK_FORMAT_D32_SFLOAT, &layers[i].depth);
        calls_floats(c, &layers[i].depth_m, 1, 0, 100);
    }
    if (calls_cmd(c, h.context, &flags, &cmd))
        CALLS_TRY(c, h.context, flags, virga_lens_prepare, h.object, cmd, wrong ? NULL : &view,
                  calls_slip(c, 12) ? NULL : layers, count, calls_number(c, 0, 10));
}

void call_virga_lens_picture(calls *c)
{
    virga_lens_image picture;
    CALLS_DO(c, virga_lens_picture, calls_pick(c, CALLS_LENS).object, calls_slip(c, 8) ? NULL : &picture);
}

void call_virga_lens_circles(calls *c)
{
    virga_lens_image circles;
    CALLS_DO(c, virga_lens_circles, calls_pick(c, CALLS_LENS).object, calls_below(c, 4),
             calls_slip(c, 8) ? NULL : &circles);
}

void call_virga_lens_fill_view(calls *c)
{
    virga_view view = virga_default_view();
    CALLS_DO(c, virga_lens_fill_view, calls_pick(c, CALLS_LENS).object, calls_slip(c, 8) ? NULL : &view);
}

void call_virga_splash_give_hits(calls *c)
{
    const calls_handle h = calls_pick(c, CALLS_SPLASH);
    const bool wrong = calls_slip(c, 12);
    VkCommandBuffer cmd;
    uint32_t flags = calls_of(h.object, CALLS_OUTSIDE | (wrong ? CALLS_WRONG : 0));
    if (!c->device->honest && calls_cmd(c, h.context, &flags, &cmd))
        CALLS_TRY(c, h.context, flags, virga_splash_give_hits, h.object, cmd, calls_below(c, 3),
                  wrong ? VK_NULL_HANDLE : c->device->buffer(c), 0, calls_below(c, 65536));
}
