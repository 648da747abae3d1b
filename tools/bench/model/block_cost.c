/* block_cost.c - see block_cost.h. */
#include "bench/model/block_cost.h"

#include "bench/model/spirv_words.h"

#include <stdlib.h>
#include <string.h>

/* What is known of an id. */
typedef struct id_facts {
    uint32_t opcode;       /* of a type or variable */
    uint32_t of;           /* type: of components, elements, or what it points to; value: its type */
    uint32_t count;        /* type: components, columns, elements; integers: bytes */
    uint32_t bytes;        /* type: size */
    uint32_t value;        /* constant: its first word */
    uint32_t storage;      /* pointers and variables: storage class */
    uint32_t set, binding; /* variables */
    uint32_t built_in;     /* variables: 1 + the number */
    uint32_t resource;     /* pointers and images: 1 + index */
    uint32_t block;        /* labels: 1 + index */
    bool own;              /* differs between the lanes of a wave */
    bool constant;         /* with a value that is known here */
    bool known;  /* to the driver when it compiles: constants, those of pipelines, and what follows from them */
    bool used;   /* atomics: an instruction takes the result */
    bool loaded; /* pointers: a load of what is the same for all lanes was counted */
    bool exact;  /* a product or sum that may not be fused with another */
    const block_cost *product_of; /* a product that can be fused: the block that it is in */
} id_facts;

typedef struct reader {
    id_facts *ids;
    uint32_t bound;
    block_costs *costs;
    block_cost *block; /* NULL before the first */
} reader;

static const id_facts *type_of(const reader *r, uint32_t id)
{
    return &r->ids[r->ids[id].of];
}

static float components(const reader *r, uint32_t type)
{
    const id_facts *t = &r->ids[type];
    if (t->opcode == OP_TYPE_MATRIX)
        return (float)t->count * (float)r->ids[t->of].count;
    return t->opcode == OP_TYPE_VECTOR ? (float)t->count : 1;
}

/* ---- types, decorations and variables */

static void read_struct(reader *r, const uint32_t *at, uint32_t length)
{
    id_facts *t = &r->ids[at[1]];
    for (uint32_t i = 2; i < length; i++)
        t->bytes += r->ids[at[i]].bytes;
}

static void read_type(reader *r, const uint32_t *at, uint32_t length)
{
    id_facts *t = &r->ids[at[1]];
    t->opcode = at[0] & 0xffff;
    switch (t->opcode) {
    case OP_TYPE_BOOL: t->bytes = 4; break;
    case OP_TYPE_INT:
    case OP_TYPE_FLOAT: t->bytes = at[2] / 8; break;
    case OP_TYPE_VECTOR:
    case OP_TYPE_MATRIX:
    case OP_TYPE_ARRAY:
        t->of = at[2];
        t->count = t->opcode == OP_TYPE_ARRAY ? r->ids[at[3]].value : at[3];
        t->bytes = t->count * r->ids[at[2]].bytes;
        break;
    case OP_TYPE_RUNTIME_ARRAY:
        t->of = at[2];
        t->bytes = r->ids[at[2]].bytes;
        break;
    case OP_TYPE_IMAGE:
        t->count = at[3]; /* Dim */
        break;
    case OP_TYPE_STRUCT: read_struct(r, at, length); break;
    case OP_TYPE_POINTER:
        t->storage = at[2];
        t->of = at[3];
        break;
    default: break;
    }
}

static void decorate(reader *r, const uint32_t *at)
{
    id_facts *id = &r->ids[at[1]];
    if (at[2] == DECORATION_NO_CONTRACTION)
        id->exact = true;
    else if (at[2] == DECORATION_SET)
        id->set = at[3];
    else if (at[2] == DECORATION_BINDING)
        id->binding = at[3];
    else if (at[2] == DECORATION_BUILT_IN)
        id->built_in = 1 + at[3];
}

static uint32_t find_resource(block_costs *costs, uint32_t set, uint32_t binding)
{
    for (uint32_t i = 0; i < costs->resource_count; i++)
        if (costs->resources[i].set == set && costs->resources[i].binding == binding)
            return 1 + i;
    if (costs->resource_count == BLOCK_RESOURCES)
        return BLOCK_RESOURCES;
    costs->resources[costs->resource_count] = (block_resource){set, binding};
    return ++costs->resource_count;
}

