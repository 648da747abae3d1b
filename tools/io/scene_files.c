/* scene_files.c - finds and hashes the files that a scene names. */
#include "scene_files.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* ---- all of them ---------------------------------------------------------------------------------------------- */

/* What one walk over a scene needs. */
typedef struct walk {
    const scene_format *format;
    bool (*visit)(const char *key, char **name, void *user);
    void *user;
} walk;

/* The keys of one group: where they are in the scene ("glass.0") and in the rules ("glass[]"). */
typedef struct group {
    const cyaml_schema_field_t *fields;
    char *data;
    char path[96], rule[96];
} group;

static bool walk_group(const walk *w, const group *in);

static bool walk_entries(const walk *w, const group *in, const cyaml_schema_field_t *list)
{
    const cyaml_schema_value_t *entry = list->value.sequence.entry;
    const uint32_t count = entry->type == CYAML_MAPPING ? scene_list_length(list, in->data) : 0;
    bool good = true;
    for (uint32_t i = 0; good && i < count; i++) {
        group inside = {entry->mapping.fields, *scene_list_entries(list, in->data) + (size_t)i * entry->data_size, "",
                        ""};
        snprintf(inside.path, sizeof inside.path, "%.80s.%u", in->path, i);
        snprintf(inside.rule, sizeof inside.rule, "%.80s[]", in->rule);
        good = walk_group(w, &inside);
    }
    return good;
}

static bool walk_field(const walk *w, const group *in, const cyaml_schema_field_t *field, bool own_texts)
{
    const char *dot = *in->path ? "." : "";
    group inside = {.data = in->data};
    snprintf(inside.path, sizeof inside.path, "%.50s%s%.40s", in->path, dot, field->key);
    snprintf(inside.rule, sizeof inside.rule, "%.50s%s%.40s", in->rule, dot, field->key);
    if (own_texts) {
        char **name = (char **)(void *)(in->data + field->data_offset);
        const scene_rule *rule = field->value.type == CYAML_STRING ? scene_rule_find(w->format, inside.rule) : NULL;
        return !rule || !(rule->flags & SCENE_RULE_NAMES_FILE) || !*name || w->visit(inside.path, name, w->user);
    }
    if (field->value.type == CYAML_SEQUENCE)
        return walk_entries(w, &inside, field);
    if (field->value.type != CYAML_MAPPING)
        return true;
    inside.fields = field->value.mapping.fields;
    inside.data += field->data_offset;
    return walk_group(w, &inside);
}

static bool walk_group(const walk *w, const group *in)
{
    bool good = true;
    for (int own_texts = 0; own_texts < 2; own_texts++)
        for (const cyaml_schema_field_t *field = in->fields; good && field->key; field++)
            good = walk_field(w, in, field, own_texts);
    return good;
}

bool scene_each_file(scene_file *scene, bool (*visit)(const char *key, char **name, void *user), void *user)
{
    const walk w = {scene->format, visit, user};
    const group root = {scene->format->schema.mapping.fields, (char *)scene, "", ""};
    return walk_group(&w, &root);
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
