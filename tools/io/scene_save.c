/* scene_save.c - writes a scene file from another one and overrides. */
#include "scene_changes.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "file.h"
#include "scene_document.h"
#include "scene_files.h"
#include "scene_settings.h"

/* The folder of a file without symbolic links, to be freed by free(). */
static char *folder_of(const char *path)
{
    char folder[4096];
    const char *slash = strrchr(path, '/');
    snprintf(folder, sizeof folder, "%.*s", slash ? (int)(slash - path) + 1 : 2, slash ? path : "./");
    return realpath(folder, NULL);
}

/* Writes a name as a quoted YAML string. */
static void quote(const char *name, char *text, size_t size)
{
    size_t used = 0;
    text[used++] = '\'';
    for (; *name && used + 4 < size; name++) {
        if (*name == '\'')
            text[used++] = '\'';
        text[used++] = *name;
    }
    text[used++] = '\'';
    text[used] = 0;
}

/* The absolute path of a file, or of a pattern of files. */
static char *real_path(const scene_item *item, const char *name)
{
    char *folder, *joined = NULL;
    const char *slash = strrchr(name, '/');
    if (!scene_is_numbered(item, name))
        return realpath(name, NULL);
    folder = folder_of(name);
    if (folder && asprintf(&joined, "%s/%s", folder, slash ? slash + 1 : name) < 0)
        joined = NULL;
    free(folder);
    return joined;
}

/* Overrides the name of a file by its absolute path. */
static bool make_absolute(const scene_item *item, char **name, void *user)
{
    char *real = real_path(item, *name), quoted[8200], override[8400];
    quote(real ? real : *name, quoted, sizeof quoted);
    snprintf(override, sizeof override, "%s=%s", item->path, quoted);
    free(real);
    const char *one = override;
    return scene_document_override(user, &one, 1);
}

static int write_bytes(void *file, unsigned char *bytes, size_t size)
{
    return file_write(file, bytes, size);
}

/* Writes the document and frees it, because libyaml frees it while it writes. */
static bool write_document(scene_document *document, const char *source, const char *path, char *error,
                           size_t error_size)
{
    file_writer file;
    yaml_emitter_t emitter;
    char head[4200];
    const int length = snprintf(head, sizeof head, "# Saved by virga view, from %s.\n", source);
    if (!file_start(&file, path, error, error_size))
        return false;
    if (!yaml_emitter_initialize(&emitter)) {
        file_abandon(&file);
        return file_fail(error, error_size, "no more memory");
    }
    file_write(&file, head, (size_t)length);
    yaml_emitter_set_output(&emitter, write_bytes, &file);
    yaml_emitter_set_unicode(&emitter, 1);
    yaml_emitter_set_width(&emitter, 110);
    document->yaml.start_implicit = document->yaml.end_implicit = 1;
    const bool dumped =
        yaml_emitter_open(&emitter) && yaml_emitter_dump(&emitter, &document->yaml) && yaml_emitter_close(&emitter);
    yaml_emitter_delete(&emitter);
    if (dumped)
        return file_finish(&file, error, error_size);
    file_abandon(&file);
    return file_fail(error, error_size, "cannot write %s", path);
}

/* `scene` is the result, which is valid. */
static bool save_checked(scene_file *scene, const char *source, const char *const *overrides, size_t count,
                         const char *path, char *error, size_t error_size)
{
    scene_document document;
    void *text = NULL;
    size_t size;
    char *from = folder_of(source), *to = folder_of(path);
    bool good = to || file_error(error, error_size, "cannot write", path, ENOENT);
    good = good && file_read(source, 16u << 20, &text, &size, error, error_size);
    if (good && scene_document_parse(&document, source, text, size, error, error_size)) {
        good = scene_document_override(&document, overrides, count) &&
               (!from || !strcmp(from, to) || scene_each_file(scene, make_absolute, &document)) &&
               write_document(&document, source, path, error, error_size);
        scene_document_free(&document);
    } else {
        good = false;
    }
    free(from);
    free(to);
    free(text);
    return good;
}

bool scene_settings_save(const char *source, const scene_section *const *sections, const char *const *overrides,
                         size_t override_count, const char *path, char *error, size_t error_size)
{
    scene_file *scene;
    if (!scene_file_load(source, sections, overrides, override_count, &scene, error, error_size))
        return false;
    const bool saved = save_checked(scene, source, overrides, override_count, path, error, error_size);
    scene_file_free(scene);
    return saved;
}
