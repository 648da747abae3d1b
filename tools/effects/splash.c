/* splash.c - what the program knows of splashes. */
#include "splash.h"

#include "effect.h"
#include "ground.h"
#include "scene_rows.h"

/* ---- keys of scene files -------------------------------------------------------------------------------------- */

/* Ranges and defaults are the library's own: virga/splash.h. */

static const scene_keyword splash_modes[] = {
    {"paper", SCENE_SPLASH_MODE_PAPER}, {"physical", SCENE_SPLASH_MODE_PHYSICAL}, {NULL, 0}};
static const scene_keyword splash_styles[] = {
    {"paper", SCENE_SPLASH_STYLE_PAPER}, {"film", SCENE_SPLASH_STYLE_FILM}, {NULL, 0}};
static const scene_row splash_rows[] = {
    SWITCH(scene_splash, on, "@ground.on", RESTARTS, "drops splash where they land on the ground"),
    CHOICE(scene_splash, mode, splash_modes, "physical", LIVE,
           "physical: by the drop's Weber number; paper: by the tables of Mizukami et al."),
    CHOICE(scene_splash, style, splash_styles, "film", LIVE,
           "film: sheets, necks and lenses; paper: pyramids and spheres"),
    WHOLE(scene_splash, max_splashes, 256, 1048576, "65536", RESTARTS,
          "alive at once; the oldest make room; 64 bytes each"),
    WHOLE(scene_splash, max_droplets, 256, 4194304, "131072", RESTARTS, "in the air at once; 264 bytes each"),
    NUMBER(scene_splash, droplets_m, 0, 1000, "2.5", LIVE, "splashes nearer than this have droplets"),
    NUMBER(scene_splash, bounce, 0, 1, "0.25", LIVE,
           "share of the drop's velocity along the surface that its droplets keep"),
    NUMBER(scene_splash, pile_s, 0.001, 0.2, "0.012", LIVE, "a pile that is older lets its droplet go"),
    NUMBER(scene_splash, pile_m, 0.001, 0.2, "0.008", LIVE, "a pile that is longer lets its droplet go"),
    NUMBER(scene_splash, dot_mm, 0.05, 5, "0.5", LIVE, "droplets as large make a dot where they fall"),
    NUMBER(scene_splash, gain, 0, 100, "1", LIVE, "multiplies coverage; 1 is what a camera records"),
    NUMBER(scene_splash, light_gain, 0, 100, "1", LIVE, "multiplies the light of lamps in splashes"),
    NUMBER(scene_splash, min_width_px, 0.5, 4, "1", LIVE, "narrower things are drawn this wide with less coverage"),
    NUMBER(scene_splash, soft_m, 0, 1, "0.002", LIVE, "splashes fade over this depth where they meet geometry"),
    NUMBER(scene_splash, near_m, 0, 5, "0.05", LIVE, "what is nearer to the camera fades out"),
};
static const scene_group splash_group = SCENE_GROUP(scene_splash, splash_rows);

/* The section has one key: all of the struct. */
static const scene_row splash_section[] = {SECTION_GROUP("splash", &splash_group, "splashes on the ground")};

/* ---- what one value alone does not show ----------------------------------------------------------------------- */

static bool check_splash(const scene_file *scene, char *error, size_t error_size)
{
    return !scene_splash_of(scene)->on || scene_ground_of(scene)->on ||
           scene_file_refuse(scene, "splash.on", error, error_size,
                             "expected ground.on: true too, as it is the ground that drops splash on");
}

const char *scene_splash_mode_name(uint32_t mode)
{
    return scene_keyword_name(splash_modes, mode);
}

const char *scene_splash_style_name(uint32_t style)
{
    return scene_keyword_name(splash_styles, style);
}

/* ---- the effect ----------------------------------------------------------------------------------------------- */

scene_splash *scene_splash_of(const scene_file *scene)
{
    return scene_file_section(scene, &splash_effect.scene);
}

const tool_effect splash_effect = {
    .name = "splash",
    .scene = {.group = SCENE_GROUP(scene_splash, splash_section), .check = check_splash},
};
