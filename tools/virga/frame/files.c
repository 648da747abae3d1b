/* files.c - layered EXR, PLY and PNG of one frame. */
#include "frame/files.h"

#include "exr.h"
#include "options.h"
#include "ply.h"
#include "png.h"
#include "suggest.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- layers */

/* In the order of lists; bit 1u << index of masks. */
enum {
    LAYER_BEAUTY,
    LAYER_DEPTH,
    LAYER_RAIN,
    LAYER_SPLASH,
    LAYER_GLASS,
    LAYER_REFRACTION,
    LAYER_VELOCITY,
    LAYER_NORMAL,
    LAYER_ID,
    LAYER_WETNESS,
    LAYER_WATER_DEPTH,
    LAYER_COUNT,
};

#define ALL_LAYERS ((1u << LAYER_COUNT) - 1)

typedef enum layer_need { NEEDS_NOTHING, NEEDS_GROUND, NEEDS_SPLASH, NEEDS_PANES, NEEDS } layer_need; /* of the scene */

static bool has_what_is_needed(const scene_file *scene, layer_need need)
{
    const bool has[NEEDS] = {true, scene_ground_of(scene)->on, scene_splash_of(scene)->on,
                             scene_glass_of(scene)->pane_count > 0};
    return has[need];
}

typedef struct layer_row {
    const char *name;
    const char *channels[4];
    exr_sample type;
    layer_need needs;
    const char *help;
} layer_row;

/* The one list of layers. */
static const layer_row layer_rows[LAYER_COUNT] = {
    [LAYER_BEAUTY] = {"beauty",
                      {"R", "G", "B", "A"},
                      EXR_SAMPLE_HALF,
                      NEEDS_NOTHING,
                      "panes over the rain over the splashes over the plate"},
    [LAYER_DEPTH] = {"depth", {"Z"}, EXR_SAMPLE_FLOAT, NEEDS_NOTHING, "metres from the camera"},
    [LAYER_RAIN] = {"rain",
                    {"rain.R", "rain.G", "rain.B", "rain.A"},
                    EXR_SAMPLE_HALF,
                    NEEDS_NOTHING,
                    "the falling drops alone, premultiplied"},
    [LAYER_SPLASH] = {"splash",
                      {"splash.R", "splash.G", "splash.B", "splash.A"},
                      EXR_SAMPLE_HALF,
                      NEEDS_SPLASH,
                      "the splashes alone, premultiplied"},
    [LAYER_GLASS] = {"glass",
                     {"glass.R", "glass.G", "glass.B", "glass.A"},
                     EXR_SAMPLE_HALF,
                     NEEDS_PANES,
                     "drops on panes and what they show, premultiplied"},
    /* Whole floats: half of them would step by half a pixel from 512 on. */
    [LAYER_REFRACTION] = {"refraction",
                          {"refraction.X", "refraction.Y"},
                          EXR_SAMPLE_FLOAT,
                          NEEDS_PANES,
                          "where drops show the plate from, pixels right and down"},
    [LAYER_VELOCITY] = {"velocity",
                        {"velocity.X", "velocity.Y"},
                        EXR_SAMPLE_HALF,
                        NEEDS_NOTHING,
                        "of the plate, px a frame right and down; see --water-velocity"},
    [LAYER_NORMAL] =
        {"normal", {"normal.X", "normal.Y", "normal.Z"}, EXR_SAMPLE_HALF, NEEDS_NOTHING, "of the plate, in the world"},
    [LAYER_ID] = {"id", {"id.Y"}, EXR_SAMPLE_UINT, NEEDS_NOTHING, "of the plate's objects; the sky is 0"},
    [LAYER_WETNESS] = {"wetness", {"wetness.Y"}, EXR_SAMPLE_HALF, NEEDS_GROUND, "of the ground, 0 to 1"},
    [LAYER_WATER_DEPTH] =
        {"waterdepth", {"waterdepth.Y"}, EXR_SAMPLE_FLOAT, NEEDS_GROUND, "metres of water on the ground"},
};

/* A name that no layer has. */
static bool refuse_layer(const char *word)
{
    const char *names[LAYER_COUNT];
    char all[256];
    for (uint32_t i = 0; i < LAYER_COUNT; i++)
        names[i] = layer_rows[i].name;
    const char *near = suggest_nearest(word, names, LAYER_COUNT);
    frame_layers_print(ALL_LAYERS, all, sizeof all);
    return options_complain("render", "--layers: no layer '%s'%s%s; there are %s", word, near ? "; did you mean " : "",
                            near ? near : "", all);
}

