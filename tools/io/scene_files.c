/* scene_files.c - finds and hashes the files that a scene names. */
#include "scene_files.h"

#include "numbered_files.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* ---- all of them ---------------------------------------------------------------------------------------------- */

typedef struct visitor {
    bool (*visit)(const scene_item *item, char **name, void *user);
    void *user;
} visitor;

static bool visit_file(const scene_item *item, void *user)
{
    const visitor *v = user;
    char **name = (char **)(void *)item->value;
    return !(item->row->flags & SCENE_ROW_NAMES_FILE) || !*name || v->visit(item, name, v->user);
}

bool scene_each_file(scene_file *scene, bool (*visit)(const scene_item *item, char **name, void *user), void *user)
{
    visitor v = {visit, user};
    return scene_walk(scene, SCENE_ORDER_GROUPS_FIRST, visit_file, &v);
}

bool scene_is_numbered(const scene_item *item, const char *name)
{
    return (item->row->flags & SCENE_ROW_NUMBERED) && strchr(name, '%');
}

/* ---- finding -------------------------------------------------------------------------------------------------- */

/* Joins a name with the folder of the scene file. */
static char *join_folder(const char *scene_path, const char *name)
{
    const char *slash = strrchr(scene_path, '/');
    char *joined = NULL;
    int folder = slash && name[0] != '/' ? (int)(slash - scene_path) + 1 : 0;
    return asprintf(&joined, "%.*s%s", folder, scene_path, name) < 0 ? NULL : joined;
}

static bool find_file(const scene_item *item, char **name, void *user)
{
    scene_document *document = user;
    const char *key = item->path;
    const int node = scene_document_find(document, key);
    char *path = join_folder(document->path, *name);
    if (!path)
        return scene_document_fail(document, node, "%s: no more memory", key);
    free(*name);
    *name = path;
    if (scene_is_numbered(item, path))
        return true; /* which there are is for those to check who use them */
    struct stat info;
    if (stat(path, &info) != 0 || (S_ISREG(info.st_mode) && access(path, R_OK) != 0))
        return scene_document_fail(document, node, "%s: cannot read %s: %s", key, path, strerror(errno));
    if (!S_ISREG(info.st_mode))
        return scene_document_fail(document, node, "%s: expected a file, but %s is %s", key, path,
                                   S_ISDIR(info.st_mode) ? "a folder" : "something else");
    return true;
}

bool scene_files_find(scene_document *document, scene_file *scene)
{
    return scene_each_file(scene, find_file, document);
}

/* ---- hashing -------------------------------------------------------------------------------------------------- */

uint64_t scene_hash_bytes(uint64_t hash, const void *data, size_t size)
{
    const unsigned char *bytes = data;
    for (size_t i = 0; i < size; i++)
        hash = (hash ^ bytes[i]) * 0x100000001b3u;
    return hash;
}

/* A file that can not be read adds nothing. Loading it reports the error later. */
static void hash_file(uint64_t *hash, const char *name)
{
    unsigned char bytes[65536];
    size_t got;
    FILE *file = fopen(name, "rb");
    while (file && (got = fread(bytes, 1, sizeof bytes, file)) > 0)
        *hash = scene_hash_bytes(*hash, bytes, got);
    if (file)
        fclose(file);
}

/* The files of a simulation have gigabytes, so three parts of each stand for all of it. */
static void hash_parts(uint64_t *hash, const char *name)
{
    unsigned char bytes[4096];
    struct stat info;
    FILE *file = fopen(name, "rb");
    if (file && fstat(fileno(file), &info) == 0 && S_ISREG(info.st_mode)) {
        const uint64_t size = (uint64_t)info.st_size;
        *hash = scene_hash_bytes(*hash, &size, sizeof size);
        for (int part = 0; part < 3; part++) {
            const off_t at = (info.st_size > (off_t)sizeof bytes ? info.st_size - (off_t)sizeof bytes : 0) / 2 * part;
            if (fseeko(file, at, SEEK_SET) == 0)
                *hash = scene_hash_bytes(*hash, bytes, fread(bytes, 1, sizeof bytes, file));
        }
    }
    if (file)
        fclose(file);
}

static void hash_numbered(uint64_t *hash, const char *name)
{
    numbered_files files;
    uint32_t *numbers = NULL;
    size_t count = 0;
    if (!numbered_files_parse(&files, name, NULL, 0))
        return;
    if (numbered_files_list(&files, &numbers, &count, NULL, 0))
        for (size_t i = 0; i < count; i++) {
            char *path = numbered_files_path(&files, numbers[i]);
            *hash = scene_hash_bytes(*hash, &numbers[i], sizeof numbers[i]);
            if (path)
                hash_parts(hash, path);
            free(path);
        }
    free(numbers);
    numbered_files_free(&files);
}

static bool hash_item(const scene_item *item, char **name, void *user)
{
    if (scene_is_numbered(item, *name))
        hash_numbered(user, *name);
    else
        hash_file(user, *name);
    return true;
}

uint64_t scene_hash_files(uint64_t hash, scene_file *scene)
{
    scene_each_file(scene, hash_item, &hash);
    return hash;
}
