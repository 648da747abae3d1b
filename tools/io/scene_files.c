/* scene_files.c - finds and hashes the files that a scene names. */
#include "scene_files.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* ---- all of them ---------------------------------------------------------------------------------------------- */

typedef struct visitor {
    bool (*visit)(const char *key, char **name, void *user);
    void *user;
} visitor;

static bool visit_file(const scene_item *item, void *user)
{
    const visitor *v = user;
    char **name = (char **)(void *)item->value;
    return !(item->row->flags & SCENE_ROW_NAMES_FILE) || !*name || v->visit(item->path, name, v->user);
}

bool scene_each_file(scene_file *scene, bool (*visit)(const char *key, char **name, void *user), void *user)
{
    visitor v = {visit, user};
    return scene_walk(scene, SCENE_ORDER_GROUPS_FIRST, visit_file, &v);
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

static bool find_file(const char *key, char **name, void *user)
{
    scene_document *document = user;
    int node = scene_document_find(document, key);
    char *path = join_folder(document->path, *name);
    if (!path)
        return scene_document_fail(document, node, "%s: no more memory", key);
    free(*name);
    *name = path;
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

/* A file that cannot be read adds nothing: loading it reports why, later. */
static bool hash_file(const char *key, char **name, void *user)
{
    (void)key;
    uint64_t *hash = user;
    unsigned char bytes[65536];
    size_t got;
    FILE *file = fopen(*name, "rb");
    while (file && (got = fread(bytes, 1, sizeof bytes, file)) > 0)
        *hash = scene_hash_bytes(*hash, bytes, got);
    if (file)
        fclose(file);
    return true;
}

uint64_t scene_hash_files(uint64_t hash, scene_file *scene)
{
    scene_each_file(scene, hash_file, &hash);
    return hash;
}
