/* ground/standing.c - water on ground where drops are not simulated, for each material.
 *
 * A cell that enters the window for the first time has been in the rain as long as the cells inside. So the water that
 * it would hold by now is simulated for two cells of each material: one in the open and one under cover. They follow
 * the same laws as the cells of the window. First the pores absorb the rain. Then a film forms that the roughness holds
 * (its retention). The rest runs into hollows. The water infiltrates and evaporates in the same way. Nothing runs off
 * to other cells. Hollows are full when half of the ground is under water: from there on, the hollows of level but
 * uneven ground overflow into each other. */
#include "ground/ground_internal.h"

#include <math.h>

#define SPREAD 1.18 /* standard deviation of the bumps in shaders/ground/terrain.glsl / that of the material */

/* Share of the ground that is under water where hollows are filled to `level_um`. The heights of the bumps are assumed
 * to be normally distributed. Humps begin half a standard deviation below the mean (as in
 * shaders/ground/standing.glsl). */
static double share_under(double level_um, double bumps_um)
{
    return 0.5 * erfc((0.5 - level_um / bumps_um) / (SPREAD * sqrt(2)));
}

static void fill_hollows(ground_standing *s, const virga_soil_gpu *soil, double um)
{
    const double bumps_um = (double)soil->bumps_um, full_um = 0.5 * bumps_um;
    if (s->level_um < full_um)
        s->level_um = fmin(s->level_um + um / share_under(s->level_um, bumps_um), full_um);
}

/* Returns how much was removed: at most what was there. */
static double remove_water(double *from, double requested)
{
    const double removed = fmin(requested, *from);
    *from -= removed;
    return removed;
}

static void tick_cell(ground_standing *s, const virga_soil_gpu *soil, const ground_weather *weather)
{
    const double room = fmax((double)soil->capacity_nl - s->held_nl, 0), pores = fmin(weather->rain_nl, room);
    const double comes = weather->rain_nl - pores;
    s->held_nl = fmin(s->held_nl + pores, (double)soil->capacity_nl);
    if (soil->drain)
        s->film_nl = s->level_um = 0;
    else
        s->film_nl += comes;
    const double share = s->film_nl > 0 ? 1 : s->held_nl / fmax((double)soil->capacity_nl, 1);
    const double drying = weather->evaporation_nl * (double)soil->drying * share;
    const double sinking = (double)soil->sink_nl_s * weather->tick_s;
    remove_water(&s->film_nl, sinking);
    const double dried = remove_water(&s->film_nl, drying);
    remove_water(&s->held_nl, drying - dried);
    const double above = s->film_nl - (double)soil->retention_nl;
    const double lost = sinking + weather->evaporation_nl * (double)soil->drying - comes; /* lost by hollows */
    if (above > 0) {
        s->film_nl -= above;
        fill_hollows(s, soil, above / weather->nl_per_um);
    }
    if (lost > 0)
        s->level_um = fmax(s->level_um - lost / weather->nl_per_um, 0);
    s->spots = s->held_nl > 0 || s->film_nl > 0 ? s->spots + weather->spots : 0;
}

void ground_standing_tick(ground_standing cells[GROUND_STANDING], const virga_soil_gpu soils[VIRGA_GROUND_MATERIALS],
                          const ground_weather *weather)
{
    ground_weather covered = *weather;
    covered.rain_nl = covered.spots = 0;
    for (uint32_t i = 0; i < VIRGA_GROUND_MATERIALS; i++) {
        tick_cell(&cells[i], &soils[i], weather);
        tick_cell(&cells[VIRGA_GROUND_MATERIALS + i], &soils[i], &covered);
    }
}

void ground_standing_start(ground_standing cells[GROUND_STANDING], const virga_ground_settings *settings,
                           const virga_soil_gpu soils[VIRGA_GROUND_MATERIALS])
{
    const bool wet = settings->start_water_mm > 0;
    for (uint32_t i = 0; i < GROUND_STANDING; i++) {
        const virga_soil_gpu *soil = &soils[i % VIRGA_GROUND_MATERIALS];
        const bool stays = wet && !soil->drain;
        cells[i] =
            (ground_standing){.held_nl = (double)soil->capacity_nl * (stays ? 1 : (double)settings->start_wetness),
                              .film_nl = stays ? soil->retention_nl / 2 : 0,
                              .level_um = stays ? (double)settings->start_water_mm * 1e3 : 0};
    }
}

void ground_standing_fill(const ground_standing cells[GROUND_STANDING],
                          const virga_soil_gpu soils[VIRGA_GROUND_MATERIALS], virga_standing_gpu out[GROUND_STANDING])
{
    for (uint32_t i = 0; i < GROUND_STANDING; i++) {
        const double capacity = (double)soils[i % VIRGA_GROUND_MATERIALS].capacity_nl;
        out[i] = (virga_standing_gpu){.held = capacity > 0 ? (float)fmin(cells[i].held_nl / capacity, 1) : 1,
                                      .film_nl = (float)cells[i].film_nl,
                                      .level_um = (float)cells[i].level_um,
                                      .spots = (float)cells[i].spots};
    }
}
