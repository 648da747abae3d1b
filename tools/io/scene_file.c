/* scene_file.c - from a file's bytes to a checked scene. */
#include "scene_file.h"

#include <errno.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "file.h"
#include "scene_check.h"
#include "scene_document.h"
#include "scene_schema.h"

#define MAX_BYTES (16u << 20)

/* ---- loading by schema ---------------------------------------------------------------------------------------- */

typedef struct first_line {
    char text[200];
} first_line;

/* libcyaml says the cause first and then where it was, line by line: the first is kept. */
static void keep_first_line(cyaml_log_t level, void *context, const char *format, va_list arguments)
{
    first_line *line = context;
    if (level < CYAML_LOG_ERROR || line->text[0])
        return;
    vsnprintf(line->text, sizeof line->text, format, arguments);
    line->text[strcspn(line->text, "\n")] = 0;
}

static cyaml_config_t loader(first_line *line)
{
    return (cyaml_config_t){
        .log_fn = keep_first_line,
        .log_ctx = line,
        .mem_fn = cyaml_mem,
        .log_level = CYAML_LOG_ERROR,
        .flags = CYAML_CFG_NO_ALIAS,
    };
}

void scene_file_free(scene_file *scene)
{
    cyaml_config_t config = loader(&(first_line){""});
    if (!scene)
        return;
    if (scene->source)
        scene_document_free(scene->source);
    free(scene->source);
    cyaml_free(&config, &scene_schema, scene, 0);
}

static bool load_data(scene_document *document, scene_file **scene)
{
    size_t size = 0;
    char *text = scene_document_print(document, &size);
    if (!text)
        return scene_document_fail(document, 0, "no more memory");
    first_line line = {""};
    cyaml_config_t config = loader(&line);
    cyaml_err_t result =
        cyaml_load_data((const uint8_t *)text, size, &config, &scene_schema, (cyaml_data_t **)scene, NULL);
    free(text);
    if (result == CYAML_OK)
        return true;
    *scene = NULL;
    return scene_document_fail(document, 0, "%s", line.text[0] ? line.text : cyaml_strerror(result));
}

/* ---- files ---------------------------------------------------------------------------------------------------- */

/* Joins a name with the folder of the scene file. */
static char *beside(const char *scene_path, const char *name)
{
    const char *slash = strrchr(scene_path, '/');
    char *joined = NULL;
    int folder = slash && name[0] != '/' ? (int)(slash - scene_path) + 1 : 0;
    return asprintf(&joined, "%.*s%s", folder, scene_path, name) < 0 ? NULL : joined;
}

/* Replaces a name by the path it can be opened with, if it can. */
static bool find_file(scene_document *document, const char *key, char **name)
{
    int node = scene_document_find(document, key);
    char *path = beside(document->path, *name);
    if (!path)
        return scene_document_fail(document, node, "%s: no more memory", key);
    free(*name); /* libcyaml's memory is realloc's */
    *name = path;
    struct stat info;
    if (stat(path, &info) != 0 || (S_ISREG(info.st_mode) && access(path, R_OK) != 0))
        return scene_document_fail(document, node, "%s: cannot read %s: %s", key, path, strerror(errno));
    if (!S_ISREG(info.st_mode))
        return scene_document_fail(document, node, "%s: expected a file, but %s is %s", key, path,
                                   S_ISDIR(info.st_mode) ? "a folder" : "something else");
    return true;
}

static bool find_pane_files(scene_document *document, scene_file *scene)
{
    char key[64];
    for (uint32_t i = 0; i < scene->pane_count; i++) {
        scene_pane *pane = &scene->panes[i];
        snprintf(key, sizeof key, "glass.%u.bumps.file", i);
        if (pane->bumps.file && !find_file(document, key, &pane->bumps.file))
            return false;
        snprintf(key, sizeof key, "glass.%u.mask", i);
        if (pane->mask && !find_file(document, key, &pane->mask))
            return false;
    }
    return true;
}

static bool find_files(scene_document *document, scene_file *scene)
{
    char key[64];
    for (uint32_t i = 0; i < scene->mesh_count; i++) {
        snprintf(key, sizeof key, "meshes.%u.file", i);
        if (!find_file(document, key, &scene->meshes[i].file))
            return false;
    }
    scene_material_map *map = &scene->ground.material_map;
    return (!scene->environment.file || find_file(document, "environment.file", &scene->environment.file)) &&
           (!map->file || find_file(document, "ground.material_map.file", &map->file)) &&
           find_pane_files(document, scene);
}

/* ---- what one value alone does not show ----------------------------------------------------------------------- */

