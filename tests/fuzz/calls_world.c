/* calls_world.c - random numbers, handles and frames of the random calls, and what must be true after each call. */
#include "calls.h"

#include "stand_in.h"

/* ---- numbers */

static uint64_t next(calls *c)
{
    uint64_t z = c->random += 0x9e3779b97f4a7c15;
    z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9;
    z = (z ^ z >> 27) * 0x94d049bb133111eb;
    return z ^ z >> 31;
}

uint32_t calls_below(calls *c, uint32_t count)
{
    return count ? (uint32_t)((next(c) >> 32) * count >> 32) : 0;
}

bool calls_once_in(calls *c, uint32_t n)
{
    return !calls_below(c, n);
}

bool calls_slip(calls *c, uint32_t n)
{
    return calls_once_in(c, c->careful ? 16 * n : n);
}

static double wild_number(calls *c)
{
    static const double wild[] = {(double)NAN,
                                  (double)INFINITY,
                                  -(double)INFINITY,
                                  1e30,
                                  -1e30,
                                  1e-40,
                                  0,
                                  -1,
                                  1,
                                  2147483648.0,
                                  4294967296.0,
                                  1e9,
                                  -1e9,
                                  1e300,
                                  3e38,
                                  -3e38,
                                  1e-300,
                                  1e19,
                                  -1e19,
                                  0.5,
                                  65536.0};
    return wild[calls_below(c, sizeof wild / sizeof wild[0])];
}

static double number(calls *c, bool wild, double low, double high)
{
    if (wild && calls_once_in(c, 4))
        return wild_number(c);
    return low + (high - low) * (calls_below(c, 1001) / 1000.0);
}

double calls_number(calls *c, double low, double high)
{
    return number(c, calls_slip(c, 6), low, high);
}

void calls_floats(calls *c, float *values, uint32_t count, double low, double high)
{
    const bool wild = calls_slip(c, 8);
    for (uint32_t i = 0; i < count; i++) {
        const double value = number(c, wild, low, high);
        values[i] = fabs(value) > 3.4e38 ? (value > 0 ? INFINITY : -INFINITY) : (float)value;
    }
}

void calls_doubles(calls *c, double *values, uint32_t count, double low, double high)
{
    const bool wild = calls_slip(c, 8);
    for (uint32_t i = 0; i < count; i++)
        values[i] = number(c, wild, low, high);
}

static void wild_word(calls *c, char *at, size_t left)
{
    const uint32_t kind = calls_below(c, 6);
    uint32_t word = (uint32_t)next(c);
    if (kind == 0 && left >= 8) {
        const double value = wild_number(c);
        memcpy(at, &value, 8);
        return;
    }
    if (kind < 3) {
        const double value = wild_number(c);
        const float number = fabs(value) > 3.4e38 ? INFINITY : (float)value;
        memcpy(&word, &number, 4);
    } else if (kind == 3) {
        word = calls_below(c, 40);
    } else if (kind == 4) {
        word = 0 - calls_below(c, 3);
    }
    memcpy(at, &word, 4);
}

void calls_wild(calls *c, void *bytes, size_t size, const calls_member *kept, uint32_t kept_count)
{
    static char before[32768];
    uint32_t words = !calls_slip(c, 2) ? 0 : 1 + calls_below(c, calls_once_in(c, 6) ? (uint32_t)(size / 8) : 3);
    if (size > sizeof before)
        abort();
    memcpy(before, bytes, size);
    for (; words; words--) {
        const size_t at = (size_t)calls_below(c, (uint32_t)(size / 4)) * 4;
        if (at + 4 <= size)
            wild_word(c, (char *)bytes + at, at % 8 ? 0 : size - at);
    }
    for (uint32_t i = 0; i < kept_count; i++) {
        char *at = (char *)bytes + kept[i].offset;
        if (kept[i].size)
            memcpy(at, before + kept[i].offset, kept[i].size);
        else
            *at &= 1;
    }
}

/* ---- handles */

uint32_t calls_some_context(calls *c)
{
    return calls_slip(c, 5) ? c->device->contexts - 1 : 0;
}

virga_context *calls_context_of(calls *c, uint32_t index)
{
    return c->contexts[index];
}

/* The part of a scene of that type. */
static void *part_of(calls *c, calls_type type, void *scene)
{
    switch (type) {
    case CALLS_RAIN: return virga_scene_rain(scene);
    case CALLS_GROUND: return virga_scene_ground(scene);
    case CALLS_SPLASH: return virga_scene_splash(scene);
    case CALLS_GLASS: return virga_scene_glass(scene, calls_below(c, 3));
    case CALLS_WATER: return virga_scene_water(scene);
    default: return NULL;
    }
}

calls_handle calls_pick(calls *c, calls_type type)
{
    if (calls_slip(c, 24))
        return (calls_handle){0};
    if (type != CALLS_SCENE && calls_once_in(c, c->careful ? 6 : 3)) {
        calls_handle scene = c->handles[CALLS_SCENE][calls_below(c, CALLS_SLOTS)];
        if (scene.object && (scene.object = part_of(c, type, scene.object))) {
            scene.lent = true;
            return scene;
        }
    }
    /* Mostly the same one in careful sequences: what was attached and prepared is then drawn. */
    const uint32_t first = c->careful && !calls_once_in(c, 4) ? 0 : calls_below(c, CALLS_SLOTS);
    for (uint32_t i = 0; i < CALLS_SLOTS; i++) {
        const calls_handle handle = c->handles[type][(first + i) % CALLS_SLOTS];
        if (handle.object)
            return handle;
    }
    return (calls_handle){0};
}