static void read_variable(reader *r, const uint32_t *at)
{
    id_facts *v = &r->ids[at[2]];
    v->opcode = OP_VARIABLE;
    v->of = at[1];
    v->storage = at[3];
    const uint32_t built_in = v->built_in - 1;
    /* Inputs differ from lane to lane, except these; what a lane keeps for itself may. */
    v->own = v->storage == CLASS_INPUT &&
             !(v->built_in && built_in >= BUILT_IN_WORKGROUP_COUNT && built_in <= BUILT_IN_WORKGROUP_ID);
    v->own = v->own || v->storage == CLASS_FUNCTION || v->storage == CLASS_PRIVATE || v->storage == CLASS_WORKGROUP;
    if (v->storage == CLASS_STORAGE_BUFFER || v->storage == CLASS_UNIFORM_CONSTANT)
        v->resource = find_resource(r->costs, v->set, v->binding);
}

/* ---- costs of instructions */

/* Of GLSL.std.450, for each component of the result: issues of full and of a quarter of the rate. `taken` is the number
 * of components of an operand. As compilers for GPUs expand them: e.g. a power is log2, multiply, exp2. */
static void cost_of_function(block_cost *b, uint32_t function, float n, float taken)
{
    enum { ABS = 4, FSIGN = 6, SSIGN, SIN = 13, COS, TAN, ASIN, ACOS, ATAN, SINH, COSH, TANH, ASINH, ACOSH, ATANH };
    enum { ATAN2 = 25, POW, EXP, LOG, EXP2, LOG2, SQRT, RSQRT, MIX = 46, SMOOTH = 49, LENGTH = 66, DISTANCE, CROSS };
    enum { NORMALIZE = 69, FACE, REFLECT, REFRACT };
    float full = n, slow = 0;
    if (function == ABS)
        full = 0; /* a modifier */
    else if (function == FSIGN || function == SSIGN || function == MIX)
        full = 2 * n;
    else if (function == SIN || function == COS || function == EXP || function == LOG)
        full = n, slow = n;
    else if (function == TAN)
        full = 2 * n, slow = 3 * n;
    else if (function >= ASIN && function <= ATAN2)
        full = 20 * n, slow = 2 * n;
    else if (function == POW)
        full = n, slow = 2 * n;
    else if (function >= EXP2 && function <= RSQRT)
        full = 0, slow = n;
    else if (function == SMOOTH)
        full = 6 * n, slow = n;
    else if (function == LENGTH || function == DISTANCE)
        full = (function == DISTANCE ? 2 : 1) * taken, slow = 1;
    else if (function == CROSS)
        full = 6;
    else if (function == NORMALIZE)
        full = 2 * n, slow = 1;
    else if (function == REFLECT)
        full = 2 * n + 1;
    else if (function == REFRACT)
        full = 3 * n + 6, slow = 1;
    b->full += full;
    b->slow += slow;
}

/* A sum or difference of a product of the same block is fused with it, as compilers for GPUs do: one operation, which
 * the product has counted. Once for each product; for another sum it is computed again. */
static bool is_fused(reader *r, const uint32_t *at)
{
    for (int i = 3; i < 5 && !r->ids[at[2]].exact; i++)
        if (r->ids[at[i]].product_of == r->block) {
            r->ids[at[i]].product_of = NULL;
            return true;
        }
    return false;
}

static bool is_power_of_two(uint32_t value)
{
    return value && !(value & (value - 1));
}

/* Integers over integers. By a constant it is a shift or a mask, or else a multiplication that gives the high word, and
 * a shift; a remainder then is what the product of that and the constant leaves. Numbers with signs are rounded to 0,
 * which takes two more. */
static void cost_of_division(reader *r, const uint32_t *at, uint32_t op, float n)
{
    block_cost *b = r->block;
    const id_facts *by = &r->ids[at[4]];
    const bool divides = op == OP_U_DIV || op == OP_S_DIV, has_sign = op != OP_U_DIV && op != OP_U_MOD;
    if (!by->constant) {
        b->full += 12 * n;
        b->slow += 5 * n;
        return;
    }
    const bool shifts = is_power_of_two(by->value);
    b->full += (1 + (has_sign ? 2 : 0) + (divides || shifts ? 0 : 1)) * n;
    b->slow += shifts ? 0 : divides ? n : 2 * n;
}

