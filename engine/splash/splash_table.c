/* splash/splash_table.c - the default splash rule for each material and state of the ground.
 *
 * From Mizukami et al.:
 *   asphalt    as printed in their table 1
 *   concrete   no splash while it is only moist; weaker splashes than asphalt with a film or a puddle
 *   all        a crown-cone on 10 mm of water
 *   dry        a drop leaves a spot; on dry steel it makes a disk (their sections 2.2 and 4.3)
 *
 * The other materials are set by similarity. Rough hard materials are as asphalt, smooth hard ones as concrete. Smooth
 * materials that absorb no water make a disk, as steel does. Soft materials and leaves absorb the larger part of the
 * drop. The paper gives no shares of water, so we chose them. With them, a drop of 2 mm makes droplets of 0.3 to
 * 0.7 mm, which is the size in such splashes (Bai, Rusche and Gosman 2002). */
#include "splash/splash_internal.h"

#include "core/settings.h"

#include <virga/material.h>

#include <math.h>

/* ---- rows by state */

/* Smaller drops hardly splash. It is between two thresholds: 0.69 mm, where Mundo's We^1/2 Re^1/4 is 57.7, and 0.92 mm,
 * from which Bai, Rusche and Gosman find droplets on a wet wall. */
#define MIN_MM 0.8f

/* clang-format off */
static const virga_splash_rule
    none = {VIRGA_SPLASH_NONE},
    disk = {VIRGA_SPLASH_DISK, MIN_MM},
    /*           model, min diameter mm, min depth mm, share, count, angle deg, speed m/s, strength, circle radius */
    wet =       {VIRGA_SPLASH_SCATTERING, MIN_MM, 0, {0.03f, 0.10f}, {1, 5},   {1, 30},  {0.1f, 1.0f},  0.7f, 1.0f},
    puddle_3 =  {VIRGA_SPLASH_SCATTERING, MIN_MM, 0, {0.05f, 0.16f}, {4, 14},  {1, 60},  {0.15f, 1.5f}, 1.0f, 1.3f},
    puddle_5 =  {VIRGA_SPLASH_SCATTERING, MIN_MM, 0, {0.08f, 0.22f}, {12, 22}, {1, 90},  {0.2f, 2.0f},  1.0f, 1.6f},
    /* The angle is that of the cone's droplet. Piles of the crown itself, if it has any, rise at 50 to 80 degrees. */
    puddle_10 = {VIRGA_SPLASH_CROWN_CONE, MIN_MM, 0, {0.03f, 0.10f}, {1, 1},   {90, 90}, {0.1f, 2.0f},  1.0f, 2.0f};
/* clang-format on */

/* ---- materials: their splashes relative to asphalt */

typedef struct splash_surface {
    float count, speed, angle; /* factors of the values of asphalt */
    float wet_depth_mm;        /* min depth of film for a splash on a wet surface */
    bool dry_disk;
} splash_surface;

static const splash_surface hard_rough = {1, 1, 1, 0, false};
static const splash_surface hard_smooth = {0.6f, 0.75f, 0.8f, 0.5f, false};
static const splash_surface smooth = {1, 1, 1, 0, true}; /* absorbs nothing, so any water on it is a film */
static const splash_surface soft = {0.5f, 0.8f, 1, 0, false};
static const splash_surface yielding = {0.4f, 0.5f, 1, 0.5f, false};

static const splash_surface *const surfaces[] = {
    [VIRGA_MATERIAL_DEFAULT] = &hard_smooth,
    [VIRGA_MATERIAL_ASPHALT] = &hard_rough,
    [VIRGA_MATERIAL_CONCRETE] = &hard_smooth,
    [VIRGA_MATERIAL_STONE] = &hard_rough,
    [VIRGA_MATERIAL_BRICK] = &hard_smooth,
    [VIRGA_MATERIAL_GRASS] = &yielding,
    [VIRGA_MATERIAL_SAND] = &soft,
    [VIRGA_MATERIAL_SOIL] = &soft,
    [VIRGA_MATERIAL_WOOD] = &hard_smooth,
    [VIRGA_MATERIAL_STEEL] = &smooth,
    [VIRGA_MATERIAL_GLASS] = &smooth,
    [VIRGA_MATERIAL_WATER] = &smooth,
    [VIRGA_MATERIAL_LEAVES] = &yielding,
    [VIRGA_MATERIAL_CLOTH] = &yielding,
    [VIRGA_MATERIAL_PLASTIC] = &smooth,
    [VIRGA_MATERIAL_TILE] = &smooth,
    [VIRGA_MATERIAL_DRAIN] = &hard_rough,
};

static virga_splash_rule adapt_rule(virga_splash_rule row, const splash_surface *surface)
{
    row.count[0] = fmaxf(floorf(row.count[0] * surface->count), 1);
    row.count[1] = fmaxf(floorf(row.count[1] * surface->count), 1);
    for (int i = 0; i < 2; i++)
        row.speed_m_s[i] *= surface->speed;
    row.angle_deg[1] *= surface->angle;
    row.share[1] *= surface->count;
    row.share[0] *= surface->count;
    row.strength *= surface->count;
    return row;
}

