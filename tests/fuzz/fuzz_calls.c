/* fuzz_calls.c - random sequences of calls of every public function, with handles that live, are NULL or of another
 * context, random structs, frames that are lost, failures and lost devices. No order of calls may crash, leak, hang,
 * or say OK where nothing was done.
 *
 * usage: fuzz-calls [-n CALLS] [-s SEED] [-q CALLS_IN_A_SEQUENCE] [lavapipe]
 *
 * A sequence starts with no context and ends with none. Its seed is printed where something is wrong. */
#include "calls_list.h"

#include <signal.h>
#include <unistd.h>

#define CALL(name) {#name, call_##name},
static const struct entry {
    const char *name;
    void (*call)(calls *c);
} table[] = {
#include "calls_exports.inc"
};
#undef CALL

enum { TABLE = sizeof table / sizeof table[0] };

/* How often each function did what it is for, and how often it refused. */
static uint32_t goods[TABLE], bads[TABLE];

static unsigned long long seed_now, call_now;
static const char *name_now = "";

static volatile sig_atomic_t ended;

/* A long run that is told to end does so, and says how far it came. */
static void end_soon(int number)
{
    (void)number;
    ended = 1;
}

static void say_where(int number)
{
    char line[160];
    const int length = snprintf(line, sizeof line, "in sequence %llu, call %llu, %s\n", seed_now, call_now, name_now);
    if (write(2, line, (size_t)length) < 0)
        _exit(3);
    signal(number, SIG_DFL);
    raise(number);
}

static const struct entry *find(const char *name)
{
    for (int i = 0; i < TABLE; i++)
        if (!strcmp(table[i].name, name))
            return &table[i];
    abort();
}

/* What happens in frames comes more often than single creations: else all objects would be young, and the table of
 * rings that each ground fills would take most of the time. */
static const struct entry *choose(calls *c)
{
    static const char *const often[] = {
        "virga_frame_begin",  "virga_frame_begin",    "virga_frame_begin",   "virga_frame_begin",
        "virga_frame_begin",  "virga_frame_begin",    "virga_target_create", "virga_rain_create",
        "virga_scene_attach", "virga_scene_record",   "virga_scene_record",  "virga_scene_draw",
        "virga_rain_attach",  "virga_rain_step",      "virga_rain_prepare",  "virga_rain_draw",
        "virga_ground_step",  "virga_splash_attach",  "virga_splash_step",   "virga_splash_prepare",
        "virga_glass_attach", "virga_glass_step",     "virga_glass_prepare", "virga_water_attach",
        "virga_water_step",   "virga_water_prepare",  "virga_lens_attach",   "virga_lens_prepare",
        "virga_lens_draw",    "virga_fluid_step",     "virga_glass_draw",    "virga_splash_draw",
        "virga_water_draw",   "virga_pipelines_build"};
    return calls_once_in(c, 2) ? &table[calls_below(c, TABLE)]
                               : find(often[calls_below(c, sizeof often / sizeof often[0])]);
}

static void run(calls *c, const struct entry *entry)
{
    name_now = entry->name;
    if (getenv("VIRGA_TEST_VERBOSE"))
        fprintf(stderr, "%llu %s\n", call_now, entry->name);
    c->good = c->bad = 0;
    entry->call(c);
    goods[entry - table] += c->good;
    bads[entry - table] += c->bad;
}

/* An effect's calls of a frame, in their order: chance alone would hardly ever draw what it has prepared. */
static void play_frame(calls *c)
{
    static const char *const frames[][4] = {
        {"virga_scene_record", "virga_scene_prepare_panes", "virga_scene_draw"},
        {"virga_scene_record", NULL, "virga_scene_draw_view", "virga_scene_draw_view"},
        {"virga_rain_step", "virga_rain_prepare", "virga_rain_draw", "virga_rain_draw_parts"},
        {"virga_rain_step", "virga_rain_prepare_view", "virga_rain_draw_view", "virga_rain_draw_haze"},
        {"virga_ground_step", NULL, "virga_ground_draw_wet"},
        {"virga_splash_step", "virga_splash_prepare_view", "virga_splash_draw_view", "virga_splash_draw"},
        {"virga_glass_step", "virga_glass_prepare_view", "virga_glass_draw_view", "virga_glass_draw_refraction"},
        {"virga_glass_step", "virga_glass_prepare_panes", "virga_glass_draw_view", "virga_glass_draw"},
        {"virga_water_step", "virga_water_prepare_view", "virga_water_draw_view", "virga_water_draw_foam"},
        {"virga_water_step", "virga_water_prepare", "virga_water_draw", "virga_water_draw_data"},
        {"virga_fluid_add", "virga_fluid_step"},
        {"virga_lens_prepare", NULL, "virga_lens_draw", "virga_lens_draw_part"},
        {"virga_lens_prepare_view", NULL, "virga_lens_draw_view", "virga_lens_draw_part_view"}};
    const char *const *names = frames[calls_below(c, sizeof frames / sizeof frames[0])];
    run(c, find("virga_frame_begin"));
    for (int i = 0; i < 4; i++) {
        if (i == 2 && c->frames[0].open && !c->device->inside(c, 0))
            c->device->render(c, 0, true);
        if (names[i])
            run(c, find(names[i]));
    }
}