static void cost_of_product(reader *r, const uint32_t *at, float n)
{
    for (int i = 3; i < 5; i++)
        if (r->ids[at[i]].constant && is_power_of_two(r->ids[at[i]].value)) { /* a shift */
            r->block->full += n;
            return;
        }
    r->block->slow += n;
}

static void cost_of_arithmetic(reader *r, const uint32_t *at, uint32_t op, float n)
{
    block_cost *b = r->block;
    const float taken = components(r, r->ids[at[3]].of);
    switch (op) {
    case OP_I_MUL: cost_of_product(r, at, n); break;
    case OP_F_MUL:
    case OP_VECTOR_TIMES_SCALAR:
        b->full += n;
        r->ids[at[2]].product_of = r->ids[at[2]].exact ? NULL : b;
        break;
    case OP_F_ADD:
    case OP_F_SUB: b->full += is_fused(r, at) ? 0 : n; break;
    case OP_F_DIV: /* times the reciprocal, which is known of a constant */
        b->full += n;
        b->slow += r->ids[at[4]].constant ? 0 : n;
        break;
    case OP_F_REM:
    case OP_F_MOD:
        b->full += 3 * n;
        b->slow += n;
        break;
    case OP_U_DIV:
    case OP_S_DIV:
    case OP_U_MOD:
    case OP_S_REM:
    case OP_S_MOD: cost_of_division(r, at, op, n); break;
    case OP_VECTOR_TIMES_MATRIX:
    case OP_MATRIX_TIMES_VECTOR: b->full += n * (taken > n ? taken / n : taken); break;
    case OP_MATRIX_TIMES_MATRIX: b->full += 4 * n; break;
    case OP_DOT: b->full += taken; break;
    default: b->full += op >= OP_ARITHMETIC_FIRST + 2 ? n : 0; /* a negation is a modifier */
    }
}

static void touch(block_cost *b, uint32_t resource, float bytes, bool written)
{
    if (resource)
        (written ? b->bytes_written : b->bytes_read)[resource - 1] += bytes;
}

static void cost_of_access(reader *r, uint32_t pointer, float bytes, bool written)
{
    block_cost *b = r->block;
    id_facts *p = &r->ids[pointer];
    const float words = bytes / 16 > 1 ? bytes / 16 : 1; /* one instruction moves four words */
    switch (p->storage) {
    case CLASS_STORAGE_BUFFER:
        if (p->own || written) {
            b->memory += words;
            touch(b, p->resource, bytes, written);
        } else { /* compilers keep what they have loaded, as these are mostly settings */
            b->uniform += p->loaded ? 0 : 1;
            p->loaded = true;
        }
        b->waits = b->waits || !written;
        break;
    case CLASS_UNIFORM:
        *(p->own ? &b->memory : &b->constant) += p->own ? words : p->loaded ? 0 : 1;
        p->loaded = true;
        break;
    case CLASS_WORKGROUP: b->shared += words; break;
    default: /* registers */ break;
    }
}

/* Bytes of a texel are not in the module: a format of four halves or one float each is usual here. */
#define TEXEL_BYTES 8

static void cost_of_texels(reader *r, const uint32_t *at, uint32_t op)
{
    block_cost *b = r->block;
    const bool writes = op == OP_IMAGE_WRITE;
    const id_facts *image = &r->ids[at[writes ? 1 : 3]];
    const id_facts *coordinate = &r->ids[at[writes ? 2 : 4]];
    const id_facts *type = &r->ids[image->of];
    if (type->opcode == OP_TYPE_SAMPLED_IMAGE)
        type = &r->ids[type->of];
    const bool of_buffer = type->count == IMAGE_BUFFER;
    const float bytes = of_buffer ? 16 : op == OP_IMAGE_GATHER ? 4 * TEXEL_BYTES : TEXEL_BYTES;
    b->waits = b->waits || !writes;
    if (!coordinate->own && !writes) {
        b->uniform += 1;
        return;
    }
    if (of_buffer)
        b->memory += 1;
    else if ((op >= OP_IMAGE_SAMPLE_FIRST && op <= OP_IMAGE_SAMPLE_LAST) || op == OP_IMAGE_GATHER)
        b->sample += 1;
    else
        b->fetch += 1;
    touch(b, image->resource, bytes, writes);
}

/* An atomic whose result nobody takes returns nothing, and the wave goes on: AMD's "RDNA 2 Instruction Set
 * Architecture" (2020), GLC bit of global and buffer atomics; from memory. */
