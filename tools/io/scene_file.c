/* scene_file.c - from a file's bytes to a checked scene. */
#include "scene_file.h"

#include <errno.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "file.h"
#include "scene_check.h"
#include "scene_document.h"
#include "scene_files.h"
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

static void free_data(scene_file *scene, const scene_format *format)
{
    cyaml_config_t config = loader(&(first_line){""});
    cyaml_free(&config, &format->schema, scene, 0);
}

void scene_file_free(scene_file *scene)
{
    if (!scene)
        return;
    scene_document *source = scene->source;
    scene_format *format = scene->format;
    free_data(scene, format);
    scene_document_free(source);
    free(source);
    free(format);
}

/* On success the format is the scene's. */
static bool load_data(scene_document *document, scene_format *format, scene_file **scene)
{
    size_t size = 0;
    char *text = scene_document_print(document, &size);
    if (!text)
        return scene_document_fail(document, 0, "no more memory");
    first_line line = {""};
    cyaml_config_t config = loader(&line);
    cyaml_err_t result =
        cyaml_load_data((const uint8_t *)text, size, &config, &format->schema, (cyaml_data_t **)scene, NULL);
    free(text);
    if (result == CYAML_OK) {
        (*scene)->format = format;
        return true;
    }
    *scene = NULL;
    return scene_document_fail(document, 0, "%s", line.text[0] ? line.text : cyaml_strerror(result));
}

/* ---- what one value alone does not show ----------------------------------------------------------------------- */

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

static bool check_camera(const scene_file *scene, char *error, size_t error_size)
{
    const scene_camera *camera = &scene->camera;
    char key[64];
    if (camera->far_m <= camera->near_m)
        return scene_file_refuse(scene, "camera.far_m", error, error_size, "expected more than near_m (%g), got %g",
                                 camera->near_m, camera->far_m);
    for (uint32_t i = 0; i < camera->key_count; i++) {
        const scene_camera_key *now = &camera->keys[i];
        if (i > 0 && now->time_s <= now[-1].time_s) {
            snprintf(key, sizeof key, "camera.keys.%u.time_s", i);
            return scene_file_refuse(scene, key, error, error_size,
                                     "expected more than the key before has (%g), got %g", now[-1].time_s, now->time_s);
        }
        if (!memcmp(now->position_m, now->look_at_m, sizeof now->position_m)) {
            snprintf(key, sizeof key, "camera.keys.%u.look_at_m", i);
            return scene_file_refuse(scene, key, error, error_size, "expected another place than position_m");
        }
    }
    return true;
}

static bool check_lights(const scene_file *scene, char *error, size_t error_size)
{
    char key[64];
    for (uint32_t i = 0; i < scene->light_count; i++) {
        const scene_light *light = &scene->lights[i];
        if (light->type != SCENE_LIGHT_SPOT)
            continue;
        if (light->direction[0] == 0 && light->direction[1] == 0 && light->direction[2] == 0) {
            snprintf(key, sizeof key, "lights.%u.direction", i);
            return scene_file_refuse(scene, key, error, error_size, "expected a direction, got all zero");
        }
        if (light->outer_deg <= light->inner_deg) {
            snprintf(key, sizeof key, "lights.%u.outer_deg", i);
            return scene_file_refuse(scene, key, error, error_size, "expected more than inner_deg (%g), got %g",
                                     light->inner_deg, light->outer_deg);
        }
    }
    return true;
}

static bool check_together(const scene_file *scene, char *error, size_t error_size)
{
    if (scene->frames.last < scene->frames.first)
        return scene_file_refuse(scene, "frames.last", error, error_size, "expected at least frames.first (%u), got %u",
                                 scene->frames.first, scene->frames.last);
    if (!check_camera(scene, error, error_size) || !check_lights(scene, error, error_size))
        return false;
    for (const scene_section *const *section = scene->format->sections; *section; section++)
        if ((*section)->check && !(*section)->check(scene, error, error_size))
            return false;
    return true;
}

/* ---- loading -------------------------------------------------------------------------------------------------- */

static uint64_t hash_of(const void *text, size_t size, const char *const *overrides, size_t count)
{
    uint64_t hash = scene_hash_bytes(0xcbf29ce484222325u, text, size);
    for (size_t i = 0; i < count; i++)
        hash = scene_hash_bytes(hash, overrides[i], strlen(overrides[i]) + 1);
    return hash;
}

/* On success the document and the format are the scene's. */
static bool load_document(scene_document *document, scene_format *format, scene_file **scene,
                          const char *const *overrides, size_t count)
{
    if (!scene_document_override(document, overrides, count) || !scene_check(document, format) ||
        !load_data(document, format, scene))
        return false;
    (*scene)->source = document;
    if (check_together(*scene, document->error, document->error_size) && scene_files_find(document, *scene) &&
        scene_document_keep(document, count))
        return true;
    free_data(*scene, format);
    *scene = NULL;
    return false;
}

static bool load_text(scene_document *document, scene_format *format, const char *path, const char *text, size_t size,
                      const char *const *overrides, size_t count, scene_file **scene, char *error, size_t error_size)
{
    if (!scene_document_parse(document, path, text, size, error, error_size))
        return false;
    if (load_document(document, format, scene, overrides, count))
        return true;
    scene_document_free(document);
    return false;
}

bool scene_file_load(const char *path, const scene_section *const *sections, const char *const *overrides,
                     size_t override_count, scene_file **scene, char *error, size_t error_size)
{
    void *text = NULL;
    size_t size = 0;
    *scene = NULL;
    if (!file_read(path, MAX_BYTES, &text, &size, error, error_size))
        return false;
    scene_document *document = malloc(sizeof *document);
    scene_format *format = scene_format_create(sections);
    bool ok = (document && format) || file_error(error, error_size, "cannot read", path, ENOMEM);
    ok = ok && load_text(document, format, path, text, size, overrides, override_count, scene, error, error_size);
    if (ok) {
        (*scene)->hash = scene_hash_files(hash_of(text, size, overrides, override_count), *scene);
    } else {
        free(document);
        free(format);
    }
    free(text);
    return ok;
}

uint64_t scene_file_hash(const scene_file *scene)
{
    return scene->hash;
}
