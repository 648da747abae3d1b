/* splash/splash_table.c - which splash a drop makes on a material in a state, in one readable place.
 *
 * Asphalt is table 1 of Mizukami et al. as printed. Concrete makes none while it is only moist, and weaker ones than
 * asphalt where a film or a puddle stands on it; 10 mm of water give a crown-cone on all materials; on dry ones a drop
 * leaves a spot, but a disk on dry steel (their sections 2.2 and 4.3). The others are set by likeness: rough and hard
 * as asphalt, smooth and hard as concrete; what is smooth and takes up nothing shows a disk as steel does; soft ones
 * and leaves take most of the drop. Shares of water are ours: the paper has none. They make droplets of 0.3 to 0.7 mm
 * from a drop of 2 mm, as such splashes have (Bai, Rusche and Gosman 2002). */
#include "splash/splash_internal.h"

#include "core/settings.h"

#include <virga/material.h>

#include <math.h>

/* ---- rows by state */

#define LEAST_MM \
    0.8f /* smaller drops hardly splash: between 0.69 mm, where Mundo's We^1/2 Re^1/4 is 57.7, and 0.92 mm,
                       * where Bai, Rusche and Gosman's droplets begin on a wet wall */

static const virga_splash_row none = {.model = VIRGA_SPLASH_NONE};

static const virga_splash_row disk = {.model = VIRGA_SPLASH_DISK, .least_diameter_mm = LEAST_MM};

static const virga_splash_row wet = {.model = VIRGA_SPLASH_SCATTERING,
                                     .least_diameter_mm = LEAST_MM,
                                     .share = {0.03f, 0.10f},
                                     .count = {1, 5},
                                     .angle_deg = {1, 30},
                                     .speed_m_s = {0.1f, 1.0f},
                                     .strength = 0.7f,
                                     .circle = 1.0f};

static const virga_splash_row puddle_3 = {.model = VIRGA_SPLASH_SCATTERING,
                                          .least_diameter_mm = LEAST_MM,
                                          .share = {0.05f, 0.16f},
                                          .count = {4, 14},
                                          .angle_deg = {1, 60},
                                          .speed_m_s = {0.15f, 1.5f},
                                          .strength = 1.0f,
                                          .circle = 1.3f};

static const virga_splash_row puddle_5 = {.model = VIRGA_SPLASH_SCATTERING,
                                          .least_diameter_mm = LEAST_MM,
                                          .share = {0.08f, 0.22f},
                                          .count = {12, 22},
                                          .angle_deg = {1, 90},
                                          .speed_m_s = {0.2f, 2.0f},
                                          .strength = 1.0f,
                                          .circle = 1.6f};

/* The angle is that of the cone's droplet; a crown's own piles, where it lets any go, rise at 50 to 80 degrees. */
static const virga_splash_row puddle_10 = {.model = VIRGA_SPLASH_CROWN_CONE,
                                           .least_diameter_mm = LEAST_MM,
                                           .share = {0.03f, 0.10f},
                                           .count = {1, 1},
                                           .angle_deg = {90, 90},
                                           .speed_m_s = {0.1f, 2.0f},
                                           .strength = 1.0f,
                                           .circle = 2.0f};

/* ---- materials: how much of asphalt's splash each makes */

typedef struct splash_nature {
    float count, speed, angle; /* times those of asphalt */
    float wet_depth_mm;        /* of film that a wet surface needs */
    bool dry_disk;
} splash_nature;

static const splash_nature hard_rough = {1, 1, 1, 0, false};
static const splash_nature hard_smooth = {0.6f, 0.75f, 0.8f, 0.5f, false};
static const splash_nature sealed = {1, 1, 1, 0, true}; /* takes up nothing, so any water on it is a film */
static const splash_nature soft = {0.5f, 0.8f, 1, 0, false};
static const splash_nature yielding = {0.4f, 0.5f, 1, 0.5f, false};

