/* world.c - the drawn world: street, walls that its model does not have, car and sky. */
#include "game.h"

#include "exr.h"

#include <stdlib.h>
#include <string.h>

static bool add_boxes(drive *d, const boxes *b, const host_material *material, host_mesh *mesh)
{
    return host_mesh_create(&d->device, b->vertices, b->count * 24, b->indices, b->count * 36, material, mesh, d->error,
                            sizeof d->error) &&
           stage_add(&d->stage, mesh, d->error, sizeof d->error);
}

bool load_world(drive *d)
{
    boxes *b = &d->boxes;
    char *error = d->error;
    const size_t error_size = sizeof d->error;
    host_environment_def sky = host_default_environment();
    float *pixels = NULL;
    host_material material;
    if (!exr_read_rgb(DRIVE_ASSETS "/environments/dusk.exr", &sky.width, &sky.height, &pixels, NULL, error, error_size))
        return false;
    sky.pixels = pixels;
    const bool lit = host_environment_create(&d->device, &sky, &d->environment, error, error_size);
    free(pixels);
    if (!lit || !track_load(d->chosen.track, &d->track, error, error_size) ||
        !host_mesh_load(&d->device, d->chosen.model, NULL, &d->street, error, error_size) ||
        !stage_add(&d->stage, &d->street, error, error_size))
        return false;
    b->count = 0;
    for (uint32_t i = 0; i < d->track.box_count; i++)
        boxes_put_cuboid(b, d->track.boxes[i].low, d->track.boxes[i].high);
    material = (host_material){.name = "wall", .base_color = {0.16f, 0.14f, 0.13f, 1}, .roughness = 0.9f};
    if (b->count && !add_boxes(d, b, &material, &d->blocks))
        return false;
    if (!host_mesh_load(&d->device, DRIVE_ASSETS "/scenes/car.glb", NULL, &d->body, error, error_size) ||
        !stage_add(&d->stage, &d->body, error, error_size))
        return false;
    if (d->body.primitive_count > MAX_PARTS)
        return host_fail(error, error_size, "car.glb has more than %d parts", MAX_PARTS);
    put_wipers(d);
    material = (host_material){.name = "wiper", .base_color = {0.015f, 0.015f, 0.016f, 1}, .roughness = 0.55f};
    return add_boxes(d, b, &material, &d->wipers);
}

static void draw_car(drive *d, VkCommandBuffer cmd)
{
    float skies[MAX_PARTS], of_wheel[MAX_PARTS];
    stage_draw draw = {.mesh = &d->body, .skies = of_wheel};
    for (uint32_t i = 0; i < d->body.primitive_count; i++) {
        const car_part part = car_part_of(d->body.materials[d->body.primitives[i].material].name);
        const bool drawn = part == CAR_BODY || part == CAR_CABIN || (part == CAR_WINDOWS && d->outside);
        skies[i] = drawn ? part == CAR_CABIN ? 0.45f : 1 : -1;
        of_wheel[i] = part == CAR_WHEEL ? 1 : -1;
    }
    for (int wheel = 0; wheel < 4; wheel++) {
        car_wheel(&d->car, wheel, draw.position_m, draw.axes);
        stage_draw_mesh(&d->stage, cmd, &d->camera, &draw);
    }
    memcpy(draw.axes, d->car.axes, sizeof draw.axes);
    memcpy(draw.position_m, d->car.position_m, sizeof draw.position_m);
    draw.mesh = &d->wipers;
    draw.skies = NULL;
    draw.sky = 0.5f;
    stage_draw_mesh(&d->stage, cmd, &d->camera, &draw);
    draw.mesh = &d->body;
    draw.skies = skies;
    stage_draw_mesh(&d->stage, cmd, &d->camera, &draw);
}

void draw_world(drive *d, VkCommandBuffer cmd, const virga_ground_maps *maps)
{
    const float upright[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    stage_draw draw = {.mesh = &d->street, .sky = 1};
    memcpy(draw.axes, upright, sizeof upright);
    d->stage.shade = (stage_shade){.half_m = {CAR_HALF_WIDTH_M, CAR_HALF_LENGTH_M}};
    memcpy(d->stage.shade.position_m, d->car.position_m, sizeof d->car.position_m);
    memcpy(d->stage.shade.axes, d->car.axes, sizeof d->car.axes);
    stage_world_begin(&d->stage, cmd, &d->camera, maps, &d->lighting);
    stage_draw_mesh(&d->stage, cmd, &d->camera, &draw);
    draw.mesh = &d->blocks;
    if (d->track.box_count)
        stage_draw_mesh(&d->stage, cmd, &d->camera, &draw);
    draw_car(d, cmd);
    stage_world_end(&d->stage, cmd);
}

void unload_world(drive *d)
{
    host_mesh_destroy(&d->device, &d->street);
    host_mesh_destroy(&d->device, &d->blocks);
    host_mesh_destroy(&d->device, &d->wipers);
    host_mesh_destroy(&d->device, &d->body);
    if (d->environment.sky.image)
        host_environment_destroy(&d->device, &d->environment);
    track_free(&d->track);
}
