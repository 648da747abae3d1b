/* plate_ground.c - a mesh of what the mask of a plate calls ground, on a plane or where the depth has it. */
#include "shot/plate_ground.h"

#include "picture.h"
#include "shot/distort.h"
#include "shot/focus.h"
#include "shot/internal.h"
#include "shot/plate.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum {
    COLUMNS = 320,   /* of the grid over the picture whose points become the mesh */
    MAX_FRAMES = 64, /* of a camera that moves: of so many the grids are put together */
};

#define APART_M    2.0    /* and so far it has moved in between, */
#define APART_COS  0.9976 /* or so far it has turned: 4 degrees, less than the border shows */
#define RANGE_M    80.0   /* ground is not farther away than that */
#define PLANE_M    2000   /* half the side of the plane that is drawn wet */
#define BORDER     1.2    /* the grid is larger than the picture by that */
#define NEAR_M     0.5f
#define STEP_SHARE 1.25 /* neighbors whose depths differ by more are not of one surface */

/* ---- masks */

static bool is_mask(const char *name)
{
    picture_kind kind;
    return picture_kind_of(name, &kind);
}

static const scene_footage *footage_of(const shot *s)
{
    return &s->scene->footage;
}

bool plate_ground_open(shot *s, char *error, size_t error_size)
{
    const char *mask = s->options.ground_mask;
    if (!s->plate || footage_of(s)->ground == SCENE_FOOTAGE_NO_GROUND)
        return !mask || host_fail(error, error_size, "--ground-mask: expected footage.ground in the scene");
    if (footage_of(s)->ground == SCENE_FOOTAGE_GROUND_DEPTH && !s->options.depth)
        return scene_file_refuse(s->scene, "footage.ground", error, error_size, "depth: expected --depth");
    const size_t pixels = (size_t)s->plate->def.width * s->plate->def.height;
    plate_ground *g = s->plate_ground = calloc(1, sizeof *s->plate_ground);
    if (!g)
        return host_fail(error, error_size, "no memory for the ground of a plate");
    g->loaded = UINT32_MAX;
    g->has_masks = mask;
    g->masks = (plate_files){.option = "--ground-mask",
                             .endings = "EXR, PNG, JPEG or TIFF",
                             .takes = is_mask,
                             .pattern = mask,
                             .first = s->scene->frames.first};
    g->picture = malloc(pixels * sizeof *g->picture);
    g->share = s->distortion ? malloc((size_t)s->options.width * s->options.height * sizeof *g->share) : g->picture;
    if (!g->picture || !g->share)
        return host_fail(error, error_size, "no memory for the ground of a plate");
    for (size_t i = 0; i < pixels; i++)
        g->picture[i] = 1;
    return !mask || plate_files_open(&g->masks, s->options.frames, error, error_size);
}

void plate_ground_close(plate_ground *g)
{
    plate_files_close(&g->masks);
    if (g->share != g->picture)
        free(g->share);
    free(g->picture);
    *g = (plate_ground){0};
}

static bool load_mask(shot *s, uint32_t frame, char *error, size_t error_size)
{
    plate_ground *g = s->plate_ground;
    const uint32_t width = s->plate->def.width, height = s->plate->def.height;
    char path[4096], reason[1024];
    picture mask = {.rgb = NULL};
    if (g->loaded == frame)
        return true;
    if (g->has_masks) {
        if (!shot_blame_input(s, plate_files_name(&g->masks, frame, path, error, error_size)))
            return false;
        if (!shot_blame_input(s, picture_read(path, &mask, reason, sizeof reason)))
            return host_fail(error, error_size, "--ground-mask: %s", reason);
    }
    for (size_t i = 0; mask.rgb && i < (size_t)width * height; i++) {
        const size_t row = (2 * (i / width) + 1) * mask.height / (2 * (size_t)height);
        const size_t column = (2 * (i % width) + 1) * mask.width / (2 * (size_t)width);
        g->picture[i] = fminf(fmaxf(mask.rgb[3 * (row * mask.width + column)], 0), 1);
    }
    free(mask.rgb);
    if (s->distortion)
        shot_distortion_undo_nearest(s->distortion, g->picture, g->share);
    g->loaded = frame;
    return true;
}

