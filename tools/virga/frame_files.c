/* frame_files.c - layered EXR, PLY, PNG and JSON of one frame. */
#include "frame_files.h"

#include "exr.h"
#include "options.h"
#include "ply.h"
#include "png.h"
#include "suggest.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char *const layer_names[] = {"beauty", "depth", "rain",    "velocity",
                                          "normal", "id",    "wetness", "waterdepth"};

#define LAYER_COUNT (sizeof layer_names / sizeof layer_names[0])

bool frame_layers_parse(const char *list, uint32_t *layers)
{
    *layers = list ? 0 : LAYER_ALL;
    while (list && *list) {
        char word[32];
        const size_t length = strcspn(list, ",");
        snprintf(word, sizeof word, "%.*s", (int)length, list);
        size_t i = 0;
        while (i < LAYER_COUNT && strcmp(word, layer_names[i]))
            i++;
        if (i == LAYER_COUNT) {
            const char *near = suggest_nearest(word, layer_names, LAYER_COUNT);
            return options_complain("render",
                                    "--layers: no layer '%s'%s%s; there are beauty, depth, rain, velocity, "
                                    "normal, id, wetness, waterdepth",
                                    word, near ? "; did you mean " : "", near ? near : "");
        }
        *layers |= 1u << i;
        list += length + (list[length] == ',');
    }
    return *layers || options_complain("render", "--layers: expected at least one layer");
}

uint32_t frame_layers_in(const char *channels)
{
    static const char *const first[LAYER_COUNT] = {",R,",        ",Z,",    ",rain.R,",    ",velocity.X,",
                                                   ",normal.X,", ",id.Y,", ",wetness.Y,", ",waterdepth.Y,"};
    uint32_t layers = 0;
    for (size_t i = 0; i < LAYER_COUNT; i++)
        if (strstr(channels, first[i]))
            layers |= 1u << i;
    return layers;
}

void frame_layers_print(uint32_t layers, char *text, size_t size)
{
    size_t used = 0;
    snprintf(text, size, "none");
    for (size_t i = 0; i < LAYER_COUNT && used < size; i++)
        if (layers & 1u << i)
            used += (size_t)snprintf(text + used, size - used, "%s%s", used ? "," : "", layer_names[i]);
}

/* ---- EXR */

typedef struct exr_parts {
    exr_channel channels[20];
    uint32_t count;
} exr_parts;

static void add(exr_parts *parts, const char *name, exr_sample type, const void *data, uint32_t stride_values,
                uint32_t offset)
{
    parts->channels[parts->count++] = (exr_channel){
        .name = name, .type = type, .data = (const char *)data + offset * 4, .stride = stride_values * 4u};
}

static void collect(const shot *s, uint32_t layers, const float *beauty, const float *distance, exr_parts *parts)
{
    static const char *const rgba[4] = {"R", "G", "B", "A"}, *const rain[4] = {"rain.R", "rain.G", "rain.B", "rain.A"},
                             *const normal[3] = {"normal.X", "normal.Y", "normal.Z"},
                             *const velocity[2] = {"velocity.X", "velocity.Y"};
    for (uint32_t i = 0; i < 4; i++) {
        if (layers & LAYER_BEAUTY)
            add(parts, rgba[i], EXR_SAMPLE_HALF, beauty, 4, i);
        if (layers & LAYER_RAIN)
            add(parts, rain[i], EXR_SAMPLE_HALF, s->frame.layer, 4, i);
        if (layers & LAYER_NORMAL && i < 3)
            add(parts, normal[i], EXR_SAMPLE_HALF, s->frame.normal, 4, i);
        if (layers & LAYER_WETNESS && s->ground && i < 1)
            add(parts, "wetness.Y", EXR_SAMPLE_HALF, s->frame.water, 2, 0);
        if (layers & LAYER_DEPTHS && s->ground && i < 1)
            add(parts, "waterdepth.Y", EXR_SAMPLE_FLOAT, s->frame.water, 2, 1);
        if (layers & LAYER_VELOCITY && i < 2)
            add(parts, velocity[i], EXR_SAMPLE_HALF, s->frame.velocity, 2, i);
    }
    if (layers & LAYER_DEPTH)
        add(parts, "Z", EXR_SAMPLE_FLOAT, distance, 1, 0);
    if (layers & LAYER_ID)
        add(parts, "id.Y", EXR_SAMPLE_UINT, s->frame.id, 1, 0);
}

