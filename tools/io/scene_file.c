/* scene_file.c - from a file's bytes to a checked scene. */
#include "scene_file.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "file.h"
#include "scene_calibration.h"
#include "scene_check.h"
#include "scene_document.h"
#include "scene_files.h"
#include "scene_load.h"
#include "scene_schema.h"

#define MAX_BYTES (16u << 20)

void scene_file_free(scene_file *scene)
{
    if (!scene)
        return;
    scene_free_group(&scene->format->root, scene);
    if (scene->source)
        scene_document_free(scene->source);
    free(scene->source);
    free(scene->format);
    free(scene);
}

/* Checks what ranges of single values can not express. */
static bool check_sections(const scene_file *scene, char *error, size_t error_size)
{
    if (!scene_core_section.check(scene, error, error_size))
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

/* Reads a parsed document. On success the scene owns the document. */
static bool read_document(scene_document *document, const scene_section *const *sections, const char *const *overrides,
                          size_t count, scene_file **scene)
{
    scene_format *format = scene_format_create(sections);
    bool good = format || scene_document_fail(document, 0, "no more memory");
    good = good && scene_document_override(document, overrides, count) && scene_calibration_check_keys(document) &&
           scene_check(document, format);
    if (good)
        *scene = scene_load(document, format);
    if (!*scene) {
        free(format);
        return good && scene_document_fail(document, 0, "no more memory");
    }
    (*scene)->format = format;
    (*scene)->source = document;
    if (check_sections(*scene, document->error, document->error_size) && scene_files_find(document, *scene) &&
        scene_calibration_read(*scene, document->error, document->error_size) && scene_document_keep(document, count))
        return true;
    (*scene)->source = NULL;
    scene_file_free(*scene);
    *scene = NULL;
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
    bool parsed = document || file_error(error, error_size, "cannot read", path, ENOMEM);
    parsed = parsed && scene_document_parse(document, path, text, size, error, error_size);
    if (parsed && read_document(document, sections, overrides, override_count, scene)) {
        (*scene)->hash = scene_hash_files(hash_of(text, size, overrides, override_count), *scene);
    } else {
        if (parsed)
            scene_document_free(document);
        free(document);
    }
    free(text);
    return *scene;
}

uint64_t scene_file_hash(const scene_file *scene)
{
    return scene->hash;
}