/* Most sequences begin with one object of each type, so that calls find what they need. */
static void furnish(calls *c)
{
    static void (*const create[CALLS_TYPES])(calls *) = {[CALLS_RAIN] = call_virga_rain_create,
                                                         [CALLS_GROUND] = call_virga_ground_create,
                                                         [CALLS_SPLASH] = call_virga_splash_create,
                                                         [CALLS_GLASS] = call_virga_glass_create,
                                                         [CALLS_FLUID] = call_virga_fluid_create,
                                                         [CALLS_LENS] = call_virga_lens_create,
                                                         [CALLS_ENVIRONMENT] = call_virga_environment_create,
                                                         [CALLS_WATER] = call_virga_water_create,
                                                         [CALLS_SCENE] = call_virga_scene_create,
                                                         [CALLS_TARGET] = call_virga_target_create};
    static void (*const attach[])(calls *) = {call_virga_rain_attach,  call_virga_splash_attach,
                                              call_virga_glass_attach, call_virga_water_attach,
                                              call_virga_lens_attach,  call_virga_scene_attach};
    calls_make_context(c, 0);
    for (int type = 0; type < CALLS_TYPES; type++)
        for (int i = 0; i < 3 && !c->handles[type][0].object && !c->handles[type][1].object; i++)
            create[type](c);
    call_virga_pipelines_build(c);
    for (int i = 0; i < 12; i++)
        attach[i % 6](c);
    call_virga_frame_begin(c);
}

static void run_sequence(calls *c, uint64_t seed, uint32_t length)
{
    const calls_device *device = c->device;
    const uint64_t made = c->made;
    uint32_t results[9];
    memcpy(results, c->results, sizeof results);
    memset(c, 0, sizeof *c);
    memcpy(c->results, results, sizeof results);
    c->device = device;
    c->made = made;
    c->random = seed_now = seed;
    c->careful = !calls_once_in(c, 3);
    c->lies = !c->careful && !device->honest && calls_once_in(c, 3);
    c->lost[CALLS_GONE] = true;
    for (uint32_t i = 0; i < device->contexts; i++)
        device->begin(c, i);
    if (!device->honest)
        device->begin(c, CALLS_GONE);
    if (c->careful || !calls_once_in(c, 3))
        furnish(c);
    for (uint32_t i = 0; i < length && !ended; i++) {
        call_now = i;
        for (uint32_t k = 0; k < device->contexts; k++)
            if (!c->contexts[k] && calls_once_in(c, 4))
                calls_make_context(c, k);
        if (calls_once_in(c, 8)) {
            const uint32_t index = calls_some_context(c);
            if (c->frames[index].open)
                device->render(c, index, !device->inside(c, index));
        }
        if (c->careful && calls_once_in(c, 12))
            play_frame(c);
        else
            run(c, choose(c));
    }
    name_now = "the end";
    for (uint32_t i = 0; i < device->contexts; i++) {
        device->begin(c, i);
        device->wait(c, i);
    }
    c->fail_alloc = 0;
    calls_destroy_all(c);
    device->close(c);
}

/* A public function without a call here. */
static uint32_t count_missing(void)
{
    uint32_t missing = 0;
    for (int i = 0; i < TABLE; i++)
        if (!table[i].call) {
            fprintf(stderr, "%s: no call_%s in tests/fuzz: every public function joins the random calls\n",
                    table[i].name, table[i].name);
            missing++;
        }
    return missing;
}

int main(int argc, char **argv)
{
    static calls c;
    uint64_t count = 20000, seed = 1, length = 600;
    c.device = &calls_stand_in;
    for (int i = 1; i < argc; i++) {
        if (!strcmp(argv[i], "-n") && i + 1 < argc)
            count = strtoull(argv[++i], NULL, 10);
        else if (!strcmp(argv[i], "-s") && i + 1 < argc)
            seed = strtoull(argv[++i], NULL, 10);
        else if (!strcmp(argv[i], "-q") && i + 1 < argc)
            length = strtoull(argv[++i], NULL, 10);
        else if (!strcmp(argv[i], "lavapipe"))
            c.device = &calls_lavapipe;
        else {
            fprintf(stderr, "fuzz-calls: no option %s\n", argv[i]);
            return 2;
        }
    }
    if (count_missing())
        return 1;
    signal(SIGABRT, say_where);
    signal(SIGSEGV, say_where);
    signal(SIGTERM, end_soon);
    c.device->close(&c);
    for (; c.made < count && !ended; seed++)
        run_sequence(&c, seed, (uint32_t)length);
    if (c.device->end)
        c.device->end();
    static const char *const names[9] = {"ok",          "invalid",      "host memory", "device memory", "unsupported",
                                         "device lost", "vulkan error", "not ready",   "degraded"};
    printf("%llu calls of %d functions;", (unsigned long long)c.made, (int)TABLE);
    for (int i = 0; i < 9; i++)
        printf(" %s %u", names[i], c.results[i]);
    printf("\n");
    for (int i = 0; i < TABLE; i++)
        if (goods[i] + bads[i] && (goods[i] * 20 < bads[i] || getenv("VIRGA_TEST_VERBOSE")))
            printf("%s: %u of %u were accepted\n", table[i].name, goods[i], goods[i] + bads[i]);
    return 0;
}
