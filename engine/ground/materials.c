/* ground/materials.c - how each material absorbs, holds and drains water.
 *
 * Capacity is what a surface absorbs in the first minutes, not what a column of soil holds. 0.1 to 0.5 mm wets a paved
 * surface: depression and wetting losses of impervious areas are 0.2 to 1.5 mm together, which is capacity + retention
 * here.
 *
 * Infiltration of soils is the saturated conductivity of Carsel and Parrish 1988: sand 712.8 cm/day, sandy loam 106.1
 * (lawn), silt loam 10.8 (trodden soil).
 *
 * Manning's n: paved surfaces .011 to .016, overland flow in grass .15. */
#include "ground/ground_internal.h"

#include "core/settings.h"

#define CM_DAY (10.0f / 24) /* mm/h */

/* clang-format off */
static const virga_ground_material table[] = {
    /*                            capacity retention infiltration   drying manning bumps  width drain */
    [VIRGA_MATERIAL_DEFAULT] =  {0.25f,   0.20f,    0.05f,          1.0f,  0.013f, 1.5f,  2.0f, false},
    [VIRGA_MATERIAL_ASPHALT] =  {0.15f,   0.35f,    0.20f,          1.0f,  0.014f, 3.0f,  2.4f, false},
    [VIRGA_MATERIAL_CONCRETE] = {0.25f,   0.15f,    0.05f,          1.0f,  0.013f, 1.5f,  2.0f, false},
    [VIRGA_MATERIAL_STONE] =    {0.10f,   0.20f,    0.10f,          1.0f,  0.015f, 1.5f,  0.8f, false},
    [VIRGA_MATERIAL_BRICK] =    {0.50f,   0.20f,    0.50f,          1.0f,  0.015f, 1.0f,  0.8f, false},
    [VIRGA_MATERIAL_GRASS] =    {3.00f,   3.00f,    106.1f * CM_DAY, 1.2f, 0.15f,  12.0f, 1.5f, false},
    [VIRGA_MATERIAL_SAND] =     {5.00f,   1.00f,    712.8f * CM_DAY, 1.0f, 0.025f, 8.0f,  1.0f, false},
    [VIRGA_MATERIAL_SOIL] =     {2.00f,   2.00f,    10.8f * CM_DAY, 1.0f,  0.03f,  8.0f,  1.5f, false},
    [VIRGA_MATERIAL_WOOD] =     {0.40f,   0.10f,    0.50f,          1.2f,  0.012f, 0.4f,  1.0f, false},
    [VIRGA_MATERIAL_STEEL] =    {0.00f,   0.03f,    0.00f,          1.5f,  0.012f, 0.2f,  1.0f, false},
    [VIRGA_MATERIAL_GLASS] =    {0.00f,   0.02f,    0.00f,          1.2f,  0.010f, 0.0f,  1.0f, false},
    [VIRGA_MATERIAL_WATER] =    {0.00f,   0.00f,    0.00f,          1.0f,  0.010f, 0.0f,  1.0f, false},
    [VIRGA_MATERIAL_LEAVES] =   {0.20f,   0.30f,    0.00f,          1.2f,  0.05f,  0.0f,  1.0f, false},
    [VIRGA_MATERIAL_CLOTH] =    {0.60f,   0.10f,    0.00f,          1.2f,  0.02f,  0.0f,  1.0f, false},
    [VIRGA_MATERIAL_PLASTIC] =  {0.00f,   0.05f,    0.00f,          1.2f,  0.011f, 0.2f,  1.0f, false},
    [VIRGA_MATERIAL_TILE] =     {0.02f,   0.03f,    0.00f,          1.2f,  0.011f, 0.4f,  1.0f, false},
    [VIRGA_MATERIAL_DRAIN] =    {0.00f,   0.00f,    0.00f,          1.0f,  0.011f, 0.0f,  1.0f, true},
};
/* clang-format on */

void ground_default_materials(virga_ground_material materials[VIRGA_GROUND_MATERIALS])
{
    for (uint32_t i = 0; i < VIRGA_GROUND_MATERIALS; i++)
        materials[i] = table[i < sizeof table / sizeof table[0] ? i : VIRGA_MATERIAL_DEFAULT];
}

#define MATERIAL(member, ...) \
    VIRGA_SETTING_ROW(ground_settings.materials, virga_ground_material, FLOAT, member, __VA_ARGS__)

/* clang-format off */
static const virga_setting_row rows[] = {
    MATERIAL(capacity_mm, 0, 100),
    MATERIAL(retention_mm, 0, 50),
    MATERIAL(infiltration_mm_h, 0, 10000),
    MATERIAL(drying, 0, 10),
    MATERIAL(manning_n, 0.005, 1),
    MATERIAL(bump_height_mm, 0, 50),
    MATERIAL(bump_width_m, 0.2, 50),
};
/* clang-format on */

virga_result ground_check_materials(const virga_log *log, virga_ground_material materials[VIRGA_GROUND_MATERIALS],
                                    bool *changed)
{
    for (uint32_t i = 0; i < VIRGA_GROUND_MATERIALS; i++)
        if (virga_settings_apply_rows(log, rows, VIRGA_ROWS(rows), &materials[i], changed))
            return VIRGA_ERROR_INVALID;
    return VIRGA_OK;
}

/* Converts millimetres on a cell to nanolitres: 1 mm on 1 m^2 is one litre. */
static double on_cell_nl(double mm, double cell_m)
{
    return mm * cell_m * cell_m * 1e9;
}

void ground_fill_soils(const virga_ground_settings *settings, double cell_m,
                       virga_soil_gpu soils[VIRGA_GROUND_MATERIALS])
{
    for (uint32_t i = 0; i < VIRGA_GROUND_MATERIALS; i++) {
        const virga_ground_material *m = &settings->materials[i];
        soils[i] = (virga_soil_gpu){.capacity_nl = (uint32_t)on_cell_nl((double)m->capacity_mm, cell_m),
                                    .retention_nl = (uint32_t)on_cell_nl((double)m->retention_mm, cell_m),
                                    .sink_nl_s = (float)on_cell_nl((double)m->infiltration_mm_h / 3600, cell_m),
                                    .drying = m->drying,
                                    .inv_manning = 1 / m->manning_n,
                                    .bumps_um = m->bump_height_mm * 1e3f,
                                    .bump_cells = (float)((double)m->bump_width_m / cell_m),
                                    .drain = m->drain};
    }
}
