/* bench_run.c - spawns splashes at a rate on a kind of ground, and counts the live ones. */
#include "splash/bench_splash.h"

#include <virga/shared/random.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define LIFE_SPLASHES 4096 /* of the warm-up */
#define LIFE_TICKS    240  /* more than any droplet flies */
#define TICK_S        (1.0 / 60)
#define MAX_DROPLETS  4194304u /* virga_splash_def */
#define MAX_SLOTS     1048576u
#define DROPLET_BYTES 72.0 /* of the largest buffer that grows with droplets: their indices */

static uint32_t between(double value, double low, double high)
{
    return (uint32_t)(value < low ? low : value > high ? high : value);
}

static bool open_buffers(run *r)
{
    bench *b = r->b;
    char *error = b->error;
    const size_t size = sizeof b->error;
    const VkDeviceSize spawns = sizeof(virga_spawns_gpu) + (VkDeviceSize)r->max_spawns * sizeof(virga_spawn_gpu);
    return host_buffer_create(&b->device, spawns, VK_BUFFER_USAGE_TRANSFER_SRC_BIT, HOST_BUFFER_UPLOAD, "spawns up",
                              &r->upload, error, size) &&
           host_buffer_create(&b->device, spawns,
                              VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT |
                                  VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                              HOST_BUFFER_DEVICE, "spawns", &r->spawns, error, size) &&
           host_buffer_create(&b->device, (VkDeviceSize)r->max_droplets * sizeof(virga_droplet_gpu),
                              VK_BUFFER_USAGE_TRANSFER_DST_BIT, HOST_BUFFER_READBACK, "droplets down", &r->readback,
                              error, size);
}

/* Room for `rate` splashes a tick, `splashes` at once, and as many droplets as the device's buffers hold. */
bool splash_bench_open_splash(run *r, double splashes, double droplets, double rate)
{
    /* The mesh of a sheet lies behind the indices, and droplets come in whole workgroups. */
    const double holds =
        floor((r->b->device.properties.limits.maxStorageBufferRange - 4096.0) / DROPLET_BYTES / 256) * 256;
    virga_splash_def def = virga_default_splash_def();
    def.tick_s = TICK_S;
    def.max_splashes = between(splashes, 1024, MAX_SLOTS);
    def.max_droplets = between(fmin(droplets, holds), 4096, MAX_DROPLETS);
    def.max_spawns = between(rate + 2, 1024, MAX_SLOTS);
    def.max_returned_droplets = between(fmin(def.max_droplets, holds - 1), def.max_spawns, MAX_DROPLETS);
    if (virga_splash_create(r->b->context, &def, &r->splash) < 0)
        return splash_bench_fail(r->b, "no splashes of that many could be made");
    virga_splash_droplets(r->splash, NULL, &r->max_droplets, NULL);
    r->max_spawns = def.max_spawns;
    r->tick = r->next_id = 0;
    r->rate = rate;
    r->owed = 0;
    if (virga_splash_set(r->splash, &r->settings) || virga_splash_attach(r->splash, r->picture.target))
        return splash_bench_fail(r->b, "settings or picture were refused");
    return open_buffers(r) || splash_bench_fail(r->b, "buffers");
}

void splash_bench_close_splash(run *r)
{
    host_buffer *const buffers[] = {&r->upload, &r->spawns, &r->readback};
    virga_splash_destroy(&r->splash);
    for (size_t i = 0; i < sizeof buffers / sizeof buffers[0]; i++)
        if (buffers[i]->buffer)
            host_buffer_destroy(&r->b->device, buffers[i]);
}

/* The camera sees the ground from a metre on, and a strip of sky. */
#define CAMERA_M 1.5
#define DOWN_RAD 0.4712388980 /* 27 degrees */
#define FOV_DEG  60.0
#define FIRST_M  1.0

void splash_bench_fill_view(virga_view *view)
{
    const uint32_t *size = bench_sizes[PICTURE];
    const host_camera_key key = {.position_m = {0, CAMERA_M, 0},
                                 .look_at_m = {0, CAMERA_M - sin(DOWN_RAD), -cos(DOWN_RAD)}};
    const host_camera_path path = {.keys = &key, .count = 1, .fov_deg = FOV_DEG, .near_m = 0.1, .far_m = 1000};
    host_camera camera;
    host_camera_at(&path, 0, size[0], size[1], NULL, &camera);
    *view = virga_default_view();
    host_camera_view(&camera, &camera, 1.0 / 96, view);
}

