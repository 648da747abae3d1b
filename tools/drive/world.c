/* world.c - the drawn world: street, walls that its model does not have, car and sky. */
#include "game.h"

#include "drip_edges.h"
#include "drip_model.h"
#include "exr.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define DRIPS_HALF_M 48.0 /* of the square in which edges drip */
#define GUTTER_M     2.5  /* where water runs farther, a gutter takes it */
#define AHEAD_M      6.0  /* before the camera, where drips are seen best */
#define DRIP_STEP_S  0.01 /* over which a velocity is taken */

static bool add_boxes(drive *d, const boxes *b, const host_material *material, host_mesh *mesh)
{
    return host_mesh_create(&d->device, b->vertices, b->count * 24, b->indices, b->count * 36, material, mesh, d->error,
                            sizeof d->error) &&
           stage_add(&d->stage, mesh, d->error, sizeof d->error);
}

/* Awnings, balconies and trees in a square around the middle of the street. */
static bool find_drips(drive *d, const host_vertex *vertices, const uint32_t *indices)
{
    const host_mesh *street = &d->street;
    const double middle[2] = {0.5 * (double)(street->low[0] + street->high[0]),
                              0.5 * (double)(street->low[2] + street->high[2])};
    const double half_m = 0.5 * (double)fmaxf(street->high[0] - street->low[0], street->high[2] - street->low[2]);
    host_drip_edges *edges = host_drip_edges_begin(middle, fmin(half_m, DRIPS_HALF_M));
    host_eave *eaves = NULL;
    virga_drip_site *places = malloc(MAX_PLACES * sizeof *places);
    uint32_t found = 0, eave_count = 0, count = UINT32_MAX;
    if (edges && places) {
        host_drip_edges_add(edges, street, vertices, indices);
        count = host_drip_edges_find(edges, GUTTER_M, places, MAX_PLACES, &found, &eaves, &eave_count);
    }
    host_drip_edges_end(edges);
    free(eaves);
    if (count == UINT32_MAX) {
        free(places);
        return host_fail(d->error, sizeof d->error, "no memory for the edges that drip");
    }
    return drip_places_create(places, count, MAX_DRIPS, &d->drip_places) ||
           host_fail(d->error, sizeof d->error, "no memory for the edges that drip");
}

/* Of the car's outside. What is never drawn is no edge, and wheels are where they are not at rest. */
static bool find_car_drips(drive *d, const host_vertex *vertices, const uint32_t *indices)
{
    host_primitive outside[MAX_PARTS];
    host_mesh shell = d->body;
    uint32_t found = 0;
    shell.primitives = outside;
    shell.primitive_count = 0;
    for (uint32_t i = 0; i < d->body.primitive_count && i < MAX_PARTS; i++) {
        const host_primitive *primitive = &d->body.primitives[i];
        const car_part part = car_part_of(d->body.materials[primitive->material].name);
        if (part != CAR_BODY && part != CAR_WINDOWS)
            continue;
        outside[shell.primitive_count] = *primitive;
        outside[shell.primitive_count++].ground = false;
        for (uint32_t k = 0; k < primitive->index_count; k++) {
            const host_vertex *vertex = &vertices[indices[primitive->first_index + k]];
            d->car_top_m = fmax(d->car_top_m, (double)vertex->position[1]);
        }
    }
    d->car_drip_count = host_drip_model_find(&shell, vertices, indices, 0, d->car_drips, MAX_CAR_DRIPS, &found);
    return d->car_drip_count != UINT32_MAX ||
           host_fail(d->error, sizeof d->error, "no memory for the edges of the car that drip");
}

static bool load_car(drive *d)
{
    host_vertex *vertices = NULL;
    uint32_t *indices = NULL;
    const bool ok = host_mesh_load_kept(&d->device, DRIVE_ASSETS "/scenes/car.glb", NULL, &d->body, &vertices, &indices,
                                        d->error, sizeof d->error) &&
                    find_car_drips(d, vertices, indices);
    free(vertices);
    free(indices);
    return ok;
}

/* Those of the car move along with it; below a bridge its film only runs off. */
static void move_car_drips(drive *d)
{
    float now[12], before[12];
    virga_walls walls;
    virga_drip_site *sites = d->drips + d->drip_count;
    for (int row = 0; row < 3; row++) {
        for (int column = 0; column < 3; column++)
            now[4 * row + column] = before[4 * row + column] = d->car.axes[3 * column + row];
        now[4 * row + 3] = (float)d->car.position_m[row];
        before[4 * row + 3] = now[4 * row + 3] - (float)DRIP_STEP_S * d->car.velocity_m_s[row];
    }
    host_drip_model_move(d->car_drips, d->car_drip_count, now, before, DRIP_STEP_S, sites);
    virga_rain_walls_get(virga_scene_rain(d->rain), &walls);
    host_heights_shade(&d->heights, d->car.position_m[1] + d->car_top_m, walls.slant, sites, d->car_drip_count);
}

/* Those of the street are chosen for what is ahead: the car has passed the others soon. */
void move_drips(drive *d)
{
    double ahead_m[3];
    for (int axis = 0; axis < 3; axis++)
        ahead_m[axis] = d->camera.position_m[axis] + AHEAD_M * d->camera.forward[axis];
    d->drip_count = drip_places_choose(&d->drip_places, ahead_m, d->drips);
    move_car_drips(d);
}

static bool load_street(drive *d)
{
    host_vertex *vertices = NULL;
    uint32_t *indices = NULL;
    const bool ok = host_mesh_load_kept(&d->device, d->chosen.model, NULL, &d->street, &vertices, &indices, d->error,
                                        sizeof d->error) &&
                    (host_heights_of_mesh(&d->street, vertices, indices, PLACE_CELL_M, &d->heights) ||
                     host_fail(d->error, sizeof d->error, "no memory for the heights of the street")) &&
                    find_drips(d, vertices, indices) && stage_add(&d->stage, &d->street, d->error, sizeof d->error);
    free(vertices);
    free(indices);
    return ok;
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
    if (!lit || !track_load(d->chosen.track, &d->track, error, error_size) || !load_street(d))
        return false;
    b->count = 0;
    for (uint32_t i = 0; i < d->track.box_count; i++)
        boxes_put_cuboid(b, d->track.boxes[i].low, d->track.boxes[i].high);
    material = (host_material){.name = "wall", .base_color = {0.16f, 0.14f, 0.13f, 1}, .roughness = 0.9f};
    if (b->count && !add_boxes(d, b, &material, &d->blocks))
        return false;
    if (!load_car(d) || !stage_add(&d->stage, &d->body, error, error_size))
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

void draw_world(drive *d, VkCommandBuffer cmd, const virga_ground_maps *maps, const virga_walls *walls)
{
    const float upright[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    stage_draw draw = {.mesh = &d->street, .sky = 1};
    memcpy(draw.axes, upright, sizeof upright);
    d->stage.shade = (stage_shade){.half_m = {CAR_HALF_WIDTH_M, CAR_HALF_LENGTH_M}};
    memcpy(d->stage.shade.position_m, d->car.position_m, sizeof d->car.position_m);
    memcpy(d->stage.shade.axes, d->car.axes, sizeof d->car.axes);
    stage_shelter(&d->stage, cmd, &d->camera, walls, &d->street);
    stage_world_begin(&d->stage, cmd, &d->camera, maps, walls, &d->lighting);
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
    host_heights_free(&d->heights);
    drip_places_free(&d->drip_places);
}