/* ---- where the ground is */

/* The direction of a place of the picture, 1 along the camera's axis. */
static void direction_of(const host_camera *camera, const double at[2], double direction[3])
{
    const float *p = camera->clip_from_view_plain, *m = camera->view_from_world;
    const double v[3] = {(2 * at[0] / camera->width - 1 + (double)p[8]) / (double)p[0],
                         (2 * at[1] / camera->height - 1 + (double)p[9]) / (double)p[5], -1};
    for (int i = 0; i < 3; i++)
        direction[i] = (double)m[4 * i] * v[0] + (double)m[4 * i + 1] * v[1] + (double)m[4 * i + 2] * v[2];
}

/* Where the ray of a pixel meets the ground: its way along the axis. 0: nowhere. */
static double way_to_ground(const shot *s, const host_camera *camera, const double at[2], double direction[3])
{
    double way = 0;
    direction_of(camera, at, direction);
    if (footage_of(s)->ground == SCENE_FOOTAGE_GROUND_DEPTH) {
        const size_t pixel = (size_t)at[1] * camera->width + (size_t)at[0];
        way = host_camera_distance(camera, s->plate->depth[pixel]);
    } else if (direction[1] < -1e-6) {
        way = -camera->position_m[1] / direction[1];
    }
    return way > camera->near_m && way < RANGE_M ? way : 0;
}

/* The grid of a mesh while it is made. */
typedef struct grid {
    host_vertex *vertices;
    uint32_t *indices;
    uint32_t vertex_count, index_count;
} grid;

/* One quad, counter-clockwise from above, and its part of the normals. */
static void add_quad(grid *g, const uint32_t corners[4], const double *ways)
{
    double least = INFINITY, most = 0;
    for (int i = 0; i < 4; i++) {
        least = fmin(least, ways[corners[i]]);
        most = fmax(most, ways[corners[i]]);
    }
    if (!(least > 0) || most > STEP_SHARE * least)
        return;
    const uint32_t triangles[6] = {corners[0], corners[1], corners[2], corners[0], corners[2], corners[3]};
    for (int t = 0; t < 6; t += 3) {
        const float *a = g->vertices[triangles[t]].position, *b = g->vertices[triangles[t + 1]].position,
                    *c = g->vertices[triangles[t + 2]].position;
        const float u[3] = {b[0] - a[0], b[1] - a[1], b[2] - a[2]}, w[3] = {c[0] - a[0], c[1] - a[1], c[2] - a[2]};
        const float n[3] = {u[1] * w[2] - u[2] * w[1], u[2] * w[0] - u[0] * w[2], u[0] * w[1] - u[1] * w[0]};
        for (int i = 0; i < 3; i++)
            for (int k = 0; k < 3; k++)
                g->vertices[triangles[t + i]].normal[k] += n[k];
        memcpy(g->indices + g->index_count, triangles + t, 3 * sizeof *triangles);
        g->index_count += 3;
    }
}

/* The same for a place that may lie beside the picture: the ground goes on there as high as at the nearest pixel, so
 * that cells at the border are whole. Only where the mask of that pixel says ground. */
static double way_with_border(const shot *s, const host_camera *camera, const double at[2], double direction[3])
{
    const double near[2] = {fmin(fmax(at[0], 0.5), camera->width - 0.5), fmin(fmax(at[1], 0.5), camera->height - 0.5)};
    const size_t pixel = (size_t)near[1] * camera->width + (size_t)near[0];
    double edge[3];
    const double way = way_to_ground(s, camera, near, edge);
    direction_of(camera, at, direction);
    if (s->plate_ground->share[pixel] < 0.5f)
        return 0;
    if (near[0] == at[0] && near[1] == at[1])
        return way;
    return direction[1] < -1e-3 && edge[1] < 0 ? way * edge[1] / direction[1] : 0;
}

