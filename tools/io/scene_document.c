/* scene_document.c - libyaml's document with lines, overrides and defaults. */
#include "scene_document.h"

#include <ctype.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- where a node comes from ---------------------------------------------------------------------------------- */

/* Nodes of an override have this value minus the override's index, instead of an offset into the file. */
#define OVERRIDE_MARK SIZE_MAX
#define MAX_OVERRIDES 65536
#define MAX_DEPTH     100 /* nested brackets; scenes need 4 */

static yaml_node_t *get(const scene_document *document, int node)
{
    return node ? yaml_document_get_node((yaml_document_t *)&document->yaml, node) : NULL;
}

/* Replaces control characters by '?'. UTF-8 is not changed. */
static void make_printable(char *text)
{
    for (; *text; text++)
        if (iscntrl((unsigned char)*text))
            *text = '?';
}

static bool fail_at(const scene_document *document, const char *where, const char *format, va_list arguments)
{
    if (!document->error || !document->error_size)
        return false;
    int used = snprintf(document->error, document->error_size, "%s%s", where, *where ? ": " : "");
    if (used >= 0 && (size_t)used < document->error_size)
        vsnprintf(document->error + used, document->error_size - (size_t)used, format, arguments);
    make_printable(document->error);
    return false;
}

bool scene_document_fail(const scene_document *document, int node, const char *format, ...)
{
    char where[4200] = "";
    const yaml_node_t *at = get(document, node);
    if (!document->path)
        ; /* the value of an override; the caller writes its name */
    else if (at && OVERRIDE_MARK - at->start_mark.index < MAX_OVERRIDES)
        snprintf(where, sizeof where, "--set %.120s", document->overrides[OVERRIDE_MARK - at->start_mark.index]);
    else if (at)
        snprintf(where, sizeof where, "%s:%zu", document->path, at->start_mark.line + 1);
    else
        snprintf(where, sizeof where, "%s", document->path);
    va_list arguments;
    va_start(arguments, format);
    fail_at(document, where, format, arguments);
    va_end(arguments);
    return false;
}