/* Evenly over the trapezoid of ground that the picture shows between FIRST_M and `far_m`. */
static void place_on_ground(float far_m, float u, float v, float position[3])
{
    const double wide = tan(FOV_DEG * 0.5 * 3.14159265358979 / 180) * bench_sizes[PICTURE][0] / bench_sizes[PICTURE][1];
    const double slope = cos(DOWN_RAD),
                 start = CAMERA_M * sin(DOWN_RAD); /* half the width, by `wide`: start + slope z */
    const double low = FIRST_M * (start + 0.5 * slope * FIRST_M);
    const double area = low + (double)u * ((double)far_m * (start + 0.5 * slope * (double)far_m) - low);
    const double z = (sqrt(start * start + 2 * slope * area) - start) / slope;
    position[0] = (float)((2 * (double)v - 1) * wide * (start + slope * z));
    position[1] = 0;
    position[2] = (float)-z;
}

static virga_spawn_gpu make_spawn(const run *r, uint32_t id, float share)
{
    const virga_splash_rule *row = &r->settings.rules[VIRGA_MATERIAL_ASPHALT][splash_bench_rows[r->row].state];
    float chance[4];
    for (uint32_t i = 0; i < 4; i++)
        chance[i] = virga_unit(virga_hash3(0x59a5u, id, i));
    const double diameter = 2e-3 + 2e-3 * (double)chance[0];
    const double flown = (double)(row->share[0] + chance[1] * (row->share[1] - row->share[0]));
    virga_spawn_gpu spawn = {.share = share,
                             .velocity = {0, -(float)virga_drop_terminal_speed(diameter, 1.204), 0},
                             .diameter_m = (float)diameter,
                             .normal = {0, 1, 0},
                             .depth_m = splash_bench_rows[r->row].depth_m,
                             .weight = 1,
                             .drops = 1,
                             .id = id,
                             .tick = r->tick,
                             .water_nl = (uint32_t)(virga_drop_volume(diameter) * 1e12 * flown),
                             .random = virga_hash2(id, 0x5b1a5u),
                             .kind = splash_bench_rows[r->row].state | VIRGA_MATERIAL_ASPHALT << 8 | row->model << 16};
    place_on_ground(r->far_m, chance[2], chance[3], spawn.position);
    return spawn;
}

/* Writes this tick's spawns, and brings them where the device reads them fast. */
static bool feed(run *r, uint32_t count)
{
    VkCommandBuffer cmd;
    double ms;
    virga_spawns_gpu *head = r->upload.mapped;
    virga_spawn_gpu *spawns = (virga_spawn_gpu *)(head + 1);
    *head = (virga_spawns_gpu){.count = count,
                               .capacity = r->max_spawns,
                               .group_count = {(count + 63) / 64, 1, 1},
                               .tick_s = (float)TICK_S,
                               .first_tick = r->tick,
                               .ticks = 1};
    for (uint32_t i = 0; i < count; i++)
        spawns[i] = make_spawn(r, r->next_id++, ((float)i + 0.5f) / (float)count);
    if (!bench_begin(r->b, &cmd))
        return false;
    const VkBufferCopy copy = {0, 0, sizeof *head + (VkDeviceSize)count * sizeof *spawns};
    vkCmdCopyBuffer(cmd, r->upload.buffer, r->spawns.buffer, 1, &copy);
    host_memory_barrier(cmd, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT,
                        VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_DRAW_INDIRECT_BIT,
                        VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_INDIRECT_COMMAND_READ_BIT);
    return bench_submit(r->b, &ms);
}

bool splash_bench_step(run *r, uint32_t spawns, double *ms)
{
    VkCommandBuffer cmd;
    const virga_splash_step_info info = {
        .camera_m = {0, CAMERA_M, 0}, .spawns = r->spawns.buffer, .first_tick = r->tick, .ticks = 1};
    if (!feed(r, spawns) || !bench_begin(r->b, &cmd) || virga_splash_step(r->splash, cmd, &info) != VIRGA_OK ||
        !bench_submit(r->b, ms))
        return splash_bench_fail(r->b, "a step failed");
    r->tick++;
    return true;
}

