/* rain/walls.c - water that driving rain brings to upright surfaces, see virga/walls.h. On the host, in whole
 * nanolitres per square metre. Like the size classes it has the same bits on every run. */
#include "rain/rain_internal.h"

#include "core/settings.h"

#include <virga/material.h>

#include <math.h>
#include <string.h>

#define NL_PER_MM  1e9   /* per square metre */
#define RUN_S      2.0   /* time in which a film loses what does not cling to the wall */
#define MEMORY_S   300.0 /* of the mean slant */
#define START_S    30.0  /* a step of the time before the first tick, */
#define MAX_STARTS 480   /* or more, so that there are no more than so many */
#define MAX_SLANT  8.0   /* as of the occlusion maps */
#define FULL_TURN  6.283185307179586
#define GUSTS      13

/* Pores: as of ground (engine/ground/materials.c). Films that cling to upright surfaces: 0.05 to 0.1 mm. The speed into
 * the depth is that of capillary absorption after an hour, A / (2 sqrt(t)), with the water absorption coefficients of
 * EN ISO 15148: brick 0.1 kg/(m^2 s^0.5), cement render 0.02, sandstone 0.02, spruce 0.006 (Kuenzel 1995). */
/* clang-format off */
static const virga_wall_material table[] = {
    /*                            pores  film   sink  drying */
    [VIRGA_MATERIAL_DEFAULT] =  {0.25f, 0.08f, 0.60f, 1.0f},
    [VIRGA_MATERIAL_ASPHALT] =  {0.15f, 0.10f, 0.20f, 1.0f},
    [VIRGA_MATERIAL_CONCRETE] = {0.25f, 0.08f, 0.60f, 1.0f},
    [VIRGA_MATERIAL_STONE] =    {0.20f, 0.08f, 0.60f, 1.0f},
    [VIRGA_MATERIAL_BRICK] =    {0.50f, 0.08f, 3.00f, 1.0f},
    [VIRGA_MATERIAL_GRASS] =    {1.00f, 0.10f, 0.00f, 1.2f},
    [VIRGA_MATERIAL_SAND] =     {5.00f, 0.10f, 3.00f, 1.0f},
    [VIRGA_MATERIAL_SOIL] =     {2.00f, 0.10f, 3.00f, 1.0f},
    [VIRGA_MATERIAL_WOOD] =     {0.40f, 0.06f, 0.18f, 1.2f},
    [VIRGA_MATERIAL_STEEL] =    {0.00f, 0.05f, 0.00f, 1.5f},
    [VIRGA_MATERIAL_GLASS] =    {0.00f, 0.05f, 0.00f, 1.2f},
    [VIRGA_MATERIAL_WATER] =    {0.00f, 0.00f, 0.00f, 1.0f},
    [VIRGA_MATERIAL_LEAVES] =   {0.05f, 0.08f, 0.00f, 1.2f},
    [VIRGA_MATERIAL_CLOTH] =    {0.40f, 0.10f, 0.00f, 1.2f},
    [VIRGA_MATERIAL_PLASTIC] =  {0.00f, 0.05f, 0.00f, 1.2f},
    [VIRGA_MATERIAL_TILE] =     {0.02f, 0.05f, 0.00f, 1.2f},
    [VIRGA_MATERIAL_DRAIN] =    {0.00f, 0.05f, 0.00f, 1.0f},
};
/* clang-format on */

#define MATERIAL(member, ...) \
    VIRGA_SETTING_ROW(rain_settings.walls.materials, virga_wall_material, FLOAT, member, __VA_ARGS__)

static const virga_setting_row rows[] = {
    MATERIAL(capacity_mm, 0, 100),
    MATERIAL(film_mm, 0, 5),
    MATERIAL(sink_mm_h, 0, 1000),
    MATERIAL(drying, 0, 10),
};

void rain_walls_default(virga_wall_material materials[VIRGA_WALL_MATERIALS])
{
    for (uint32_t i = 0; i < VIRGA_WALL_MATERIALS; i++)
        materials[i] = table[i < sizeof table / sizeof table[0] ? i : VIRGA_MATERIAL_DEFAULT];
}

virga_result rain_walls_check(const virga_log *log, virga_wall_material materials[VIRGA_WALL_MATERIALS], bool *changed)
{
    for (uint32_t i = 0; i < VIRGA_WALL_MATERIALS; i++)
        if (virga_settings_apply_rows(log, rows, VIRGA_ROWS(rows), &materials[i], changed))
            return VIRGA_ERROR_INVALID;
    return VIRGA_OK;
}

/* ---- what hits a wall */

