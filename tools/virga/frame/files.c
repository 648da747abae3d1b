/* files.c - layered EXR, PLY and PNG of one frame. */
#include "frame/files.h"

#include "effect.h"
#include "exr.h"
#include "frame/layers.h"
#include "ply.h"
#include "png.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- EXR */

typedef struct exr_parts {
    exr_channel channels[FRAME_MAX_LAYERS * 4];
    uint32_t count;
} exr_parts;

/* The first pixel of a layer that an effect draws, by its output. */
static const void *drawn_pixels(const shot *s, const host_drawn *picture, const tool_layer *layer)
{
    for (uint32_t i = 0; i < s->layer_count; i++)
        if (s->layers[i].layer == layer)
            return picture->layers[s->layers[i].output - HOST_LAYER];
    return NULL;
}

/* The first value of a layer, and how many values a pixel has there. */
static const void *layer_pixels(const shot *s, const host_drawn *frame, const tool_layer *layer, const float *beauty,
                                const float *distance, uint32_t *values)
{
    const void *const plate[HOST_LAYER] = {
        [HOST_COLOR] = beauty,       [HOST_NORMAL] = frame->normal, [HOST_VELOCITY] = frame->velocity,
        [HOST_WATER] = frame->water, [HOST_ID] = frame->id,         [HOST_DEPTH] = distance,
    };
    *values = layer->draw ? host_output_channels(HOST_LAYER) : host_output_channels(layer->plate);
    return layer->draw ? drawn_pixels(s, frame, layer) : (const float *)plate[layer->plate] + layer->value;
}

static void collect(const shot *s, const host_drawn *frame, uint32_t layers, const float *beauty, const float *distance,
                    exr_parts *parts)
{
    for (uint32_t i = 0; frame_layer(i); i++) {
        const tool_layer *layer = frame_layer(i)->layer;
        uint32_t values;
        if (!(layers & 1u << i))
            continue;
        const char *pixels = layer_pixels(s, frame, layer, beauty, distance, &values);
        for (size_t c = 0; pixels && c < 4 && layer->channels[c]; c++)
            parts->channels[parts->count++] = (exr_channel){
                .name = layer->channels[c], .type = layer->type, .data = pixels + c * 4, .stride = values * 4u};
    }
}

static float over(const float *layer, size_t c, float below)
{
    return layer[c] + below * (1 - layer[3]);
}

void frame_compose(const shot *s, const host_drawn *frame, float *beauty)
{
    const size_t values = (size_t)frame->width * frame->height * 4;
    memcpy(beauty, frame->color, values * sizeof *beauty);
    for (uint32_t k = 0; k < s->layer_count; k++) {
        const float *layer = frame->layers[s->layers[k].output - HOST_LAYER];
        for (size_t i = 0; i < values && !s->layers[k].layer->is_data; i += 4)
            for (size_t c = 0; c < 4; c++)
                beauty[i + c] = over(&layer[i], c, beauty[i + c]);
    }
}

static uint32_t fill_attributes(const shot *s, const host_camera *camera, uint32_t frame, exr_attribute *out,
                                char *hash, char *digits)
{
    uint32_t n = 0;
    const double fps = s->scene->frames.fps;
    snprintf(hash, 32, "%016llx", (unsigned long long)scene_file_hash(s->scene));
    out[n++] = exr_attribute_uint("seed", tool_seed(s->scene), digits);
    out[n++] = (exr_attribute){.name = "samples", .kind = EXR_ATTRIBUTE_INT, .integer = (int32_t)s->options.samples};
    out[n++] = (exr_attribute){.name = "frame", .kind = EXR_ATTRIBUTE_INT, .integer = (int32_t)frame};
    out[n++] = (exr_attribute){.name = "time", .kind = EXR_ATTRIBUTE_DOUBLE, .real64 = shot_time(s, frame)};
    out[n++] = (exr_attribute){.name = "sceneHash", .kind = EXR_ATTRIBUTE_STRING, .string = hash};
    out[n++] = (exr_attribute){.name = "virgaVersion", .kind = EXR_ATTRIBUTE_STRING, .string = virga_version()};
    out[n++] = (exr_attribute){.name = "device", .kind = EXR_ATTRIBUTE_STRING, .string = s->info.name};
    out[n++] = (exr_attribute){
        .name = "framesPerSecond", .kind = EXR_ATTRIBUTE_RATIONAL, .rational = {(int32_t)lround(fps * 1000), 1000}};
    if (s->options.plate)
        out[n++] = (exr_attribute){.name = "plate", .kind = EXR_ATTRIBUTE_STRING, .string = s->options.plate};
    if (s->options.depth)
        out[n++] = (exr_attribute){.name = "plateDepth", .kind = EXR_ATTRIBUTE_STRING, .string = s->options.depth};
    if (s->options.ground_mask)
        out[n++] =
            (exr_attribute){.name = "groundMask", .kind = EXR_ATTRIBUTE_STRING, .string = s->options.ground_mask};
    if (s->options.water_velocity)
        out[n++] = (exr_attribute){
            .name = "waterVelocity", .kind = EXR_ATTRIBUTE_INT, .integer = (int32_t)s->options.water_velocity};
    out[n] = (exr_attribute){.name = "worldToCamera", .kind = EXR_ATTRIBUTE_M44F};
    memcpy(out[n++].m44f, camera->view_from_world, sizeof camera->view_from_world);
    return n;
}

