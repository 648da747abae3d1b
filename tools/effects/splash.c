/* splash.c - what the program knows of splashes. */
#include "splash.h"

#include "effect.h"
#include "ground.h"
#include "scene_rows.h"

/* ---- keys of scene files -------------------------------------------------------------------------------------- */

static const cyaml_strval_t splash_modes[] = {
    {"paper", SCENE_SPLASH_MODE_PAPER},
    {"physical", SCENE_SPLASH_MODE_PHYSICAL},
};
static const cyaml_strval_t splash_styles[] = {
    {"paper", SCENE_SPLASH_STYLE_PAPER},
    {"film", SCENE_SPLASH_STYLE_FILM},
};
static const cyaml_schema_field_t splash_fields[] = {
    SWITCH(scene_splash, on),
    CHOICE(scene_splash, mode, splash_modes),
    CHOICE(scene_splash, style, splash_styles),
    WHOLE(scene_splash, max_splashes),
    WHOLE(scene_splash, max_droplets),
    NUMBER(scene_splash, droplets_m),
    NUMBER(scene_splash, bounce),
    NUMBER(scene_splash, pile_s),
    NUMBER(scene_splash, pile_m),
    NUMBER(scene_splash, dot_mm),
    NUMBER(scene_splash, gain),
    NUMBER(scene_splash, light_gain),
    NUMBER(scene_splash, min_width_px),
    NUMBER(scene_splash, soft_m),
    NUMBER(scene_splash, near_m),
    CYAML_FIELD_END,
};

/* Ranges and defaults are the library's own: virga/splash.h. */
static const scene_rule splash_rules[] = {
    {"splash", 0, 0, "{}", RESTARTS, "splashes on the ground"},
    {"splash.on", 0, 0, "@ground.on", RESTARTS, "drops splash where they land on the ground"},
    {"splash.mode", 0, 0, "physical", LIVE,
     "physical: by the drop's Weber number; paper: by the tables of Mizukami et al."},
    {"splash.style", 0, 0, "film", LIVE, "film: sheets, necks and lenses; paper: pyramids and spheres"},
    {"splash.max_splashes", 256, 1048576, "65536", RESTARTS, "alive at once; the oldest make room; 64 bytes each"},
    {"splash.max_droplets", 256, 4194304, "131072", RESTARTS, "in the air at once; 264 bytes each"},
    {"splash.droplets_m", 0, 1000, "2.5", LIVE, "splashes nearer than this have droplets"},
    {"splash.bounce", 0, 1, "0.25", LIVE, "share of the drop's velocity along the surface that its droplets keep"},
    {"splash.pile_s", 0.001, 0.2, "0.012", LIVE, "a pile that is older lets its droplet go"},
    {"splash.pile_m", 0.001, 0.2, "0.008", LIVE, "a pile that is longer lets its droplet go"},
    {"splash.dot_mm", 0.05, 5, "0.5", LIVE, "droplets as large make a dot where they fall"},
    {"splash.gain", 0, 100, "1", LIVE, "multiplies coverage; 1 is what a camera records"},
    {"splash.light_gain", 0, 100, "1", LIVE, "multiplies the light of lamps in splashes"},
    {"splash.min_width_px", 0.5, 4, "1", LIVE, "narrower things are drawn this wide with less coverage"},
    {"splash.soft_m", 0, 1, "0.002", LIVE, "splashes fade over this depth where they meet geometry"},
    {"splash.near_m", 0, 5, "0.05", LIVE, "what is nearer to the camera fades out"},
};

/* ---- what one value alone does not show ----------------------------------------------------------------------- */

static bool check_splash(const scene_file *scene, char *error, size_t error_size)
{
    return !scene_splash_of(scene)->on || scene_ground_of(scene)->on ||
           scene_file_refuse(scene, "splash.on", error, error_size,
                             "expected ground.on: true too, as it is the ground that drops splash on");
}

/* ---- the effect ----------------------------------------------------------------------------------------------- */

const tool_effect splash_effect = {
    .name = "splash",
    .scene =
        {
            .field = GROUP_SECTION("splash", scene_splash, splash_fields),
            .size = sizeof(scene_splash),
            .rules = splash_rules,
            .rule_count = CYAML_ARRAY_LEN(splash_rules),
            .check = check_splash,
        },
};

scene_splash *scene_splash_of(const scene_file *scene)
{
    return scene_file_section(scene, &splash_effect.scene);
}

const char *scene_splash_mode_name(uint32_t mode)
{
    return scene_choice_keyword(splash_modes, CYAML_ARRAY_LEN(splash_modes), mode);
}

const char *scene_splash_style_name(uint32_t style)
{
    return scene_choice_keyword(splash_styles, CYAML_ARRAY_LEN(splash_styles), style);
}