bool frame_layers_parse(const char *list, uint32_t *layers)
{
    *layers = list ? 0 : ALL_LAYERS;
    while (list && *list) {
        char word[32];
        const size_t length = strcspn(list, ",");
        snprintf(word, sizeof word, "%.*s", (int)length, list);
        uint32_t i = 0;
        while (i < LAYER_COUNT && strcmp(word, layer_rows[i].name))
            i++;
        if (i == LAYER_COUNT)
            return refuse_layer(word);
        *layers |= 1u << i;
        list += length + (list[length] == ',');
    }
    return *layers || options_complain("render", "--layers: expected at least one layer");
}

bool frame_layers_narrow(const scene_file *scene, uint32_t *layers)
{
    static const char *const words[NEEDS] = {"", "ground; expected ground.on: true",
                                             "splashes; expected splash.on: true",
                                             "panes; expected a list of them, glass"};
    const char *lacking = "";
    for (uint32_t i = 0; i < LAYER_COUNT; i++) {
        if (has_what_is_needed(scene, layer_rows[i].needs) || !(*layers & 1u << i))
            continue;
        lacking = words[layer_rows[i].needs];
        *layers &= ~(1u << i);
    }
    return *layers || options_complain("render", "--layers: the scene has no %s", lacking);
}

uint32_t frame_layers_in(const char *channels)
{
    uint32_t layers = 0;
    for (uint32_t i = 0; i < LAYER_COUNT; i++) {
        char first[EXR_MAX_NAME + 3];
        snprintf(first, sizeof first, ",%s,", layer_rows[i].channels[0]);
        if (strstr(channels, first))
            layers |= 1u << i;
    }
    return layers;
}

void frame_layers_print(uint32_t layers, char *text, size_t size)
{
    size_t used = 0;
    snprintf(text, size, "none");
    for (uint32_t i = 0; i < LAYER_COUNT && used < size; i++)
        if (layers & 1u << i)
            used += (size_t)snprintf(text + used, size - used, "%s%s", used ? "," : "", layer_rows[i].name);
}

void frame_layers_help(void)
{
    for (uint32_t i = 0; i < LAYER_COUNT; i++) {
        const layer_row *row = &layer_rows[i];
        char channels[64] = "";
        for (uint32_t c = 0; c < 4 && row->channels[c]; c++) {
            const char *dot = c ? strchr(row->channels[c], '.') : NULL;
            const size_t used = strlen(channels);
            snprintf(channels + used, sizeof channels - used, "%s%s", c ? " " : "", dot ? dot + 1 : row->channels[c]);
        }
        printf("    %c %-12s %-16s %s\n", row->needs >= NEEDS_SPLASH ? '*' : ' ', row->name, channels, row->help);
    }
    printf("    * where the scene has some\n");
}

/* ---- EXR */

typedef struct exr_parts {
    exr_channel channels[LAYER_COUNT * 4];
    uint32_t count;
} exr_parts;

/* The first pixel of a layer, and how many values a pixel has there. */
static const void *layer_pixels(const shot *s, uint32_t layer, const float *beauty, const float *distance,
                                uint32_t *values)
{
    const host_accumulator *frame = &s->frame;
    const struct {
        const void *pixels;
        uint32_t values;
    } rows[LAYER_COUNT] = {
        [LAYER_BEAUTY] = {beauty, 4},
        [LAYER_DEPTH] = {distance, 1},
        [LAYER_RAIN] = {frame->layer, 4},
        [LAYER_SPLASH] = {frame->splash, 4},
        [LAYER_GLASS] = {frame->glass, 4},
        [LAYER_REFRACTION] = {frame->refraction, 4},
        [LAYER_VELOCITY] = {frame->velocity, 2},
        [LAYER_NORMAL] = {frame->normal, 4},
        [LAYER_ID] = {frame->id, 1},
        [LAYER_WETNESS] = {frame->water, 2},
        [LAYER_WATER_DEPTH] = {frame->water + 1, 2},
    };
    *values = rows[layer].values;
    return rows[layer].pixels;
}

static void collect(const shot *s, uint32_t layers, const float *beauty, const float *distance, exr_parts *parts)
{
    for (uint32_t layer = 0; layer < LAYER_COUNT; layer++) {
        const layer_row *row = &layer_rows[layer];
        uint32_t values;
        const char *pixels = layer_pixels(s, layer, beauty, distance, &values);
        if (!(layers & 1u << layer))
            continue;
        for (size_t c = 0; c < 4 && row->channels[c]; c++)
            parts->channels[parts->count++] = (exr_channel){
                .name = row->channels[c], .type = row->type, .data = pixels + c * 4, .stride = values * 4u};
    }
}

