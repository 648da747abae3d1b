/* calls.h - random calls of every public function: what the files of fuzz_calls share.
 *
 *   fuzz_calls.c         the program: sequences of calls, from the table of all public functions
 *   calls_world.c        random numbers, handles, frames, and what must be true after each call
 *   calls_structs.c      random structs
 *   calls_context.c      the calls of base.h, drops.h, vulkan.h
 *   calls_effects.c      the calls that all effects have
 *   calls_rain.c ...     the other calls of an effect
 *   calls_stand_in.c     the device of the sequences: a stand-in that needs no driver ...
 *   calls_lavapipe.c     ... or software Vulkan with validation, for which handles and sizes must be true
 *
 * For each public function there is a `void call_NAME(calls *c)`, which calls it once with random arguments. */
#ifndef VIRGA_TESTS_FUZZ_CALLS_H
#define VIRGA_TESTS_FUZZ_CALLS_H

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <virga/virga.h>

/* CALLS_GONE stands for the context of objects whose context was destroyed. */
enum {
    CALLS_CONTEXTS = 2,
    CALLS_GONE = CALLS_CONTEXTS,
    CALLS_SLOTS = 3,
    CALLS_BUFFER_BYTES = 1 << 16,
    CALLS_STATE_BYTES = CALLS_BUFFER_BYTES + 64, /* offsets of states are smaller than 64 */
    CALLS_SIZE = 16
};

typedef enum calls_type {
    CALLS_RAIN,
    CALLS_GROUND,
    CALLS_SPLASH,
    CALLS_GLASS,
    CALLS_FLUID,
    CALLS_LENS,
    CALLS_ENVIRONMENT,
    CALLS_WATER,
    CALLS_SCENE,
    CALLS_TARGET,
    CALLS_TYPES
} calls_type;

/* A handle, and the context that it was made from. `lent`: it belongs to a scene. */
typedef struct calls_handle {
    void *object;
    uint32_t context;
    bool lent;
} calls_handle;

typedef struct calls_frames {
    uint64_t begun, completed;
    VkCommandBuffer cmd; /* of the newest frame */
    bool open;           /* it is not submitted */
} calls_frames;

/* What can go wrong is said by these. */
typedef enum calls_flags {
    CALLS_PLAIN = 0,
    CALLS_RECORDS = 1, /* VIRGA_OK means that something was recorded, and an invalid argument that nothing was */
    CALLS_WRONG = 2,   /* an argument is NULL, or of another context: must be refused */
    CALLS_SILENT = 4,  /* no object, whose log could say more */
    CALLS_OUTSIDE = 8, /* goes outside of rendering */
    CALLS_INSIDE = 16,
} calls_flags;

struct calls_device;

typedef struct calls {
    uint64_t random;
    const struct calls_device *device;
    bool lies;        /* frames are said to be complete that are not */
    bool careful;     /* mistakes are rare */
    bool thrown_away; /* (software Vulkan) the command buffer before this one was not submitted */
    virga_context *contexts[CALLS_CONTEXTS];
    bool lost[CALLS_CONTEXTS + 1];
    bool jobs[CALLS_CONTEXTS + 1]; /* its pipelines are built outside of calls */
    calls_handle handles[CALLS_TYPES][CALLS_SLOTS];
    calls_frames frames[CALLS_CONTEXTS + 1];
    virga_prepared prepared[CALLS_TYPES]; /* the newest view */

    uint64_t made, lines; /* calls made; log lines since calls_before */
    uint32_t results[9];  /* how often each virga_result came: errors by -result, then NOT_READY and DEGRADED */
    const char *name;     /* of the function that is called */
    uint32_t good, bad;   /* results of that function: not negative, and negative */
    char said[256];       /* the newest line */
    uint64_t bytes;       /* of host memory that the library has */
    uint32_t fail_alloc;  /* the allocation that fails, counted from 1; 0: none */
    uint64_t commands;    /* in the command buffer before the call */
} calls;

/* The device that the sequences run on. */
typedef struct calls_device {
    /* Handles are checked by nobody below the library: sizes, layouts and the place of a call must be true. */
    bool honest;
    uint32_t contexts;                                                /* at most CALLS_CONTEXTS */
    void (*define)(calls *c, uint32_t index, virga_context_def *def); /* its device */
    void (*begin)(calls *c, uint32_t index); /* a new command buffer in c->frames; submits the last one, or drops it */
    void (*wait)(calls *c, uint32_t index);  /* all submitted frames are done */
    uint64_t (*commands)(const calls *c, uint32_t index); /* number of commands recorded in the frame */
    bool (*lost)(void);
    void (*target)(calls *c, virga_target_def *def);       /* a target that can be drawn into */
    void (*render)(calls *c, uint32_t index, bool inside); /* begins or ends rendering */
    bool (*inside)(const calls *c, uint32_t index);
    VkBuffer (*buffer)(calls *c);       /* of CALLS_BUFFER_BYTES, for every use */
    VkBuffer (*state_buffer)(calls *c); /* where states are saved, and from where they are loaded */
    void (*image)(calls *c, VkFormat format, virga_image *image);
    void (*close)(calls *c); /* after a sequence: nothing may be left */
    void (*end)(void);       /* (optional) of the program */
} calls_device;