/* Adds what a frame shows: its camera, the loaded mask, and the loaded plate's depth. */
static bool add_frame(const shot *s, const host_camera *camera, grid *g)
{
    const uint32_t step = camera->width > COLUMNS ? camera->width / COLUMNS : 1;
    const uint32_t columns = (uint32_t)(BORDER * camera->width / step);
    const uint32_t rows = (uint32_t)(BORDER * camera->height / step);
    const uint32_t first = g->vertex_count, more = columns * rows;
    host_vertex *vertices = realloc(g->vertices, (first + more) * sizeof *vertices);
    if (vertices)
        g->vertices = vertices;
    uint32_t *indices = realloc(g->indices, (g->index_count + 6 * (size_t)more) * sizeof *indices);
    if (indices)
        g->indices = indices;
    double *ways = calloc(first + more, sizeof *ways);
    if (!vertices || !indices || !ways) {
        free(ways);
        return false;
    }
    for (uint32_t i = 0; i < more; i++) {
        const double at[2] = {((i % columns) + 0.5 - 0.5 * columns) * step + 0.5 * camera->width,
                              ((double)(i / columns) + 0.5 - 0.5 * rows) * step + 0.5 * camera->height};
        double direction[3];
        const double way = ways[first + i] = way_with_border(s, camera, at, direction);
        vertices[first + i] = (host_vertex){.normal = {0, 1e-12f, 0}};
        for (int c = 0; c < 3; c++)
            vertices[first + i].position[c] = (float)(camera->position_m[c] + way * direction[c]);
    }
    g->vertex_count += more;
    for (uint32_t row = 0; row + 1 < rows; row++)
        for (uint32_t column = 0; column + 1 < columns; column++) {
            const uint32_t a = first + row * columns + column;
            add_quad(g, (const uint32_t[]){a, a + columns, a + columns + 1, a + 1}, ways);
        }
    free(ways);
    return true;
}

/* ---- depths of several frames: each place of the ground has that of the frame that saw it from nearest */

#define CELL_M 0.25

/* What one frame has added. */
typedef struct part {
    uint32_t first, end; /* of its indices */
    double camera_m[3];
} part;

/* A cell of the ground from above, in a table with open addressing. */
typedef struct cell {
    int32_t x, z;
    uint32_t owner; /* a part; UINT32_MAX: the entry is free */
    double distance_m;
} cell;

typedef struct cells {
    cell *entries;
    size_t mask; /* entries - 1; a power of two */
} cells;

static cell *find_cell(const cells *all, int32_t x, int32_t z)
{
    size_t at = ((uint32_t)x * 2654435761u ^ (uint32_t)z * 2246822519u) & all->mask;
    while (all->entries[at].owner != UINT32_MAX && (all->entries[at].x != x || all->entries[at].z != z))
        at = (at + 1) & all->mask;
    return &all->entries[at];
}

/* The cell of a triangle's middle, and how far that is from the camera of its frame. */
static cell *cell_of(const cells *all, const grid *g, const part *of, const uint32_t *corners, double *distance_m)
{
    double square = 0, middle[3];
    for (int axis = 0; axis < 3; axis++) {
        middle[axis] = 0;
        for (int i = 0; i < 3; i++)
            middle[axis] += (double)g->vertices[corners[i]].position[axis] / 3;
        square += (middle[axis] - of->camera_m[axis]) * (middle[axis] - of->camera_m[axis]);
    }
    *distance_m = sqrt(square);
    cell *found = find_cell(all, (int32_t)floor(middle[0] / CELL_M), (int32_t)floor(middle[2] / CELL_M));
    if (found->owner == UINT32_MAX)
        *found = (cell){.x = (int32_t)floor(middle[0] / CELL_M),
                        .z = (int32_t)floor(middle[2] / CELL_M),
                        .owner = UINT32_MAX,
                        .distance_m = INFINITY};
    return found;
}

