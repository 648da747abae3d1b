/* test_defaults.c - what a scene file leaves out is as the library has it: the defaults stand in both. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#include "effect.h"
#include "glass.h"
#include "ground.h"
#include "scene_file.h"
#include "splash.h"
#include "vehicles.h"
#include "water.h"

#include <virga/virga.h>

#define SAME(name)                            \
    if ((float)from->name != (float)def.name) \
    fail_msg(#name ": %.9g in scene files, %.9g in the library", (double)from->name, (double)def.name)

static scene_file *load_with(const char *const *overrides, size_t count)
{
    static const char text[] = "virga: 1\ncamera: {keys: [{position_m: [0, 2, 8], look_at_m: [0, 2, 0]}]}\n";
    char path[] = "/tmp/virga-defaults-XXXXXX", error[256];
    scene_file *scene = NULL;
    const int file = mkstemp(path);
    assert_true(file >= 0);
    assert_int_equal(write(file, text, sizeof text - 1), sizeof text - 1);
    close(file);
    if (!scene_file_load(path, tool_effect_sections, overrides, count, &scene, error, sizeof error))
        fail_msg("%s", error);
    unlink(path);
    return scene;
}

static scene_file *load(void)
{
    return load_with(NULL, 0);
}

static void splashes(void **state)
{
    (void)state;
    scene_file *scene = load();
    const scene_splash *from = scene_splash_of(scene);
    {
        const virga_splash_def def = virga_default_splash_def();
        SAME(max_splashes);
        SAME(max_droplets);
    }
    const virga_splash_settings def = virga_default_splash_settings();
    SAME(mode);
    SAME(style);
    SAME(droplet_range_m);
    SAME(bounce);
    SAME(pile_max_s);
    SAME(pile_max_m);
    SAME(dot_min_mm);
    SAME(gain);
    SAME(light_gain);
    SAME(min_width_px);
    SAME(soft_m);
    SAME(parts_px);
    SAME(hole_um);
    SAME(near_fade_m);
    scene_file_free(scene);
}

static void water(void **state)
{
    (void)state;
    scene_file *scene = load();
    const scene_water *from = scene_water_of(scene);
    const virga_water_settings def = virga_default_water_settings();
    SAME(kernel_spacings);
    SAME(level);
    SAME(style);
    SAME(shading);
    SAME(surfel_difference);
    SAME(surfel_divisions);
    SAME(kernel);
    SAME(smoothing);
    SAME(stretch);
    for (int c = 0; c < 3; c++) {
        SAME(absorption_1_m[c]);
        SAME(scattering_1_m[c]);
    }
    SAME(spray_density);
    SAME(spray_pieces);
    SAME(spray_speed_m_s);
    SAME(spray_pattern);
    SAME(foam_air_hz);
    SAME(foam_crest_hz);
    for (int i = 0; i < 2; i++) {
        SAME(foam_speed_m_s[i]);
        SAME(foam_air_m_s[i]);
        SAME(foam_crest[i]);
        SAME(foam_life_s[i]);
    }
    SAME(foam_radius_m);
    SAME(foam_rise_m_s);
    SAME(foam_drag_hz);
    SAME(foam_coverage);
    SAME(reflection);
    SAME(refraction);
    SAME(surfel_radius);
    SAME(soft_m);
    SAME(light_gain);
    assert_int_equal(SCENE_WATER_KERNEL_ISOTROPIC, VIRGA_WATER_KERNEL_ISOTROPIC);
    assert_int_equal(SCENE_WATER_KERNEL_ANISOTROPIC, VIRGA_WATER_KERNEL_ANISOTROPIC);
    assert_int_equal(SCENE_WATER_STYLE_PAPER, VIRGA_WATER_STYLE_PAPER);
    assert_int_equal(SCENE_WATER_STYLE_PHYSICAL, VIRGA_WATER_STYLE_PHYSICAL);
    assert_int_equal(SCENE_WATER_SHADING_PIXELS, VIRGA_WATER_SHADING_PIXELS);
    assert_int_equal(SCENE_WATER_SHADING_SURFELS, VIRGA_WATER_SHADING_SURFELS);
    assert_null(from->files);
    scene_file_free(scene);
}

static void solver(void **state)
{
    (void)state;
    const char *overrides[] = {"water={solver: {boxes: [{low_m: [0, 0, 0], high_m: [0.1, 0.1, 0.1]}]}}"};
    scene_file *scene = load_with(overrides, 1);
    const scene_solver *from = &scene_water_of(scene)->solver;
    {
        const virga_fluid_def def = virga_default_fluid_def();
        SAME(max_iterations);
    }
    const virga_fluid_settings def = virga_default_fluid_settings();
    SAME(spacing_m);
    SAME(viscosity_m2_s);
    SAME(cfl);
    SAME(solver_error);
    for (int axis = 0; axis < 3; axis++) {
        SAME(gravity_m_s2[axis]);
        assert_float_equal(from->walls.low_m[axis], def.low_m[axis], 0);
        assert_float_equal(from->walls.high_m[axis], def.high_m[axis], 0);
    }
    scene_file_free(scene);
}

/* Enumerations of scene files have the values of the library's. */
static void enumerations(void **state)
{
    (void)state;
    assert_int_equal(SCENE_SPLASH_MODE_PAPER, VIRGA_SPLASH_MODE_PAPER);
    assert_int_equal(SCENE_SPLASH_MODE_PHYSICAL, VIRGA_SPLASH_MODE_PHYSICAL);
    assert_int_equal(SCENE_SPLASH_STYLE_PAPER, VIRGA_SPLASH_STYLE_PAPER);
    assert_int_equal(SCENE_SPLASH_STYLE_FILM, VIRGA_SPLASH_STYLE_FILM);
}