static const splash_nature *const natures[] = {
    [VIRGA_MATERIAL_DEFAULT] = &hard_smooth,
    [VIRGA_MATERIAL_ASPHALT] = &hard_rough,
    [VIRGA_MATERIAL_CONCRETE] = &hard_smooth,
    [VIRGA_MATERIAL_STONE] = &hard_rough,
    [VIRGA_MATERIAL_BRICK] = &hard_smooth,
    [VIRGA_MATERIAL_GRASS] = &yielding,
    [VIRGA_MATERIAL_SAND] = &soft,
    [VIRGA_MATERIAL_SOIL] = &soft,
    [VIRGA_MATERIAL_WOOD] = &hard_smooth,
    [VIRGA_MATERIAL_STEEL] = &sealed,
    [VIRGA_MATERIAL_GLASS] = &sealed,
    [VIRGA_MATERIAL_WATER] = &sealed,
    [VIRGA_MATERIAL_LEAVES] = &yielding,
    [VIRGA_MATERIAL_CLOTH] = &yielding,
    [VIRGA_MATERIAL_PLASTIC] = &sealed,
    [VIRGA_MATERIAL_TILE] = &sealed,
    [VIRGA_MATERIAL_DRAIN] = &hard_rough,
};

static virga_splash_row natural(virga_splash_row row, const splash_nature *nature)
{
    row.count[0] = fmaxf(floorf(row.count[0] * nature->count), 1);
    row.count[1] = fmaxf(floorf(row.count[1] * nature->count), 1);
    for (int i = 0; i < 2; i++)
        row.speed_m_s[i] *= nature->speed;
    row.angle_deg[1] *= nature->angle;
    row.share[1] *= nature->count;
    row.share[0] *= nature->count;
    row.strength *= nature->count;
    return row;
}

void splash_default_rows(virga_splash_row rows[VIRGA_GROUND_MATERIALS][VIRGA_GROUND_STATES])
{
    for (uint32_t i = 0; i < VIRGA_GROUND_MATERIALS; i++) {
        const uint32_t known = i < sizeof natures / sizeof natures[0] ? i : VIRGA_MATERIAL_DEFAULT;
        const splash_nature *nature = natures[known];
        virga_splash_row *row = rows[i];
        row[VIRGA_GROUND_DRY] = nature->dry_disk ? disk : none;
        row[VIRGA_GROUND_WET] = natural(wet, nature);
        row[VIRGA_GROUND_WET].least_depth_mm = nature->wet_depth_mm;
        row[VIRGA_GROUND_PUDDLE_3] = natural(puddle_3, nature);
        row[VIRGA_GROUND_PUDDLE_5] = natural(puddle_5, nature);
        row[VIRGA_GROUND_PUDDLE_10] = puddle_10;
        /* What is not ground is taken to be wet: roofs, cars, walls. There is no film to be known there. */
        row[VIRGA_GROUND_NONE] = row[VIRGA_GROUND_WET];
        row[VIRGA_GROUND_NONE].least_depth_mm = 0;
    }
    for (uint32_t state = VIRGA_GROUND_NONE; state <= VIRGA_GROUND_PUDDLE_5; state++)
        rows[VIRGA_MATERIAL_WATER][state] = puddle_10; /* a pond is deep */
    rows[VIRGA_MATERIAL_DRAIN][VIRGA_GROUND_DRY] = none;
}

/* ---- checks */

static void clamp_range(const virga_log *log, const char *name, float range[2], float most, bool *changed)
{
    for (int i = 0; i < 2; i++)
        range[i] = virga_clamp_setting_float(log, name, range[i], i ? range[0] : 0, most, changed);
}

