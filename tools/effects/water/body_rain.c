/* body_rain.c - bodies in simulated water stop rain. Rain is simulated in the same frame as the water, so where the
 * water moves a body in this step is not known yet: it is taken to go on as it did at the end of the last one, which is
 * wrong by less than a millimetre where a body swims, and by a few where it hits the water. */
#include "body_pose.h"

#include <math.h>

static bool is_free(const water_body *body)
{
    return body->from && body->from->density > 0;
}

static bool add_occluders(shot *s, water_body *body, char *error, size_t error_size)
{
    const uint32_t room = SHOT_MAX_OCCLUDERS - s->occluder_count;
    virga_occluder *first = s->occluders + s->occluder_count;
    if (!host_buffer_create_with(&s->device, body->vertices, body->vertex_count * sizeof *body->vertices,
                                 VK_BUFFER_USAGE_VERTEX_BUFFER_BIT, "a body for rain", &body->sheltering, error,
                                 error_size))
        return false;
    const uint32_t count = host_mesh_occluders(&body->mesh, first, room);
    body->first_occluder = s->occluder_count;
    body->occluder_count = count < room ? count : room;
    for (uint32_t i = 0; i < body->occluder_count; i++) {
        first[i].vertices = body->sheltering.buffer;
        first[i].ground = false;
        first[i].is_dynamic = is_free(body) || body->from->key_count > 0;
    }
    s->occluder_count += body->occluder_count;
    return true;
}

/* Where the scene lets it begin. */
static void note_start(water_body *body)
{
    body_place place;
    body_place_of_keys(body->from, 0, &place);
    body->known = (virga_fluid_pose){.frame_index = 0};
    body_copy_place(&place, body->known.position_m, body->known.rotation);
    body_copy_place(&place, body->known.center_m, body->known.rotation);
}

bool water_add_occluders(shot *s, water_state *state, char *error, size_t error_size)
{
    for (uint32_t i = 0; i < state->solver.body_count; i++) {
        water_body *body = &state->solver.bodies[i];
        if (!body->from)
            continue;
        note_start(body);
        if (!add_occluders(s, body, error, error_size))
            return false;
    }
    water_move_occluders(s, state, 0);
    return true;
}

bool water_note_bodies(shot *s, water_state *state, double frame_s, char *error, size_t error_size)
{
    water_solver *solver = &state->solver;
    bool any = false;
    for (uint32_t i = 0; i < solver->body_count; i++)
        any = any || (is_free(&solver->bodies[i]) && solver->bodies[i].occluder_count);
    if (!any || !solver->step_frame)
        return true;
    if (!s->options.live && !water_wait_for_solver(s, solver, error, error_size))
        return false;
    for (uint32_t i = 0; i < solver->body_count; i++) {
        water_body *body = &solver->bodies[i];
        if (!is_free(body))
            continue;
        body->known_s = solver->now_s;
        if (s->options.live)
            body_known_pose(solver, i, frame_s, &body->known, &body->known_s);
        else
            body_newest_pose(solver, i, &body->known);
    }
    return true;
}

void water_move_occluders(shot *s, const water_state *state, double time_s)
{
    for (uint32_t i = 0; i < state->solver.body_count; i++) {
        const water_body *body = &state->solver.bodies[i];
        body_place place;
        if (!body->occluder_count)
            continue;
        if (is_free(body))
            body_place_ahead(&body->known, time_s - scene_water_of(s->scene)->start_s - body->known_s, &place);
        else
            body_place_of_keys(body->from, time_s, &place);
        for (uint32_t k = 0; k < body->occluder_count; k++)
            body_transform(&place, scene_water_of(s->scene)->position_m,
                           s->occluders[body->first_occluder + k].world_from_mesh);
    }
}