static void ground(void **state)
{
    (void)state;
    scene_file *scene = load();
    const scene_ground *from = scene_ground_of(scene);
    {
        const virga_ground_def def = virga_default_ground_def();
        SAME(cells);
        SAME(cell_m);
        SAME(cached_tiles);
        SAME(far_cells);
    }
    const virga_ground_settings def = virga_default_ground_settings();
    SAME(evaporation_mm_h);
    SAME(start_wetness);
    SAME(start_water_mm);
    SAME(contact_droplets);
    SAME(stream_waves);
    SAME(wake_waves);
    scene_file_free(scene);
}

static void wheels(void **state)
{
    (void)state;
    const char *overrides[] = {
        "vehicles=[{keys: [{time_s: 0, position_m: [0, 0, 0]}], wheels: [{contact_m: [0, 0, 0]}]}]"};
    scene_file *scene = load_with(overrides, 1);
    const scene_wheel *from = &scene_vehicles_of(scene)->vehicles[0].wheels[0];
    const virga_wheel def = virga_default_wheel();
    SAME(radius_m);
    SAME(width_m);
    SAME(patch_m);
    SAME(open_deg);
    scene_file_free(scene);
}

static scene_file *load_pane(void)
{
    const char *overrides[] = {
        "glass=[{position_m: [0, 0, 0], wipers: [{pivot_m: [0, 0], reach_m: 0.6, blade_m: 0.5, "
        "low_deg: 5, high_deg: 95}], bumps: {file: /proc/self/exe, size_mm: [1, 1], depth_mm: 1}}]"};
    return load_with(overrides, 1);
}

static void panes(void **state)
{
    (void)state;
    scene_file *scene = load_pane();
    const scene_pane *from = &scene_glass_of(scene)->panes[0];
    const virga_glass_def def = virga_default_glass_def();
    SAME(width_m);
    SAME(height_m);
    SAME(cell_m);
    SAME(max_drops);
    SAME(affinity_size_m);
    SAME(max_texels);
    SAME(texture_columns);
    SAME(texture_rows);
    SAME(texture_texels);
    scene_file_free(scene);
}

static void water_of_panes(void **state)
{
    (void)state;
    scene_file *scene = load_pane();
    const scene_pane *from = &scene_glass_of(scene)->panes[0];
    const virga_glass_settings def = virga_default_glass_settings();
    SAME(drag);
    SAME(meander);
    SAME(path_ease);
    SAME(path_dry_s);
    SAME(merge_distance);
    SAME(tail_spacing_m);
    SAME(tail_lifetime_s);
    SAME(film_break_s);
    SAME(evaporation_mm_h);
    SAME(mist_max_mm);
    SAME(air_share);
    SAME(air_outward);
    SAME(particle_radius_mm);
    SAME(penalty);
    SAME(particle_band);
    SAME(hold_back_mm);
    SAME(hold_back_cells);
    SAME(density);
    SAME(blend);
    SAME(compress);
    SAME(compress_from);
    SAME(compress_step);
    SAME(compress_k);
    SAME(compress_steps);
    SAME(threshold);
    SAME(impact_s);
    scene_file_free(scene);
}