static bool fail_in_override(const scene_document *document, size_t number, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

static bool fail_in_override(const scene_document *document, size_t number, const char *format, ...)
{
    char where[160];
    snprintf(where, sizeof where, "--set %.120s", document->overrides[number]);
    va_list arguments;
    va_start(arguments, format);
    fail_at(document, where, format, arguments);
    va_end(arguments);
    return false;
}

/* ---- parsing -------------------------------------------------------------------------------------------------- */

static size_t line_of_offset(const char *text, size_t size, size_t offset)
{
    size_t line = 1;
    for (size_t i = 0; i + 1 < size && i < offset; i++)
        line += text[i] == '\n';
    return line;
}

static bool fail_on_line(const scene_document *document, size_t line, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

static bool fail_on_line(const scene_document *document, size_t line, const char *format, ...)
{
    char where[4200] = "";
    if (document->path)
        snprintf(where, sizeof where, "%s:%zu", document->path, line);
    va_list arguments;
    va_start(arguments, format);
    fail_at(document, where, format, arguments);
    va_end(arguments);
    return false;
}

/* libyaml's reason, with the line where it stopped. The end of the file counts as the last line. */
static bool parse_problem(const scene_document *document, const yaml_parser_t *parser, const char *text, size_t size)
{
    bool context = parser->context && parser->error != YAML_READER_ERROR;
    size_t line = line_of_offset(text, size, parser->problem_offset);
    if (parser->error != YAML_READER_ERROR) {
        size_t last = line_of_offset(text, size, size);
        line = parser->problem_mark.line < last ? parser->problem_mark.line + 1 : last;
    }
    return fail_on_line(document, line, "not valid YAML: %s%s%s", parser->problem ? parser->problem : "no more memory",
                        context ? ", " : "", context ? parser->context : "");
}

/* Every node may be referenced only once. This also excludes cycles, and files that expand to more than memory. */
static bool count_reference(const scene_document *document, int node, unsigned char *seen)
{
    if (seen[node])
        return scene_document_fail(document, node, "anchors and aliases are not read here, write the value out twice");
    seen[node] = 1;
    return true;
}

static bool refuse_aliases(const scene_document *document)
{
    size_t count = (size_t)(document->yaml.nodes.top - document->yaml.nodes.start);
    unsigned char *seen = calloc(count + 1, 1);
    if (!seen)
        return scene_document_fail(document, 0, "no more memory");
    seen[1] = 1; /* the root */
    bool ok = true;
    for (size_t i = 0; ok && i < count; i++) {
        const yaml_node_t *node = &document->yaml.nodes.start[i];
        if (node->type == YAML_SEQUENCE_NODE)
            for (yaml_node_item_t *item = node->data.sequence.items.start; ok && item < node->data.sequence.items.top;
                 item++)
                ok = count_reference(document, *item, seen);
        if (node->type == YAML_MAPPING_NODE)
            for (yaml_node_pair_t *pair = node->data.mapping.pairs.start; ok && pair < node->data.mapping.pairs.top;
                 pair++)
                ok = count_reference(document, pair->key, seen) && count_reference(document, pair->value, seen);
    }
    free(seen);
    return ok;
}

/* Offset of the bracket that opens too many levels, or `size`. libyaml has its own limit, but reaches it in a time that
 * grows with the square of the levels. Brackets in quotes count too, because no scene has that many. */
static size_t find_deep_nesting(const char *text, size_t size)
{
    size_t depth = 0;
    for (size_t i = 0; i < size; i++) {
        if (text[i] == '[' || text[i] == '{')
            depth++;
        else if ((text[i] == ']' || text[i] == '}') && depth > 0)
            depth--;
        if (depth > MAX_DEPTH)
            return i;
    }
    return size;
}

static bool load_only_document(scene_document *document, yaml_parser_t *parser, const char *text, size_t size)
{
    size_t deep = find_deep_nesting(text, size);
    if (deep < size)
        return fail_on_line(document, line_of_offset(text, size, deep), "brackets are nested more than %d deep",
                            MAX_DEPTH);
    if (!yaml_parser_load(parser, &document->yaml))
        return parse_problem(document, parser, text, size);
    yaml_document_t second;
    bool ok = true;
    if (!yaml_parser_load(parser, &second)) {
        ok = parse_problem(document, parser, text, size);
    } else {
        const yaml_node_t *root = yaml_document_get_root_node(&second);
        if (root)
            ok = fail_on_line(document, root->start_mark.line + 1, "a second document begins, expected one");
        yaml_document_delete(&second);
    }
    if (!ok)
        yaml_document_delete(&document->yaml);
    return ok;
}

bool scene_document_parse(scene_document *document, const char *path, const char *text, size_t size, char *error,
                          size_t error_size)
{
    *document = (scene_document){.path = path, .error = error, .error_size = error_size};
    yaml_parser_t parser;
    if (!yaml_parser_initialize(&parser))
        return scene_document_fail(document, 0, "no more memory");
    yaml_parser_set_input_string(&parser, (const unsigned char *)text, size);
    bool ok = load_only_document(document, &parser, text, size);
    yaml_parser_delete(&parser);
    if (!ok)
        return false;
    const yaml_node_t *root = yaml_document_get_root_node(&document->yaml);
    if (!root)
        ok = scene_document_fail(document, 0, "is empty, expected a scene that begins with 'virga: 1'");
    else if (root->type != YAML_MAPPING_NODE)
        ok = scene_document_fail(document, 1, "expected keys such as 'virga: 1', got %s",
                                 root->type == YAML_SEQUENCE_NODE ? "a list" : "a single value");
    else
        ok = refuse_aliases(document);
    if (!ok)
        scene_document_free(document);
    return ok;
}

void scene_document_free(scene_document *document)
{
    yaml_document_delete(&document->yaml);
    free(document->kept);
    document->kept = NULL;
}

static const char *copy_text(char **room, const char *text)
{
    char *copy = *room;
    *room = stpcpy(copy, text) + 1;
    return copy;
}

bool scene_document_keep(scene_document *document, size_t override_count)
{
    size_t size = override_count * sizeof(char *) + strlen(document->path) + 1;
    for (size_t i = 0; i < override_count; i++)
        size += strlen(document->overrides[i]) + 1;
    const char **overrides = malloc(size);
    if (!overrides)
        return scene_document_fail(document, 0, "no more memory");
    char *room = (char *)(overrides + override_count);
    for (size_t i = 0; i < override_count; i++)
        overrides[i] = copy_text(&room, document->overrides[i]);
    document->path = copy_text(&room, document->path);
    document->overrides = overrides;
    document->kept = overrides;
    return true;
}

/* ---- looking up ----------------------------------------------------------------------------------------------- */

const char *scene_document_text(scene_document *document, int node)
{
    const yaml_node_t *at = get(document, node);
    return at && at->type == YAML_SCALAR_NODE ? (const char *)at->data.scalar.value : NULL;
}

bool scene_document_is_null(scene_document *document, int node)
{
    const yaml_node_t *at = get(document, node);
    if (!at || at->type != YAML_SCALAR_NODE || at->data.scalar.style != YAML_PLAIN_SCALAR_STYLE)
        return false;
    const char *text = (const char *)at->data.scalar.value;
    return !*text || !strcmp(text, "~") || !strcmp(text, "null");
}

/* The pair of a key, or NULL. */
static yaml_node_pair_t *find_pair(const scene_document *document, int mapping, const char *key)
{
    yaml_node_t *at = get(document, mapping);
    if (!at || at->type != YAML_MAPPING_NODE)
        return NULL;
    for (yaml_node_pair_t *pair = at->data.mapping.pairs.start; pair < at->data.mapping.pairs.top; pair++) {
        const yaml_node_t *name = get(document, pair->key);
        if (name->type == YAML_SCALAR_NODE && !strcmp((const char *)name->data.scalar.value, key))
            return pair;
    }
    return NULL;
}

int scene_document_member(scene_document *document, int mapping, const char *key, int *key_node)
{
    const yaml_node_pair_t *pair = find_pair(document, mapping, key);
    if (key_node)
        *key_node = pair ? pair->key : 0;
    return pair ? pair->value : 0;
}

/* A list index; -1 if the step is not a number. */
static long list_index(const char *step)
{
    if (!*step || strlen(step) > 6 || strspn(step, "0123456789") != strlen(step))
        return -1;
    return strtol(step, NULL, 10);
}

/* Copies the first step of a path and advances the path past its dot. False if the step is empty or too long. */
static bool next_step(const char **path, char step[64])
{
    size_t length = strcspn(*path, ".");
    if (length == 0 || length >= 64)
        return false;
    memcpy(step, *path, length);
    step[length] = 0;
    *path += length + ((*path)[length] == '.');
    return true;
}

int scene_document_find(scene_document *document, const char *path)
{
    int node = 1;
    char step[64];
    while (node && *path) {
        if (!next_step(&path, step))
            return 0;
        const yaml_node_t *at = get(document, node);
        long index = list_index(step);
        if (at->type == YAML_SEQUENCE_NODE) {
            long count = at->data.sequence.items.top - at->data.sequence.items.start;
            node = index >= 0 && index < count ? at->data.sequence.items.start[index] : 0;
        } else {
            node = scene_document_member(document, node, step, NULL);
        }
    }
    return node;
}

/* ---- adding --------------------------------------------------------------------------------------------------- */

static int add_scalar(scene_document *document, const char *text, size_t length, yaml_scalar_style_t style)
{
    return yaml_document_add_scalar(&document->yaml, NULL, (const yaml_char_t *)text, (int)length, style);
}

/* Copies a tree and sets the mark of all its nodes; 0 if there is no memory. `from` may be the document itself. Adding
 * a node moves the others, so they are looked up again after each. */
static int copy_tree(scene_document *document, yaml_document_t *from, int node, const yaml_mark_t *mark)
{
    yaml_node_t source = *yaml_document_get_node(from, node);
    int copy = 0;
    bool ok = true;
    if (source.type == YAML_SCALAR_NODE) {
        copy = add_scalar(document, (const char *)source.data.scalar.value, source.data.scalar.length,
                          source.data.scalar.style);
    } else if (source.type == YAML_SEQUENCE_NODE) {
        copy = yaml_document_add_sequence(&document->yaml, NULL, source.data.sequence.style);
        for (yaml_node_item_t *item = source.data.sequence.items.start;
             ok && copy && item < source.data.sequence.items.top; item++) {
            int child = copy_tree(document, from, *item, mark);
            ok = child && yaml_document_append_sequence_item(&document->yaml, copy, child);
        }
    } else {
        copy = yaml_document_add_mapping(&document->yaml, NULL, source.data.mapping.style);
        for (yaml_node_pair_t *pair = source.data.mapping.pairs.start;
             ok && copy && pair < source.data.mapping.pairs.top; pair++) {
            int key = copy_tree(document, from, pair->key, mark);
            int value = key ? copy_tree(document, from, pair->value, mark) : 0;
            ok = value && yaml_document_append_mapping_pair(&document->yaml, copy, key, value);
        }
    }
    if (!copy || !ok)
        return 0;
    get(document, copy)->start_mark = *mark;
    return copy;
}

/* Parses a value and adds a copy. `problem` gets the error line. */
static int add_value(scene_document *document, const char *text, const yaml_mark_t *mark, char *problem, size_t room)
{
    scene_document value = {.error = problem, .error_size = room};
    yaml_parser_t parser;
    if (!yaml_parser_initialize(&parser)) {
        snprintf(problem, room, "no more memory");
        return 0;
    }
    yaml_parser_set_input_string(&parser, (const unsigned char *)text, strlen(text));
    bool ok = load_only_document(&value, &parser, text, strlen(text));
    yaml_parser_delete(&parser);
    if (!ok)
        return 0;
    int node = 0;
    if (!yaml_document_get_root_node(&value.yaml)) {
        node = add_scalar(document, "", 0, YAML_PLAIN_SCALAR_STYLE);
        if (node)
            get(document, node)->start_mark = *mark;
    } else if (refuse_aliases(&value)) {
        node = copy_tree(document, &value.yaml, 1, mark);
        if (!node)
            snprintf(problem, room, "no more memory");
    }
    yaml_document_delete(&value.yaml);
    return node;
}

static bool append_pair(scene_document *document, int mapping, const char *key, int value, const yaml_mark_t *mark)
{
    int name = add_scalar(document, key, strlen(key), YAML_PLAIN_SCALAR_STYLE);
    if (!name || !value)
        return false;
    get(document, name)->start_mark = *mark;
    return yaml_document_append_mapping_pair(&document->yaml, mapping, name, value);
}

/* Sets the value of a key. It replaces an empty value. */
static bool put_member(scene_document *document, int mapping, const char *key, int node, const yaml_mark_t *mark)
{
    yaml_node_pair_t *pair = find_pair(document, mapping, key);
    if (!pair)
        return append_pair(document, mapping, key, node, mark);
    pair->value = node;
    return true;
}

bool scene_document_add(scene_document *document, int mapping, const char *key, const char *value)
{
    char problem[160] = "no more memory";
    yaml_mark_t mark = get(document, mapping)->start_mark;
    int node = add_value(document, value, &mark, problem, sizeof problem);
    return (node && put_member(document, mapping, key, node, &mark)) ||
           scene_document_fail(document, mapping, "%s: %s", key, problem);
}

bool scene_document_add_copy(scene_document *document, int mapping, const char *key, const char *from)
{
    yaml_mark_t mark = get(document, mapping)->start_mark;
    int source = scene_document_find(document, from);
    int node = source ? copy_tree(document, &document->yaml, source, &mark) : 0;
    return (node && put_member(document, mapping, key, node, &mark)) ||
           scene_document_fail(document, mapping, "%s: cannot be taken from %s", key, from);
}

void scene_document_remove(scene_document *document, int mapping, const char *key)
{
    yaml_node_pair_t *pair = find_pair(document, mapping, key);
    if (!pair)
        return;
    yaml_node_t *at = get(document, mapping);
    memmove(pair, pair + 1, (size_t)(at->data.mapping.pairs.top - pair - 1) * sizeof *pair);
    at->data.mapping.pairs.top--;
}

/* ---- overrides ------------------------------------------------------------------------------------------------ */

/* The result of a step of an override's path: an existing node, or the slot for a new one. */
typedef struct slot {
    int parent;    /* mapping or list */
    int node;      /* the existing node, or 0 */
    char step[64]; /* key or index */
} slot;

static bool look_up(scene_document *document, size_t number, slot *at, size_t length_before)
{
    const char *text = document->overrides[number];
    const yaml_node_t *parent = get(document, at->parent);
    int shown = length_before ? (int)length_before - 1 : 0;
    if (parent->type == YAML_MAPPING_NODE) {
        at->node = scene_document_member(document, at->parent, at->step, NULL);
        return true;
    }
    if (parent->type == YAML_SCALAR_NODE)
        return fail_in_override(document, number, "%.*s: is a single value, it has no '%s'", shown, text, at->step);
    long index = list_index(at->step), count = parent->data.sequence.items.top - parent->data.sequence.items.start;
    if (index < 0 || index > count)
        return fail_in_override(document, number, "%.*s: has %ld entries, expected a number from 0 to %ld, got '%s'",
                                shown, text, count, count, at->step);
    at->node = index < count ? parent->data.sequence.items.start[index] : 0;
    return true;
}

/* Puts a node into a slot. */
static bool put(scene_document *document, const slot *at, int node, const yaml_mark_t *mark)
{
    yaml_node_t *parent = get(document, at->parent);
    if (parent->type == YAML_SEQUENCE_NODE) {
        if (at->node) {
            parent->data.sequence.items.start[list_index(at->step)] = node;
            return true;
        }
        return yaml_document_append_sequence_item(&document->yaml, at->parent, node);
    }
    yaml_node_pair_t *pair = find_pair(document, at->parent, at->step);
    if (!pair)
        return append_pair(document, at->parent, at->step, node, mark);
    pair->value = node;
    get(document, pair->key)->start_mark = *mark;
    return true;
}

/* Creates the list or mapping that the next step needs. */
static int make_room(scene_document *document, const slot *at, const char *next, const yaml_mark_t *mark)
{
    char step[64];
    bool list = next_step(&next, step) && list_index(step) >= 0;
    int node = list ? yaml_document_add_sequence(&document->yaml, NULL, YAML_ANY_SEQUENCE_STYLE)
                    : yaml_document_add_mapping(&document->yaml, NULL, YAML_ANY_MAPPING_STYLE);
    if (!node)
        return 0;
    get(document, node)->start_mark = *mark;
    return put(document, at, node, mark) ? node : 0;
}

static bool apply_override(scene_document *document, size_t number)
{
    const char *text = document->overrides[number], *equals = strchr(text, '=');
    char keys[256];
    size_t length = equals ? (size_t)(equals - text) : 0;
    if (length == 0 || length >= sizeof keys)
        return fail_in_override(document, number, "expected key=value, such as rain.rate_mm_h=50");
    memcpy(keys, text, length);
    keys[length] = 0;

    yaml_mark_t mark = {.index = OVERRIDE_MARK - number};
    char problem[200] = "no more memory";
    int value = add_value(document, equals + 1, &mark, problem, sizeof problem);
    if (!value)
        return fail_in_override(document, number, "%s", problem);

    slot at = {.parent = 1};
    const char *rest = keys;
    for (;;) {
        size_t before = (size_t)(rest - keys);
        if (!next_step(&rest, at.step) || (!*rest && keys[length - 1] == '.'))
            return fail_in_override(document, number, "expected keys with dots between, such as rain.rate_mm_h=50");
        if (!look_up(document, number, &at, before))
            return false;
        if (!*rest)
            return put(document, &at, value, &mark) || fail_in_override(document, number, "no more memory");
        bool there = at.node && !scene_document_is_null(document, at.node);
        at.parent = there ? at.node : make_room(document, &at, rest, &mark);
        if (!at.parent)
            return fail_in_override(document, number, "no more memory");
    }
}

bool scene_document_override(scene_document *document, const char *const *overrides, size_t count)
{
    document->overrides = overrides;
    if (count > MAX_OVERRIDES)
        return scene_document_fail(document, 0, "more than %d overrides", MAX_OVERRIDES);
    for (size_t i = 0; i < count; i++)
        if (!apply_override(document, i))
            return false;
    return true;
}