bool frame_save_exr(const shot *s, const host_drawn *picture, const host_camera *camera, const char *path,
                    uint32_t frame, uint32_t layers, char *error, size_t error_size)
{
    const size_t pixels = (size_t)picture->width * picture->height;
    float *beauty = malloc(pixels * 4 * sizeof *beauty), *distance = malloc(pixels * sizeof *distance);
    if (!beauty || !distance) {
        free(beauty);
        free(distance);
        return host_fail(error, error_size, "no memory for a frame of %u x %u", picture->width, picture->height);
    }
    frame_compose(s, picture, beauty);
    for (size_t i = 0; i < pixels; i++)
        distance[i] = (float)host_camera_distance(camera, picture->depth[i]);
    exr_parts parts = {.count = 0};
    exr_attribute attributes[13];
    char hash[32], digits[EXR_UINT_DIGITS];
    collect(s, picture, layers, beauty, distance, &parts);
    const exr_frame file = {.width = picture->width,
                            .height = picture->height,
                            .channels = parts.channels,
                            .channel_count = parts.count,
                            .attributes = attributes,
                            .attribute_count = fill_attributes(s, camera, frame, attributes, hash, digits)};
    const bool written = exr_write(path, &file, error, error_size);
    free(beauty);
    free(distance);
    return written;
}

bool frame_write_exr(const shot *s, const host_drawn *picture, const host_camera *camera, const char *directory,
                     uint32_t frame, uint32_t layers, char *error, size_t error_size)
{
    char path[4096];
    snprintf(path, sizeof path, "%s/frame.%04u.exr", directory, frame);
    return frame_save_exr(s, picture, camera, path, frame, layers, error, error_size);
}

/* ---- the rest */

bool frame_save_preview(const shot *s, const host_drawn *picture, const char *path, char *error, size_t error_size)
{
    const size_t pixels = (size_t)picture->width * picture->height;
    float *beauty = malloc(pixels * 4 * sizeof *beauty);
    uint8_t *rgb = malloc(pixels * 3);
    bool written = beauty && rgb;
    if (!written)
        host_fail(error, error_size, "no memory for a preview of %u x %u", picture->width, picture->height);
    if (written) {
        frame_compose(s, picture, beauty);
        png_from_linear(beauty, pixels, (float)s->scene->preview.exposure_ev, s->scene->preview.curve, rgb);
        written = png_write(path, picture->width, picture->height, 3, rgb, error, error_size);
    }
    free(beauty);
    free(rgb);
    return written;
}

bool frame_write_preview(const shot *s, const host_drawn *picture, const char *directory, uint32_t frame, char *error,
                         size_t error_size)
{
    char path[4096];
    snprintf(path, sizeof path, "%s/preview.%04u.png", directory, frame);
    return frame_save_preview(s, picture, path, error, error_size);
}

/* ---- points */

static const char *points_name(const tool_effect *effect, const tool_points *points)
{
    return points->name ? points->name : effect->name;
}

const char *frame_points_name(const scene_file *scene, uint32_t index)
{
    for (uint32_t i = 0; tool_effects[i]; i++) {
        const tool_effect *effect = tool_effects[i];
        for (const tool_points *points = effect->points; points; points = points->next)
            if (tool_effect_is_used(effect, scene) && !index--)
                return points_name(effect, points);
    }
    return NULL;
}

void frame_points_path(const char *directory, const char *name, uint32_t frame, char *path, size_t size)
{
    snprintf(path, size, "%s/%s.%04u.ply", directory, name, frame);
}

void frame_points_help(void)
{
    for (uint32_t i = 0; tool_effects[i]; i++)
        for (const tool_points *points = tool_effects[i]->points; points; points = points->next) {
            const char *name = points_name(tool_effects[i], points);
            printf("    %c %s.%%04d.ply%*s %s\n", tool_effects[i]->is_used ? '*' : ' ', name, (int)(19 - strlen(name)),
                   "", points->help);
        }
}