static void looks_of_panes(void **state)
{
    (void)state;
    scene_file *scene = load_pane();
    const scene_pane *from = &scene_glass_of(scene)->panes[0];
    const virga_glass_settings def = virga_default_glass_settings();
    SAME(style);
    SAME(textured_px);
    SAME(texture_shape);
    SAME(textures_per_frame);
    SAME(still_behind);
    SAME(veil);
    SAME(starburst);
    SAME(starburst_rays);
    SAME(starburst_deg);
    SAME(opening_blades);
    SAME(opening_roundness);
    SAME(opening_deg);
    SAME(paper_shift);
    SAME(thickness_mm);
    SAME(tint[0]);
    SAME(tint[2]);
    SAME(gain);
    scene_file_free(scene);
}

static void condensation_of_panes(void **state)
{
    (void)state;
    scene_file *scene = load_pane();
    const scene_condensation *from = &scene_glass_of(scene)->panes[0].condensation;
    const virga_glass_condensation def = virga_default_glass_settings().condensation;
    SAME(side);
    SAME(air_c);
    SAME(humidity);
    SAME(glass_c);
    SAME(heat_w_m2_k);
    SAME(droplets_per_mm2);
    SAME(drop_radius_mm);
    SAME(start_um);
    SAME(heater_k);
    SAME(heater_s);
    SAME(heater_wires);
    scene_file_free(scene);
}

static void wipers(void **state)
{
    (void)state;
    scene_file *scene = load_pane();
    {
        const scene_wiper *from = &scene_glass_of(scene)->panes[0].wipers[0];
        const virga_glass_wiper def = virga_default_glass_wiper();
        SAME(width_m);
        SAME(blade_deg);
        SAME(blade_hold_direction);
        SAME(drive);
        SAME(sweep_s);
        SAME(pause_s);
        SAME(phase_s);
        SAME(film_mm);
        SAME(wear);
    }
    assert_true((float)scene_glass_of(scene)->panes[0].bumps.affinity == virga_default_glass_shape().bump_affinity);
    scene_file_free(scene);
}

/* Enumerations of panes, and that the default kind is that of the library's default settings. */
static void enumerations_of_panes(void **state)
{
    (void)state;
    static const char *const kinds[VIRGA_GLASS_KINDS] = {
        [VIRGA_GLASS_KIND_PAPER] = "paper",   [VIRGA_GLASS_KIND_CLEAN] = "clean", [VIRGA_GLASS_KIND_DIRTY] = "dirty",
        [VIRGA_GLASS_KIND_COATED] = "coated", [VIRGA_GLASS_KIND_METAL] = "metal", [VIRGA_GLASS_KIND_LEAF] = "leaf"};
    for (uint32_t i = 0; i < VIRGA_GLASS_KINDS; i++)
        assert_string_equal(scene_pane_kind_name(i), kinds[i]);
    assert_string_equal(scene_pane_style_name(VIRGA_GLASS_STYLE_PAPER), "paper");
    assert_string_equal(scene_pane_style_name(VIRGA_GLASS_STYLE_PHYSICAL), "physical");
    assert_int_equal(SCENE_WIPER_PARKED, VIRGA_GLASS_PARKED);
    assert_int_equal(SCENE_WIPER_CONTINUOUS, VIRGA_GLASS_CONTINUOUS);
    assert_int_equal(SCENE_WIPER_INTERMITTENT, VIRGA_GLASS_INTERMITTENT);
    assert_int_equal(SCENE_WIPER_KEYS, VIRGA_GLASS_HOST);
    assert_int_equal(SCENE_FILE_MAX_PANES, VIRGA_SCENE_MAX_PANES);
    assert_int_equal(SCENE_FILE_MAX_WIPERS, VIRGA_GLASS_MAX_WIPERS);
    scene_file *scene = load_pane();
    const virga_glass_settings before = virga_default_glass_settings();
    virga_glass_settings after = before;
    virga_glass_apply_kind((virga_glass_kind)scene_glass_of(scene)->panes[0].kind, &after);
    assert_memory_equal(&before, &after, sizeof before);
    scene_file_free(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(splashes),       cmocka_unit_test(enumerations),
        cmocka_unit_test(ground),         cmocka_unit_test(wheels),
        cmocka_unit_test(panes),          cmocka_unit_test(water_of_panes),
        cmocka_unit_test(looks_of_panes), cmocka_unit_test(condensation_of_panes),
        cmocka_unit_test(wipers),         cmocka_unit_test(enumerations_of_panes),
        cmocka_unit_test(water),          cmocka_unit_test(solver),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