static float over(const float *layer, size_t c, float below)
{
    return layer[c] + below * (1 - layer[3]);
}

/* Panes over the rain over the splashes over the plate. What the scene lacks is zero. */
static void compose(const shot *s, float *beauty)
{
    const size_t values = (size_t)s->frame.width * s->frame.height * 4;
    for (size_t i = 0; i < values; i += 4)
        for (size_t c = 0; c < 4; c++)
            beauty[i + c] = over(&s->frame.glass[i], c,
                                 over(&s->frame.layer[i], c, over(&s->frame.splash[i], c, s->frame.color[i + c])));
}

static uint32_t fill_attributes(const shot *s, const host_camera *camera, uint32_t frame, exr_attribute *out,
                                char *hash, char *digits)
{
    uint32_t n = 0;
    const double fps = s->scene->frames.fps;
    snprintf(hash, 32, "%016llx", (unsigned long long)scene_file_hash(s->scene));
    out[n++] = exr_attribute_uint("seed", scene_rain_of(s->scene)->seed, digits);
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
    if (s->options.water_velocity)
        out[n++] = (exr_attribute){
            .name = "waterVelocity", .kind = EXR_ATTRIBUTE_INT, .integer = (int32_t)s->options.water_velocity};
    out[n] = (exr_attribute){.name = "worldToCamera", .kind = EXR_ATTRIBUTE_M44F};
    memcpy(out[n++].m44f, camera->view_from_world, sizeof camera->view_from_world);
    return n;
}

bool frame_save_exr(shot *s, const host_camera *camera, const char *path, uint32_t frame, uint32_t layers, char *error,
                    size_t error_size)
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
    exr_attribute attributes[11];
    char hash[32], digits[EXR_UINT_DIGITS];
    collect(s, layers, beauty, distance, &parts);
    const exr_frame file = {.width = s->frame.width,
                            .height = s->frame.height,
                            .channels = parts.channels,
                            .channel_count = parts.count,
                            .attributes = attributes,
                            .attribute_count = fill_attributes(s, camera, frame, attributes, hash, digits)};
    const bool written = exr_write(path, &file, error, error_size);
    free(beauty);
    free(distance);
    return written;
}

bool frame_write_exr(shot *s, const host_camera *camera, const char *directory, uint32_t frame, uint32_t layers,
                     char *error, size_t error_size)
{
    char path[4096];
    snprintf(path, sizeof path, "%s/frame.%04u.exr", directory, frame);
    return frame_save_exr(s, camera, path, frame, layers, error, error_size);
}

/* ---- the rest */

bool frame_save_preview(shot *s, const char *path, char *error, size_t error_size)
{
    const size_t pixels = (size_t)s->frame.width * s->frame.height;
    float *beauty = malloc(pixels * 4 * sizeof *beauty);
    uint8_t *rgb = malloc(pixels * 3);
    bool written = beauty && rgb;
    if (!written)
        host_fail(error, error_size, "no memory for a preview of %u x %u", s->frame.width, s->frame.height);
    if (written) {
        compose(s, beauty);
        png_from_linear(beauty, pixels, (float)s->scene->preview.exposure_ev, rgb);
        written = png_write(path, s->frame.width, s->frame.height, 3, rgb, error, error_size);
    }
    free(beauty);
    free(rgb);
    return written;
}

bool frame_write_preview(shot *s, const char *directory, uint32_t frame, char *error, size_t error_size)
{
    char path[4096];
    snprintf(path, sizeof path, "%s/preview.%04u.png", directory, frame);
    return frame_save_preview(s, path, error, error_size);
}

/* ---- points */

static const struct {
    const char *name;
    layer_need needs;
} points_rows[] = {
    {"rain.%04u.ply", NEEDS_NOTHING}, {"splash.%04u.ply", NEEDS_SPLASH}, {"glass.%04u.ply", NEEDS_PANES}};

const char *frame_points_name(const scene_file *scene, uint32_t system)
{
    for (size_t i = 0; i < sizeof points_rows / sizeof points_rows[0]; i++)
        if (has_what_is_needed(scene, points_rows[i].needs) && !system--)
            return points_rows[i].name;
    return NULL;
}

