/* check.c - `virga check`: whether a scene file can be rendered, before a farm finds out. */
#include "commands/commands.h"
#include "options.h"

#include "effect.h"
#include "exr.h"
#include "scene_file.h"
#include "shot/focus.h"
#include "shot/path.h"
#include "shot/shot.h"

#include <assimp/cimport.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const option_row rows[] = {
    {"--set", 0, "KEY=VALUE", "override a key before the check, e.g. rain.rate_mm_h=50. May be repeated", true},
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

/* ---- what the camera focuses on */

static bool node_has(const struct aiNode *node, const char *name)
{
    if (strcasestr(node->mName.data, name))
        return true;
    for (unsigned i = 0; i < node->mNumChildren; i++)
        if (node_has(node->mChildren[i], name))
            return true;
    return false;
}

static bool model_has(const char *path, const char *name)
{
    const struct aiScene *model = aiImportFile(path, 0);
    bool found = model && model->mRootNode && node_has(model->mRootNode, name);
    for (unsigned i = 0; model && i < model->mNumMeshes; i++)
        found = found || strcasestr(model->mMeshes[i]->mName.data, name);
    for (unsigned i = 0; model && i < model->mNumMaterials; i++) {
        struct aiString text;
        found = found || (aiGetMaterialString(model->mMaterials[i], AI_MATKEY_NAME, &text) == aiReturn_SUCCESS &&
                          strcasestr(text.data, name));
    }
    if (model)
        aiReleaseImport(model);
    return found;
}

static bool check_name(const scene_file *scene, const char *name, const char *key)
{
    char error[512];
    bool found = !name;
    for (uint32_t i = 0; !found && tool_effects[i]; i++)
        found = tool_effects[i]->has && tool_effects[i]->has(scene, name);
    for (uint32_t i = 0; !found && i < scene->mesh_count; i++)
        found = model_has(scene->meshes[i].file, name);
    if (found)
        return true;
    scene_file_refuse(scene, key, error, sizeof error, SHOT_NO_SUCH_FOCUS, name);
    return options_complain("check", "%s", error);
}

static bool check_focus(const scene_file *scene)
{
    const scene_camera *camera = &scene->camera;
    bool good = check_name(scene, camera->focus_on, "camera.focus_on");
    for (uint32_t i = 0; good && i < camera->focus_key_count; i++) {
        char key[64];
        snprintf(key, sizeof key, "camera.focus_keys.%u.focus_on", i);
        good = check_name(scene, camera->focus_keys[i].focus_on, key);
    }
    return good;
}

static bool check_path(const scene_file *scene)
{
    char error[1024];
    host_camera_key *keys;
    uint32_t count;
    if (!path_keys(scene, &keys, &count, error, sizeof error))
        return options_complain("check", "%s", error);
    free(keys);
    return true;
}

static bool check_files(const scene_file *scene)
{
    for (uint32_t i = 0; i < scene->mesh_count; i++)
        if (!check_mesh(scene->meshes[i].file))
            return false;
    if (!check_path(scene) || !check_environment(scene->environment.file) || !check_focus(scene))
        return false;
    for (uint32_t i = 0; tool_effects[i]; i++) {
        char error[1024];
        if (tool_effects[i]->check_files && !tool_effects[i]->check_files(scene, error, sizeof error))
            return options_complain("check", "%s", error);
    }
    return true;
}

static void print_lens(const scene_file *scene)
{
    const scene_camera *camera = &scene->camera;
    if (camera->aperture_f <= 0)
        return;
    printf("  lens         %.3g mm, f/%g, focus ", 1e3 * scene_camera_focal_m(scene), camera->aperture_f);
    if (camera->focus_key_count)
        printf("by %u keys\n", camera->focus_key_count);
    else if (camera->focus_on)
        printf("on %s\n", camera->focus_on);
    else if (camera->focus_m > 0)
        printf("at %g m\n", camera->focus_m);
    else
        printf("at infinity\n");
}

static void print_camera(const scene_file *scene)
{
    const scene_camera *camera = &scene->camera;
    if (scene_camera_is_calibrated(scene))
        printf("  calibration  focal length %g x %g pixels, %.1f degrees high%s%s\n", camera->calibration.focal_px[0],
               camera->calibration.focal_px[1], scene_camera_fov_deg(scene), camera->calibration.file ? ", of " : "",
               camera->calibration.file ? camera->calibration.file : "");
    if (camera->poses.file)
        printf("  camera       poses of %s, the first %g m high\n", camera->poses.file, camera->height_m);
    else if (camera->speed_m_s)
        printf("  camera       at %g m/s\n", *camera->speed_m_s);
}

static void print_scene(const char *path, const scene_file *scene)
{
    const scene_frames *frames = &scene->frames;
    printf("%s\n", path);
    printf("  frames       %u to %u at %g a second, %u x %u\n", frames->first, frames->last, frames->fps,
           frames->size[0], frames->size[1]);
    if (frames->preroll_s > 0)
        printf("  pre-roll     %g s of rain before frame %u\n", frames->preroll_s, frames->first);
    print_camera(scene);
    print_lens(scene);
    for (uint32_t i = 0; tool_effects[i]; i++)
        if (tool_effects[i]->print)
            tool_effects[i]->print(scene);
    printf("  lights       %u\n", scene->light_count);
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
    if (!shot_check_scene(scene, error, sizeof error)) {
        options_complain("check", "%s", error);
        scene_file_free(scene);
        return EXIT_USAGE;
    }
    print_scene(parsed.arguments[0], scene);
    const bool good = check_files(scene);
    scene_file_free(scene);
    if (good)
        printf("good\n");
    return good ? EXIT_OK : EXIT_USAGE;
}