void rain_walls_flux(const rain_classes *classes, double share, double mm_s[VIRGA_WALL_ROWS])
{
    memset(mm_s, 0, VIRGA_WALL_ROWS * sizeof mm_s[0]);
    for (uint32_t k = 0; k < VIRGA_RAIN_CLASSES; k++) {
        const rain_class *c = &classes->classes[k];
        const double mm = 1e3 * classes->per_m3[k] * virga_drop_volume(c->diameter_m); /* of water, by m of path */
        mm_s[VIRGA_WALL_LEVEL] += mm * fmax(-c->velocity[1], 0);
        for (uint32_t i = 0; i < VIRGA_WALL_SIDES; i++) {
            const double turn = FULL_TURN * i / VIRGA_WALL_SIDES;
            mm_s[i] += share * mm * fmax(-(c->velocity[0] * cos(turn) + c->velocity[2] * sin(turn)), 0);
        }
    }
}

/* Moments of the slants, weighted by the water that the drops bring to a wall; a little also without wind. */
static void add_slants(const rain_classes *classes, double weight, double sums[4])
{
    for (uint32_t k = 0; k < VIRGA_RAIN_CLASSES; k++) {
        const rain_class *c = &classes->classes[k];
        const double down = fmax(-c->velocity[1], 0.05);
        double slant[2], square = 0;
        for (int axis = 0; axis < 2; axis++) {
            slant[axis] = fmin(fmax(c->velocity[2 * axis] / down, -MAX_SLANT), MAX_SLANT);
            square += slant[axis] * slant[axis];
        }
        const double water = weight * classes->per_m3[k] * pow(c->diameter_m, 3) * down * (sqrt(square) + 0.02);
        sums[0] += water;
        sums[1] += water * slant[0];
        sums[2] += water * slant[1];
        sums[3] += water * square;
    }
}

/* ---- what becomes of it */

static uint64_t nl_of(double nl)
{
    return nl > 0 ? (uint64_t)llround(nl) : 0;
}

static uint64_t least(uint64_t a, uint64_t b)
{
    return a < b ? a : b;
}

/* What came fills the pores first (soak.glsl). It dries as the cells of ground do (flow.comp): first the film, then
 * more and more slowly the pores. */
static void wet(rain_wall *wall, const virga_wall_material *m, uint64_t fell_nl, double evaporation_mm_h, double s)
{
    const uint64_t capacity = nl_of((double)m->capacity_mm * NL_PER_MM), held = nl_of((double)m->film_mm * NL_PER_MM);
    wall->film_nl += fell_nl;
    wall->ways_nl[RAIN_WALL_FELL] += fell_nl;
    const uint64_t soaked = least(wall->film_nl, capacity - least(wall->pores_nl, capacity));
    wall->film_nl -= soaked;
    wall->pores_nl += soaked;
    const double full = capacity ? (double)wall->pores_nl / (double)capacity : 0;
    const uint64_t sunk = least(nl_of((double)m->sink_mm_h * fmin(full, 1) * NL_PER_MM * s / 3600), wall->pores_nl);
    wall->pores_nl -= sunk;
    const double share = wall->film_nl ? 1 : fmin(full, 1);
    const uint64_t wanted = nl_of(evaporation_mm_h * (double)m->drying * share * NL_PER_MM * s / 3600);
    const uint64_t from_film = least(wanted, wall->film_nl), from_pores = least(wanted - from_film, wall->pores_nl);
    wall->film_nl -= from_film;
    wall->pores_nl -= from_pores;
    const uint64_t above = wall->film_nl - least(wall->film_nl, held);
    const uint64_t ran = least(nl_of((double)above * (1 - exp(-s / RUN_S))), above);
    wall->film_nl -= ran;
    wall->ways_nl[RAIN_WALL_SUNK] += sunk;
    wall->ways_nl[RAIN_WALL_DRIED] += from_film + from_pores;
    wall->ways_nl[RAIN_WALL_RAN_OFF] += ran;
}

static void wet_all(rain_walls *walls, const virga_walls_settings *settings, const double mm_s[VIRGA_WALL_ROWS],
                    double s)
{
    for (uint32_t row = 0; row < VIRGA_WALL_ROWS; row++) {
        walls->mm_s[row] = mm_s[row];
        const uint64_t fell = nl_of(mm_s[row] * NL_PER_MM * s);
        for (uint32_t i = 0; i < VIRGA_WALL_MATERIALS; i++)
            wet(&walls->walls[row][i], &settings->materials[i], fell, (double)settings->evaporation_mm_h, s);
    }
}

/* ---- time */

static double gust_at(int i)
{
    return 0.5 * (i - GUSTS / 2);
}

/* Means over the gusts, which are normally distributed (wind.c), in steps of half a deviation: a wall that the wind
 * blows along gets rain from half of them. Drops follow the wind, as gusts last for seconds. Vertical gusts nearly
 * cancel out. */
