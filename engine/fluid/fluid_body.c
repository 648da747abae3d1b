/* fluid/fluid_body.c - bodies in the water: their meshes, what the host tells of them, and what it asks. */
#include "fluid/fluid_internal.h"

#include "core/settings.h"
#include "gpu/errors.h"
#include "gpu/record.h"

#include <math.h>
#include <string.h>

#define MAX_POSITION_M  10000.0f
#define MAX_DRIVE_M_S   100.0 /* a faster body was put elsewhere */
#define MAX_DRIVE_RAD_S 100.0

/* ---- quaternions x, y, z, w, as shaders/gpu/quaternion.glsl */

static void product(const double a[4], const double b[4], double out[4])
{
    for (int axis = 0; axis < 3; axis++) {
        const int u = (axis + 1) % 3, v = (axis + 2) % 3;
        out[axis] = a[3] * b[axis] + b[3] * a[axis] + a[u] * b[v] - a[v] * b[u];
    }
    out[3] = a[3] * b[3] - a[0] * b[0] - a[1] * b[1] - a[2] * b[2];
}

static void turn(const double q[4], const double v[3], double out[3])
{
    const double p[4] = {v[0], v[1], v[2], 0}, back[4] = {-q[0], -q[1], -q[2], q[3]};
    double half[4], whole[4];
    product(q, p, half);
    product(half, back, whole);
    memcpy(out, whole, 3 * sizeof *out);
}

/* All zero is no turn. False: not finite. */
static bool set_rotation(const float given[4], double out[4])
{
    double length2 = 0;
    for (int k = 0; k < 4; k++)
        length2 += (double)given[k] * (double)given[k];
    if (!isfinite(length2))
        return false;
    for (int k = 0; k < 4; k++)
        out[k] = length2 > 0 ? (double)given[k] / sqrt(length2) : k == 3;
    return true;
}

/* ---- poses */

/* From the mesh's origin to the center of mass. */
static bool set_pose(const virga_fluid_shape_gpu *shape, const float position_m[3], const float rotation[4],
                     fluid_pose *pose)
{
    const double arm[3] = {(double)shape->center[0], (double)shape->center[1], (double)shape->center[2]};
    double turned[3];
    if (!set_rotation(rotation, pose->rotation))
        return false;
    turn(pose->rotation, arm, turned);
    for (int axis = 0; axis < 3; axis++) {
        if (!(fabsf(position_m[axis]) <= MAX_POSITION_M))
            return false;
        pose->center[axis] = (double)position_m[axis] + turned[axis];
    }
    return true;
}

/* Puts a body's state at a pose. */
static void put(const virga_fluid_shape_gpu *shape, const fluid_pose *pose, virga_fluid_body_gpu *state)
{
    const double arm[3] = {(double)shape->center[0], (double)shape->center[1], (double)shape->center[2]};
    double turned[3];
    turn(pose->rotation, arm, turned);
    for (int axis = 0; axis < 3; axis++) {
        state->center[axis] = (float)pose->center[axis];
        state->origin[axis] = (float)(pose->center[axis] - turned[axis]);
    }
    for (int k = 0; k < 4; k++)
        state->rotation[k] = (float)pose->rotation[k];
}

static double length_of(const float v[3])
{
    return sqrt((double)v[0] * (double)v[0] + (double)v[1] * (double)v[1] + (double)v[2] * (double)v[2]);
}

/* The velocities that lead from a pose to another. If they are too large, the body is put there, at rest. */
static void lead(fluid_body *body, const fluid_pose *from, double dt_s)
{
    const double back[4] = {-from->rotation[0], -from->rotation[1], -from->rotation[2], from->rotation[3]};
    double by[4];
    product(body->wanted.rotation, back, by);
    const double sine = sqrt(by[0] * by[0] + by[1] * by[1] + by[2] * by[2]), sign = by[3] < 0 ? -1 : 1;
    const double angle = 2 * atan2(sine, fabs(by[3]));
    for (int axis = 0; axis < 3; axis++) {
        body->start.velocity[axis] = (float)((body->wanted.center[axis] - from->center[axis]) / dt_s);
        body->start.spin[axis] = sine > 0 ? (float)(sign * by[axis] / sine * angle / dt_s) : 0;
    }
    put(&body->shape, from, &body->start);
    if (length_of(body->start.velocity) <= MAX_DRIVE_M_S && length_of(body->start.spin) <= MAX_DRIVE_RAD_S)
        return;
    memset(body->start.velocity, 0, sizeof body->start.velocity);
    memset(body->start.spin, 0, sizeof body->start.spin);
    put(&body->shape, &body->wanted, &body->start);
}

