/* spirv_count.c - see spirv_count.h. */
#include "bench/model/spirv_count.h"

#include "bench/model/spirv_words.h"

#include <stdlib.h>
#include <string.h>

#define WORDS_OF_BLOCK  64  /* that a block grows by, at most */
#define WORDS_OF_MODULE 128 /* that the rest grows by, at most */

/* New ids, and those of the module that are used again: a number type may be declared only once. */
typedef struct count_ids {
    uint32_t next;
    uint32_t uint_type, bool_type, uint4_type, array_type, struct_type, struct_pointer, number_pointer, buffer;
    uint32_t zero, one, eight, subgroup, always;
} count_ids;

typedef struct writer {
    const spirv_count_def *def;
    uint32_t *to;
    size_t count;
    count_ids ids;
    bool has_uint, has_bool, has_uint4, has_groups, has_ballots, kills_fragments;
    uint32_t block, stage, entry;
} writer;

static void put(writer *w, const uint32_t *words, uint32_t count)
{
    memcpy(w->to + w->count, words, count * sizeof *words);
    w->count += count;
}

#define PUT(w, op, ...)                                               \
    do {                                                              \
        const uint32_t words_[] = {0, __VA_ARGS__};                   \
        const uint32_t count_ = sizeof words_ / sizeof words_[0];     \
        put((w), words_, count_);                                     \
        (w)->to[(w)->count - count_] = count_ << 16 | (uint32_t)(op); \
    } while (0)

static void look_around(writer *w)
{
    const spirv_count_def *def = w->def;
    w->ids.next = def->code[SPIRV_BOUND];
    for (size_t i = SPIRV_HEADER_WORDS; i < def->word_count; i += def->code[i] >> 16) {
        const uint32_t *at = def->code + i, op = at[0] & 0xffff;
        if (op == OP_TYPE_INT && at[2] == 32 && !at[3])
            w->ids.uint_type = at[1], w->has_uint = true;
        else if (op == OP_TYPE_BOOL)
            w->ids.bool_type = at[1], w->has_bool = true;
        else if (op == OP_TYPE_VECTOR && w->has_uint && at[2] == w->ids.uint_type && at[3] == 4)
            w->ids.uint4_type = at[1], w->has_uint4 = true;
        else if (op == OP_CAPABILITY && at[1] == CAPABILITY_GROUP_NON_UNIFORM)
            w->has_groups = true;
        else if (op == OP_CAPABILITY && at[1] == CAPABILITY_BALLOT)
            w->has_ballots = true;
        else if (op == OP_ENTRY_POINT)
            w->stage = at[1], w->entry = at[2];
        else if (op == 252 || op == 4416 || (op == OP_EXECUTION_MODE && at[2] == MODE_DEPTH_REPLACING))
            w->kills_fragments = true; /* OpKill, OpTerminateInvocation */
    }
    uint32_t *made[] = {
        &w->ids.array_type, &w->ids.struct_type, &w->ids.struct_pointer, &w->ids.number_pointer, &w->ids.buffer,
        &w->ids.zero,       &w->ids.one,         &w->ids.eight,          &w->ids.subgroup,       &w->ids.always};
    for (size_t i = 0; i < sizeof made / sizeof made[0]; i++)
        *made[i] = w->ids.next++;
    w->ids.uint_type = w->has_uint ? w->ids.uint_type : w->ids.next++;
    w->ids.uint4_type = w->has_uint4 ? w->ids.uint4_type : w->ids.next++;
    w->ids.bool_type = w->has_bool ? w->ids.bool_type : w->ids.next++;
}

static void put_decorations(writer *w)
{
    const count_ids *ids = &w->ids;
    PUT(w, OP_DECORATE, ids->array_type, DECORATION_ARRAY_STRIDE, 4);
    PUT(w, OP_DECORATE, ids->struct_type, DECORATION_BLOCK);
    PUT(w, OP_MEMBER_DECORATE, ids->struct_type, 0, DECORATION_OFFSET, 0);
    PUT(w, OP_DECORATE, ids->buffer, DECORATION_SET, w->def->set);
    PUT(w, OP_DECORATE, ids->buffer, DECORATION_BINDING, 0);
}

/* Before the first function: all that it needs of the module is declared. */
static void put_declarations(writer *w)
{
    const count_ids *ids = &w->ids;
    if (!w->has_uint)
        PUT(w, OP_TYPE_INT, ids->uint_type, 32, 0);
    if (!w->has_bool)
        PUT(w, OP_TYPE_BOOL, ids->bool_type);
    if (!w->has_uint4)
        PUT(w, OP_TYPE_VECTOR, ids->uint4_type, ids->uint_type, 4);
    PUT(w, OP_TYPE_RUNTIME_ARRAY, ids->array_type, ids->uint_type);
    PUT(w, OP_TYPE_STRUCT, ids->struct_type, ids->array_type);
    PUT(w, OP_TYPE_POINTER, ids->struct_pointer, CLASS_STORAGE_BUFFER, ids->struct_type);
    PUT(w, OP_TYPE_POINTER, ids->number_pointer, CLASS_STORAGE_BUFFER, ids->uint_type);
    PUT(w, OP_VARIABLE, ids->struct_pointer, ids->buffer, CLASS_STORAGE_BUFFER);
    PUT(w, OP_CONSTANT, ids->uint_type, ids->zero, 0);
    PUT(w, OP_CONSTANT, ids->uint_type, ids->one, 1);
    PUT(w, OP_CONSTANT, ids->uint_type, ids->eight, 8);
    PUT(w, OP_CONSTANT, ids->uint_type, ids->subgroup, SCOPE_SUBGROUP);
    PUT(w, OP_CONSTANT_TRUE, ids->bool_type, ids->always);
    /* The places of the numbers: one constant each. */
    uint32_t blocks = 0;
    for (size_t i = SPIRV_HEADER_WORDS; i < w->def->word_count; i += w->def->code[i] >> 16)
        blocks += (w->def->code[i] & 0xffff) == OP_LABEL;
    for (uint32_t i = 0; i < 2 * blocks; i++)
        PUT(w, OP_CONSTANT, ids->uint_type, ids->next + i, w->def->first + i);
}

