/* load.c - what a scene file names, loaded: meshes and what they are made of, the sky, the camera's path. */
#include "shot/internal.h"

#include "exr.h"
#include "png.h"
#include "suggest.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- meshes */

/* Rotation about X, then Y, then Z of the world, scaled and moved; row-major 3 x 4. */
void shot_place_mesh(const scene_mesh *mesh, float out[12])
{
    double m[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    for (int axis = 0; axis < 3; axis++) {
        const double angle = mesh->rotation_deg[axis] * M_PI / 180, c = cos(angle), sn = sin(angle);
        const int a = (axis + 1) % 3, b = (axis + 2) % 3;
        for (int column = 0; column < 3; column++) {
            const double x = m[a][column], y = m[b][column];
            m[a][column] = c * x - sn * y;
            m[b][column] = sn * x + c * y;
        }
    }
    for (int row = 0; row < 3; row++) {
        for (int column = 0; column < 3; column++)
            out[row * 4 + column] = (float)(m[row][column] * mesh->scale);
        out[row * 4 + 3] = (float)mesh->position_m[row];
    }
}

static bool check_material(const scene_file *scene, const char *key, const char *name, char *error, size_t error_size)
{
    const char *names[VIRGA_GROUND_MATERIALS];
    char all[256] = "";
    uint32_t material, count = 0;
    size_t used = 0;
    if (host_material_find(name, &material))
        return true;
    for (; count < VIRGA_GROUND_MATERIALS && used < sizeof all; count++) {
        names[count] = host_material_name(count);
        if (count && names[count] == names[0])
            break;
        used += (size_t)snprintf(all + used, sizeof all - used, "%s%s", count ? ", " : "", names[count]);
    }
    const char *near = suggest_nearest(name, names, count);
    return scene_file_refuse(scene, key, error, error_size, "expected one of %s, got '%.40s'%s%s%s", all, name,
                             near ? ", did you mean '" : "", near ? near : "", near ? "'?" : "");
}

bool shot_check_materials(const scene_file *scene, char *error, size_t error_size)
{
    char key[64];
    const scene_ground *ground = scene_ground_of(scene);
    for (uint32_t i = 0; i < ground->material_count; i++) {
        snprintf(key, sizeof key, "ground.materials.%u.material", i);
        if (ground->materials[i].material &&
            !check_material(scene, key, ground->materials[i].material, error, error_size))
            return false;
    }
    for (uint32_t i = 0; i < ground->material_map.material_count; i++) {
        snprintf(key, sizeof key, "ground.material_map.materials.%u", i);
        if (!check_material(scene, key, ground->material_map.materials[i], error, error_size))
            return false;
    }
    return true;
}

/* Rules of the scene over what the words in names say: the first that matches a primitive or its material. */
static void apply_rules(const shot *s, host_mesh *mesh)
{
    const scene_ground *ground = scene_ground_of(s->scene);
    for (uint32_t i = 0; i < mesh->primitive_count; i++) {
        host_primitive *primitive = &mesh->primitives[i];
        const scene_ground_rule *rule = ground->materials, *end = rule + ground->material_count;
        while (rule < end && !host_name_contains(primitive->name, rule->match) &&
               !host_name_contains(mesh->materials[primitive->material].name, rule->match))
            rule++;
        if (rule == end)
            continue;
        if (rule->material)
            host_material_find(rule->material, &primitive->surface);
        primitive->ground = rule->walkable;
    }
}

bool shot_load_meshes(shot *s, char *error, size_t error_size)
{
    s->meshes = calloc(s->scene->mesh_count ? s->scene->mesh_count : 1, sizeof *s->meshes);
    s->occluders = calloc(SHOT_MAX_OCCLUDERS, sizeof *s->occluders);
    if (!s->meshes || !s->occluders)
        return host_fail(error, error_size, "no memory for meshes");
    for (uint32_t i = 0; i < s->scene->mesh_count; i++) {
        float transform[12];
        shot_place_mesh(&s->scene->meshes[i], transform);
        const char *path = s->scene->meshes[i].file;
        if (!shot_blame_input(s, host_mesh_load(&s->device, path, transform, &s->meshes[i], error, error_size)))
            return false;
        s->meshes_loaded++;
        apply_rules(s, &s->meshes[i]);
        const uint32_t room = SHOT_MAX_OCCLUDERS - s->occluder_count;
        const uint32_t more = host_mesh_occluders(&s->meshes[i], s->occluders + s->occluder_count, room);
        s->occluder_count += more < room ? more : room;
        if (s->renderer && !host_renderer_add(s->renderer, &s->meshes[i], error, error_size))
            return false;
    }
    return true;
}

/* ---- the material map */

bool shot_read_material_map(const scene_file *scene, uint32_t *width, uint32_t *height, uint8_t **texels, char *error,
                            size_t error_size)
{
    const scene_material_map *map = &scene_ground_of(scene)->material_map;
    uint8_t material_of[256];
    char reason[1024];
    *texels = NULL;
    if (!map->file)
        return true;
    if (!png_read_numbers(map->file, width, height, texels, reason, sizeof reason))
        return scene_file_refuse(scene, "ground.material_map.file", error, error_size, "%s", reason);
    memset(material_of, SHOT_MATERIAL_OF_MESH, sizeof material_of);
    for (uint32_t i = 0; i < map->material_count; i++) {
        uint32_t material = SHOT_MATERIAL_OF_MESH;
        host_material_find(map->materials[i], &material);
        material_of[i] = (uint8_t)material;
    }
    for (size_t i = 0; i < (size_t)*width * *height; i++)
        (*texels)[i] = material_of[(*texels)[i]];
    return true;
}

static bool upload_materials(shot *s, uint32_t width, uint32_t height, const uint8_t *texels, char *error,
                             size_t error_size)
{
    const uint32_t limit = s->device.properties.limits.maxImageDimension2D;
    const host_image_def def = {.format = VK_FORMAT_R8_UINT,
                                .extent = {width, height, 1},
                                .usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT,
                                .name = "material map"};
    if (!shot_blame_input(s, width <= limit && height <= limit))
        return scene_file_refuse(s->scene, "ground.material_map.file", error, error_size,
                                 "%u x %u pixels are more than this device's %u on a side", width, height, limit);
    return host_image_create(&s->device, &def, &s->material_image, error, error_size) &&
           host_image_upload(&s->device, &s->material_image, texels, (VkDeviceSize)width * height, 1, error,
                             error_size);
}

bool shot_load_material_map(shot *s, char *error, size_t error_size)
{
    const scene_material_map *map = &scene_ground_of(s->scene)->material_map;
    const virga_image_state read = {VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT,
                                    VK_ACCESS_SHADER_READ_BIT};
    uint32_t width, height;
    uint8_t *texels;
    if (!shot_blame_input(s, shot_read_material_map(s->scene, &width, &height, &texels, error, error_size)))
        return false;
    if (!texels)
        return true;
    const bool uploaded = upload_materials(s, width, height, texels, error, error_size);
    free(texels);
    s->materials.image = (virga_image){.image = s->material_image.image,
                                       .view = s->material_image.view,
                                       .format = VK_FORMAT_R8_UINT,
                                       .extent = {width, height, 1},
                                       .before = read,
                                       .after = read};
    memcpy(s->materials.low_m, map->low_m, sizeof s->materials.low_m);
    memcpy(s->materials.high_m, map->high_m, sizeof s->materials.high_m);
    return uploaded;
}

/* ---- light and camera */

bool shot_load_environment(shot *s, char *error, size_t error_size)
{
    const scene_environment *from = &s->scene->environment;
    host_environment_def def = host_default_environment();
    def.rotation_deg = (float)from->rotation_deg;
    def.intensity = (float)from->intensity;
    for (int c = 0; c < 3; c++) {
        def.zenith[c] = (float)from->zenith[c];
        def.horizon[c] = (float)from->horizon[c];
        def.ground[c] = (float)from->ground[c];
    }
    float *pixels = NULL;
    if (from->file) {
        uint64_t repaired = 0;
        if (!shot_blame_input(s,
                              exr_read_rgb(from->file, &def.width, &def.height, &pixels, &repaired, error, error_size)))
            return false;
        if (repaired)
            host_warn(&s->device, "%s: %llu values were not finite or below zero and count as 0", from->file,
                      (unsigned long long)repaired);
        def.pixels = pixels;
    }
    const bool made = host_environment_create(&s->device, &def, &s->environment, error, error_size);
    free(pixels);
    return made && (!s->renderer || host_renderer_set_environment(s->renderer, &s->environment, error, error_size));
}

bool shot_load_camera(shot *s)
{
    const scene_camera *from = &s->scene->camera;
    if (from->key_count > s->camera_key_room) {
        host_camera_key *grown = realloc(s->camera_keys, from->key_count * sizeof *grown);
        if (!grown)
            return false;
        s->camera_keys = grown;
        s->camera_key_room = from->key_count;
    }
    for (uint32_t i = 0; i < from->key_count; i++) {
        host_camera_key *key = &s->camera_keys[i];
        key->time_s = from->keys[i].time_s;
        memcpy(key->position_m, from->keys[i].position_m, sizeof key->position_m);
        memcpy(key->look_at_m, from->keys[i].look_at_m, sizeof key->look_at_m);
        key->roll_deg = from->keys[i].roll_deg;
        key->cut = from->keys[i].cut;
    }
    s->path = (host_camera_path){.keys = s->camera_keys,
                                 .count = from->key_count,
                                 .fov_deg = from->fov_deg,
                                 .near_m = from->near_m,
                                 .far_m = from->far_m};
    return true;
}