/* ---- adding */

static virga_result check_numbers(const virga_log *log, const virga_fluid_body *body)
{
    if (body->density != 0 && !(body->density >= 0.05f && body->density <= 100))
        return virga_wrong_argument(log, "fluid_body.density: expected 0, or 0.05 to 100, got %g",
                                    (double)body->density);
    if (!(body->friction >= 0 && body->friction <= 10))
        return virga_wrong_argument(log, "fluid_body.friction: expected 0 to 10, got %g", (double)body->friction);
    for (int axis = 0; axis < 3; axis++)
        if (!(fabsf(body->velocity_m_s[axis]) <= VIRGA_MAX_SPEED_M_S) ||
            !(fabsf(body->spin_rad_s[axis]) <= VIRGA_MAX_ANGULAR_SPEED_RAD_S))
            return virga_wrong_argument(log, "fluid_body: axis %d moves by %g m/s and turns by %g rad/s", axis,
                                        (double)body->velocity_m_s[axis], (double)body->spin_rad_s[axis]);
    return VIRGA_OK;
}

static virga_result check_mesh(const virga_log *log, const virga_fluid_body *body)
{
    if (!body->positions || !body->indices || body->index_count < 12 || body->index_count % 3 ||
        body->index_count > 30000000 || body->stride < 12 || body->stride % 4)
        return virga_wrong_argument(log,
                                    "fluid_body: expected vertices and at least four triangles, got %u indices, "
                                    "and %u bytes for a vertex",
                                    body->index_count, body->stride);
    for (uint32_t i = 0; i < body->index_count; i++) {
        float at[3];
        if (body->indices[i] >= body->vertex_count)
            return virga_wrong_argument(log, "fluid_body.indices: expected less than %u, got %u", body->vertex_count,
                                        body->indices[i]);
        memcpy(at, (const char *)body->positions + (size_t)body->indices[i] * body->stride, sizeof at);
        for (int axis = 0; axis < 3; axis++)
            if (!(fabsf(at[axis]) <= MAX_POSITION_M))
                return virga_wrong_argument(log, "fluid_body.positions: vertex %u is at %g m", body->indices[i],
                                            (double)at[axis]);
    }
    return VIRGA_OK;
}

/* Inverse of a symmetric matrix xx, yy, zz, xy, xz, yz. */
static void invert(const double m[6], double out[6])
{
    const double a = m[1] * m[2] - m[5] * m[5], b = m[4] * m[5] - m[3] * m[2], c = m[3] * m[5] - m[4] * m[1];
    const double determinant = m[0] * a + m[3] * b + m[4] * c;
    out[0] = a / determinant;
    out[1] = (m[0] * m[2] - m[4] * m[4]) / determinant;
    out[2] = (m[0] * m[1] - m[3] * m[3]) / determinant;
    out[3] = b / determinant;
    out[4] = c / determinant;
    out[5] = (m[3] * m[4] - m[0] * m[5]) / determinant;
}

static void describe_shape(const body_mass *mass, const body_map *map, const virga_fluid_body *from, double spacing,
                           virga_fluid_shape_gpu *shape)
{
    double inverse[6], half[3];
    /* Masses are over that of a particle, which is spacing^3 of water. */
    const double times = (double)from->density / pow(spacing, 3);
    invert(mass->inertia, inverse);
    *shape = (virga_fluid_shape_gpu){.inv_node_m = (float)(1 / map->node), .friction = from->friction};
    for (int axis = 0; axis < 3; axis++) {
        shape->low[axis] = (float)map->low[axis];
        shape->dims[axis] = map->dims[axis];
        shape->center[axis] = (float)mass->center[axis];
        half[axis] = fmax(-map->low[axis], map->low[axis] + map->node * map->dims[axis]);
    }
    shape->radius_m = (float)sqrt(half[0] * half[0] + half[1] * half[1] + half[2] * half[2]);
    if (from->density == 0)
        return;
    shape->inv_mass = (float)(1 / (times * mass->volume));
    shape->response = (float)(mass->area / (spacing * spacing)) * shape->inv_mass;
    for (int k = 0; k < 6; k++) {
        shape->inertia[k] = (float)(times * mass->inertia[k]);
        shape->inv_inertia[k] = (float)(inverse[k] / times);
    }
}