static bool write_points(const char *directory, uint32_t system, uint32_t frame, const ply_property *properties,
                         uint32_t property_count, const void *rows, size_t stride, uint32_t count, const char *comment,
                         char *error, size_t error_size)
{
    const char *const comments[] = {comment, NULL};
    char path[4096], name[64];
    snprintf(name, sizeof name, points_rows[system].name, frame);
    snprintf(path, sizeof path, "%s/%s", directory, name);
    return ply_write(path, properties, property_count, rows, stride, count, comments, error, error_size);
}

#define AT(type, member, place) (offsetof(type, member) + 4 * (place))

/* The columns that all point caches begin with. */
/* clang-format off */
#define POINT_COLUMNS(type)                           \
    {"x", PLY_FLOAT, AT(type, position, 0)},          \
    {"y", PLY_FLOAT, AT(type, position, 1)},          \
    {"z", PLY_FLOAT, AT(type, position, 2)},          \
    {"vx", PLY_FLOAT, AT(type, velocity, 0)},         \
    {"vy", PLY_FLOAT, AT(type, velocity, 1)},         \
    {"vz", PLY_FLOAT, AT(type, velocity, 2)},         \
    {"radius", PLY_FLOAT, AT(type, radius_m, 0)},     \
    {"id", PLY_UINT, AT(type, id, 0)},                \
    {"age", PLY_FLOAT, AT(type, age_s, 0)}
/* clang-format on */

static bool write_drops(shot *s, const char *directory, uint32_t frame, char *error, size_t error_size)
{
    static const ply_property properties[] = {
        POINT_COLUMNS(shot_point),
        {"weight", PLY_FLOAT, AT(shot_point, weight, 0)},
    };
    shot_point *points;
    uint32_t count;
    const bool written =
        shot_points(s, &points, &count, error, error_size) &&
        write_points(directory, 0, frame, properties, sizeof properties / sizeof properties[0], points, sizeof *points,
                     count, "virga rain: metres, seconds; weight is the drops that a point stands for", error,
                     error_size);
    free(points);
    return written;
}

static bool write_droplets(shot *s, const char *directory, uint32_t frame, char *error, size_t error_size)
{
    static const ply_property properties[] = {
        POINT_COLUMNS(shot_droplet),
        {"model", PLY_UINT, AT(shot_droplet, model, 0)},
        {"material", PLY_UINT, AT(shot_droplet, material, 0)},
        {"state", PLY_UINT, AT(shot_droplet, state, 0)},
        {"parent", PLY_UINT, AT(shot_droplet, parent, 0)},
        {"index", PLY_UINT, AT(shot_droplet, index, 0)},
        {"water_ul", PLY_FLOAT, AT(shot_droplet, water_ul, 0)},
    };
    shot_droplet *droplets;
    uint32_t count;
    const bool written =
        shot_droplets(s, &droplets, &count, error, error_size) &&
        write_points(directory, 1, frame, properties, sizeof properties / sizeof properties[0], droplets,
                     sizeof *droplets, count,
                     "virga splash: metres, seconds, microlitres; parent is the drop's id; water_ul is of all the "
                     "droplets that a point stands for",
                     error, error_size);
    free(droplets);
    return written;
}

static bool write_glass_drops(shot *s, const char *directory, uint32_t frame, char *error, size_t error_size)
{
    static const ply_property properties[] = {
        POINT_COLUMNS(shot_glass_drop),
        {"kind", PLY_UINT, AT(shot_glass_drop, kind, 0)},
        {"flags", PLY_UINT, AT(shot_glass_drop, flags, 0)},
        {"pane", PLY_UINT, AT(shot_glass_drop, pane, 0)},
        {"water_ul", PLY_FLOAT, AT(shot_glass_drop, water_ul, 0)},
    };
    shot_glass_drop *drops;
    uint32_t count;
    const bool written =
        shot_glass_drops(s, &drops, &count, error, error_size) &&
        write_points(
            directory, 2, frame, properties, sizeof properties / sizeof properties[0], drops, sizeof *drops, count,
            "virga glass: metres, seconds, microlitres; radius is of the base; kind 1 drop, 2 particle; flags 4 "
            "running, 8 left behind, 16 held, 32 pushed",
            error, error_size);
    free(drops);
    return written;
}

bool frame_write_points(shot *s, const char *directory, uint32_t frame, char *error, size_t error_size)
{
    return write_drops(s, directory, frame, error, error_size) &&
           (!s->splash || write_droplets(s, directory, frame, error, error_size)) &&
           (!scene_glass_of(s->scene)->pane_count || write_glass_drops(s, directory, frame, error, error_size));
}
