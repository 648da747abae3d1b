/* check.c - `virga check`: whether a scene file can be rendered, before a farm finds out. */
#include "commands/commands.h"
#include "options.h"

#include "effect.h"
#include "exr.h"
#include "scene_file.h"
#include "shot/shot.h"

#include <assimp/cimport.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <stdio.h>
#include <stdlib.h>

static const option_row rows[] = {
    {"--set", 0, "KEY=VALUE", "override a key before the check, e.g. rain.rate_mm_h=50; may be given often", true},
};

void check_help(void)
{
    printf("virga check SCENE.yaml [--set KEY=VALUE]...\n\n"
           "Reads a scene file as `virga render` would: every key, type, range and unit, and every mesh and\n"
           "picture that it names. Prints what is in it, or one line with file, line and key of the first\n"
           "thing that is wrong.\n\n");
    options_print(rows, sizeof rows / sizeof rows[0]);
}

static bool check_mesh(const char *path)
{
    const struct aiScene *model = aiImportFile(path, 0);
    if (!model)
        return options_complain("check", "%s: %s", path, aiGetErrorString());
    unsigned triangles = 0;
    for (unsigned i = 0; i < model->mNumMeshes; i++)
        triangles += model->mMeshes[i]->mNumFaces;
    printf("  mesh         %s: %u meshes, %u faces\n", path, model->mNumMeshes, triangles);
    aiReleaseImport(model);
    return triangles > 0 || options_complain("check", "%s: has no faces", path);
}

static bool check_environment(const char *path)
{
    uint32_t width, height;
    float *pixels;
    char error[1024];
    if (!path)
        return true;
    if (!exr_read_rgb(path, &width, &height, &pixels, NULL, error, sizeof error))
        return options_complain("check", "%s", error);
    printf("  environment  %s: %u x %u\n", path, width, height);
    free(pixels);
    return true;
}

static bool check_material_map(const scene_file *scene)
{
    uint32_t width, height;
    uint8_t *texels;
    char error[1024];
    if (!shot_read_material_map(scene, &width, &height, &texels, error, sizeof error))
        return options_complain("check", "%s", error);
    if (!texels)
        return true;
    size_t mapped = 0;
    const size_t count = (size_t)width * height;
    for (size_t i = 0; i < count; i++)
        mapped += texels[i] != SHOT_MATERIAL_OF_MESH;
    printf("  material map %s: %u x %u, %u materials on %.3g %% of it\n", scene_ground_of(scene)->material_map.file,
           width, height, scene_ground_of(scene)->material_map.material_count, 100 * (double)mapped / (double)count);
    free(texels);
    return true;
}

static bool check_pane_files(const scene_file *scene)
{
    for (uint32_t i = 0; i < scene_glass_of(scene)->pane_count; i++) {
        uint32_t columns, rows;
        float *bumps = NULL;
        uint8_t *mask = NULL;
        char error[1024];
        if (!shot_read_bumps(scene, i, &columns, &rows, &bumps, error, sizeof error))
            return options_complain("check", "%s", error);
        if (bumps)
            printf("  bumps        %s: %u x %u\n", scene_glass_of(scene)->panes[i].bumps.file, columns, rows);
        free(bumps);
        if (!shot_read_mask(scene, i, &columns, &rows, &mask, error, sizeof error))
            return options_complain("check", "%s", error);
        if (mask)
            printf("  mask         %s: %u x %u\n", scene_glass_of(scene)->panes[i].mask, columns, rows);
        free(mask);
    }
    return true;
}

static bool check_files(const scene_file *scene)
{
    for (uint32_t i = 0; i < scene->mesh_count; i++)
        if (!check_mesh(scene->meshes[i].file))
            return false;
    return check_environment(scene->environment.file) && check_material_map(scene) && check_pane_files(scene);
}

static void print_ground(const scene_file *scene)
{
    const scene_ground *ground = scene_ground_of(scene);
    const scene_splash *splash = scene_splash_of(scene);
    if (ground->on)
        printf("  ground       %u x %u cells of %g m\n", ground->cells, ground->cells, ground->cell_m);
    else
        printf("  ground       off\n");
    if (splash->on)
        printf("  splash       %s, %s style, %u splashes, %u droplets\n", scene_splash_mode_name(splash->mode),
               scene_splash_style_name(splash->style), splash->max_splashes, splash->max_droplets);
    else
        printf("  splash       off\n");
}

static void print_panes(const scene_file *scene)
{
    for (uint32_t i = 0; i < scene_glass_of(scene)->pane_count; i++) {
        const scene_pane *pane = &scene_glass_of(scene)->panes[i];
        printf("  glass        %s: %s, %g x %g m, %s, %s style, %u wiper%s%s\n", pane->name,
               scene_pane_shape_name(pane->shape), pane->width_m, pane->height_m, scene_pane_kind_name(pane->kind),
               scene_pane_style_name(pane->style), pane->wiper_count, pane->wiper_count == 1 ? "" : "s",
               pane->follow == SCENE_PANE_CAMERA ? ", with the camera" : "");
    }
}

int check_run(int argc, char **argv)
{
    options parsed;
    scene_file *scene;
    char error[1024];
    if (!options_parse(&parsed, "check", rows, sizeof rows / sizeof rows[0], argc, argv))
        return EXIT_USAGE;
    if (parsed.argument_count != 1) {
        options_complain("check", "expected one scene file; see virga help check");
        return EXIT_USAGE;
    }
    if (!scene_file_load(parsed.arguments[0], tool_effect_sections, parsed.repeated, parsed.repeated_count, &scene,
                         error, sizeof error)) {
        fprintf(stderr, "%s\n", error);
        return EXIT_USAGE;
    }
    if (!shot_check_materials(scene, error, sizeof error) || !shot_check_panes(scene, error, sizeof error)) {
        options_complain("check", "%s", error);
        scene_file_free(scene);
        return EXIT_USAGE;
    }
    printf("%s\n", parsed.arguments[0]);
    printf("  frames       %u to %u at %g a second, %u x %u\n", scene->frames.first, scene->frames.last,
           scene->frames.fps, scene->frames.size[0], scene->frames.size[1]);
    if (scene->frames.preroll_s > 0)
        printf("  pre-roll     %g s of rain before frame %u\n", scene->frames.preroll_s, scene->frames.first);
    printf("  rain         %g mm/h, %u drops, seed %u\n", scene_rain_of(scene)->rate_mm_h,
           scene_rain_of(scene)->max_drops, scene_rain_of(scene)->seed);
    print_ground(scene);
    print_panes(scene);
    printf("  lights       %u\n", scene->light_count);
    const bool good = check_files(scene);
    scene_file_free(scene);
    if (good)
        printf("good\n");
    return good ? EXIT_OK : EXIT_USAGE;
}
