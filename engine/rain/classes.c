/* rain/classes.c - size classes of drops: the class of each slot, how many drops a slot represents, and how each class
 * moves. Everything is computed on the host in double precision; the device only reads the result.
 *
 * The size of a slot never changes. New settings change weights only, and slots stay where they are. Slots are assigned
 * to classes for a cloudburst. In lighter rain the slots of high rank are not used, with a soft transition between used
 * and unused ranks. */
#include "rain/rain_internal.h"

#include <virga/shared/random.h>

#include <math.h>
#include <string.h>

#define RANK_SOFTNESS   0.05  /* as in shaders/rain/field.glsl */
#define DEALT_RATE_MM_H 150.0 /* slots are assigned for this rain: heavier rain needs weights above 1 */
#define LIGHT_RATE_MM_H 5.0   /* in the outer boxes, half of the slots are assigned for this rain */
#define EVEN_SHARE      0.15  /* of slots, spread evenly over all sizes, so that every size distribution finds some */

static const virga_sizes marshall_palmer = {VIRGA_SIZES_MARSHALL_PALMER, NULL, NULL, 0};

/* ---- assigning slots to classes */

static void class_sizes(rain_classes *classes)
{
    const double ratio = log(VIRGA_DROP_MAX_M / VIRGA_DROP_MIN_M) / VIRGA_RAIN_CLASSES;
    for (uint32_t k = 0; k < VIRGA_RAIN_CLASSES; k++) {
        rain_class *c = &classes->classes[k];
        c->diameter_m = VIRGA_DROP_MIN_M * exp(ratio * (k + 0.5));
        c->density_share = c->diameter_m * ratio;
        c->terminal_m_s = virga_drop_terminal_speed(c->diameter_m, 0);
    }
}

/* Adds `share` x density x diameter^power to the demand, normalised to a sum of `share` over all classes. */
static void add_demand(const rain_classes *classes, double rate, double power, double share, double *demand)
{
    double diameters[VIRGA_RAIN_CLASSES], densities[VIRGA_RAIN_CLASSES], sum = 0;
    for (uint32_t k = 0; k < VIRGA_RAIN_CLASSES; k++)
        diameters[k] = classes->classes[k].diameter_m;
    virga_sizes_densities(&marshall_palmer, rate, 0, VIRGA_RAIN_CLASSES, diameters, densities);
    for (uint32_t k = 0; k < VIRGA_RAIN_CLASSES; k++) {
        densities[k] *= classes->classes[k].density_share * pow(diameters[k], power);
        sum += densities[k];
    }
    for (uint32_t k = 0; k < VIRGA_RAIN_CLASSES; k++)
        demand[k] += share * densities[k] / sum;
}

/* In the innermost box, classes get slots in proportion to their drops, so that each slot can be one drop. In the other
 * boxes they get them in proportion to the screen area that their drops cover (diameter squared), so that each streak
 * contributes about equally. */
static void deal_level(rain_classes *classes, uint32_t level)
{
    double demand[VIRGA_RAIN_CLASSES];
    for (uint32_t k = 0; k < VIRGA_RAIN_CLASSES; k++)
        demand[k] = EVEN_SHARE / VIRGA_RAIN_CLASSES;
    if (level == 0) {
        add_demand(classes, DEALT_RATE_MM_H, 0, 1 - EVEN_SHARE, demand);
    } else {
        add_demand(classes, DEALT_RATE_MM_H, 2, (1 - EVEN_SHARE) / 2, demand);
        add_demand(classes, LIGHT_RATE_MM_H, 2, (1 - EVEN_SHARE) / 2, demand);
    }
    double sum = 0;
    uint32_t dealt = 0;
    for (uint32_t k = 0; k < VIRGA_RAIN_CLASSES; k++) {
        sum += demand[k];
        uint32_t share_end =
            k + 1 == VIRGA_RAIN_CLASSES ? classes->slots_per_level : (uint32_t)(sum * classes->slots_per_level + 0.5);
        share_end = share_end > classes->slots_per_level ? classes->slots_per_level : share_end;
        classes->slot_count[level][k] = share_end > dealt ? share_end - dealt : 0;
        dealt += classes->slot_count[level][k];
    }
}