extern const calls_device calls_stand_in, calls_lavapipe;

/* ---- calls_world.c */

/* A number below `count`. True once in `n`. */
uint32_t calls_below(calls *c, uint32_t count);
bool calls_once_in(calls *c, uint32_t n);
/* The same for mistakes of a host and failures of a device: rarer in careful sequences, which so get farther. */
bool calls_slip(calls *c, uint32_t n);
/* Mostly in a range; sometimes far out of it, or no number. */
double calls_number(calls *c, double low, double high);
void calls_floats(calls *c, float *values, uint32_t count, double low, double high);
void calls_doubles(calls *c, double *values, uint32_t count, double low, double high);

/* Overwrites some words of a struct. What `kept` lists keeps its value, and what is a bool stays one. */
typedef struct calls_member {
    uint32_t offset, size; /* size 0: a bool */
} calls_member;
#define CALLS_KEPT(type, member)                            \
    {                                                       \
        offsetof(type, member), sizeof(((type *)0)->member) \
    }
#define CALLS_BOOL(type, member)  \
    {                             \
        offsetof(type, member), 0 \
    }
void calls_wild(calls *c, void *bytes, size_t size, const calls_member *kept, uint32_t kept_count);
#define CALLS_WILD(c, pointer, kept) \
    calls_wild(c, pointer, sizeof *(pointer), kept, (uint32_t)(sizeof(kept) / sizeof(kept)[0]))
#define CALLS_WILD_ALL(c, pointer) calls_wild(c, pointer, sizeof *(pointer), NULL, 0)

/* A handle of that type: mostly one that lives, sometimes NULL. */
calls_handle calls_pick(calls *c, calls_type type);
virga_context *calls_context_of(calls *c, uint32_t index);
/* An index of a context, which may be NULL. */
uint32_t calls_some_context(calls *c);
/* Keeps a new handle; destroys the one that it replaces. */
void calls_keep(calls *c, calls_type type, uint32_t context, void *object);
void calls_destroy(calls *c, calls_type type, void **object);
void calls_destroy_all(calls *c);

/* The command buffer of a context's frame; sometimes NULL, with *flags then CALLS_WRONG. With an honest device it is
 * where `flags` says, or the call must be left out: false then. */
bool calls_cmd(calls *c, uint32_t context, uint32_t *flags, VkCommandBuffer *cmd);

/* The flags of a call with an object that may be NULL. */
uint32_t calls_of(const void *object, uint32_t flags);

void calls_before(calls *c, uint32_t context);
virga_result calls_after(calls *c, const char *name, uint32_t context, uint32_t flags, virga_result result);
#define CALLS_TRY(c, context, flags, name, ...) \
    (calls_before(c, context), calls_after(c, #name, context, flags, name(__VA_ARGS__)))
#define CALLS_DO(c, name, ...) \
    do {                       \
        (c)->made++;           \
        (name)(__VA_ARGS__);   \
    } while (0)

void calls_wrong(const calls *c, const char *name, const char *what) __attribute__((noreturn));

/* ---- calls_context.c */

void calls_make_context(calls *c, uint32_t index);

/* ---- calls_structs.c */

void calls_fill_view(calls *c, virga_view *view);
void calls_fill_lighting(calls *c, virga_lighting *lighting);
void calls_fill_image(calls *c, VkFormat format, virga_image *image); /* may be none */
/* Up to `count` occluders; the number that was filled. */
uint32_t calls_fill_occluders(calls *c, virga_occluder *occluders, uint32_t count);
/* The same for wheels and feet. */
uint32_t calls_fill_wheels(calls *c, virga_wheel *wheels, uint32_t count);
uint32_t calls_fill_feet(calls *c, virga_foot *feet, uint32_t count);
void calls_fill_rotation(calls *c, float m[9]);
void calls_fill_sizes(calls *c, virga_sizes *sizes, double diameters[4], double numbers[4]);
void calls_fill_target_def(calls *c, virga_target_def *def);

/* Definitions are small where the device is honest: each is really run. */
void calls_fill_rain_def(calls *c, virga_rain_def *def);
void calls_fill_ground_def(calls *c, virga_ground_def *def);
void calls_fill_splash_def(calls *c, virga_splash_def *def);
void calls_fill_glass_def(calls *c, virga_glass_def *def);
void calls_fill_water_def(calls *c, virga_water_def *def);
void calls_fill_fluid_def(calls *c, virga_fluid_def *def);
void calls_fill_lens_def(calls *c, virga_lens_def *def);
void calls_fill_environment_def(calls *c, virga_environment_def *def);

#endif