/* Makes the map of a body in `nodes`. */
static virga_result make_map(virga_fluid *fluid, const body_mesh *mesh, const body_mass *mass, const body_map *map,
                             uint32_t (*nodes)[4])
{
    virga_context *context = fluid->base.context;
    void *memory = virga_alloc(&context->heap, body_map_bytes(mesh, map));
    if (!memory)
        return virga_out_of_host_memory(context, "the map of a body");
    const body_map_result made = body_map_fill(mesh, mass, map, (double)fluid->settings.spacing_m, memory, nodes);
    virga_free(&context->heap, memory);
    if (made == BODY_MAP_OPEN)
        return virga_wrong_argument(&context->log, "fluid_body: the mesh has holes, or triangles that face the other "
                                                   "way");
    if (made == BODY_MAP_THIN)
        return virga_wrong_argument(&context->log, "fluid_body: the mesh is too thin for water with a spacing of %g m",
                                    (double)fluid->settings.spacing_m);
    return VIRGA_OK;
}

/* Appends nodes and points of a body to those that there are, as a new array. */
static virga_result extend_map(virga_fluid *fluid, const body_mesh *mesh, const body_mass *mass, const body_map *map,
                               uint32_t node_count, virga_fluid_shape_gpu *shape)
{
    virga_context *context = fluid->base.context;
    const uint32_t all = fluid->map_nodes + node_count + VIRGA_FLUID_BODY_POINTS;
    uint32_t(*grown)[4] = virga_alloc_array(&context->heap, all, sizeof *grown);
    virga_buffer *upload = NULL;
    virga_result result = VIRGA_OK;
    if (!grown)
        return virga_out_of_host_memory(context, "the map of a body");
    if (fluid->map_nodes)
        memcpy(grown, fluid->map, fluid->map_nodes * sizeof *grown);
    TRY(make_map(fluid, mesh, mass, map, grown + fluid->map_nodes));
    shape->first_node = fluid->map_nodes;
    shape->first_point = fluid->map_nodes + node_count;
    shape->points = body_points(mesh, mass, VIRGA_FLUID_BODY_POINTS, (float(*)[4])(grown + shape->first_point));
    TRY(virga_buffer_create(context, all * sizeof *grown, VK_BUFFER_USAGE_TRANSFER_SRC_BIT, VIRGA_HEAP_UPLOAD,
                            "fluid.map_upload", &upload));
    memcpy(upload->memory.block.mapped, grown, all * sizeof *grown);
    virga_buffer_flush(context, upload, 0, upload->size);
    TRY(virga_recording_result(context));
    VIRGA_RETIRE(context, fluid->map_upload);
    virga_free(&context->heap, fluid->map);
    fluid->map_upload = upload;
    fluid->map = grown;
    fluid->map_nodes = all;
    return VIRGA_OK;
error:
    VIRGA_RETIRE(context, upload);
    virga_free(&context->heap, grown);
    return result;
}

static virga_result check_room(const virga_fluid *fluid, const body_mass *mass, uint64_t nodes)
{
    const virga_log *log = &fluid->base.context->log;
    if (!(mass->volume > 1e-6 * pow(mass->radius, 3)))
        return virga_wrong_argument(log, "fluid_body: the mesh has no volume");
    if (!nodes || nodes + VIRGA_FLUID_BODY_POINTS > fluid->def.max_body_nodes - fluid->map_nodes)
        return virga_wrong_argument(log, "fluid_body: its map has %llu nodes, and def.max_body_nodes has room for %u",
                                    (unsigned long long)nodes, fluid->def.max_body_nodes - fluid->map_nodes);
    return VIRGA_OK;
}