static void cost_of_atomic(reader *r, const uint32_t *at)
{
    const bool is_store = (at[0] & 0xffff) == OP_ATOMIC_STORE; /* has no result */
    const id_facts *p = &r->ids[at[is_store ? 1 : 3]];
    if (p->storage == CLASS_WORKGROUP) {
        r->block->shared += 1;
        return;
    }
    r->block->atomic += 1;
    r->block->waits = r->block->waits || (!is_store && r->ids[at[2]].used);
    touch(r->block, p->resource, 4, true);
}

/* ---- what instructions give: pointers, images, and whether lanes differ */

/* Operands are ids up to here; what follows are numbers that would be taken for ids. */
static uint32_t end_of_ids(uint32_t op, uint32_t length)
{
    enum { SHUFFLE = 79, EXTRACT = 81, INSERT = 82 };
    const uint32_t end = op == EXTRACT || op == OP_LOAD ? 4 : op == SHUFFLE || op == INSERT ? 5 : length;
    const bool of_image = op >= OP_IMAGE_SAMPLE_FIRST && op <= OP_IMAGE_READ;
    return of_image && length > 5 ? 5 : end < length ? end : length;
}

static bool any_own(const reader *r, const uint32_t *at, uint32_t length, uint32_t op)
{
    const uint32_t end = end_of_ids(op, length);
    for (uint32_t i = op == OP_EXT_INST ? 5 : 3; i < end; i++)
        if (at[i] < r->bound && r->ids[at[i]].own)
            return true;
    return false;
}

/* Whether an instruction computes with what is known alone. */
static bool all_known(const reader *r, const uint32_t *at, uint32_t length, uint32_t op)
{
    const bool computes = (op >= OP_CONVERT_FIRST && op <= OP_ARITHMETIC_LAST) ||
                          (op >= OP_LOGICAL_FIRST && op <= OP_LOGICAL_LAST) ||
                          (op >= OP_BIT_FIRST && op <= OP_BIT_LAST);
    for (uint32_t i = 3; computes && i < length; i++)
        if (!r->ids[at[i]].known)
            return false;
    return computes;
}

static void read_result(reader *r, const uint32_t *at, uint32_t length, uint32_t op)
{
    id_facts *result = &r->ids[at[2]];
    result->of = at[1];
    bool own = any_own(r, at, length, op);
    if (op == OP_ACCESS_CHAIN || op == OP_IN_BOUNDS_ACCESS_CHAIN || op == OP_IMAGE_TEXEL_POINTER) {
        result->storage = op == OP_IMAGE_TEXEL_POINTER ? CLASS_STORAGE_BUFFER : type_of(r, at[2])->storage;
        result->resource = r->ids[at[3]].resource;
    } else if (op == OP_LOAD || op == OP_IMAGE || op == 86) { /* OpSampledImage */
        result->resource = r->ids[at[3]].resource;
    } else if (op >= OP_ATOMIC_FIRST && op <= OP_ATOMIC_LAST) {
        own = true;
    } else if (op >= OP_SUBGROUP_FIRST && op <= OP_SUBGROUP_LAST) {
        own = op >= OP_SUBGROUP_REDUCE && length > 5 ? at[4] != 0 : own; /* a reduction is the same in all lanes */
    }
    result->own = result->own || own;
    result->known = all_known(r, at, length, op);
}

/* True for instructions in functions with a type and a result. */
static bool has_result(uint32_t op)
{
    return !(op == OP_STORE || op == 63 || op == 64 || op == OP_IMAGE_WRITE || op == OP_ATOMIC_STORE ||
             op == OP_LABEL || op == 8 || op == 317 || op == 0 || op == OP_LOOP_MERGE || op == OP_SELECTION_MERGE ||
             op == OP_BRANCH || op == OP_BRANCH_CONDITIONAL || op == OP_SWITCH || op == 56 ||
             (op >= OP_KILL && op <= OP_UNREACHABLE) || op == OP_CONTROL_BARRIER || op == 225);
}