/* The rain over the plate. */
static void compose(const shot *s, float *beauty)
{
    const size_t pixels = (size_t)s->frame.width * s->frame.height;
    for (size_t i = 0; i < pixels; i++)
        for (size_t c = 0; c < 4; c++)
            beauty[i * 4 + c] = s->frame.layer[i * 4 + c] + s->frame.color[i * 4 + c] * (1 - s->frame.layer[i * 4 + 3]);
}

static uint32_t fill_attributes(const shot *s, const host_camera *camera, uint32_t frame, exr_attribute *out,
                                char *hash, char *digits)
{
    uint32_t n = 0;
    const double fps = s->scene->frames.fps;
    snprintf(hash, 32, "%016llx", (unsigned long long)scene_file_hash(s->scene));
    out[n++] = exr_attribute_uint("seed", s->scene->rain.seed, digits);
    out[n++] = (exr_attribute){.name = "samples", .kind = EXR_ATTRIBUTE_INT, .integer = (int32_t)s->options.samples};
    out[n++] = (exr_attribute){.name = "frame", .kind = EXR_ATTRIBUTE_INT, .integer = (int32_t)frame};
    out[n++] = (exr_attribute){.name = "time", .kind = EXR_ATTRIBUTE_DOUBLE, .real64 = shot_time(s, frame)};
    out[n++] = (exr_attribute){.name = "sceneHash", .kind = EXR_ATTRIBUTE_STRING, .string = hash};
    out[n++] = (exr_attribute){.name = "virgaVersion", .kind = EXR_ATTRIBUTE_STRING, .string = virga_version()};
    out[n++] = (exr_attribute){.name = "device", .kind = EXR_ATTRIBUTE_STRING, .string = s->info.name};
    out[n++] = (exr_attribute){
        .name = "framesPerSecond", .kind = EXR_ATTRIBUTE_RATIONAL, .rational = {(int32_t)lround(fps * 1000), 1000}};
    out[n] = (exr_attribute){.name = "worldToCamera", .kind = EXR_ATTRIBUTE_M44F};
    memcpy(out[n++].m44f, camera->view_from_world, sizeof camera->view_from_world);
    return n;
}

bool frame_write_exr(shot *s, const host_camera *camera, const char *directory, uint32_t frame, uint32_t layers,
                     char *error, size_t error_size)
{
    const size_t pixels = (size_t)s->frame.width * s->frame.height;
    float *beauty = malloc(pixels * 4 * sizeof *beauty), *distance = malloc(pixels * sizeof *distance);
    if (!beauty || !distance) {
        free(beauty);
        free(distance);
        return host_fail(error, error_size, "no memory for a frame of %u x %u", s->frame.width, s->frame.height);
    }
    compose(s, beauty);
    for (size_t i = 0; i < pixels; i++)
        distance[i] = (float)host_camera_distance(camera, s->frame.depth[i]);
    exr_parts parts = {.count = 0};
    exr_attribute attributes[9];
    char path[4096], hash[32], digits[EXR_UINT_DIGITS];
    collect(s, layers, beauty, distance, &parts);
    const exr_frame file = {.width = s->frame.width,
                            .height = s->frame.height,
                            .channels = parts.channels,
                            .channel_count = parts.count,
                            .attributes = attributes,
                            .attribute_count = fill_attributes(s, camera, frame, attributes, hash, digits)};
    snprintf(path, sizeof path, "%s/frame.%04u.exr", directory, frame);
    const bool written = exr_write(path, &file, error, error_size);
    free(beauty);
    free(distance);
    return written;
}

/* ---- the rest */

bool frame_write_preview(shot *s, const char *directory, uint32_t frame, char *error, size_t error_size)
{
    const size_t pixels = (size_t)s->frame.width * s->frame.height;
    float *beauty = malloc(pixels * 4 * sizeof *beauty);
    uint8_t *rgb = malloc(pixels * 3);
    bool written = beauty && rgb;
    if (!written)
        host_fail(error, error_size, "no memory for a preview of %u x %u", s->frame.width, s->frame.height);
    if (written) {
        char path[4096];
        compose(s, beauty);
        png_from_linear(beauty, pixels, (float)s->scene->preview.exposure_ev, rgb);
        snprintf(path, sizeof path, "%s/preview.%04u.png", directory, frame);
        written = png_write(path, s->frame.width, s->frame.height, 3, rgb, error, error_size);
    }
    free(beauty);
    free(rgb);
    return written;
}