static void average(const rain_classes *classes, const virga_rain_settings *settings, double mm_s[VIRGA_WALL_ROWS],
                    double sums[4])
{
    double weights[GUSTS], whole = 0;
    for (int i = 0; i < GUSTS; i++) {
        weights[i] = exp(-0.5 * gust_at(i) * gust_at(i));
        whole += weights[i];
    }
    rain_classes at = *classes;
    memset(mm_s, 0, VIRGA_WALL_ROWS * sizeof mm_s[0]);
    for (int i = 0; i < GUSTS * GUSTS; i++) {
        const int x = i % GUSTS, z = i / GUSTS;
        const double gust = (double)settings->gust_m_s, weight = weights[x] * weights[z] / (whole * whole);
        const double wind[3] = {(double)settings->wind_m_s[0] + gust * gust_at(x), (double)settings->wind_m_s[1],
                                (double)settings->wind_m_s[2] + gust * gust_at(z)};
        double flux[VIRGA_WALL_ROWS];
        rain_classes_settle(&at, wind);
        rain_walls_flux(&at, (double)settings->walls.share, flux);
        for (uint32_t row = 0; row < VIRGA_WALL_ROWS; row++)
            mm_s[row] += weight * flux[row];
        add_slants(&at, weight, sums);
    }
}

void rain_walls_begin(rain_walls *walls, const rain_classes *classes, const virga_rain_settings *settings)
{
    const double start_s = (double)settings->walls.start_h * 3600, step_s = fmax(START_S, start_s / MAX_STARTS);
    double mm_s[VIRGA_WALL_ROWS];
    memset(walls, 0, sizeof *walls);
    average(classes, settings, mm_s, walls->slants);
    for (double left_s = start_s; left_s > 1e-3; left_s -= step_s)
        wet_all(walls, &settings->walls, mm_s, fmin(left_s, step_s));
}

void rain_walls_tick(rain_walls *walls, const rain_classes *classes, const virga_rain_settings *settings, double tick_s)
{
    double mm_s[VIRGA_WALL_ROWS];
    rain_walls_flux(classes, (double)settings->walls.share, mm_s);
    wet_all(walls, &settings->walls, mm_s, tick_s);
    for (int i = 0; i < 4; i++)
        walls->slants[i] *= exp(-tick_s / MEMORY_S);
    add_slants(classes, 1 - exp(-tick_s / MEMORY_S), walls->slants);
}

/* ---- what others read */

static virga_wall_gpu row_of(const rain_wall *wall, const virga_wall_material *m, double mm_s)
{
    const double pores = (double)wall->pores_nl / NL_PER_MM, film = (double)wall->film_nl / NL_PER_MM;
    const double held = (double)m->film_mm, full = m->capacity_mm > 0 ? pores / (double)m->capacity_mm : film / held;
    return (virga_wall_gpu){.wet = m->capacity_mm > 0 || m->film_mm > 0 ? (float)fmin(full, 1) : 0,
                            .film_mm = (float)film,
                            .run_mm_h = (float)(fmax(film - held, 0) / RUN_S * 3600),
                            .fall_mm_h = (float)(mm_s * 3600)};
}

void virga_rain_walls_get(const virga_rain *rain, virga_walls *walls)
{
    if (!walls)
        return;
    memset(walls, 0, sizeof *walls);
    if (!rain)
        return;
    const rain_walls *from = &rain->walls;
    for (uint32_t row = 0; row < VIRGA_WALL_ROWS; row++)
        for (uint32_t i = 0; i < VIRGA_WALL_MATERIALS; i++)
            walls->rows[row][i] = row_of(&from->walls[row][i], &rain->settings.walls.materials[i], from->mm_s[row]);
    const double *sums = from->slants;
    if (!(sums[0] > 0))
        return;
    const double x = sums[1] / sums[0], z = sums[2] / sums[0];
    walls->slant[0] = (float)x;
    walls->slant[1] = (float)z;
    walls->spread = (float)sqrt(fmax(sums[3] / sums[0] - x * x - z * z, 0) / 2);
}

void virga_rain_wall_water_get(const virga_rain *rain, uint32_t row, uint32_t material, virga_wall_water *water)
{
    if (!water)
        return;
    memset(water, 0, sizeof *water);
    if (!rain || row >= VIRGA_WALL_ROWS)
        return;
    const rain_wall *wall =
        &rain->walls.walls[row][material < VIRGA_WALL_MATERIALS ? material : VIRGA_WALL_MATERIALS - 1];
    *water = (virga_wall_water){.fell_nl = wall->ways_nl[RAIN_WALL_FELL],
                                .pores_nl = wall->pores_nl,
                                .film_nl = wall->film_nl,
                                .dried_nl = wall->ways_nl[RAIN_WALL_DRIED],
                                .sunk_nl = wall->ways_nl[RAIN_WALL_SUNK],
                                .ran_off_nl = wall->ways_nl[RAIN_WALL_RAN_OFF]};
}