void rain_classes_init(rain_classes *classes, uint32_t levels, uint32_t slots_per_level, double side_m)
{
    memset(classes, 0, sizeof *classes);
    classes->levels = levels;
    classes->slots_per_level = slots_per_level;
    classes->side_m = side_m;
    class_sizes(classes);
    for (uint32_t level = 0; level < levels; level++)
        deal_level(classes, level);
}

void rain_classes_fill_slots(const rain_classes *classes, uint32_t seed, virga_slot_gpu *slots)
{
    uint32_t index = 0;
    for (uint32_t level = 0; level < classes->levels; level++)
        for (uint32_t k = 0; k < VIRGA_RAIN_CLASSES; k++)
            for (uint32_t i = 0, count = classes->slot_count[level][k]; i < count; i++, index++) {
                /* Ranks are stratified over the class: evenly spaced, with jitter. */
                const double jitter = (double)virga_unit(virga_hash3(seed, 3, index));
                const uint32_t rank = (uint32_t)((i + jitter) / count * 65536.0);
                slots[index].class_rank = k | (rank > 65535 ? 65535 : rank) << 16;
                for (uint32_t axis = 0; axis < 3; axis++)
                    slots[index].lattice[axis] = virga_hash3(seed, axis, index);
            }
}

/* ---- how many drops a slot represents */

/* Threshold t for which the mean over ranks u in [0; 1] of clamp((t - u) / e, 0, 1) is `share`. The mean is
 * t^2 / 2e for t < e, t - e/2 up to 1, and 1 - (1 - t + e)^2 / 2e from there to 1 + e. */
static double threshold_for(double share)
{
    const double e = RANK_SOFTNESS;
    if (share <= 0)
        return 0;
    if (share < e / 2)
        return sqrt(2 * e * share);
    if (share < 1 - e / 2)
        return share + e / 2;
    return share < 1 ? 1 + e - sqrt(2 * e * (1 - share)) : 2;
}

/* The number of drops of each class that the slots of a box represent. A class without slots passes its water to the
 * nearest class that has some: the same amount of water lands, in drops of nearly the same size. */
static void level_drops(const rain_classes *classes, uint32_t level, double volume_m3, double *drops)
{
    const uint32_t *count = classes->slot_count[level];
    memset(drops, 0, VIRGA_RAIN_CLASSES * sizeof drops[0]);
    for (uint32_t k = 0; k < VIRGA_RAIN_CLASSES; k++) {
        uint32_t to = k;
        for (uint32_t away = 1; !count[to] && away < VIRGA_RAIN_CLASSES; away++) {
            if (k >= away && count[k - away])
                to = k - away;
            else if (k + away < VIRGA_RAIN_CLASSES && count[k + away])
                to = k + away;
        }
        const rain_class *from = &classes->classes[k], *into = &classes->classes[to];
        const double water = from->terminal_m_s * pow(from->diameter_m, 3);
        drops[to] += classes->per_m3[k] * volume_m3 * water / (into->terminal_m_s * pow(into->diameter_m, 3));
    }
}

static void update_weights(rain_classes *classes)
{
    for (uint32_t level = 0; level < classes->levels; level++) {
        double drops[VIRGA_RAIN_CLASSES];
        const double side = ldexp(classes->side_m, (int)level + 1 - (int)classes->levels);
        level_drops(classes, level, side * side * side, drops);
        for (uint32_t k = 0; k < VIRGA_RAIN_CLASSES; k++) {
            const uint32_t count = classes->slot_count[level][k];
            const double each = count ? drops[k] / count : 0;
            classes->weights[level * VIRGA_RAIN_CLASSES + k] =
                (virga_weight_gpu){.drops = each > 1 ? (float)each : 1.0f, .threshold = (float)threshold_for(each)};
        }
    }
}

