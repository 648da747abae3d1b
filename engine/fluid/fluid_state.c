/* fluid/fluid_state.c - checks a saved state of simulated water, see gpu/state_check.h. */
#include "fluid/fluid_internal.h"

#include "gpu/errors.h"
#include "gpu/state_check.h"

#include <string.h>

static void expect_finite(virga_state_check *check, const char *name, const float *values, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++)
        virga_state_expect(check, name, (double)values[i], -1e9, 1e9);
}

/* Blocks that were added after the newest step. */
static void check_blocks(const virga_fluid *fluid, virga_state_check *check)
{
    const uint32_t particles = VIRGA_STATE_SAVED(check, fluid->particles);
    const uint32_t count = VIRGA_STATE_SAVED(check, fluid->block_count);
    const virga_fluid_add_gpu *blocks = VIRGA_STATE_SAVED(check, fluid->blocks);
    virga_state_expect(check, "fluid.particles", particles, fluid->def.max_exchanged, fluid->def.max_particles);
    virga_state_expect(check, "fluid.block_count", count, 0, FLUID_MAX_BLOCKS);
    for (uint32_t i = 0; i < count && !check->failed; i++) {
        virga_state_expect(check, "fluid.blocks.first_slot", blocks[i].first_slot, 0, particles);
        virga_state_expect(check, "fluid.blocks.count", blocks[i].count, 1, (double)particles - blocks[i].first_slot);
        for (int axis = 0; axis < 3; axis++)
            virga_state_expect(check, "fluid.blocks.counts", blocks[i].counts[axis], 1, particles);
    }
}

/* Maps of bodies are not part of a state: the same bodies were added before the load. */
static void check_bodies(const virga_fluid *fluid, virga_state_check *check)
{
    const fluid_body *bodies = VIRGA_STATE_SAVED(check, fluid->bodies);
    const virga_fluid_body_gpu *states = virga_state_saved_buffer(check, fluid->body_states);
    for (uint32_t i = 0; i < fluid->body_count && !check->failed; i++) {
        const bool same = bodies[i].is_driven == fluid->bodies[i].is_driven &&
                          !memcmp(&bodies[i].shape, &fluid->bodies[i].shape, sizeof bodies[i].shape);
        if (!same) {
            virga_wrong_argument(&fluid->base.context->log, "%s: body %u: the state was saved with another one",
                                 check->call, i);
            check->failed = true;
        }
        virga_state_expect(check, "fluid.bodies.is_sent", bodies[i].is_sent, 0, 1);
        for (int k = 0; k < 7; k++)
            virga_state_expect(check, "fluid.bodies.wanted", ((const double *)&bodies[i].wanted)[k], -1e9, 1e9);
        virga_state_expect(check, "fluid.bodies.contacts", states[i].contacts, 0, fluid->def.max_contacts);
        expect_finite(check, "fluid.bodies.start", bodies[i].start.center, 3);
        expect_finite(check, "fluid.bodies.center", states[i].center, 3);
        expect_finite(check, "fluid.bodies.rotation", states[i].rotation, 4);
        expect_finite(check, "fluid.bodies.velocity", states[i].velocity, 3);
        expect_finite(check, "fluid.bodies.spin", states[i].spin, 3);
    }
}

static void check_exchange(const virga_fluid *fluid, virga_state_check *check)
{
    const virga_exchange_gpu *saved = virga_state_saved_buffer(check, fluid->exchange);
    virga_state_expect(check, "fluid.exchange.capacity", saved->capacity, 0, fluid->def.max_exchanged);
    virga_state_expect(check, "fluid.exchange.free_slots", saved->free_slots, 0, fluid->def.max_exchanged);
    virga_state_expect(check, "fluid.exchange.taken", saved->taken, 0, saved->capacity);
    virga_state_expect(check, "fluid.exchange.given", saved->given, 0, saved->capacity);
    virga_state_expect(check, "fluid.exchange.particle_nl", saved->particle_nl, saved->capacity ? 1 : 0, UINT32_MAX);
    virga_state_expect_groups(check, "fluid.exchange.given_groups", saved->given_groups, saved->capacity / 64.0 + 1);
    if (!saved->capacity)
        return;
    virga_state_expect(check, "fluid.exchange.spacing_m", (double)saved->spacing_m, 1e-5, 100);
    expect_finite(check, "fluid.exchange.floor_m", &saved->floor_m, 1);
    expect_finite(check, "fluid.exchange.ceiling_m", &saved->ceiling_m, 1);
}

void fluid_check_state(const void *object, virga_state_check *check)
{
    check_blocks(object, check);
    check_bodies(object, check);
    check_exchange(object, check);
}
