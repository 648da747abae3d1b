/* rain_expected_streak.h - the position, coverage and surroundings of a streak, computed in doubles from its drop. */
#ifndef VIRGA_TESTS_RAIN_EXPECTED_STREAK_H
#define VIRGA_TESTS_RAIN_EXPECTED_STREAK_H

#include "rain_picture_fixture.h"

typedef struct expected {
    double head[2], tail[2], depth[2], distance[2];
    double width_px, body_px, way_px, alpha;
    double drops, near, weight; /* drops of its slot; what is left of it near the camera; their product */
    double middle[3];           /* relative to the camera */
    double diameter_m;
} expected;

static inline double clamp01(double x)
{
    return x < 0 ? 0 : x > 1 ? 1 : x;
}

static inline double box_share(double radius, double half)
{
    const double t = clamp01((radius - 0.75 * half) / (0.25 * half));
    return 1 - t * t * (3 - 2 * t);
}

static inline double weight_of(const shot *s, uint32_t slot, const double p[3])
{
    const virga_rain *rain = s->f.rain;
    const rain_classes *classes = rain->classes;
    const uint32_t class_rank = ((const virga_slot_gpu *)s->slots.mapped)[slot].class_rank;
    const uint32_t level = slot / (rain->groups_per_level * VIRGA_RAIN_GROUP);
    const virga_weight_gpu *weight = &classes->weights[level * VIRGA_RAIN_CLASSES + (class_rank & 0xffff)];
    const double presence = clamp01(((double)weight->threshold - (class_rank >> 16) / 65536.0) / 0.05);
    const double radius = fmax(fmax(fabs(p[0]), fabs(p[1])), fabs(p[2]));
    const double half = 0.5 * ldexp(classes->side_m, (int)level + 1 - (int)classes->levels);
    const double share = box_share(radius, half) - (level ? box_share(radius, 0.5 * half) : 0);
    return presence * (double)weight->drops * fmax(share, 0);
}

static inline void to_clip(const host_camera *camera, bool reversed, const double from_camera[3], double clip[4])
{
    const float *m = camera->view_from_world, *p = camera->clip_from_view;
    double v[3];
    for (int row = 0; row < 3; row++)
        v[row] =
            (double)m[row] * from_camera[0] + (double)m[4 + row] * from_camera[1] + (double)m[8 + row] * from_camera[2];
    clip[0] = (double)p[0] * v[0] + (double)p[8] * v[2];
    clip[1] = (double)p[5] * v[1] + (double)p[9] * v[2];
    clip[2] = (double)p[10] * v[2] + (double)p[14];
    clip[3] = -v[2];
    clip[2] = reversed ? clip[3] - clip[2] : clip[2];
}

/* Coverage of one drop: D / distance that it moves in the shutter interval; 1 if it moves by less than D. Less if it is
 * narrower than the sampling. */
static inline double coverage_of_one(const shot *s, double width_px, double body_px, double way_px)
{
    const double narrow = fmin(width_px / (double)s->f.settings.min_width_px, 1);
    return fmin((double)s->f.settings.streak_gain * body_px / fmax(way_px, body_px), 1) * narrow;
}

/* Multiplied by the drops that it represents, up to what one drop of streak_group_mm covers in the same wind, and at
 * most a quarter. Zero below 1 / 800, or less for what is wider than 3 px. */
static inline double coverage_of(const shot *s, const expected *e)
{
    const float *wind = s->f.settings.wind_m_s;
    const double group_m = 1e-3 * (double)s->f.settings.streak_group_mm,
                 across2 = pow((double)wind[0], 2) + pow((double)wind[2], 2);
    const double faster = hypot(virga_drop_terminal_speed(group_m, 0), sqrt(across2)) /
                          hypot(virga_drop_terminal_speed(e->diameter_m, 0) - (double)wind[1], sqrt(across2));
    const double group_px = e->width_px * group_m / e->diameter_m;
    const double one = coverage_of_one(s, e->width_px, e->body_px, e->way_px),
                 large = coverage_of_one(s, group_px, group_px, e->way_px * faster);
    const double coverage = fmin(one * e->drops, fmax(one, fmin(large, 0.25)));
    const double drawn = fmax(e->width_px, (double)s->f.settings.min_width_px);
    return e->near * coverage * clamp01(coverage * 800 * fmax(drawn / 3, 1) - 1);
}