virga_result virga_fluid_body_add(virga_fluid *fluid, const virga_fluid_body *given, uint32_t *index)
{
    if (!fluid || !given)
        return VIRGA_ERROR_INVALID;
    const virga_log *log = &fluid->base.context->log;
    if (fluid->base.context->lost)
        return VIRGA_ERROR_DEVICE_LOST;
    if (fluid->body_count == fluid->def.max_bodies)
        return virga_wrong_argument(log, "virga_fluid_body_add: expected up to %u bodies", fluid->def.max_bodies);
    if (check_numbers(log, given) || check_mesh(log, given))
        return VIRGA_ERROR_INVALID;
    const body_mesh mesh = {given->positions, given->stride, given->vertex_count, given->indices, given->index_count};
    body_mass mass;
    body_map map;
    fluid_body body = {.is_driven = given->density == 0};
    body_mass_of(&mesh, &mass);
    const uint64_t nodes = body_map_size(&mass, (double)fluid->settings.spacing_m, &map);
    if (check_room(fluid, &mass, nodes))
        return VIRGA_ERROR_INVALID;
    describe_shape(&mass, &map, given, (double)fluid->settings.spacing_m, &body.shape);
    if (!set_pose(&body.shape, given->position_m, given->rotation, &body.wanted))
        return virga_wrong_argument(log, "fluid_body.position_m, rotation: out of range");
    const virga_result result = extend_map(fluid, &mesh, &mass, &map, (uint32_t)nodes, &body.shape);
    if (result)
        return result;
    put(&body.shape, &body.wanted, &body.start);
    memcpy(body.start.velocity, given->velocity_m_s, sizeof body.start.velocity);
    memcpy(body.start.spin, given->spin_rad_s, sizeof body.start.spin);
    fluid->bodies[fluid->body_count] = body;
    fluid->seen[fluid->body_count] = (fluid_seen){0};
    if (index)
        *index = fluid->body_count;
    fluid->body_count++;
    return VIRGA_OK;
}

void fluid_remove_bodies(virga_fluid *fluid)
{
    virga_context *context = fluid->base.context;
    VIRGA_RETIRE(context, fluid->map_upload);
    virga_free(&context->heap, fluid->map);
    fluid->map = NULL;
    fluid->map_nodes = fluid->body_count = 0;
}

/* ---- what the host tells and asks */

virga_result virga_fluid_body_drive(virga_fluid *fluid, uint32_t index, const virga_fluid_pose *pose)
{
    if (!fluid || !pose)
        return VIRGA_ERROR_INVALID;
    const virga_log *log = &fluid->base.context->log;
    fluid_pose wanted;
    if (index >= fluid->body_count || !fluid->bodies[index].is_driven)
        return virga_wrong_argument(log, "virga_fluid_body_drive: body %u is not there, or has a density", index);
    if (!set_pose(&fluid->bodies[index].shape, pose->position_m, pose->rotation, &wanted))
        return virga_wrong_argument(log, "virga_fluid_body_drive: position or rotation out of range");
    fluid->bodies[index].wanted = wanted;
    return VIRGA_OK;
}

bool virga_fluid_body_get(virga_fluid *fluid, uint32_t index, virga_fluid_pose *pose)
{
    if (!fluid || !pose || index >= fluid->body_count)
        return false;
    virga_effect_read_statistics(&fluid->base);
    const fluid_seen *seen = &fluid->seen[index];
    const virga_fluid_body_gpu *from = seen->newest_frame ? &seen->newest : &fluid->bodies[index].start;
    *pose = (virga_fluid_pose){.frame_index = seen->newest_frame};
    memcpy(pose->position_m, from->origin, sizeof pose->position_m);
    memcpy(pose->rotation, from->rotation, sizeof pose->rotation);
    memcpy(pose->velocity_m_s, from->velocity, sizeof pose->velocity_m_s);
    memcpy(pose->spin_rad_s, from->spin, sizeof pose->spin_rad_s);
    memcpy(pose->center_m, from->center, sizeof pose->center_m);
    return true;
}

void virga_fluid_bodies(const virga_fluid *fluid, virga_fluid_buffer *bodies)
{
    const bool any = fluid && fluid->base.contents && fluid->body_count;
    if (bodies)
        *bodies = any ? (virga_fluid_buffer){fluid->body_states->buffer, 0,
                                             VIRGA_FLUID_MAX_BODIES * sizeof(virga_fluid_body_gpu)}
                      : (virga_fluid_buffer){0};
}

