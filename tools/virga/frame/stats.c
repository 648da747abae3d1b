/* stats.c - a frame's object in stats.jsonl. */
#include "frame/files.h"

#include "words.h"

/* The budget: start + rained_total = elsewhere + absorbed + film + puddle + run_off + evaporated + kept + forgotten +
 * aloft, to the last nanolitre. What is aloft flew up in splashes and has not fallen back. */
static void write_water(shot *s, jsonl *stats, const virga_rain_stats *rain)
{
    static const char *const states[VIRGA_GROUND_STATES] = {"none",       "dry",        "wet",
                                                            "puddle_3mm", "puddle_5mm", "puddle_10mm"};
    virga_ground_stats g;
    virga_ground_stats_get(s->ground, &g);
    jsonl_begin_object(stats, "water_ul");
    jsonl_number(stats, "rained", (double)rain->impact_water_nl * 1e-3);
    jsonl_number(stats, "rained_total", (double)rain->total_water_nl * 1e-3);
    if (s->ground) {
        jsonl_number(stats, "start", (double)g.start_nl * 1e-3);
        jsonl_number(stats, "elsewhere", (double)g.elsewhere_nl * 1e-3);
        jsonl_number(stats, "absorbed", (double)(g.held_nl + g.infiltrated_nl) * 1e-3);
        jsonl_number(stats, "film", (double)g.film_nl * 1e-3);
        jsonl_number(stats, "puddle", (double)g.puddles_nl * 1e-3);
        jsonl_number(stats, "run_off", (double)g.run_off_nl * 1e-3);
        jsonl_number(stats, "evaporated", (double)g.evaporated_nl * 1e-3);
        jsonl_number(stats, "kept", (double)g.kept_nl * 1e-3);
        jsonl_number(stats, "forgotten", (double)g.forgotten_nl * 1e-3);
        jsonl_number(stats, "aloft", (double)(g.flown_nl - g.returned_nl) * 1e-3);
    }
    jsonl_end(stats);
    if (!s->ground)
        return;
    jsonl_begin_object(stats, "cells");
    for (uint32_t i = 0; i < VIRGA_GROUND_STATES; i++)
        jsonl_uint64(stats, states[i], g.cells[i]);
    jsonl_end(stats);
}

/* Splashes of a model by what they are on. Materials without a name count as the default one. */
static void write_materials(jsonl *stats, uint32_t model, const uint64_t counts[VIRGA_GROUND_MATERIALS])
{
    const char *other = host_material_name(0);
    jsonl_begin_object(stats, host_splash_model_name(model));
    for (uint32_t i = 0; i < VIRGA_GROUND_MATERIALS; i++) {
        uint64_t count = counts[i];
        if (i && host_material_name(i) == other)
            continue;
        for (uint32_t more = 1; !i && more < VIRGA_GROUND_MATERIALS; more++)
            count += host_material_name(more) == other ? counts[more] : 0;
        if (count)
            jsonl_uint64(stats, host_material_name(i), count);
    }
    jsonl_end(stats);
}

static void write_splash(shot *s, jsonl *stats)
{
    virga_splash_stats splash;
    if (!s->splash)
        return;
    virga_splash_stats_get(s->splash, &splash);
    jsonl_begin_object(stats, "splash");
    jsonl_begin_object(stats, "splashes");
    for (uint32_t model = VIRGA_SPLASH_NONE + 1; model < VIRGA_SPLASH_MODELS; model++)
        write_materials(stats, model, splash.splashes[model]);
    jsonl_end(stats);
    jsonl_uint64(stats, "splashes_alive", splash.splashes_alive);
    jsonl_uint64(stats, "droplets_alive", splash.droplets_alive);
    jsonl_uint64(stats, "droplets", splash.droplets);
    jsonl_uint64(stats, "fallen", splash.fallen);
    jsonl_uint64(stats, "crowded", splash.crowded);
    jsonl_uint64(stats, "sprites", splash.sprites);
    jsonl_end(stats);
}