static virga_result check_row(const virga_log *log, virga_splash_row *row, bool *changed)
{
    if (virga_settings_finite(log, "splash_settings.rows.least_diameter_mm", &row->least_diameter_mm, 1) ||
        virga_settings_finite(log, "splash_settings.rows.least_depth_mm", &row->least_depth_mm, 1) ||
        virga_settings_finite(log, "splash_settings.rows.share", row->share, 2) ||
        virga_settings_finite(log, "splash_settings.rows.count", row->count, 2) ||
        virga_settings_finite(log, "splash_settings.rows.angle_deg", row->angle_deg, 2) ||
        virga_settings_finite(log, "splash_settings.rows.speed_m_s", row->speed_m_s, 2) ||
        virga_settings_finite(log, "splash_settings.rows.strength", &row->strength, 1) ||
        virga_settings_finite(log, "splash_settings.rows.circle", &row->circle, 1))
        return VIRGA_ERROR_INVALID;
    row->model = virga_clamp_setting_u32(log, "splash_settings.rows.model", row->model, 0, VIRGA_SPLASH_DISK, changed);
    row->least_diameter_mm = virga_clamp_setting_float(log, "splash_settings.rows.least_diameter_mm",
                                                       row->least_diameter_mm, 0, 10, changed);
    row->least_depth_mm =
        virga_clamp_setting_float(log, "splash_settings.rows.least_depth_mm", row->least_depth_mm, 0, 100, changed);
    clamp_range(log, "splash_settings.rows.share", row->share, 1, changed);
    clamp_range(log, "splash_settings.rows.count", row->count, VIRGA_SPLASH_MOST_COUNT, changed);
    clamp_range(log, "splash_settings.rows.angle_deg", row->angle_deg, 90, changed);
    clamp_range(log, "splash_settings.rows.speed_m_s", row->speed_m_s, 10, changed);
    row->strength = virga_clamp_setting_float(log, "splash_settings.rows.strength", row->strength, 0, 4, changed);
    row->circle = virga_clamp_setting_float(log, "splash_settings.rows.circle", row->circle, 0, 10, changed);
    return VIRGA_OK;
}

virga_result splash_check_rows(const virga_log *log, virga_splash_row rows[VIRGA_GROUND_MATERIALS][VIRGA_GROUND_STATES],
                               bool *changed)
{
    for (uint32_t i = 0; i < VIRGA_GROUND_MATERIALS; i++)
        for (uint32_t state = 0; state < VIRGA_GROUND_STATES; state++)
            if (check_row(log, &rows[i][state], changed))
                return VIRGA_ERROR_INVALID;
    return VIRGA_OK;
}

/* ---- for the device */

void splash_fill_rules(const virga_splash *splash, virga_splash_rules_gpu *rules)
{
    const virga_splash_settings *settings = &splash->settings;
    const float degree = 0.0174532925f;
    /* Splashes last for about a tenth of a second (disks stay, on what is dry only); there are dots beside them. */
    rules->mode = (uint32_t)settings->mode;
    rules->quota = (float)(splash->def.max_splashes * splash->def.tick_s / 0.25);
    rules->droplets_m = fmaxf(settings->droplets_m, 1e-3f);
    rules->dot_diameter_m = settings->dot_mm * 1e-3f;
    for (uint32_t i = 0; i < VIRGA_GROUND_MATERIALS * VIRGA_GROUND_STATES; i++) {
        const virga_splash_row *row = &settings->rows[i / VIRGA_GROUND_STATES][i % VIRGA_GROUND_STATES];
        virga_splash_rule_gpu *rule = &rules->rules[i];
        *rule = (virga_splash_rule_gpu){.model = row->model,
                                        .least_diameter_m = row->least_diameter_mm * 1e-3f,
                                        .least_depth_m = row->least_depth_mm * 1e-3f,
                                        .strength = row->strength,
                                        .circle = row->circle};
        for (int end = 0; end < 2; end++) {
            rule->share[end] = row->share[end];
            rule->count[end] = row->count[end];
            rule->angle[end] = row->angle_deg[end] * degree;
            rule->speed[end] = row->speed_m_s[end];
        }
    }
}