uint32_t splash_bench_next_spawns(run *r)
{
    const double due = r->rate + r->owed;
    const uint32_t count = (uint32_t)due;
    r->owed = due - count;
    return count;
}

/* ---- counts */

static bool read_droplets(run *r)
{
    VkCommandBuffer cmd;
    double ms;
    virga_splash_buffer droplets;
    virga_splash_droplets(r->splash, &droplets, NULL, NULL);
    if (!bench_begin(r->b, &cmd))
        return false;
    const VkBufferCopy copy = {droplets.offset, 0, r->readback.size};
    vkCmdCopyBuffer(cmd, droplets.buffer, r->readback.buffer, 1, &copy);
    host_memory_barrier(cmd, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT, VK_PIPELINE_STAGE_HOST_BIT,
                        VK_ACCESS_HOST_READ_BIT);
    if (!bench_submit(r->b, &ms))
        return false;
    host_buffer_invalidate(&r->b->device, &r->readback);
    return true;
}

/* Decodes the upper of two half floats in a 32-bit word. It is never negative here. */
static float upper_half(uint32_t halves)
{
    const uint32_t bits = halves >> 16, exponent = (bits >> 10) & 31;
    return exponent ? ldexpf((float)(1024 + (bits & 1023)), (int)exponent - 25) : ldexpf((float)(bits & 1023), -24);
}

/* A pile stands until its droplet separates. It then sinks for as long as it rose. */
static bool has_pile(const virga_droplet_gpu *droplet)
{
    const float free_s = upper_half(droplet->weight_free);
    return droplet->age_s > 0 &&
           (!(droplet->kind & VIRGA_DROPLET_FREE) || droplet->age_s - free_s < fmaxf(free_s, 0.004f));
}

/* Counts splashes with a droplet in the air, and the flying droplets, piles and crowns. */
bool splash_bench_count_air(run *r, air_counts *air)
{
    const virga_droplet_gpu *droplets = r->readback.mapped;
    uint8_t *seen = calloc(r->next_id + 1u, 1);
    *air = (air_counts){0};
    if (!seen || !read_droplets(r)) {
        free(seen);
        return splash_bench_fail(r->b, "droplets could not be read");
    }
    for (uint32_t i = 0; i < r->max_droplets && droplets[i].kind & VIRGA_DROPLET_ALIVE; i++) {
        const bool cone = VIRGA_DROPLET_MODEL(droplets[i].kind) == VIRGA_SPLASH_CROWN_CONE &&
                          VIRGA_DROPLET_INDEX(droplets[i].kind) == 0;
        air->live += !seen[droplets[i].id];
        seen[droplets[i].id] = 1;
        air->flying += droplets[i].age_s > 0;
        air->piles += has_pile(&droplets[i]);
        /* A cone waits until its crown is over. */
        air->crowns += cone && droplets[i].age_s < 0;
    }
    free(seen);
    return true;
}

/* Simulates the splashes of one tick until all their droplets have landed. */
bool splash_bench_measure_life(run *r, splash_life *life)
{
    bool good = splash_bench_open_splash(r, LIFE_SPLASHES, 64.0 * LIFE_SPLASHES, LIFE_SPLASHES);
    air_counts air = {.live = 1};
    double ms, lived[LIFE_TICKS];
    *life = (splash_life){0};
    for (uint32_t i = 0; good && air.live && i < LIFE_TICKS; i++) {
        virga_splash_stats stats;
        good = splash_bench_step(r, i ? 0 : LIFE_SPLASHES, &ms) && splash_bench_count_air(r, &air);
        virga_splash_stats_get(r->splash, &stats);
        life->mean += (double)air.live / LIFE_SPLASHES;
        life->droplets += (double)stats.droplets_alive / LIFE_SPLASHES;
        life->crown += (double)air.crowns / LIFE_SPLASHES;
        lived[i] = life->mean;
    }
    while (good && lived[life->settled] < 0.98 * life->mean)
        life->settled++;
    splash_bench_close_splash(r);
    return good && (life->mean > 0 || splash_bench_fail(r->b, "no droplet flew"));
}