static void read_cost(reader *r, const uint32_t *at, uint32_t length, uint32_t op)
{
    block_cost *b = r->block;
    const float n = has_result(op) ? components(r, at[1]) : 1;
    if (op == OP_EXT_INST)
        cost_of_function(b, at[4], n, length > 5 ? components(r, r->ids[at[5]].of) : 1);
    else if (op >= OP_ARITHMETIC_FIRST && op <= OP_ARITHMETIC_LAST)
        cost_of_arithmetic(r, at, op, n);
    else if (op == OP_LOAD && type_of(r, at[2])->opcode != OP_TYPE_IMAGE &&
             type_of(r, at[2])->opcode != OP_TYPE_SAMPLED_IMAGE)
        cost_of_access(r, at[3], (float)r->ids[at[1]].bytes, false);
    else if (op == OP_STORE)
        cost_of_access(r, at[1], (float)type_of(r, at[2])->bytes, true);
    else if ((op >= OP_IMAGE_SAMPLE_FIRST && op <= OP_IMAGE_GATHER) || op == OP_IMAGE_READ || op == OP_IMAGE_WRITE)
        cost_of_texels(r, at, op);
    else if (op >= OP_ATOMIC_FIRST && op <= OP_ATOMIC_LAST)
        cost_of_atomic(r, at);
    else if (op >= OP_SUBGROUP_REDUCE && op <= OP_SUBGROUP_LAST)
        b->full += 8 * n; /* log2 of a wave, twice */
    else if (op >= OP_SUBGROUP_SHUFFLE && op < OP_SUBGROUP_REDUCE)
        b->shared += n;
    else if ((op >= OP_CONVERT_FIRST && op <= OP_CONVERT_LAST) || (op >= OP_LOGICAL_FIRST && op <= OP_LOGICAL_LAST) ||
             (op >= OP_BIT_FIRST && op <= OP_BIT_LAST) || (op >= OP_SUBGROUP_FIRST && op < OP_SUBGROUP_SHUFFLE))
        b->full += n;
    else if (op == OP_VECTOR_EXTRACT_DYNAMIC)
        b->full += 4;
    else if (op == OP_BRANCH_CONDITIONAL || op == OP_SWITCH)
        b->branch += r->ids[at[1]].known ? 0 : 1; /* compilers leave out the side that is not taken */
    else if (op == OP_CONTROL_BARRIER)
        b->barrier += 1;
}

/* ---- blocks that run equally often */

/* Whether all blocks between a header and its merge block lead to each other or to the merge block, and nowhere else:
 * then whoever runs the header runs the merge block. `from` is the header's label. */
static bool all_end_in(const reader *r, const uint32_t *from, const uint32_t *end, uint32_t header, uint32_t merge)
{
    uint32_t block = header;
    for (const uint32_t *at = from + 2; at < end && block < merge; at += at[0] >> 16) {
        const uint32_t op = at[0] & 0xffff, length = at[0] >> 16;
        if (op == OP_LABEL)
            block = r->ids[at[1]].block - 1;
        if (op >= OP_KILL && op <= OP_UNREACHABLE)
            return false;
        const bool branches = op == OP_BRANCH || op == OP_BRANCH_CONDITIONAL || op == OP_SWITCH;
        for (uint32_t i = 1; branches && i < length && block < merge; i++) {
            const uint32_t to = at[i] < r->bound ? r->ids[at[i]].block : 0; /* 0: a condition or a number */
            if (to && (to - 1 <= header || to - 1 > merge))
                return false;
        }
    }
    return true;
}

static void find_equals(reader *r, const uint32_t *code, size_t word_count, size_t first)
{
    const uint32_t *header = NULL;
    uint32_t block = 0;
    for (uint32_t i = 0; i < r->costs->block_count; i++)
        r->costs->blocks[i].runs_as = i;
    for (size_t i = first; i < word_count; i += code[i] >> 16)
        if ((code[i] & 0xffff) == OP_LABEL)
            r->ids[code[i + 1]].block = ++block;
    for (size_t i = first; i < word_count; i += code[i] >> 16) {
        const uint32_t op = code[i] & 0xffff;
        if (op == OP_LABEL)
            header = code + i;
        if (op != OP_SELECTION_MERGE || !header)
            continue;
        const uint32_t from = r->ids[header[1]].block - 1, to = r->ids[code[i + 1]].block - 1;
        if (all_end_in(r, header, code + word_count, from, to))
            r->costs->blocks[to].runs_as = r->costs->blocks[from].runs_as;
    }
}

/* ---- the module */