/* Far away a picture's depth is coarse, and two frames do not agree. False: no memory. */
static bool keep_nearest(grid *g, const part *parts, uint32_t count)
{
    size_t room = 1024;
    while (room < g->index_count) /* three times as many as there are triangles */
        room *= 2;
    const cells all = {.entries = malloc(room * sizeof *all.entries), .mask = room - 1};
    if (!all.entries)
        return false;
    for (size_t i = 0; i < room; i++)
        all.entries[i].owner = UINT32_MAX;
    double distance_m;
    for (uint32_t p = 0; p < count; p++)
        for (uint32_t i = parts[p].first; i < parts[p].end; i += 3) {
            cell *at = cell_of(&all, g, &parts[p], g->indices + i, &distance_m);
            if (at->owner != UINT32_MAX && at->distance_m <= distance_m)
                continue;
            at->owner = p;
            at->distance_m = distance_m;
        }
    uint32_t kept = 0;
    for (uint32_t p = 0; p < count; p++)
        for (uint32_t i = parts[p].first; i < parts[p].end; i += 3)
            if (cell_of(&all, g, &parts[p], g->indices + i, &distance_m)->owner == p) {
                memmove(g->indices + kept, g->indices + i, 3 * sizeof *g->indices);
                kept += 3;
            }
    g->index_count = kept;
    free(all.entries);
    return true;
}

/* Whether two cameras see nearly the same ground. */
static bool is_near(const host_camera *a, const host_camera *b)
{
    double square = 0, cosine = 0;
    for (int i = 0; i < 3; i++) {
        square += (a->position_m[i] - b->position_m[i]) * (a->position_m[i] - b->position_m[i]);
        cosine += (double)a->view_from_world[4 * i + 2] * (double)b->view_from_world[4 * i + 2];
    }
    return square < APART_M * APART_M && cosine > APART_COS;
}

/* All that is seen of the ground, in the scene's first frame and in others, as the camera moves on. */
static bool gather_frames(shot *s, grid *g, char *error, size_t error_size)
{
    const scene_frames *frames = &s->scene->frames;
    const bool by_depth = footage_of(s)->ground == SCENE_FOOTAGE_GROUND_DEPTH;
    host_camera last = {.width = 0};
    part parts[MAX_FRAMES];
    uint32_t taken = 0;
    for (uint32_t frame = frames->first; frame <= frames->last && taken < MAX_FRAMES; frame++) {
        host_camera camera;
        shot_camera(s, shot_time(s, frame), 0, NULL, &camera);
        if (taken && is_near(&camera, &last))
            continue;
        if (!plate_has(s->plate, frame)) {
            if (taken)
                break;
            scene_file_refuse(s->scene, "footage.ground", error, error_size,
                              "expected a picture of the scene's first frame, %u", frame);
            return shot_blame_input(s, false);
        }
        if (!load_mask(s, frame, error, error_size) ||
            (by_depth && !shot_blame_input(s, plate_load(s->plate, frame, error, error_size))))
            return false;
        parts[taken].first = g->index_count;
        if (!add_frame(s, &camera, g))
            return host_fail(error, error_size, "no memory for the ground of a plate");
        parts[taken].end = g->index_count;
        memcpy(parts[taken++].camera_m, camera.position_m, sizeof camera.position_m);
        last = camera;
    }
    if (by_depth && taken > 1 && !keep_nearest(g, parts, taken))
        return host_fail(error, error_size, "no memory for the ground of a plate");
    if (!g->index_count) {
        scene_file_refuse(s->scene, "footage.ground", error, error_size,
                          "expected ground within %g m in the picture, found none", RANGE_M);
        return shot_blame_input(s, false);
    }
    return true;
}

/* ---- meshes */

static const host_material asphalt = {.name = "footage ground, asphalt", .base_color = {1, 1, 1, 1}, .roughness = 0.8f};