static void put_sum(writer *w, uint32_t place, uint32_t term)
{
    count_ids *ids = &w->ids;
    const uint32_t pointer = ids->next++, before = ids->next++, after = ids->next++;
    PUT(w, OP_ACCESS_CHAIN, ids->number_pointer, pointer, ids->buffer, ids->zero, place);
    PUT(w, OP_LOAD, ids->uint_type, before, pointer, VOLATILE);
    PUT(w, OP_I_ADD, ids->uint_type, after, before, term);
    PUT(w, OP_STORE, pointer, after, VOLATILE);
}

static void put_count(writer *w, uint32_t places)
{
    count_ids *ids = &w->ids;
    const uint32_t place = places + 2 * w->block++;
    const block_costs *costs = w->def->costs;
    if (costs->blocks[w->block - 1].runs_as != w->block - 1 ||
        (w->block > 1 && !block_costs_anything(costs, w->block - 1)))
        return;
    uint32_t lanes = ids->eight;
    if (w->stage != STAGE_VERTEX) {
        const uint32_t ballot = ids->next++;
        lanes = ids->next++;
        PUT(w, OP_SUBGROUP_BALLOT, ids->uint4_type, ballot, ids->subgroup, ids->always);
        PUT(w, OP_SUBGROUP_BALLOT_COUNT, ids->uint_type, lanes, ids->subgroup, REDUCE, ballot);
    }
    put_sum(w, place, lanes);
    put_sum(w, place + 1, ids->one);
}

/* The head of the module, in the order that SPIR-V asks for. */
static void put_global(writer *w, const uint32_t *at, uint32_t length)
{
    const uint32_t op = at[0] & 0xffff;
    put(w, at, length);
    if (op == OP_CAPABILITY && at[1] == CAPABILITY_SHADER && !w->has_groups)
        PUT(w, OP_CAPABILITY, CAPABILITY_GROUP_NON_UNIFORM);
    if (op == OP_CAPABILITY && at[1] == CAPABILITY_SHADER && !w->has_ballots)
        PUT(w, OP_CAPABILITY, CAPABILITY_BALLOT);
    if (op == OP_ENTRY_POINT) {
        w->to[w->count - length] += 1 << 16;
        w->to[w->count++] = w->ids.buffer;
        /* A shader that writes to memory is tested for depth after it ran. One that can not change its depth may be
         * tested before, as it would be without the counting. */
        if (w->stage == STAGE_FRAGMENT && !w->kills_fragments)
            PUT(w, OP_EXECUTION_MODE, w->entry, MODE_EARLY_FRAGMENT_TESTS);
    }
}

static void put_functions(writer *w, size_t first, uint32_t places)
{
    const spirv_count_def *def = w->def;
    bool due = false; /* a block has begun, and its phis and variables come first */
    for (size_t i = first; i < def->word_count; i += def->code[i] >> 16) {
        const uint32_t *at = def->code + i, op = at[0] & 0xffff;
        enum { LINE = 8, NO_LINE = 317 };
        if (due && op != OP_PHI && op != OP_VARIABLE && op != LINE && op != NO_LINE) {
            put_count(w, places);
            due = false;
        }
        put(w, at, at[0] >> 16);
        due = due || op == OP_LABEL;
    }
}

static bool is_annotation_or_before(uint32_t op)
{
    return op < OP_TYPE_VOID || op == OP_DECORATE || op == OP_MEMBER_DECORATE || (op >= 330 && op <= 332);
}

uint32_t *spirv_count_blocks(const spirv_count_def *def, size_t *word_count)
{
    writer w = {.def = def};
    size_t blocks = 0, at = SPIRV_HEADER_WORDS;
    for (size_t i = at; i < def->word_count; i += def->code[i] >> 16)
        blocks += (def->code[i] & 0xffff) == OP_LABEL;
    w.to = malloc((def->word_count + blocks * WORDS_OF_BLOCK + WORDS_OF_MODULE) * sizeof *w.to);
    if (!w.to)
        return NULL;
    look_around(&w);
    put(&w, def->code, SPIRV_HEADER_WORDS);
    for (; is_annotation_or_before(def->code[at] & 0xffff); at += def->code[at] >> 16)
        put_global(&w, def->code + at, def->code[at] >> 16);
    put_decorations(&w);
    for (; (def->code[at] & 0xffff) != OP_FUNCTION; at += def->code[at] >> 16)
        put(&w, def->code + at, def->code[at] >> 16);
    const uint32_t places = w.ids.next;
    put_declarations(&w);
    w.ids.next += 2 * (uint32_t)blocks;
    put_functions(&w, at, places);
    w.to[SPIRV_BOUND] = w.ids.next;
    *word_count = w.count;
    return w.to;
}