static void read_global(reader *r, const uint32_t *at, uint32_t length)
{
    const uint32_t op = at[0] & 0xffff;
    if (op == OP_ENTRY_POINT)
        r->costs->stage = at[1];
    else if (op == OP_EXECUTION_MODE && at[2] == MODE_LOCAL_SIZE)
        memcpy(r->costs->local_size, at + 3, sizeof r->costs->local_size);
    else if (op == OP_DECORATE && (length > 3 || at[2] == DECORATION_NO_CONTRACTION))
        decorate(r, at);
    else if (op >= OP_TYPE_VOID && op <= OP_TYPE_POINTER)
        read_type(r, at, length);
    else if (op == OP_VARIABLE)
        read_variable(r, at);
    else if (op >= 41 && op <= OP_SPEC_CONSTANT_OP) { /* constants: a type, a result, and a value */
        id_facts *constant = &r->ids[at[2]];
        constant->of = at[1];
        constant->value = length > 3 ? at[3] : 0;
        constant->constant = op != OP_SPEC_CONSTANT_OP;
        constant->known = true;
        if (op == OP_CONSTANT_COMPOSITE) /* its components are nearly always alike */
            constant->value = r->ids[at[3]].value;
    }
}

/* Which ids instructions take. A number that is no id may be taken for one: then an atomic waits that need not. */
static void find_used(reader *r, const uint32_t *code, size_t word_count, size_t first)
{
    for (size_t i = first; i < word_count; i += code[i] >> 16) {
        const uint32_t op = code[i] & 0xffff, length = code[i] >> 16;
        for (uint32_t k = 1; k < length; k++)
            if (code[i + k] < r->bound && !(k == 2 && has_result(op)))
                r->ids[code[i + k]].used = true;
    }
}

/* One pass over the functions. With `counting`, costs are added; before, only what differs between lanes is found. */
static void read_functions(reader *r, const uint32_t *code, size_t word_count, size_t first, bool counting)
{
    uint32_t block = 0;
    r->block = NULL;
    for (size_t i = first; i < word_count; i += code[i] >> 16) {
        const uint32_t *at = code + i, op = at[0] & 0xffff, length = at[0] >> 16;
        if (op == OP_LABEL)
            r->block = &r->costs->blocks[block++];
        else if (op == OP_VARIABLE)
            read_variable(r, at);
        else if (r->block && has_result(op))
            read_result(r, at, length, op);
        if (r->block && counting && op != OP_LABEL && op != OP_VARIABLE)
            read_cost(r, at, length, op);
    }
}

bool block_costs_read(const uint32_t *code, size_t word_count, block_costs *costs)
{
    reader r = {.bound = code[SPIRV_BOUND], .costs = costs};
    size_t first = 0;
    *costs = (block_costs){.local_size = {1, 1, 1}};
    r.ids = calloc(r.bound, sizeof *r.ids);
    for (size_t i = SPIRV_HEADER_WORDS; i < word_count; i += code[i] >> 16)
        costs->block_count += (code[i] & 0xffff) == OP_LABEL;
    costs->blocks = calloc(costs->block_count + 1, sizeof *costs->blocks);
    if (!r.ids || !costs->blocks) {
        free(r.ids);
        block_costs_free(costs);
        return false;
    }
    for (size_t i = SPIRV_HEADER_WORDS; i < word_count && !first; i += code[i] >> 16)
        if ((code[i] & 0xffff) == OP_FUNCTION)
            first = i;
        else
            read_global(&r, code + i, code[i] >> 16);
    /* Loops carry values back: three passes are enough for what they carry here, and more would change nothing else. */
    for (int pass = 0; pass < 3; pass++)
        read_functions(&r, code, word_count, first, false);
    find_used(&r, code, word_count, first);
    read_functions(&r, code, word_count, first, true);
    find_equals(&r, code, word_count, first);
    free(r.ids);
    return true;
}

void block_costs_free(block_costs *costs)
{
    free(costs->blocks);
    *costs = (block_costs){0};
}

bool block_costs_anything(const block_costs *costs, uint32_t block)
{
    for (uint32_t i = block; i < costs->block_count; i++) {
        const block_cost *b = &costs->blocks[i];
        const float sum = b->full + b->slow + b->memory + b->shared + b->fetch + b->sample + b->atomic + b->uniform +
                          b->constant + b->branch + b->barrier;
        if (b->runs_as == block && sum > 0)
            return true;
    }
    return false;
}