void calls_destroy(calls *c, calls_type type, void **object)
{
    c->made++;
    switch (type) {
    case CALLS_RAIN: virga_rain_destroy((virga_rain **)object); break;
    case CALLS_GROUND: virga_ground_destroy((virga_ground **)object); break;
    case CALLS_SPLASH: virga_splash_destroy((virga_splash **)object); break;
    case CALLS_GLASS: virga_glass_destroy((virga_glass **)object); break;
    case CALLS_FLUID: virga_fluid_destroy((virga_fluid **)object); break;
    case CALLS_LENS: virga_lens_destroy((virga_lens **)object); break;
    case CALLS_ENVIRONMENT: virga_environment_destroy((virga_environment **)object); break;
    case CALLS_WATER: virga_water_destroy((virga_water **)object); break;
    case CALLS_SCENE: virga_scene_destroy((virga_scene **)object); break;
    default: virga_target_destroy((virga_target **)object); break;
    }
    if (object && *object)
        calls_wrong(c, "destroy", "the handle is not NULL");
}

void calls_keep(calls *c, calls_type type, uint32_t context, void *object)
{
    if (!object)
        return;
    const bool first = c->careful && !c->handles[type][0].object;
    calls_handle *slot = &c->handles[type][first        ? 0
                                           : c->careful ? 1 + calls_below(c, 2)
                                                        : calls_below(c, CALLS_SLOTS)];
    calls_destroy(c, type, &slot->object);
    *slot = (calls_handle){object, context, false};
}

void calls_destroy_all(calls *c)
{
    enum { COUNT = CALLS_TYPES * CALLS_SLOTS, STRIDE = 37 }; /* a prime, so that each handle has its turn */
    const bool contexts_first = calls_once_in(c, 4);
    const uint32_t first = (uint32_t)c->made % COUNT;
    for (int round = 0; round < 2; round++) {
        for (uint32_t i = 0; i < CALLS_CONTEXTS && contexts_first == !round; i++)
            virga_context_destroy(&c->contexts[i]);
        for (uint32_t i = 0; i < COUNT && contexts_first == !!round; i++) {
            const uint32_t at = (i * STRIDE + first) % COUNT;
            calls_destroy(c, (calls_type)(at / CALLS_SLOTS), &c->handles[at / CALLS_SLOTS][at % CALLS_SLOTS].object);
        }
    }
}

/* ---- what must be true */

void calls_wrong(const calls *c, const char *name, const char *what)
{
    fprintf(stderr, "%s: %s; the last line: %s\n", name, what, c->said);
    abort();
}

bool calls_cmd(calls *c, uint32_t context, uint32_t *flags, VkCommandBuffer *cmd)
{
    const calls_frames *frames = &c->frames[context];
    if (calls_slip(c, 30)) {
        *cmd = VK_NULL_HANDLE;
        *flags |= CALLS_WRONG;
        return true;
    }
    *cmd = frames->cmd;
    if (!frames->open || (context == CALLS_GONE && c->device->honest))
        return false;
    const bool inside = c->device->inside(c, context);
    return !c->device->honest || !(*flags & (inside ? CALLS_OUTSIDE : CALLS_INSIDE));
}

uint32_t calls_of(const void *object, uint32_t flags)
{
    return object ? flags : flags | CALLS_WRONG | CALLS_SILENT;
}

void calls_before(calls *c, uint32_t context)
{
    c->made++;
    c->lines = 0;
    stand_in.unbuilt = false;
    c->commands = c->device->commands(c, context);
}

virga_result calls_after(calls *c, const char *name, uint32_t context, uint32_t flags, virga_result result)
{
    const bool recorded = c->device->commands(c, context) != c->commands;
    if (result > VIRGA_DEGRADED || result < VIRGA_ERROR_VULKAN)
        calls_wrong(c, name, "returned a number that is no result");
    c->results[result > 0 ? 6 + result : -result]++;
    c->good += result >= 0;
    c->bad += result < 0;
    if ((flags & CALLS_WRONG) && result >= 0)
        calls_wrong(c, name, "accepted a wrong argument");
    if (result == VIRGA_ERROR_INVALID && !(flags & CALLS_SILENT) && !c->lines)
        calls_wrong(c, name, "refused without a line in the log");
    if (result == VIRGA_ERROR_DEVICE_LOST && !c->device->lost() && context != CALLS_GONE)
        calls_wrong(c, name, "says that the device is lost, which it is not");
    if (result >= 0 && c->lost[context] && (flags & CALLS_RECORDS))
        calls_wrong(c, name, "goes on though the device is lost");
    if (result == VIRGA_ERROR_DEVICE_LOST)
        c->lost[context] = true;
    if ((flags & CALLS_RECORDS) && result == VIRGA_OK && !recorded && !c->device->honest)
        calls_wrong(c, name, "said OK, and recorded nothing");
    if ((flags & CALLS_RECORDS) && result == VIRGA_ERROR_INVALID && recorded)
        calls_wrong(c, name, "refused, and recorded something");
    if (stand_in.unbuilt && result >= 0 && !c->jobs[context])
        calls_wrong(c, name, "a pipeline could not be built, and it is no error");
    return result;
}
