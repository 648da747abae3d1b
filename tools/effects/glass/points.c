/* points.c - drops on panes, read back for point caches. */
#include "panes.h"

#include "point_columns.h"

#include <math.h>
#include <stdlib.h>

/* One drop; its radius is that of its base, or of a particle. */
typedef struct drop_row {
    POINT_MEMBERS;
    uint32_t kind, flags, pane; /* VIRGA_GLASS_DROP or _PARTICLE; the other bits of virga_glass_drop_gpu.kind */
    float water_ul;
} drop_row;

static const ply_property columns[] = {POINT_COLUMNS(drop_row), POINT_UINT(drop_row, kind), POINT_UINT(drop_row, flags),
                                       POINT_UINT(drop_row, pane), POINT_FLOAT(drop_row, water_ul)};

/* Radius of the base of a spherical cap, by its contact angle and water. */
static double base_radius(const virga_glass_settings *settings, double water_m3)
{
    const double angle = 0.5 * ((double)settings->advancing_deg + (double)settings->receding_deg) * M_PI / 180;
    const double c = cos(angle), sn = sin(angle);
    return cbrt(water_m3 * 3 * sn * sn * sn / (M_PI * (2 - 3 * c + c * c * c)));
}

/* From the pane's own frame to the world. */
static void turn_to_world(const virga_glass_pose *pose, const double local[3], double out[3])
{
    for (int i = 0; i < 3; i++)
        out[i] = (double)pose->world_from_pane[i] * local[0] + (double)pose->world_from_pane[3 + i] * local[1] +
                 (double)pose->world_from_pane[6 + i] * local[2];
}

/* Velocity in the world: along the pane, plus that of the pane. */
static void move_drop(const glass_pane *pane, const virga_glass_drop_gpu *from, drop_row *to)
{
    const double step = 1e-4;
    const double u = (double)from->position[0], v = (double)from->position[1];
    double at[3], along_u[3], along_v[3], normal[3], local[3], arm[3], slide[3];
    glass_point(pane, u, v, at, normal);
    glass_point(pane, u + step, v, along_u, normal);
    glass_point(pane, u, v + step, along_v, normal);
    for (int i = 0; i < 3; i++)
        local[i] =
            ((along_u[i] - at[i]) * (double)from->velocity[0] + (along_v[i] - at[i]) * (double)from->velocity[1]) /
            step;
    turn_to_world(&pane->now.pose, at, arm);
    turn_to_world(&pane->now.pose, local, slide);
    for (int i = 0; i < 3; i++) {
        const int y = (i + 1) % 3, z = (i + 2) % 3;
        const double spin =
            (double)pane->now.angular_velocity_rad_s[y] * arm[z] - (double)pane->now.angular_velocity_rad_s[z] * arm[y];
        to->position[i] = (float)(pane->now.pose.position_m[i] + arm[i]);
        to->velocity[i] = (float)(slide[i] + (double)pane->now.velocity_m_s[i] + spin);
    }
}

static uint32_t copy_drops(const glass_pane *pane, uint32_t index, drop_row *to)
{
    const virga_glass_drop_gpu *from = pane->read.buffer.mapped; /* as shot_finish_read has left it */
    uint32_t count = 0;
    for (uint32_t i = 0; i < pane->read.count; i++) {
        const uint32_t kind = from[i].kind & VIRGA_GLASS_KIND;
        if (kind == VIRGA_GLASS_FREE)
            continue;
        drop_row *drop = &to[count++];
        move_drop(pane, &from[i], drop);
        drop->radius_m = kind == VIRGA_GLASS_PARTICLE ? (float)(pane->from->particle_radius_mm * 1e-3)
                                                      : (float)base_radius(&pane->settings, from[i].water_nl * 1e-12);
        drop->id = from[i].id;
        drop->age_s = from[i].age_s;
        drop->kind = kind;
        drop->flags = from[i].kind & ~(uint32_t)VIRGA_GLASS_KIND;
        drop->pane = index;
        drop->water_ul = (float)(from[i].water_nl * 1e-3);
    }
    return count;
}

static bool record(shot *s, void *state, VkCommandBuffer cmd, char *error, size_t error_size)
{
    const glass_state *g = state;
    for (uint32_t i = 0; i < g->count; i++) {
        virga_glass_buffer drops;
        shot_read *read = &g->panes[i].read;
        virga_glass_drops(g->panes[i].glass, &drops, &read->count);
        if (!shot_record_read(s, cmd, drops.buffer, drops.offset, drops.size, read, error, error_size))
            return false;
    }
    return true;
}

/* Pane by pane. */
static bool read(shot *s, void *state, void **rows, uint32_t *count, char *error, size_t error_size)
{
    const glass_state *g = state;
    size_t capacity = 1;
    for (uint32_t i = 0; i < g->count; i++)
        capacity += g->panes[i].read.count;
    drop_row *drops = malloc(capacity * sizeof *drops);
    *count = 0;
    *rows = drops;
    if (!drops)
        return host_fail(error, error_size, "no memory for %zu drops", capacity);
    for (uint32_t i = 0; i < g->count; i++) {
        if (!shot_finish_read(s, &g->panes[i].read, error, error_size))
            return false;
        *count += copy_drops(&g->panes[i], i, drops + *count);
    }
    return true;
}

const tool_points glass_points = {
    TOOL_POINTS(columns, drop_row, record, read),
    .comment = "virga glass: metres, seconds, microlitres; radius is of the base; kind 1 drop, 2 particle; flags 4 "
               "running, 8 left behind, 16 held, 32 pushed",
    .help = "drops and particles on panes",
};
