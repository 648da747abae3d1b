/* test_defaults.c - what a scene file leaves out is as the library has it: the defaults stand in both. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#include "scene_file.h"

#include <virga/virga.h>

#define SAME(name)                                                                                       \
    if ((float)from->name != (float)def.name)                                                            \
    fail_msg(#name ": %.9g in scene files, %.9g in the library", (double)from->name, (double)def.name)

static scene_file *load(void)
{
    static const char text[] = "virga: 1\ncamera: {keys: [{position_m: [0, 2, 8], look_at_m: [0, 2, 0]}]}\n";
    char path[] = "/tmp/virga-defaults-XXXXXX", error[256];
    scene_file *scene = NULL;
    const int file = mkstemp(path);
    assert_true(file >= 0);
    assert_int_equal(write(file, text, sizeof text - 1), sizeof text - 1);
    close(file);
    if (!scene_file_load(path, NULL, 0, &scene, error, sizeof error))
        fail_msg("%s", error);
    unlink(path);
    return scene;
}

static void splashes(void **state)
{
    (void)state;
    scene_file *scene = load();
    const scene_splash *from = &scene->splash;
    {
        const virga_splash_def def = virga_default_splash_def();
        SAME(max_splashes);
        SAME(max_droplets);
    }
    const virga_splash_settings def = virga_default_splash_settings();
    SAME(mode);
    SAME(style);
    SAME(droplets_m);
    SAME(bounce);
    SAME(pile_s);
    SAME(pile_m);
    SAME(dot_mm);
    SAME(gain);
    SAME(light_gain);
    SAME(min_width_px);
    SAME(soft_m);
    SAME(near_m);
    scene_file_free(scene);
}

/* Words of scene files are numbers of the library. */
static void words(void **state)
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
    const scene_ground *from = &scene->ground;
    {
        const virga_ground_def def = virga_default_ground_def();
        SAME(cells);
        SAME(cell_m);
        SAME(kept_tiles);
    }
    const virga_ground_settings def = virga_default_ground_settings();
    SAME(evaporation_mm_h);
    SAME(start_wetness);
    SAME(start_water_mm);
    scene_file_free(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(splashes), cmocka_unit_test(words), cmocka_unit_test(ground)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