/* Height of a triangle's middle, and its area where it is level. */
static float height_of(const grid *g, const uint32_t *corners, float *level_m2)
{
    const float *a = g->vertices[corners[0]].position, *b = g->vertices[corners[1]].position,
                *c = g->vertices[corners[2]].position;
    const float u[3] = {b[0] - a[0], b[1] - a[1], b[2] - a[2]}, w[3] = {c[0] - a[0], c[1] - a[1], c[2] - a[2]};
    const float up = u[2] * w[0] - u[0] * w[2];
    const float size = hypotf(hypotf(u[1] * w[2] - u[2] * w[1], up), u[0] * w[1] - u[1] * w[0]);
    *level_m2 = up > 0.9f * size ? 0.5f * up : 0;
    return (a[1] + b[1] + c[1]) / 3;
}

/* The height that most of the level ground has: roofs of cars and steps are smaller. */
static float height_of_ground(const grid *g, float camera_m)
{
    enum { BINS = 1024 };
    const float bin_m = 0.1f;
    static const float half = 0.5f * BINS;
    float area[BINS] = {0}, moment[BINS] = {0};
    int best = 0;
    for (uint32_t i = 0; i < g->index_count; i += 3) {
        float level_m2;
        const float height = height_of(g, g->indices + i, &level_m2);
        const float at = (height - camera_m) / bin_m + half;
        if (!(at >= 0 && at < BINS))
            continue;
        area[(int)at] += level_m2;
        moment[(int)at] += level_m2 * height;
    }
    for (int i = 0; i + 1 < BINS; i++)
        if (area[i] + area[i + 1] > area[best] + area[best + 1])
            best = i;
    const float whole = area[best] + area[best + 1];
    return whole > 0 ? (moment[best] + moment[best + 1]) / whole : g->vertices[g->indices[0]].position[1];
}

/* Without a mask, what is a step higher or lower than that is no ground. */
static void keep_near(grid *g, float height_m)
{
    uint32_t kept = 0;
    for (uint32_t i = 0; i < g->index_count; i += 3) {
        float level_m2;
        if (fabsf(height_of(g, g->indices + i, &level_m2) - height_m) > NEAR_M)
            continue;
        memmove(g->indices + kept, g->indices + i, 3 * sizeof *g->indices);
        kept += 3;
    }
    g->index_count = kept;
}

