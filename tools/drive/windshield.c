/* windshield.c - the shape of the pane, and its wipers. */
#include "game.h"

#include <math.h>

const char *const wiper_names[WIPER_SPEEDS] = {"off", "intermittent", "slow", "fast"};

/* The pillars lean inwards, so the pane is narrower at the top. */
void mask_pane(drive *d)
{
    for (int row = 0; row < PANE_TEXELS; row++) {
        const float up = ((float)row + 0.5f) / PANE_TEXELS,
                    half = 0.5f - 0.5f * up * (1 - CAR_GLASS_TOP_M / CAR_GLASS_WIDTH_M);
        for (int column = 0; column < PANE_TEXELS; column++)
            d->glass_at[row * PANE_TEXELS + column] = fabsf(((float)column + 0.5f) / PANE_TEXELS - 0.5f) < half;
    }
}

static void pane_point(const drive *d, const virga_glass_wiper *w, double along_m, double over_m, double angle,
                       float out[3])
{
    const double u = (double)w->pivot_m[0] + along_m * cos(angle), v = (double)w->pivot_m[1] + along_m * sin(angle);
    const double x = fmin(fmax(u / (double)CAR_GLASS_WIDTH_M, 0), 1) * (PANE_POINTS - 1);
    const double y = fmin(fmax(v / (double)CAR_GLASS_HEIGHT_M, 0), 1) * (PANE_POINTS - 1);
    const int column = (int)fmin(x, PANE_POINTS - 2), row = (int)fmin(y, PANE_POINTS - 2);
    const double s = x - column, t = y - row, rake = (double)CAR_GLASS_RAKE_DEG * M_PI / 180;
    const double below = fmin(v, 0); /* arms begin below the pane's edge */
    double at[3];
    for (int i = 0; i < 3; i++) {
        const float *p = d->pane + 3 * (row * PANE_POINTS + column) + i;
        at[i] = (1 - t) * ((1 - s) * (double)p[0] + s * (double)p[3]) +
                t * ((1 - s) * (double)p[3 * PANE_POINTS] + s * (double)p[3 * PANE_POINTS + 3]);
    }
    at[1] += below * cos(rake) + over_m * sin(rake);
    at[2] += -below * sin(rake) + over_m * cos(rake);
    out[0] = (float)(car_windshield_m[0] - at[0]);
    out[1] = (float)(car_windshield_m[1] + at[1]);
    out[2] = (float)(car_windshield_m[2] - at[2]);
}

/* Arms and blades follow the curved glass: 6 bars each. */
void put_wipers(drive *d)
{
    boxes *b = &d->boxes;
    const float up[3] = {0, 0.82f, -0.57f};
    b->count = 0;
    for (int i = 0; i < WIPERS; i++) {
        const virga_glass_wiper *w = &d->glass.wipers[i];
        const double angle = (double)w->host_deg * M_PI / 180, first = (double)(w->reach_m - w->blade_m);
        float from[3], to[3];
        pane_point(d, w, 0, 0.03, angle, from);
        pane_point(d, w, first + 0.5 * (double)w->blade_m, 0.03, angle, to);
        boxes_put_bar(b, from, to, up, 0.012f, 0.007f);
        for (int k = 0; k < 5; k++) {
            pane_point(d, w, first + (double)w->blade_m * k / 5, 0.012, angle, from);
            pane_point(d, w, first + (double)w->blade_m * (k + 1) / 5, 0.012, angle, to);
            boxes_put_bar(b, from, to, up, 0.007f, 0.013f);
        }
    }
}

/* Two sweeps, up and down, then a pause. When switched off, they finish the cycle. */
void move_wipers(drive *d, double dt_s)
{
    static const double sweep_s[WIPER_SPEEDS] = {0.7, 0.7, 0.7, 0.45}, pause_s[WIPER_SPEEDS] = {0, 2.5, 0, 0};
    const double sweep = sweep_s[d->wiper_speed], whole = 2 * sweep + pause_s[d->wiper_speed];
    if (d->wiper_speed != OFF || d->wiper_s > 0)
        d->wiper_s += dt_s;
    if (d->wiper_s >= whole)
        d->wiper_s = d->wiper_speed == OFF ? 0 : fmod(d->wiper_s, whole);
    const double share = d->wiper_s < 2 * sweep ? 0.5 - 0.5 * cos(M_PI * d->wiper_s / sweep) : 0;
    for (int i = 0; i < WIPERS; i++) {
        virga_glass_wiper *w = &d->glass.wipers[i];
        w->host_deg = w->low_deg + (w->high_deg - w->low_deg) * (float)share;
    }
}