static bool write_points(shot *s, const tool_points *points, const char *name, void *state, const char *directory,
                         uint32_t frame, char *error, size_t error_size)
{
    const char *const comments[] = {points->comment, NULL};
    void *rows = NULL;
    uint32_t count;
    char path[4096];
    frame_points_path(directory, name, frame, path, sizeof path);
    const bool written = points->read(s, state, &rows, &count, error, error_size) &&
                         ply_write(path, points->properties, points->property_count, rows, points->stride, count,
                                   comments, error, error_size);
    free(rows);
    return written;
}

bool frame_write_points(shot *s, const char *directory, uint32_t frame, char *error, size_t error_size)
{
    for (uint32_t i = 0; tool_effects[i]; i++) {
        const tool_effect *effect = tool_effects[i];
        if (!tool_effect_is_used(effect, s->scene))
            continue;
        for (const tool_points *points = effect->points; points; points = points->next)
            if (!write_points(s, points, points_name(effect, points), s->states[i], directory, frame, error,
                              error_size))
                return false;
    }
    return true;
}

/* ---- meshes */

const char *frame_mesh_name(const scene_file *scene, uint32_t index)
{
    for (uint32_t i = 0; tool_effects[i]; i++)
        if (tool_effects[i]->mesh && tool_effect_is_used(tool_effects[i], scene) && !index--)
            return tool_effects[i]->mesh->name;
    return NULL;
}

void frame_meshes_help(void)
{
    for (uint32_t i = 0; tool_effects[i]; i++)
        if (tool_effects[i]->mesh)
            printf("    %c %s.%%04d.ply%*s %s\n", tool_effects[i]->is_used ? '*' : ' ', tool_effects[i]->mesh->name,
                   (int)(19 - strlen(tool_effects[i]->mesh->name)), "", tool_effects[i]->mesh->help);
}

static bool write_mesh(shot *s, const tool_mesh *mesh, void *state, const char *directory, uint32_t frame, char *error,
                       size_t error_size)
{
    const char *const comments[] = {mesh->comment, NULL};
    tool_mesh_data data = {0};
    char path[4096];
    frame_points_path(directory, mesh->name, frame, path, sizeof path);
    const bool written =
        mesh->make(s, state, &data, error, error_size) &&
        ply_write_mesh(path, mesh->properties, mesh->property_count, data.vertices, mesh->stride, data.vertex_count,
                       (const uint32_t(*)[3])data.triangles, data.triangle_count, comments, error, error_size);
    free(data.vertices);
    free(data.triangles);
    return written;
}

bool frame_write_meshes(shot *s, const char *directory, uint32_t frame, char *error, size_t error_size)
{
    for (uint32_t i = 0; tool_effects[i]; i++)
        if (tool_effects[i]->mesh && tool_effect_is_used(tool_effects[i], s->scene) &&
            !write_mesh(s, tool_effects[i]->mesh, s->states[i], directory, frame, error, error_size))
            return false;
    return true;
}

/* ---- volumes */

const char *frame_volume_name(const scene_file *scene, uint32_t index)
{
    for (uint32_t i = 0; tool_effects[i]; i++)
        if (tool_effects[i]->volume && tool_effect_is_used(tool_effects[i], scene) && !index--)
            return tool_effects[i]->volume->name;
    return NULL;
}

void frame_volume_path(const char *directory, const char *name, uint32_t frame, char *path, size_t size)
{
    snprintf(path, size, "%s/%s.%04u.vdb", directory, name, frame);
}

void frame_volumes_help(void)
{
    for (uint32_t i = 0; tool_effects[i]; i++)
        if (tool_effects[i]->volume)
            printf("    %c %s.%%04d.vdb%*s %s\n", tool_effects[i]->is_used ? '*' : ' ', tool_effects[i]->volume->name,
                   (int)(19 - strlen(tool_effects[i]->volume->name)), "", tool_effects[i]->volume->help);
}

bool frame_write_volumes(shot *s, const char *directory, uint32_t frame, char *error, size_t error_size)
{
    char path[4096];
    for (uint32_t i = 0; tool_effects[i]; i++) {
        const tool_volume *volume = tool_effects[i]->volume;
        if (!volume || !tool_effect_is_used(tool_effects[i], s->scene))
            continue;
        frame_volume_path(directory, volume->name, frame, path, sizeof path);
        if (!volume->write(s, s->states[i], path, error, error_size))
            return false;
    }
    return true;
}