/* False if an end is behind the camera or nearly so. */
static inline bool expect_streak(const shot *s, uint32_t slot, expected *e)
{
    const virga_rain *rain = s->f.rain;
    const virga_drop_gpu *drop = &rain_fixture_drops(&s->f)[slot];
    const uint32_t k = ((const virga_slot_gpu *)s->slots.mapped)[slot].class_rank & 0xffff;
    e->diameter_m = VIRGA_DROP_MIN_M * pow(VIRGA_DROP_MAX_M / VIRGA_DROP_MIN_M, (k + 0.5) / VIRGA_RAIN_CLASSES);
    const double close_s = virga_rain_time(rain) - (double)rain->ticks * rain->def.tick_s,
                 open_s = close_s - s->shutter_s;
    double at_tick[3], ends[2][3], clip[2][4];
    for (int i = 0; i < 3; i++) {
        const double velocity =
            (double)s->f.settings.wind_m_s[i] - (i == 1 ? virga_drop_terminal_speed(e->diameter_m, 0) : 0);
        at_tick[i] = (double)drop->position[i];
        ends[0][i] = at_tick[i] + s->f.origin[i] + velocity * close_s - s->camera.position_m[i];
        ends[1][i] = at_tick[i] + s->f.origin[i] + velocity * open_s - s->camera.position_m[i];
        e->middle[i] = 0.5 * (ends[0][i] + ends[1][i]);
        ends[1][i] += s->camera.position_m[i] - s->open.position_m[i];
    }
    to_clip(&s->camera, s->reversed, ends[0], clip[0]);
    to_clip(&s->open, s->reversed, ends[1], clip[1]);
    if (clip[0][3] < 0.05 || clip[1][3] < 0.05)
        return false;
    double way[2];
    for (int i = 0; i < 2; i++) {
        e->head[i] = clip[0][i] / clip[0][3];
        e->tail[i] = clip[1][i] / clip[1][3];
        e->depth[i] = clip[i][2] / clip[i][3];
        e->distance[i] = clip[i][3];
        way[i] = (e->head[i] - e->tail[i]) * 0.5 * (i ? s->picture.height : s->picture.width);
    }
    const double pixel = 2 / (fabs((double)s->camera.clip_from_view[5]) * s->picture.height);
    e->width_px = e->diameter_m / (0.5 * (clip[0][3] + clip[1][3]) * pixel);
    e->body_px = e->width_px * virga_drop_axis_ratio(e->diameter_m);
    e->way_px = hypot(way[0], way[1]);
    const double *m = e->middle, distance = sqrt(m[0] * m[0] + m[1] * m[1] + m[2] * m[2]);
    e->drops = weight_of(s, slot, at_tick);
    e->near = clamp01(distance / (double)s->f.settings.near_fade_m - 1);
    e->weight = e->drops * e->near;
    e->alpha = coverage_of(s, e);
    return true;
}

static inline bool inside(const double ndc[2])
{
    return fabs(ndc[0]) < 1 && fabs(ndc[1]) < 1;
}

static inline uint32_t slot_of(const virga_streak_gpu *streak)
{
    return streak->id & ((1u << VIRGA_RAIN_ID_SLOT_BITS) - 1);
}

/* A streak that falls vertically in front of a level camera, so that all of it has the same depth. */
static inline int choose_streak(const shot *s, double *distance_m)
{
    for (uint32_t i = 0; i < streak_count(s); i++) {
        const virga_streak_gpu *streak = &streak_list(s)[i];
        const double head[2] = {(double)streak->head[0], (double)streak->head[1]},
                     tail[2] = {(double)streak->tail[0], (double)streak->tail[1]};
        *distance_m = (double)streak->distance[0];
        if (inside(head) && inside(tail) && *distance_m > 1 && *distance_m < 4 && high_half(streak->width_alpha) > 0.01)
            return (int)i;
    }
    fail_msg("no streak to be seen");
    return 0;
}

static inline void environment_at(const shot *s, const double d[3], const double band[3], double radiance[3])
{
    const double basis[9] = {band[0] * 0.282095,
                             band[1] * 0.488603 * d[1],
                             band[1] * 0.488603 * d[2],
                             band[1] * 0.488603 * d[0],
                             band[2] * 1.092548 * d[0] * d[1],
                             band[2] * 1.092548 * d[1] * d[2],
                             band[2] * 0.315392 * (3 * d[2] * d[2] - 1),
                             band[2] * 1.092548 * d[0] * d[2],
                             band[2] * 0.546274 * (d[0] * d[0] - d[1] * d[1])};
    for (int c = 0; c < 3; c++) {
        radiance[c] = 0;
        for (int i = 0; i < 9; i++)
            radiance[c] += basis[i] * (double)s->f.settings.lighting.environment_sh[i][c];
        radiance[c] = fmax(radiance[c], 0);
    }
}

#endif