/* The budget of a pane: landed = drops + particles + film + wiped + run_off + evaporated, to the last nanolitre. */
static void write_pane(const shot_pane *pane, jsonl *stats)
{
    virga_glass_stats g;
    virga_glass_stats_get(pane->glass, &g);
    jsonl_begin_object(stats, NULL);
    jsonl_string(stats, "name", pane->from->name);
    jsonl_uint64(stats, "drops", g.drops);
    jsonl_uint64(stats, "particles", g.particles);
    jsonl_uint64(stats, "held", g.held);
    jsonl_uint64(stats, "arrived", g.arrived);
    jsonl_uint64(stats, "merged", g.merged);
    jsonl_uint64(stats, "to_particles", g.to_particles);
    jsonl_uint64(stats, "to_drops", g.to_drops);
    jsonl_uint64(stats, "crowded", g.crowded);
    jsonl_uint64(stats, "balls", g.balls);
    jsonl_uint64(stats, "balls_cut", g.balls_cut);
    jsonl_begin_object(stats, "water_ul");
    jsonl_number(stats, "landed", (double)g.landed_nl * 1e-3);
    jsonl_number(stats, "drops", (double)g.drops_nl * 1e-3);
    jsonl_number(stats, "particles", (double)g.particles_nl * 1e-3);
    jsonl_number(stats, "film", (double)g.film_nl * 1e-3);
    jsonl_number(stats, "wiped", (double)g.wiped_nl * 1e-3);
    jsonl_number(stats, "run_off", (double)g.run_off_nl * 1e-3);
    jsonl_number(stats, "evaporated", (double)g.evaporated_nl * 1e-3);
    jsonl_end(stats);
    jsonl_end(stats);
}

static void write_panes(const shot *s, jsonl *stats)
{
    if (!scene_glass_of(s->scene)->pane_count)
        return;
    jsonl_begin_array(stats, "glass");
    for (uint32_t i = 0; i < scene_glass_of(s->scene)->pane_count; i++)
        write_pane(&s->panes[i], stats);
    jsonl_end(stats);
}

static void write_rain(const shot *s, jsonl *stats, const virga_rain_stats *rain)
{
    jsonl_begin_object(stats, "rain");
    jsonl_number(stats, "rate_mm_h", (double)s->settings.rate_mm_h);
    jsonl_uint64(stats, "slots", rain->slots);
    jsonl_uint64(stats, "streaks", rain->streaks);
    jsonl_uint64(stats, "impacts", rain->impacts);
    jsonl_uint64(stats, "impacts_dropped", rain->impacts_dropped);
    jsonl_number(stats, "bodies_radius_m", (double)rain->bodies_radius_m);
    jsonl_begin_array(stats, "wind_m_s");
    for (int axis = 0; axis < 3; axis++)
        jsonl_number(stats, NULL, (double)rain->wind_m_s[axis]);
    jsonl_end(stats);
    jsonl_end(stats);
}

bool frame_write_stats(shot *s, jsonl *stats, uint32_t frame, char *error, size_t error_size)
{
    virga_rain_stats rain;
    virga_pass_time times[64];
    virga_memory_stats memory;
    virga_rain_stats_get(s->rain, &rain);
    virga_memory_get(s->context, &memory);
    const uint32_t passes = virga_timings_get(s->context, times, 64);
    jsonl_begin(stats);
    jsonl_uint64(stats, "frame", frame);
    jsonl_number(stats, "time_s", shot_time(s, frame));
    write_rain(s, stats, &rain);
    write_splash(s, stats);
    write_panes(s, stats);
    write_water(s, stats, &rain);
    jsonl_begin_object(stats, "milliseconds");
    for (uint32_t i = 0; i < passes; i++)
        jsonl_number(stats, times[i].name, times[i].milliseconds);
    jsonl_end(stats);
    jsonl_uint64(stats, "device_bytes", memory.device_bytes);
    return jsonl_end_line(stats, error, error_size);
}
