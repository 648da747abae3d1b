/* body_rain.c - bodies in simulated water stop rain. Only those that the water does not move: where the others are is
 * known too late, and rain would not be the same each time. */
#include "body_pose.h"

static bool stops_rain(const water_body *body)
{
    return body->from && !(body->from->density > 0);
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
        first[i].is_dynamic = body->from->key_count > 0;
    }
    s->occluder_count += body->occluder_count;
    return true;
}

bool water_add_occluders(shot *s, water_state *state, char *error, size_t error_size)
{
    for (uint32_t i = 0; i < state->solver.body_count; i++)
        if (stops_rain(&state->solver.bodies[i]) && !add_occluders(s, &state->solver.bodies[i], error, error_size))
            return false;
    water_move_occluders(s, state, 0);
    return true;
}

/* Rows of a rotation and a place. */
static void fill_transform(const body_place *place, const double origin_m[3], float out[12])
{
    const double *q = place->rotation;
    for (int row = 0; row < 3; row++) {
        const int u = (row + 1) % 3, v = (row + 2) % 3;
        out[row * 4 + row] = (float)(1 - 2 * (q[u] * q[u] + q[v] * q[v]));
        out[row * 4 + u] = (float)(2 * (q[row] * q[u] - q[3] * q[v]));
        out[row * 4 + v] = (float)(2 * (q[row] * q[v] + q[3] * q[u]));
        out[row * 4 + 3] = (float)(origin_m[row] + place->position_m[row]);
    }
}

void water_move_occluders(shot *s, const water_state *state, double time_s)
{
    for (uint32_t i = 0; i < state->solver.body_count; i++) {
        const water_body *body = &state->solver.bodies[i];
        body_place place;
        if (!body->occluder_count)
            continue;
        body_place_of_keys(body->from, time_s, &place);
        for (uint32_t k = 0; k < body->occluder_count; k++)
            fill_transform(&place, scene_water_of(s->scene)->position_m,
                           s->occluders[body->first_occluder + k].world_from_mesh);
    }
}