void splash_default_rows(virga_splash_rule rows[VIRGA_GROUND_MATERIALS][VIRGA_GROUND_STATES])
{
    for (uint32_t i = 0; i < VIRGA_GROUND_MATERIALS; i++) {
        const uint32_t known = i < sizeof surfaces / sizeof surfaces[0] ? i : VIRGA_MATERIAL_DEFAULT;
        const splash_surface *surface = surfaces[known];
        virga_splash_rule *row = rows[i];
        row[VIRGA_GROUND_DRY] = surface->dry_disk ? disk : none;
        row[VIRGA_GROUND_WET] = adapt_rule(wet, surface);
        row[VIRGA_GROUND_WET].min_depth_mm = surface->wet_depth_mm;
        row[VIRGA_GROUND_PUDDLE_3] = adapt_rule(puddle_3, surface);
        row[VIRGA_GROUND_PUDDLE_5] = adapt_rule(puddle_5, surface);
        row[VIRGA_GROUND_PUDDLE_10] = puddle_10;
        /* Surfaces that are not ground (roofs, cars, walls) count as wet. Their film depth is unknown. */
        row[VIRGA_GROUND_NONE] = row[VIRGA_GROUND_WET];
        row[VIRGA_GROUND_NONE].min_depth_mm = 0;
    }
    for (uint32_t state = VIRGA_GROUND_NONE; state <= VIRGA_GROUND_PUDDLE_5; state++)
        rows[VIRGA_MATERIAL_WATER][state] = puddle_10; /* a pond is deep */
    rows[VIRGA_MATERIAL_DRAIN][VIRGA_GROUND_DRY] = none;
}

/* ---- checks */

#define RULE(kind, member, ...) VIRGA_SETTING_ROW(splash_settings.rules, virga_splash_rule, kind, member, __VA_ARGS__)
/* A range: its end is at least its start. */
#define RANGE(member, max) \
    RULE(FLOAT, member[0], 0, max), RULE(FLOAT, member[1], 0, max, .min_member = offsetof(virga_splash_rule, member[0]))

static const virga_setting_row rule_rows[] = {
    RULE(U32, model, 0, VIRGA_SPLASH_DISK),
    RULE(FLOAT, min_diameter_mm, 0, 10),
    RULE(FLOAT, min_depth_mm, 0, 100),
    RANGE(share, 1),
    RANGE(count, VIRGA_SPLASH_MAX_COUNT),
    RANGE(angle_deg, 90),
    RANGE(speed_m_s, 10),
    RULE(FLOAT, strength, 0, 4),
    RULE(FLOAT, circle_radius, 0, 10),
};

virga_result splash_check_rows(const virga_log *log,
                               virga_splash_rule rows[VIRGA_GROUND_MATERIALS][VIRGA_GROUND_STATES], bool *changed)
{
    for (uint32_t i = 0; i < VIRGA_GROUND_MATERIALS; i++)
        for (uint32_t state = 0; state < VIRGA_GROUND_STATES; state++)
            if (virga_settings_apply_rows(log, rule_rows, VIRGA_ROWS(rule_rows), &rows[i][state], changed))
                return VIRGA_ERROR_INVALID;
    return VIRGA_OK;
}

/* ---- uniforms */

static void fill_rules(const virga_splash *splash, virga_splash_rules_gpu *rules)
{
    const virga_splash_settings *settings = &splash->settings;
    const float degree = 0.0174532925f;
    /* A splash lives about a tenth of a second, and that of the last piece of an impact begins half a second after it.
     * Disks live longer, but only on dry ground. */
    const double longest_s = 0.15 + VIRGA_GROUND_PIECE_S * VIRGA_GROUND_MAX_PIECES;
    rules->mode = (uint32_t)settings->mode;
    rules->quota = (float)(0.95 * splash->def.max_splashes * splash->def.tick_s / longest_s);
    rules->droplet_range_m = fmaxf(settings->droplet_range_m, 1e-3f);
    rules->dot_min_m = settings->dot_min_mm * 1e-3f;
    for (uint32_t i = 0; i < VIRGA_GROUND_MATERIALS * VIRGA_GROUND_STATES; i++) {
        const virga_splash_rule *row = &settings->rules[i / VIRGA_GROUND_STATES][i % VIRGA_GROUND_STATES];
        virga_splash_rule_gpu *rule = &rules->rules[i];
        *rule = (virga_splash_rule_gpu){.model = row->model,
                                        .min_diameter_m = row->min_diameter_mm * 1e-3f,
                                        .min_depth_m = row->min_depth_mm * 1e-3f,
                                        .strength = row->strength,
                                        .circle_radius = row->circle_radius};
        for (int end = 0; end < 2; end++) {
            rule->share[end] = row->share[end];
            rule->count[end] = row->count[end];
            rule->angle[end] = row->angle_deg[end] * degree;
            rule->speed[end] = row->speed_m_s[end];
        }
    }
}

void splash_push_rules(virga_splash *splash)
{
    virga_context *context = splash->base.context;
    virga_splash_rules_gpu rules;
    if (virga_ring_used(context, &splash->rules_ring))
        return;
    fill_rules(splash, &rules);
    splash->rules_offset = virga_ring_push(context, &splash->rules_ring, &rules, sizeof rules);
}