/* The pass body_near has written them over the touches. */
void virga_fluid_bodies_near(const virga_fluid *fluid, virga_fluid_buffer *found)
{
    const bool any = fluid && fluid->base.contents && fluid->body_count && fluid->particles;
    if (found)
        *found = any ? (virga_fluid_buffer){fluid->touches->buffer, 0,
                                            fluid->particles * (VkDeviceSize)sizeof(virga_body_near_gpu)}
                     : (virga_fluid_buffer){0};
}

/* ---- a step */

_Static_assert(sizeof(virga_body_near_gpu) == VIRGA_FLUID_TOUCHES * 16, "a particle's touches are as large");

static void upload_maps(virga_fluid *fluid, VkCommandBuffer cmd)
{
    const VkBufferCopy nodes = {0, 0, fluid->map_upload->size};
    fluid->base.context->vk.CmdCopyBuffer(cmd, fluid->map_upload->buffer, fluid->maps->buffer, 1, &nodes);
    virga_effect_uploaded(&fluid->base, &fluid->map_upload);
}

/* A free body begins where the host says and goes on by itself; one that the host drives begins anew in each step. */
static bool needs_sending(fluid_body *body, float dt_s)
{
    if (!body->is_driven)
        return !body->is_sent;
    const fluid_pose from = {
        {(double)body->start.center[0], (double)body->start.center[1], (double)body->start.center[2]},
        {(double)body->start.rotation[0], (double)body->start.rotation[1], (double)body->start.rotation[2],
         (double)body->start.rotation[3]}};
    memset(body->start.velocity, 0, sizeof body->start.velocity);
    memset(body->start.spin, 0, sizeof body->start.spin);
    if (dt_s > 0)
        lead(body, &from, (double)dt_s);
    return true;
}

void fluid_send_bodies(virga_fluid *fluid, VkCommandBuffer cmd, float dt_s, virga_fluid_step_gpu *step,
                       virga_fluid_shapes_gpu *shapes)
{
    virga_context *context = fluid->base.context;
    *shapes = (virga_fluid_shapes_gpu){0};
    if (!fluid->body_count)
        return;
    if (fluid->map_upload)
        upload_maps(fluid, cmd);
    for (uint32_t i = 0; i < fluid->body_count; i++) {
        fluid_body *body = &fluid->bodies[i];
        shapes->of[i] = body->shape;
        if (needs_sending(body, dt_s)) {
            context->vk.CmdUpdateBuffer(cmd, fluid->body_states->buffer, i * sizeof body->start, sizeof body->start,
                                        &body->start);
            fluid->seen[i].sent_frame = body->is_sent ? fluid->seen[i].sent_frame : context->frame_index;
            body->is_sent = true;
        }
        if (!body->is_driven)
            continue;
        const double speed =
            length_of(body->start.velocity) + length_of(body->start.spin) * (double)body->shape.radius_m;
        step->body_speed_m_s = fmaxf(step->body_speed_m_s, (float)speed);
        if (dt_s > 0)
            put(&body->shape, &body->wanted, &body->start); /* where the next step begins */
    }
    virga_wait(context, cmd, VIRGA_COPIES, VIRGA_PASSES);
}

/* ---- what became of it */

void fluid_bodies_lost(virga_fluid *fluid, uint64_t frame)
{
    for (uint32_t i = 0; i < fluid->body_count; i++)
        if (fluid->seen[i].sent_frame == frame)
            fluid->bodies[i].is_sent = false;
}

void fluid_read_bodies(virga_fluid *fluid, uint64_t frame, const virga_fluid_body_gpu *bodies)
{
    for (uint32_t i = 0; i < fluid->body_count; i++) {
        fluid_seen *seen = &fluid->seen[i];
        if (!fluid->bodies[i].is_sent || frame < seen->sent_frame)
            continue;
        seen->newest = bodies[i];
        seen->newest_frame = frame;
        fluid->stats.contacts += bodies[i].contacts;
        fluid->stats.contacts_dropped += bodies[i].dropped;
    }
}