static bool refuse(scene_document *document, const char *key, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

static bool refuse(scene_document *document, const char *key, const char *format, ...)
{
    char text[256];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    return scene_document_fail(document, scene_document_find(document, key), "%s: %s", key, text);
}

bool scene_file_refuse(const scene_file *scene, const char *key, char *error, size_t error_size, const char *format,
                       ...)
{
    char text[1024];
    scene_document *source = scene->source;
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    source->error = error;
    source->error_size = error_size;
    return scene_document_fail(source, scene_document_find(source, key), "%s: %s", key, text);
}

static bool check_camera(scene_document *document, const scene_camera *camera)
{
    char key[64];
    if (camera->far_m <= camera->near_m)
        return refuse(document, "camera.far_m", "expected more than near_m (%g), got %g", camera->near_m,
                      camera->far_m);
    for (uint32_t i = 0; i < camera->key_count; i++) {
        const scene_camera_key *now = &camera->keys[i];
        if (i > 0 && now->time_s <= now[-1].time_s) {
            snprintf(key, sizeof key, "camera.keys.%u.time_s", i);
            return refuse(document, key, "expected more than the key before has (%g), got %g", now[-1].time_s,
                          now->time_s);
        }
        if (!memcmp(now->position_m, now->look_at_m, sizeof now->position_m)) {
            snprintf(key, sizeof key, "camera.keys.%u.look_at_m", i);
            return refuse(document, key, "expected another place than position_m");
        }
    }
    return true;
}

static bool check_lights(scene_document *document, const scene_file *scene)
{
    char key[64];
    for (uint32_t i = 0; i < scene->light_count; i++) {
        const scene_light *light = &scene->lights[i];
        if (light->type != SCENE_LIGHT_SPOT)
            continue;
        if (light->direction[0] == 0 && light->direction[1] == 0 && light->direction[2] == 0) {
            snprintf(key, sizeof key, "lights.%u.direction", i);
            return refuse(document, key, "expected a direction, got all zero");
        }
        if (light->outer_deg <= light->inner_deg) {
            snprintf(key, sizeof key, "lights.%u.outer_deg", i);
            return refuse(document, key, "expected more than inner_deg (%g), got %g", light->inner_deg,
                          light->outer_deg);
        }
    }
    return true;
}

static bool check_table(scene_document *document, const scene_rain *rain)
{
    char key[64];
    bool any = false;
    if (rain->table_count < 2)
        return rain->sizes != SCENE_SIZES_TABLE ||
               refuse(document, "rain.table", "expected at least 2 entries, as rain.sizes is table");
    for (uint32_t i = 0; i < rain->table_count; i++) {
        const scene_size_entry *now = &rain->table[i];
        any |= now->number > 0;
        if (i > 0 && now->diameter_mm <= now[-1].diameter_mm) {
            snprintf(key, sizeof key, "rain.table.%u.diameter_mm", i);
            return refuse(document, key, "expected more than the entry before has (%g), got %g", now[-1].diameter_mm,
                          now->diameter_mm);
        }
    }
    /* The drops that the rain holds go from 0.2 to 6.8 mm. */
    if (!any || rain->table[0].diameter_mm >= 6.8 || rain->table[rain->table_count - 1].diameter_mm <= 0.2)
        return refuse(document, "rain.table", "expected some drops between 0.2 and 6.8 mm");
    return true;
}

static bool check_rain(scene_document *document, const scene_rain *rain)
{
    char key[64];
    if (rain->occlusion_size > 0 && rain->occlusion_size < 64)
        return refuse(document, "rain.occlusion_size", "expected 0 (no occlusion) or 64 to 8192, got %u",
                      rain->occlusion_size);
    for (uint32_t i = 1; i < rain->key_count; i++) {
        const scene_rain_key *now = &rain->keys[i];
        if (now->time_s <= now[-1].time_s) {
            snprintf(key, sizeof key, "rain.keys.%u.time_s", i);
            return refuse(document, key, "expected more than the key before has (%g), got %g", now[-1].time_s,
                          now->time_s);
        }
    }
    return check_table(document, rain);
}

static bool check_material_map(scene_document *document, const scene_material_map *map)
{
    for (int axis = 0; map->file && axis < 2; axis++)
        if (map->high_m[axis] <= map->low_m[axis])
            return refuse(document, "ground.material_map.high_m", "expected more than low_m in %s (%g), got %g",
                          axis ? "z" : "x", map->low_m[axis], map->high_m[axis]);
    return true;
}

static bool check_wiper(scene_document *document, const scene_wiper *wiper, const char *at)
{
    char key[160];
    if (wiper->blade_m > wiper->reach_m) {
        snprintf(key, sizeof key, "%s.blade_m", at);
        return refuse(document, key, "expected at most reach_m (%g), got %g", wiper->reach_m, wiper->blade_m);
    }
    snprintf(key, sizeof key, "%s.keys", at);
    if (wiper->drive == SCENE_WIPER_KEYS && !wiper->key_count)
        return refuse(document, key, "expected at least 1 entry, as drive is keys");
    if (wiper->drive != SCENE_WIPER_KEYS && wiper->key_count)
        return refuse(document, key, "expected none, as drive is not keys");
    for (uint32_t i = 1; i < wiper->key_count; i++) {
        const scene_wiper_key *now = &wiper->keys[i];
        snprintf(key, sizeof key, "%s.keys.%u.time_s", at, i);
        if (now->time_s <= now[-1].time_s)
            return refuse(document, key, "expected more than the key before has (%g), got %g", now[-1].time_s,
                          now->time_s);
    }
    return true;
}

static bool is_zero(const double v[3])
{
    return v[0] == 0 && v[1] == 0 && v[2] == 0;
}

/* What goes with a shape or with a motion, and only with that. */
static bool check_pane(scene_document *document, const scene_pane *pane, uint32_t index)
{
    char key[96];
    snprintf(key, sizeof key, "glass.%u.shape", index);
    if (pane->shape == SCENE_PANE_MESH && !pane->mesh)
        return refuse(document, key, "expected mesh beside it, the name of one");
    snprintf(key, sizeof key, "glass.%u.mesh", index);
    if (pane->shape != SCENE_PANE_MESH && pane->mesh)
        return refuse(document, key, "expected shape: mesh beside it");
    snprintf(key, sizeof key, "glass.%u.motion", index);
    if (pane->motion == SCENE_PANE_MOTION_PATH &&
        !(is_zero(pane->velocity_m_s) && is_zero(pane->acceleration_m_s2) && is_zero(pane->turn_deg_s)))
        return refuse(document, key, "expected given, as velocity_m_s, acceleration_m_s2 or turn_deg_s is there");
    snprintf(key, sizeof key, "glass.%u.receding_deg", index);
    if (pane->advancing_deg && pane->receding_deg && *pane->receding_deg > *pane->advancing_deg)
        return refuse(document, key, "expected at most advancing_deg (%g), got %g", *pane->advancing_deg,
                      *pane->receding_deg);
    for (uint32_t i = 0; i < pane->wiper_count; i++) {
        snprintf(key, sizeof key, "glass.%u.wipers.%u", index, i);
        if (!check_wiper(document, &pane->wipers[i], key))
            return false;
    }
    return true;
}

static bool check_panes(scene_document *document, const scene_file *scene)
{
    char key[64];
    for (uint32_t i = 0; i < scene->pane_count; i++) {
        for (uint32_t other = 0; other < i; other++) {
            snprintf(key, sizeof key, "glass.%u.name", i);
            if (!strcmp(scene->panes[i].name, scene->panes[other].name))
                return refuse(document, key, "expected another name than that of glass.%u, '%s'", other,
                              scene->panes[i].name);
        }
        if (!check_pane(document, &scene->panes[i], i))
            return false;
    }
    return true;
}

static bool check_together(scene_document *document, const scene_file *scene)
{
    if (scene->frames.last < scene->frames.first)
        return refuse(document, "frames.last", "expected at least frames.first (%u), got %u", scene->frames.first,
                      scene->frames.last);
    if (scene->splash.on && !scene->ground.on)
        return refuse(document, "splash.on", "expected ground.on: true too, as it is the ground that drops splash on");
    return check_camera(document, &scene->camera) && check_lights(document, scene) &&
           check_rain(document, &scene->rain) && check_material_map(document, &scene->ground.material_map) &&
           check_panes(document, scene);
}

/* ---- loading -------------------------------------------------------------------------------------------------- */

static uint64_t fnv(uint64_t hash, const void *data, size_t size)
{
    const unsigned char *bytes = data;
    for (size_t i = 0; i < size; i++)
        hash = (hash ^ bytes[i]) * 0x100000001b3u;
    return hash;
}

static uint64_t hash_of(const void *text, size_t size, const char *const *overrides, size_t count)
{
    uint64_t hash = fnv(0xcbf29ce484222325u, text, size);
    for (size_t i = 0; i < count; i++)
        hash = fnv(hash, overrides[i], strlen(overrides[i]) + 1);
    return hash;
}

/* A file that can not be read adds nothing: loading it says why, later. */
static uint64_t hash_file(uint64_t hash, const char *path)
{
    unsigned char bytes[65536];
    size_t got;
    FILE *file = fopen(path, "rb");
    while (file && (got = fread(bytes, 1, sizeof bytes, file)) > 0)
        hash = fnv(hash, bytes, got);
    if (file)
        fclose(file);
    return hash;
}

/* Another mesh, sky, map or picture of a pane under the same name is another scene. */
static uint64_t hash_files(uint64_t hash, const scene_file *scene)
{
    for (uint32_t i = 0; i < scene->mesh_count; i++)
        hash = hash_file(hash, scene->meshes[i].file);
    if (scene->environment.file)
        hash = hash_file(hash, scene->environment.file);
    if (scene->ground.material_map.file)
        hash = hash_file(hash, scene->ground.material_map.file);
    for (uint32_t i = 0; i < scene->pane_count; i++) {
        const scene_pane *pane = &scene->panes[i];
        hash = pane->bumps.file ? hash_file(hash, pane->bumps.file) : hash;
        hash = pane->mask ? hash_file(hash, pane->mask) : hash;
    }
    return hash;
}

/* On success the document is the scene's. */
static bool load_document(scene_document *document, scene_file **scene, const char *const *overrides, size_t count)
{
    if (!scene_document_override(document, overrides, count) || !scene_check(document) || !load_data(document, scene))
        return false;
    if (check_together(document, *scene) && find_files(document, *scene) && scene_document_keep(document, count)) {
        (*scene)->source = document;
        return true;
    }
    scene_file_free(*scene);
    *scene = NULL;
    return false;
}

static bool load_text(scene_document *document, const char *path, const char *text, size_t size,
                      const char *const *overrides, size_t count, scene_file **scene, char *error, size_t error_size)
{
    if (!scene_document_parse(document, path, text, size, error, error_size))
        return false;
    if (load_document(document, scene, overrides, count))
        return true;
    scene_document_free(document);
    return false;
}

bool scene_file_load(const char *path, const char *const *overrides, size_t override_count, scene_file **scene,
                     char *error, size_t error_size)
{
    void *text = NULL;
    size_t size = 0;
    *scene = NULL;
    if (!file_read(path, MAX_BYTES, &text, &size, error, error_size))
        return false;
    scene_document *document = malloc(sizeof *document);
    bool ok = document || file_error(error, error_size, "cannot read", path, ENOMEM);
    ok = ok && load_text(document, path, text, size, overrides, override_count, scene, error, error_size);
    if (ok)
        (*scene)->hash = hash_files(hash_of(text, size, overrides, override_count), *scene);
    else
        free(document);
    free(text);
    return ok;
}

uint64_t scene_file_hash(const scene_file *scene)
{
    return scene->hash;
}

void scene_file_weather(const scene_file *scene, double time_s, double *rate_mm_h, double wind_m_s[3])
{
    const scene_rain *rain = &scene->rain;
    *rate_mm_h = rain->rate_mm_h;
    memcpy(wind_m_s, rain->wind_m_s, sizeof rain->wind_m_s);
    if (rain->key_count == 0)
        return;
    uint32_t next = 0;
    while (next < rain->key_count && rain->keys[next].time_s <= time_s)
        next++;
    const scene_rain_key *before = &rain->keys[next > 0 ? next - 1 : 0];
    const scene_rain_key *after = &rain->keys[next < rain->key_count ? next : next - 1];
    double span = after->time_s - before->time_s;
    double share = span > 0 ? (time_s - before->time_s) / span : 0;
    *rate_mm_h = before->rate_mm_h + share * (after->rate_mm_h - before->rate_mm_h);
    for (int i = 0; i < 3; i++)
        wind_m_s[i] = before->wind_m_s[i] + share * (after->wind_m_s[i] - before->wind_m_s[i]);
}

double scene_file_wiper_deg(const scene_wiper *wiper, double time_s)
{
    uint32_t next = 0;
    if (!wiper->key_count)
        return wiper->low_deg;
    while (next < wiper->key_count && wiper->keys[next].time_s <= time_s)
        next++;
    const scene_wiper_key *before = &wiper->keys[next > 0 ? next - 1 : 0];
    const scene_wiper_key *after = &wiper->keys[next < wiper->key_count ? next : next - 1];
    const double span = after->time_s - before->time_s, share = span > 0 ? (time_s - before->time_s) / span : 0;
    return before->angle_deg + share * (after->angle_deg - before->angle_deg);
}
