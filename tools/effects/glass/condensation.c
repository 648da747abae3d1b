/* condensation.c - the fog of panes, from the scene file. */
#include "panes.h"
#include "scene_rows.h"

static const scene_row breath_rows[] = {
    NUMBER(scene_breath, time_s, -MAX_METERS, MAX_METERS, NULL, RESTARTS, "when it begins"),
    NUMBER(scene_breath, duration_s, 0.01, 60, "1", RESTARTS, "how long it lasts"),
    NUMBER(scene_breath, position_m, -20, 20, NULL, RESTARTS,
           "its middle: right and up from the lower left corner, seen from outside"),
    NUMBER(scene_breath, radius_m, 0.001, 10, "0.06", RESTARTS, "where its share of the air is 1/e of the middle's"),
    NUMBER(scene_breath, share, 0, 1, "0.7", RESTARTS, "of the air before the glass, in its middle"),
};
static const scene_group breath_group = SCENE_GROUP(scene_breath, breath_rows);

static const scene_keyword sides[] = {{"none", VIRGA_GLASS_FOG_NONE},
                                      {"outside", VIRGA_GLASS_FOG_OUTSIDE},
                                      {"inside", VIRGA_GLASS_FOG_INSIDE},
                                      {NULL, 0}};

/* Ranges and defaults are the library's own: virga/glass.h. */
static const scene_row rows[] = {
    CHOICE(scene_condensation, side, sides, "none", RESTARTS,
           "that fogs: outside is where it rains, and drops and blades clear it; none with style: front"),
    NUMBER(scene_condensation, air_c, -40, 60, "20", LIVE, "temperature of the air there"),
    NUMBER(scene_condensation, humidity, 0, 1, "0.5", LIVE, "of that air"),
    NUMBER(scene_condensation, glass_c, -40, 60, "15", LIVE, "of the glass; it fogs below the dew point of the air"),
    NUMBER(scene_condensation, heat_w_m2_k, 0, 500, "8", LIVE,
           "heat from air to glass: 4 in a room, 10 in a car, 30 before a fan"),
    NUMBER(scene_condensation, droplets_per_mm2, 1, 100000, "1000", LIVE, "that dry glass begins to fog with"),
    NUMBER(scene_condensation, drop_radius_mm, 0.1, 2, "0.5", LIVE, "from which droplets are drops that merge and run"),
    NUMBER(scene_condensation, start_um, 0, 500, "0", RESTARTS, "mean thickness of the fog at the start"),
    NUMBER(scene_condensation, heater_k, 0, 80, "0", LIVE, "by which a heater warms the glass in the end; 0: off"),
    NUMBER(scene_condensation, heater_s, 1, 3600, "300", LIVE, "time constant of that"),
    WHOLE(scene_condensation, heater_wires, 0, 64, "0", LIVE, "one above the other; 0: all of the glass is heated"),
    NUMBER(scene_condensation, heater_from_s, -MAX_METERS, MAX_METERS, "-3600", LIVE, "when the heater is switched on"),
    LIST(scene_condensation, breaths, breath_count, &breath_group, 0, VIRGA_GLASS_MAX_BREATHS, "[]",
         "of somebody before the pane, on the side that fogs"),
};
const scene_group scene_condensation_group = SCENE_GROUP(scene_condensation, rows);

void glass_fill_condensation(const scene_condensation *from, double time_s, virga_glass_condensation *to)
{
    to->side = (virga_glass_fog_side)from->side;
    to->air_c = (float)from->air_c;
    to->humidity = (float)from->humidity;
    to->glass_c = (float)from->glass_c;
    to->heat_w_m2_k = (float)from->heat_w_m2_k;
    to->droplets_per_mm2 = (float)from->droplets_per_mm2;
    to->drop_radius_mm = (float)from->drop_radius_mm;
    to->start_um = (float)from->start_um;
    to->heater_k = time_s >= from->heater_from_s ? (float)from->heater_k : 0;
    to->heater_s = (float)from->heater_s;
    to->heater_wires = from->heater_wires;
}

bool glass_breathe(shot *s, const glass_pane *pane, char *error, size_t error_size)
{
    const scene_condensation *from = &pane->from->condensation;
    if (from->side == VIRGA_GLASS_FOG_NONE)
        return true;
    for (uint32_t i = 0; i < from->breath_count; i++) {
        const scene_breath *breath = &from->breaths[i];
        /* The library's time begins with the pre-roll; what would end before it is not there. */
        const double start_s = breath->time_s + shot_preroll_s(s);
        const virga_glass_breath given = {.start_s = start_s > 0 ? start_s : 0,
                                          .duration_s = (float)(breath->duration_s + (start_s < 0 ? start_s : 0)),
                                          .position_m = {(float)breath->position_m[0], (float)breath->position_m[1]},
                                          .radius_m = (float)breath->radius_m,
                                          .share = (float)breath->share};
        if (given.duration_s > 0 &&
            !shot_ok(s, virga_glass_breathe(pane->glass, &given), "breathing on a pane", error, error_size))
            return false;
    }
    return true;
}