void rain_classes_set_rain(rain_classes *classes, const virga_sizes *sizes, double rate_mm_h, double air_density,
                           double ease_s)
{
    double diameters[VIRGA_RAIN_CLASSES], densities[VIRGA_RAIN_CLASSES], landing = 0;
    for (uint32_t k = 0; k < VIRGA_RAIN_CLASSES; k++)
        diameters[k] = classes->classes[k].diameter_m;
    virga_sizes_densities(sizes, rate_mm_h, air_density, VIRGA_RAIN_CLASSES, diameters, densities);
    for (uint32_t k = 0; k < VIRGA_RAIN_CLASSES; k++) {
        const rain_class *c = &classes->classes[k];
        classes->per_m3_to[k] = densities[k] * c->density_share;
        landing += classes->per_m3_to[k] * virga_drop_terminal_speed(c->diameter_m, air_density) *
                   virga_drop_volume(c->diameter_m) * 3.6e6;
    }
    /* Classes are bins: scale away the remaining integration error, so that exactly the rate lands. */
    for (uint32_t k = 0; k < VIRGA_RAIN_CLASSES; k++)
        classes->per_m3_to[k] *= landing > 0 ? rate_mm_h / landing : 0;
    memcpy(classes->per_m3_from, classes->per_m3, sizeof classes->per_m3);
    classes->rate_from = classes->rate_mm_h;
    classes->rate_to = rate_mm_h;
    classes->eased_s = 0;
    classes->ease_s = ease_s;
    if (ease_s <= 0) {
        memcpy(classes->per_m3, classes->per_m3_to, sizeof classes->per_m3);
        classes->rate_mm_h = rate_mm_h;
        update_weights(classes);
    }
}

static void ease(rain_classes *classes, double tick_s)
{
    if (classes->ease_s <= 0)
        return;
    classes->eased_s += tick_s;
    const double t = classes->eased_s < classes->ease_s ? classes->eased_s / classes->ease_s : 1;
    for (uint32_t k = 0; k < VIRGA_RAIN_CLASSES; k++)
        classes->per_m3[k] = t < 1 ? classes->per_m3_from[k] + t * (classes->per_m3_to[k] - classes->per_m3_from[k])
                                   : classes->per_m3_to[k];
    classes->rate_mm_h = t < 1 ? classes->rate_from + t * (classes->rate_to - classes->rate_from) : classes->rate_to;
    if (t >= 1)
        classes->ease_s = 0;
    update_weights(classes);
}

double rain_classes_real_drop_radius(const rain_classes *classes)
{
    double radius = 0;
    for (uint32_t level = 0; level < classes->levels; level++) {
        for (uint32_t k = 0; k < VIRGA_RAIN_CLASSES; k++)
            if (classes->slot_count[level][k] && classes->weights[level * VIRGA_RAIN_CLASSES + k].drops > 1)
                return radius;
        radius = 0.75 * 0.5 * ldexp(classes->side_m, (int)level + 1 - (int)classes->levels);
    }
    return radius;
}

/* ---- how classes move */

void rain_classes_set_air(rain_classes *classes, double air_density)
{
    for (uint32_t k = 0; k < VIRGA_RAIN_CLASSES; k++)
        classes->classes[k].terminal_m_s = virga_drop_terminal_speed(classes->classes[k].diameter_m, air_density);
}

void rain_classes_settle(rain_classes *classes, const double wind[3])
{
    for (uint32_t k = 0; k < VIRGA_RAIN_CLASSES; k++)
        for (int axis = 0; axis < 3; axis++)
            classes->classes[k].velocity[axis] = wind[axis] - (axis == 1 ? classes->classes[k].terminal_m_s : 0);
}

/* dv/dt = -g - (g / vt^2) |v - w| (v - w): quadratic drag, which balances gravity at the terminal speed vt. The last
 * factor is implicit: this is stable with any tick, and exact at rest. */
static void move(rain_class *c, const double wind[3], double tick_s, double side_m)
{
    const double unit = 4294967296.0 / side_m;
    double relative = 0;
    for (int axis = 0; axis < 3; axis++)
        relative += (c->velocity[axis] - wind[axis]) * (c->velocity[axis] - wind[axis]);
    const double drag = VIRGA_GRAVITY / (c->terminal_m_s * c->terminal_m_s) * sqrt(relative) * tick_s;
    c->drag = drag;
    for (int axis = 0; axis < 3; axis++) {
        const double pull = axis == 1 ? VIRGA_GRAVITY * tick_s : 0;
        c->velocity[axis] = (c->velocity[axis] + drag * wind[axis] - pull) / (1 + drag);
        c->travel[axis] += llround(c->velocity[axis] * tick_s * unit);
    }
}

void rain_classes_tick(rain_classes *classes, const double wind[3], double tick_s)
{
    ease(classes, tick_s);
    for (uint32_t k = 0; k < VIRGA_RAIN_CLASSES; k++)
        move(&classes->classes[k], wind, tick_s, classes->side_m);
}