static void turn_to_unit(grid *g)
{
    for (uint32_t i = 0; i < g->vertex_count; i++) {
        float *n = g->vertices[i].normal;
        const float length = sqrtf(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
        for (int c = 0; c < 3; c++)
            n[c] /= length;
    }
}

static bool make_mesh(shot *s, const grid *g, float height_m, char *error, size_t error_size)
{
    host_mesh *mesh = &s->meshes[s->meshes_loaded];
    if (!host_mesh_create(&s->device, g->vertices, g->vertex_count, g->indices, g->index_count, &asphalt, mesh, error,
                          error_size))
        return false;
    mesh->apart = true;                    /* flat ground shades nothing */
    mesh->primitives[0].low[1] = height_m; /* the mirror's plane is there */
    return true;
}

/* The mask is the texture of what is drawn wet. */
static bool add_texture(shot *s, host_mesh *mesh, char *error, size_t error_size)
{
    const host_image_def def = {.format = VK_FORMAT_R8_UNORM,
                                .extent = {s->options.width, s->options.height, 1},
                                .usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT,
                                .name = "mask of the ground"};
    mesh->textures = calloc(1, sizeof *mesh->textures);
    if (!mesh->textures)
        return host_fail(error, error_size, "no memory for the ground of a plate");
    mesh->texture_count = 1;
    mesh->materials[0].base_texture = 0;
    return host_image_create(&s->device, &def, &mesh->textures[0], error, error_size);
}

static bool upload_mask(shot *s, host_mesh *mesh, char *error, size_t error_size)
{
    const size_t pixels = (size_t)s->options.width * s->options.height;
    uint8_t *texels = malloc(pixels);
    if (!texels)
        return host_fail(error, error_size, "no memory for the ground of a plate");
    for (size_t i = 0; i < pixels; i++)
        texels[i] = (uint8_t)lrintf(255 * s->plate_ground->share[i]);
    const bool done = host_image_upload(&s->device, &mesh->textures[0], texels, pixels, 1, error, error_size);
    free(texels);
    return done;
}

/* Of a plane, all of it: the mask alone says where. */
static bool add_look(shot *s, const grid *seen, float height_m, char *error, size_t error_size)
{
    const double *at = s->camera_keys[0].position_m;
    host_vertex corners[4];
    uint32_t indices[6] = {0, 1, 2, 0, 2, 3};
    for (int i = 0; i < 4; i++)
        corners[i] = (host_vertex){.position = {(float)(at[0] + (i < 2 ? -PLANE_M : PLANE_M)), 0,
                                                (float)(at[2] + (i == 1 || i == 2 ? PLANE_M : -PLANE_M))},
                                   .normal = {0, 1, 0}};
    const grid plane = {corners, indices, 4, 6};
    plate_ground *g = s->plate_ground;
    g->look = s->meshes_loaded;
    if (!make_mesh(s, footage_of(s)->ground == SCENE_FOOTAGE_GROUND_PLANE ? &plane : seen, height_m, error, error_size))
        return false;
    host_mesh *mesh = &s->meshes[g->look];
    return add_texture(s, mesh, error, error_size) && upload_mask(s, mesh, error, error_size) &&
           shot_add_mesh(s, false, error, error_size) &&
           host_renderer_set_footage(s->renderer, &s->target, mesh, error, error_size);
}

/* FNV-1a of where the ground is. */
static uint64_t hash_of(const grid *g)
{
    uint64_t hash = UINT64_C(0xcbf29ce484222325);
    for (uint32_t i = 0; i < g->index_count; i++) {
        const uint8_t *bytes = (const uint8_t *)g->vertices[g->indices[i]].position;
        for (size_t k = 0; k < sizeof g->vertices->position; k++)
            hash = (hash ^ bytes[k]) * UINT64_C(0x100000001b3);
    }
    return hash;
}

uint32_t plate_ground_meshes(const shot *s)
{
    return s->plate_ground ? 2 : 0;
}

bool plate_ground_load_meshes(shot *s, char *error, size_t error_size)
{
    grid seen = {.vertices = NULL};
    if (!s->plate_ground)
        return true;
    float height_m = 0;
    bool made = gather_frames(s, &seen, error, error_size);
    if (made) {
        turn_to_unit(&seen);
        height_m = height_of_ground(&seen, (float)s->camera_keys[0].position_m[1]);
    }
    if (made && footage_of(s)->ground == SCENE_FOOTAGE_GROUND_DEPTH && !s->plate_ground->has_masks)
        keep_near(&seen, height_m);
    s->plate_ground->hash = hash_of(&seen);
    made = made && make_mesh(s, &seen, height_m, error, error_size) && shot_add_mesh(s, true, error, error_size) &&
           (!s->renderer || add_look(s, &seen, height_m, error, error_size));
    free(seen.vertices);
    free(seen.indices);
    return made;
}

/* ---- frames */

static void fill_depth(shot *s, uint32_t frame)
{
    host_camera camera;
    shot_camera(s, shot_time(s, frame), 0, NULL, &camera);
    for (uint32_t i = 0; i < camera.width * camera.height; i++) {
        const double at[2] = {i % camera.width + 0.5, (double)(i / camera.width) + 0.5};
        double direction[3];
        const double way = s->plate_ground->share[i] >= 0.5f ? way_to_ground(s, &camera, at, direction) : 0;
        if (way > 0)
            s->plate->depth[i] = plate_buffer_depth(s->plate, way);
    }
}

bool plate_ground_load(shot *s, uint32_t frame, char *error, size_t error_size)
{
    plate_ground *g = s->plate_ground;
    if (!g)
        return true;
    const bool other = g->loaded != frame && g->has_masks;
    if (!load_mask(s, frame, error, error_size))
        return false;
    if (footage_of(s)->ground == SCENE_FOOTAGE_GROUND_PLANE && !s->options.depth)
        fill_depth(s, frame);
    return !other || !s->renderer || upload_mask(s, &s->meshes[g->look], error, error_size);
}