bool frame_write_points(shot *s, const char *directory, uint32_t frame, char *error, size_t error_size)
{
    static const ply_property properties[] = {
        {"x", PLY_FLOAT, offsetof(shot_point, position)},      {"y", PLY_FLOAT, offsetof(shot_point, position) + 4},
        {"z", PLY_FLOAT, offsetof(shot_point, position) + 8},  {"vx", PLY_FLOAT, offsetof(shot_point, velocity)},
        {"vy", PLY_FLOAT, offsetof(shot_point, velocity) + 4}, {"vz", PLY_FLOAT, offsetof(shot_point, velocity) + 8},
        {"radius", PLY_FLOAT, offsetof(shot_point, radius_m)}, {"id", PLY_UINT, offsetof(shot_point, id)},
        {"age", PLY_FLOAT, offsetof(shot_point, age_s)},       {"weight", PLY_FLOAT, offsetof(shot_point, weight)},
    };
    static const char *const comments[] = {"virga rain: metres, seconds; weight is the drops that a point stands for",
                                           NULL};
    shot_point *points;
    uint32_t count;
    char path[4096];
    if (!shot_points(s, &points, &count, error, error_size))
        return false;
    snprintf(path, sizeof path, "%s/rain.%04u.ply", directory, frame);
    const bool written = ply_write(path, properties, sizeof properties / sizeof properties[0], points, sizeof *points,
                                   count, comments, error, error_size);
    free(points);
    return written;
}

/* The budget: start + rained_total = elsewhere + absorbed + film + puddle + run_off + evaporated + kept + forgotten, to
 * the last nanolitre. */
static void write_water(shot *s, jsonl *stats, const virga_rain_stats *rain)
{
    static const char *const states[VIRGA_GROUND_STATES] = {"none",       "dry",        "wet",
                                                            "puddle_3mm", "puddle_5mm", "puddle_10mm"};
    virga_ground_stats g;
    virga_ground_stats_get(s->ground, &g);
    jsonl_begin_object(stats, "water_ul");
    jsonl_number(stats, "rained", (double)rain->impact_water_nl * 1e-3);
    jsonl_number(stats, "rained_total", (double)rain->total_water_nl * 1e-3);
    if (s->ground) {
        jsonl_number(stats, "start", (double)g.start_nl * 1e-3);
        jsonl_number(stats, "elsewhere", (double)g.elsewhere_nl * 1e-3);
        jsonl_number(stats, "absorbed", (double)(g.held_nl + g.infiltrated_nl) * 1e-3);
        jsonl_number(stats, "film", (double)g.film_nl * 1e-3);
        jsonl_number(stats, "puddle", (double)g.puddles_nl * 1e-3);
        jsonl_number(stats, "run_off", (double)g.run_off_nl * 1e-3);
        jsonl_number(stats, "evaporated", (double)g.evaporated_nl * 1e-3);
        jsonl_number(stats, "kept", (double)g.kept_nl * 1e-3);
        jsonl_number(stats, "forgotten", (double)g.forgotten_nl * 1e-3);
    }
    jsonl_end(stats);
    if (!s->ground)
        return;
    jsonl_begin_object(stats, "cells");
    for (uint32_t i = 0; i < VIRGA_GROUND_STATES; i++)
        jsonl_uint64(stats, states[i], g.cells[i]);
    jsonl_end(stats);
}

bool frame_write_stats(shot *s, jsonl *stats, uint32_t frame, char *error, size_t error_size)
{
    virga_rain_stats rain;
    virga_pass_time times[32];
    virga_memory_stats memory;
    virga_rain_stats_get(s->rain, &rain);
    virga_memory_get(s->context, &memory);
    const uint32_t passes = virga_timings_get(s->context, times, 32);
    jsonl_begin(stats);
    jsonl_uint64(stats, "frame", frame);
    jsonl_number(stats, "time_s", shot_time(s, frame));
    jsonl_begin_object(stats, "rain");
    jsonl_number(stats, "rate_mm_h", (double)s->settings.rate_mm_h);
    jsonl_uint64(stats, "slots", rain.slots);
    jsonl_uint64(stats, "streaks", rain.streaks);
    jsonl_uint64(stats, "impacts", rain.impacts);
    jsonl_uint64(stats, "impacts_dropped", rain.impacts_dropped);
    jsonl_number(stats, "bodies_radius_m", (double)rain.bodies_radius_m);
    jsonl_begin_array(stats, "wind_m_s");
    for (int axis = 0; axis < 3; axis++)
        jsonl_number(stats, NULL, (double)rain.wind_m_s[axis]);
    jsonl_end(stats);
    jsonl_end(stats);
    write_water(s, stats, &rain);
    jsonl_begin_object(stats, "milliseconds");
    for (uint32_t i = 0; i < passes; i++)
        jsonl_number(stats, times[i].name, times[i].milliseconds);
    jsonl_end(stats);
    jsonl_uint64(stats, "device_bytes", memory.device_bytes);
    return jsonl_end_line(stats, error, error_size);
}
