/* shot.c - a scene file brought to life: device, meshes, light, rain and what it does; and a frame of it as an average
 * of sub-frames. */
#include "shot_internal.h"

#include "exr.h"
#include "png.h"
#include "suggest.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <virga/shared/random.h>

#define MOST_CATCHING 8u /* panes that catch the rain's own drops, see virga_rain_def.max_panes */

/* ---- loading */

static void take_log(void *user, virga_log_level level, virga_log_id id, const char *text)
{
    shot *s = user;
    (void)id;
    if (level == VIRGA_LOG_INFO)
        return;
    snprintf(s->warning, sizeof s->warning, "%s", text);
    if (level == VIRGA_LOG_WARNING)
        fprintf(stderr, "virga: %s\n", text);
}

bool shot_ok(const shot *s, virga_result result, const char *what, char *error, size_t error_size)
{
    if (result >= 0)
        return true;
    return host_fail(error, error_size, "%s: %s%s%s", what, virga_result_name(result), s->warning[0] ? ": " : "",
                     s->warning);
}

/* Notes that what fails here is wrong input. A file that this machine has no room for counts as such too: it will not
 * have it the next time either. */
bool shot_blame_input(shot *s, bool right)
{
    s->input_wrong = !right;
    return right;
}

static bool open_device(shot *s, char *error, size_t error_size)
{
    host_device_info infos[HOST_MAX_DEVICES];
    uint32_t index = 0;
    if (!host_instance_create(&s->instance, false, error, error_size))
        return false;
    const uint32_t count = host_devices_list(&s->instance, infos, HOST_MAX_DEVICES);
    if (!host_device_pick(infos, count, s->options.device, &index, error, error_size)) {
        s->input_wrong = count && s->options.device;
        return false;
    }
    s->info = infos[index];
    if (!host_device_create(&s->device, &s->instance, &infos[index], error, error_size))
        return false;
    /* The anisotropic filter of software Vulkan (Mesa 22.3) takes ten seconds over a pixel whose gradients are unlucky,
     * and three times as long as the plain one over the others. Sub-frames (--samples) make up for it. */
    if (s->info.type == VK_PHYSICAL_DEVICE_TYPE_CPU)
        s->device.anisotropy = 0;
    virga_context_def def = virga_default_context_def();
    def.instance = s->instance.instance;
    def.physical_device = s->device.physical;
    def.device = s->device.device;
    def.queue_family = s->device.queue_family;
    def.get_instance_proc_addr = vkGetInstanceProcAddr;
    def.frames_in_flight = HOST_FRAMES + 1;
    def.log = take_log;
    def.log_user = s;
    return shot_ok(s, virga_context_create(&def, &s->context), "taking the device into use", error, error_size);
}

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
    const scene_ground *ground = &scene->ground;
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
static void apply_rules(const shot *s, const host_mesh *mesh, virga_occluder *occluders, uint32_t count)
{
    const scene_ground *ground = &s->scene->ground;
    for (uint32_t i = 0; i < count; i++) {
        const host_primitive *primitive = &mesh->primitives[i];
        const scene_ground_rule *rule = ground->materials, *end = rule + ground->material_count;
        while (rule < end && !host_name_contains(primitive->name, rule->match) &&
               !host_name_contains(mesh->materials[primitive->material].name, rule->match))
            rule++;
        if (rule == end)
            continue;
        if (rule->material)
            host_material_find(rule->material, &occluders[i].material);
        occluders[i].ground = rule->walkable;
    }
}

static bool load_meshes(shot *s, char *error, size_t error_size)
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
        const uint32_t room = SHOT_MAX_OCCLUDERS - s->occluder_count;
        const uint32_t more = host_mesh_occluders(&s->meshes[i], s->occluders + s->occluder_count, room);
        const uint32_t taken = more < room ? more : room;
        apply_rules(s, &s->meshes[i], s->occluders + s->occluder_count, taken);
        s->occluder_count += taken;
        if (s->renderer && !host_renderer_add(s->renderer, &s->meshes[i], error, error_size))
            return false;
    }
    return true;
}

bool shot_read_material_map(const scene_file *scene, uint32_t *width, uint32_t *height, uint8_t **texels, char *error,
                            size_t error_size)
{
    const scene_material_map *map = &scene->ground.material_map;
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

static bool load_material_map(shot *s, char *error, size_t error_size)
{
    const scene_material_map *map = &s->scene->ground.material_map;
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

static bool load_environment(shot *s, char *error, size_t error_size)
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

static void load_camera(shot *s)
{
    const scene_camera *from = &s->scene->camera;
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
}

/* ---- rain */

static void fill_lights(shot *s)
{
    s->settings.lighting.light_count = s->scene->light_count;
    for (uint32_t i = 0; i < s->scene->light_count; i++) {
        const scene_light *from = &s->scene->lights[i];
        virga_light *to = &s->settings.lighting.lights[i];
        memset(to, 0, sizeof *to);
        for (int c = 0; c < 3; c++) {
            to->position_m[c] = from->position_m[c];
            to->intensity[c] = (float)(from->color[c] * from->intensity_w_sr);
            to->direction[c] = from->type == SCENE_LIGHT_SPOT ? (float)from->direction[c] : 0;
        }
        to->range_m = (float)from->range_m;
        to->cos_inner = (float)cos(from->inner_deg * M_PI / 180);
        to->cos_outer = (float)cos(from->outer_deg * M_PI / 180);
    }
}

static bool fill_sizes(shot *s, double *diameters, double *numbers, char *error, size_t error_size)
{
    const scene_rain *from = &s->scene->rain;
    s->settings.sizes.kind = (virga_sizes_kind)from->sizes;
    if (from->sizes != SCENE_SIZES_TABLE)
        return true;
    if (!shot_blame_input(s, from->table_count <= 256))
        return host_fail(error, error_size, "rain.table: expected at most 256 entries, got %u", from->table_count);
    for (uint32_t i = 0; i < from->table_count; i++) {
        diameters[i] = from->table[i].diameter_mm * 1e-3;
        numbers[i] = from->table[i].number;
    }
    s->settings.sizes.table_diameter_m = diameters;
    s->settings.sizes.table_number = numbers;
    s->settings.sizes.table_count = from->table_count;
    return true;
}

/* What the scene file animates is rate and wind. */
static bool set_rain(shot *s, double time_s, char *error, size_t error_size)
{
    const scene_rain *from = &s->scene->rain;
    double rate, wind[3], diameters[256], numbers[256];
    scene_file_weather(s->scene, time_s, &rate, wind);
    s->settings.rate_mm_h = (float)rate;
    for (int axis = 0; axis < 3; axis++)
        s->settings.wind_m_s[axis] = (float)wind[axis];
    s->settings.air_density = (float)from->air_density;
    /* Keys say what the rate is at every time; easing towards them would lag behind. */
    s->settings.transition_s = from->key_count ? 0 : (float)from->transition_s;
    s->settings.gust_m_s = (float)from->gust_m_s;
    s->settings.gust_time_s = (float)from->gust_time_s;
    s->settings.streak_gain = (float)from->streak_gain;
    s->settings.light_gain = (float)from->light_gain;
    s->settings.min_width_px = (float)from->min_width_px;
    s->settings.soft_m = (float)from->soft_m;
    s->settings.near_m = (float)from->near_m;
    s->settings.oscillation = (float)from->oscillation;
    s->settings.haze = (float)from->haze;
    s->settings.bodies_min_mm = (float)from->bodies_min_mm;
    memcpy(s->settings.lighting.environment_sh, s->environment.sh, sizeof s->settings.lighting.environment_sh);
    if (!fill_sizes(s, diameters, numbers, error, error_size))
        return false;
    return shot_ok(s, virga_rain_set(s->rain, &s->settings), "setting the rain", error, error_size);
}

static bool set_ground(shot *s, char *error, size_t error_size)
{
    virga_ground_settings settings = virga_default_ground_settings();
    settings.evaporation_mm_h = (float)s->scene->ground.evaporation_mm_h;
    settings.start_wetness = (float)s->scene->ground.start_wetness;
    settings.start_water_mm = (float)s->scene->ground.start_water_mm;
    settings.measure = s->options.stats;
    return !s->ground || shot_ok(s, virga_ground_set(s->ground, &settings), "setting the ground", error, error_size);
}

/* Lit and carried by the same air as the rain, whose settings are made before. */
static bool set_splash(shot *s, char *error, size_t error_size)
{
    const scene_splash *from = &s->scene->splash;
    virga_splash_settings settings = virga_default_splash_settings();
    settings.mode = (virga_splash_mode)from->mode;
    settings.style = (virga_splash_style)from->style;
    settings.droplets_m = (float)from->droplets_m;
    settings.bounce = (float)from->bounce;
    settings.pile_s = (float)from->pile_s;
    settings.pile_m = (float)from->pile_m;
    settings.dot_mm = (float)from->dot_mm;
    settings.gain = (float)from->gain;
    settings.light_gain = (float)from->light_gain;
    settings.min_width_px = (float)from->min_width_px;
    settings.soft_m = (float)from->soft_m;
    settings.near_m = (float)from->near_m;
    settings.air_density = s->settings.air_density;
    settings.lighting = s->settings.lighting;
    return !s->splash || shot_ok(s, virga_splash_set(s->splash, &settings), "setting the splashes", error, error_size);
}

/* Settings of a time. */
static bool set_weather(shot *s, double time_s, char *error, size_t error_size)
{
    return set_rain(s, time_s, error, error_size) && set_splash(s, error, error_size) &&
           shot_panes_set(s, time_s, error, error_size);
}

/* How far ahead the middle of the map of ripples lies: where the camera looks, up to a distance that the lower part of
 * a wide picture shows. */
static double ripples_ahead(const shot *s, double time_s)
{
    const host_camera_key *key = s->camera_keys;
    for (uint32_t i = 1; i < s->path.count && s->camera_keys[i].time_s <= time_s; i++)
        key = &s->camera_keys[i];
    const double way = hypot(key->look_at_m[0] - key->position_m[0], key->look_at_m[2] - key->position_m[2]);
    return way < SHOT_RIPPLES_AHEAD_M ? way : SHOT_RIPPLES_AHEAD_M;
}

static virga_scene_def define_scene(const shot *s)
{
    const scene_rain *from = &s->scene->rain;
    virga_scene_def def = virga_default_scene_def();
    def.rain.seed = from->seed;
    def.rain.max_drops = from->max_drops;
    def.rain.range_m = (float)from->range_m;
    def.rain.occlusion_size = from->occlusion_size;
    def.rain.occlusion_cascades = from->occlusion_cascades;
    def.rain.occlusion_slants = from->occlusion_slants;
    def.rain.max_ticks_per_step = 64;
    def.rain.points = s->options.points;
    def.rain.max_panes = s->scene->pane_count < MOST_CATCHING ? s->scene->pane_count : MOST_CATCHING;
    def.with_ground = s->scene->ground.on;
    def.ground.cells = s->scene->ground.cells;
    def.ground.cell_m = (float)s->scene->ground.cell_m;
    def.ground.kept_tiles = s->scene->ground.kept_tiles;
    /* A close-up sees finer waves of a smaller place. */
    def.ground.ripple_texel_m = (float)fmax(0.006 * ripples_ahead(s, 0) / SHOT_RIPPLES_AHEAD_M, 0.002);
    def.with_splash = s->scene->splash.on;
    def.splash.max_splashes = s->scene->splash.max_splashes;
    def.splash.max_droplets = s->scene->splash.max_droplets;
    /* Ticks divide a frame, so that each frame lies on one. */
    const double frame_s = 1 / s->scene->frames.fps;
    def.rain.tick_s = frame_s / ceil(frame_s * 60 - 1e-9);
    return def;
}

/* The mirror's plane: the foot of the widest ground under the place that the camera looks at first. */
static bool set_mirror(shot *s, char *error, size_t error_size)
{
    const double *at = s->camera_keys[0].look_at_m;
    double widest = 0, height_m = 0;
    for (uint32_t m = 0; m < s->meshes_loaded; m++) {
        for (uint32_t i = 0; i < s->meshes[m].primitive_count; i++) {
            const host_primitive *p = &s->meshes[m].primitives[i];
            const double area = ((double)p->high[0] - (double)p->low[0]) * ((double)p->high[2] - (double)p->low[2]);
            const bool under = at[0] >= (double)p->low[0] && at[0] <= (double)p->high[0] &&
                               at[2] >= (double)p->low[2] && at[2] <= (double)p->high[2];
            if (area <= widest || !under || !host_is_ground(p->name, p->surface))
                continue;
            widest = area;
            height_m = (double)p->low[1];
        }
    }
    return !s->ground || host_renderer_set_mirror(s->renderer, &s->target, height_m, error, error_size);
}

static bool create_scene(shot *s, char *error, size_t error_size)
{
    virga_scene_def def = define_scene(s);
    virga_glass_def *panes = shot_panes_define(s);
    def.panes = panes;
    def.pane_count = s->scene->pane_count;
    const virga_result result = virga_scene_create(s->context, &def, &s->rain_scene);
    free(panes);
    return shot_ok(s, result, "making the rain", error, error_size);
}

static bool open_moving(shot *s, char *error, size_t error_size)
{
    virga_target_def target = virga_default_target_def();
    if (!s->options.water_velocity)
        return true;
    host_target_describe_moving(&s->target, &target);
    return shot_ok(s, virga_target_create(s->context, &target, &s->moving), "making the velocity's target", error,
                   error_size) &&
           shot_ok(s, virga_scene_attach(s->rain_scene, s->moving), "building pipelines", error, error_size);
}

static bool open_rain(shot *s, char *error, size_t error_size)
{
    if (!create_scene(s, error, error_size))
        return false;
    s->rain = virga_scene_rain(s->rain_scene);
    s->ground = virga_scene_ground(s->rain_scene);
    s->splash = virga_scene_splash(s->rain_scene);
    s->settings = virga_default_rain_settings();
    if (!set_ground(s, error, error_size))
        return false;
    fill_lights(s);
    if (!shot_panes_open(s, error, error_size))
        return false;
    if (!s->options.draw)
        return true;
    virga_target_def target = virga_default_target_def();
    host_target_describe_layer(&s->target, &target);
    host_renderer_set_lights(s->renderer, s->settings.lighting.lights, s->settings.lighting.light_count);
    return set_mirror(s, error, error_size) &&
           shot_ok(s, virga_target_create(s->context, &target, &s->layer), "making the layer's target", error,
                   error_size) &&
           shot_ok(s, virga_scene_attach(s->rain_scene, s->layer), "building pipelines", error, error_size) &&
           open_moving(s, error, error_size);
}

static bool make_target(shot *s, char *error, size_t error_size)
{
    const uint32_t width = s->options.width, height = s->options.height;
    const uint32_t limit = s->device.properties.limits.maxImageDimension2D;
    const bool made = host_target_create(&s->device, width, height, &s->target, error, error_size);
    s->input_wrong = !made && (width > limit || height > limit);
    return made && (!s->scene->splash.on || host_target_add_splash(&s->device, &s->target, error, error_size)) &&
           (!s->scene->pane_count || host_target_add_glass(&s->device, &s->target, error, error_size)) &&
           (!s->options.water_velocity || host_target_add_moving(&s->device, &s->target, error, error_size));
}

/* The first picture is read at once: most of what can be wrong with one is wrong with all. */
static bool open_plate(shot *s, char *error, size_t error_size)
{
    return plate_open(&s->plate, s->options.plate, s->scene->frames.first, s->options.frames, s->options.width,
                      s->options.height, error, error_size) &&
           (!s->plate.pattern || plate_load(&s->plate, s->options.frames[0], error, error_size));
}

/* Where the pictures of a plate go on their way to the device. */
static bool open_plate_buffer(shot *s, char *error, size_t error_size)
{
    const VkDeviceSize size = (VkDeviceSize)s->options.width * s->options.height * 4 * sizeof(float);
    return !s->plate.pattern || !s->options.draw ||
           host_buffer_create(&s->device, size, VK_BUFFER_USAGE_TRANSFER_SRC_BIT, HOST_BUFFER_UPLOAD, "plate pixels",
                              &s->plate_buffer, error, error_size);
}

static bool open_all(shot *s, char *error, size_t error_size)
{
    s->camera_keys = calloc(s->scene->camera.key_count, sizeof *s->camera_keys);
    if (!s->camera_keys)
        return host_fail(error, error_size, "no memory for the camera's path");
    load_camera(s);
    if (!shot_blame_input(s, host_camera_path_check(&s->path, error, error_size) &&
                                 shot_check_materials(s->scene, error, error_size) &&
                                 shot_check_panes(s->scene, error, error_size) && open_plate(s, error, error_size)) ||
        !open_device(s, error, error_size))
        return false;
    if (s->options.draw &&
        (!make_target(s, error, error_size) ||
         !host_renderer_create(&s->device, &s->target, &s->renderer, error, error_size) ||
         !host_accumulator_create(&s->frame, s->options.width, s->options.height, error, error_size)))
        return false;
    return open_plate_buffer(s, error, error_size) && load_meshes(s, error, error_size) &&
           load_material_map(s, error, error_size) && load_environment(s, error, error_size) &&
           open_rain(s, error, error_size) && set_weather(s, 0, error, error_size);
}

bool shot_open(shot *s, const scene_file *scene, const shot_options *options, char *error, size_t error_size)
{
    memset(s, 0, sizeof *s);
    s->scene = scene;
    s->options = *options;
    s->options.samples = options->samples ? options->samples : 1;
    s->frame_index = scene->frames.first - 1;
    if (open_all(s, error, error_size))
        return true;
    const bool input_wrong = s->input_wrong;
    shot_close(s);
    s->input_wrong = input_wrong;
    return false;
}

void shot_close(shot *s)
{
    char ignored[256];
    if (s->device.device)
        host_wait(&s->device, ignored, sizeof ignored);
    virga_target_destroy(&s->layer);
    virga_target_destroy(&s->moving);
    virga_scene_destroy(&s->rain_scene);
    virga_context_destroy(&s->context);
    host_renderer_destroy(&s->renderer);
    host_accumulator_destroy(&s->frame);
    if (s->device.device) {
        for (uint32_t i = 0; i < s->meshes_loaded; i++)
            host_mesh_destroy(&s->device, &s->meshes[i]);
        host_image_destroy(&s->device, &s->material_image);
        host_environment_destroy(&s->device, &s->environment);
        if (s->target.width)
            host_target_destroy(&s->device, &s->target);
        shot_panes_close(s);
        host_buffer_destroy(&s->device, &s->plate_buffer);
        host_buffer_destroy(&s->device, &s->drops_read.buffer);
        host_buffer_destroy(&s->device, &s->droplets_read.buffer);
        host_device_destroy(&s->device);
    }
    if (s->instance.instance)
        host_instance_destroy(&s->instance);
    plate_close(&s->plate);
    free(s->meshes);
    free(s->occluders);
    free(s->camera_keys);
    memset(s, 0, sizeof *s);
}

/* ---- frames */

double shot_time(const shot *s, uint32_t frame)
{
    return (double)(frame - s->scene->frames.first) / s->scene->frames.fps;
}

static bool begin(shot *s, VkCommandBuffer *cmd, char *error, size_t error_size)
{
    return host_begin_frame(&s->device, cmd, error, error_size) &&
           shot_ok(s, virga_frame_begin(s->context, s->device.frame, s->device.completed), "beginning a frame", error,
                   error_size);
}

/* ---- points */

/* Copies points that the step just recorded has left ready for it to where the host reads them. */
bool shot_record_read(shot *s, VkCommandBuffer cmd, VkBuffer from, VkDeviceSize offset, VkDeviceSize size,
                      shot_read *read, char *error, size_t error_size)
{
    if (!read->buffer.buffer &&
        !host_buffer_create(&s->device, size, VK_BUFFER_USAGE_TRANSFER_DST_BIT, HOST_BUFFER_READBACK, "points read",
                            &read->buffer, error, error_size))
        return false;
    const VkBufferCopy copy = {offset, 0, size};
    const VkMemoryBarrier before = {.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER,
                                    .srcAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT,
                                    .dstAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT};
    const VkMemoryBarrier after = {.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER,
                                   .srcAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT,
                                   .dstAccessMask = VK_ACCESS_HOST_READ_BIT};
    vkCmdPipelineBarrier(cmd, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_PIPELINE_STAGE_TRANSFER_BIT, 0, 1, &before, 0, NULL, 0,
                         NULL);
    vkCmdCopyBuffer(cmd, from, read->buffer.buffer, 1, &copy);
    vkCmdPipelineBarrier(cmd, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_PIPELINE_STAGE_HOST_BIT, 0, 1, &after, 0, NULL, 0,
                         NULL);
    return true;
}

/* What is on the panes. */
static bool record_panes(shot *s, VkCommandBuffer cmd, char *error, size_t error_size)
{
    for (uint32_t i = 0; i < s->scene->pane_count; i++) {
        virga_glass_buffer drops;
        shot_read *read = &s->panes[i].read;
        virga_glass_drops(s->panes[i].glass, &drops, &read->count);
        if (!shot_record_read(s, cmd, drops.buffer, drops.offset, drops.size, read, error, error_size))
            return false;
    }
    return true;
}

static bool record_points(shot *s, VkCommandBuffer cmd, char *error, size_t error_size)
{
    virga_rain_buffer drops;
    virga_splash_buffer droplets;
    shot_read *read = &s->drops_read;
    if (!shot_ok(s, virga_rain_points(s->rain, cmd, &drops, &read->count, read->origin_m), "reading drops", error,
                 error_size) ||
        !shot_record_read(s, cmd, drops.buffer, drops.offset, drops.size, read, error, error_size))
        return false;
    read = &s->droplets_read;
    virga_splash_droplets(s->splash, &droplets, &read->count, read->origin_m);
    return (!s->splash ||
            shot_record_read(s, cmd, droplets.buffer, droplets.offset, droplets.size, read, error, error_size)) &&
           record_panes(s, cmd, error, error_size);
}

/* What was read back, and room for as many points of `size` bytes. */
static const void *open_read(shot *s, shot_read *read, size_t size, void **room, char *error, size_t error_size)
{
    *room = NULL;
    if (!read->buffer.buffer || !host_wait(&s->device, error, error_size)) {
        host_fail(error, error_size, "no points were read back");
        return NULL;
    }
    host_buffer_invalidate(&s->device, &read->buffer);
    *room = malloc(read->count * size + 1);
    if (*room)
        return read->buffer.mapped;
    host_fail(error, error_size, "no memory for %u points", read->count);
    return NULL;
}

/* To the world. */
static void place_point(const shot_read *read, const float position[3], float out[3])
{
    for (int axis = 0; axis < 3; axis++)
        out[axis] = (float)((double)position[axis] + read->origin_m[axis]);
}

bool shot_points(shot *s, shot_point **points, uint32_t *count, char *error, size_t error_size)
{
    void *room;
    const virga_point_gpu *from = open_read(s, &s->drops_read, sizeof **points, &room, error, error_size);
    *points = room;
    *count = 0;
    if (!from)
        return false;
    for (uint32_t i = 0; i < s->drops_read.count; i++) {
        if (from[i].weight <= 0)
            continue;
        shot_point *to = &(*points)[(*count)++];
        place_point(&s->drops_read, from[i].position, to->position);
        memcpy(to->velocity, from[i].velocity, sizeof to->velocity);
        to->radius_m = 0.5f * from[i].diameter_m;
        to->id = from[i].id;
        to->age_s = from[i].age_s;
        to->weight = from[i].weight;
    }
    return true;
}

bool shot_droplets(shot *s, shot_droplet **droplets, uint32_t *count, char *error, size_t error_size)
{
    void *room;
    const virga_droplet_gpu *from = open_read(s, &s->droplets_read, sizeof **droplets, &room, error, error_size);
    *droplets = room;
    *count = 0;
    if (!from)
        return false;
    for (uint32_t i = 0; i < s->droplets_read.count; i++) {
        if (!(from[i].kind & VIRGA_DROPLET_ALIVE) || from[i].age_s < 0)
            continue;
        shot_droplet *to = &(*droplets)[(*count)++];
        place_point(&s->droplets_read, from[i].position, to->position);
        memcpy(to->velocity, from[i].velocity, sizeof to->velocity);
        to->radius_m = 0.5f * from[i].diameter_m;
        to->age_s = from[i].age_s;
        to->model = VIRGA_DROPLET_MODEL(from[i].kind);
        to->material = VIRGA_DROPLET_MATERIAL(from[i].kind);
        to->state = VIRGA_DROPLET_STATE(from[i].kind);
        to->parent = from[i].id;
        to->index = VIRGA_DROPLET_NUMBER(from[i].kind);
        to->id = virga_hash2(to->parent, to->index);
        to->water_ul = (float)(from[i].water_nl * 1e-3);
    }
    return true;
}

/* ---- stepping */

/* Where ripples are worth drawing: ahead of the camera, from its feet on. */
static void place_focus(const shot *s, const host_camera *camera, double time_s, double focus_m[3])
{
    const double ahead_m = ripples_ahead(s, time_s);
    const float *m = camera->view_from_world; /* its third row points back */
    const double back[2] = {(double)m[2], (double)m[10]}, length = hypot(back[0], back[1]);
    memcpy(focus_m, camera->position_m, 3 * sizeof focus_m[0]);
    for (int axis = 0; axis < 2 && length > 1e-3; axis++)
        focus_m[axis * 2] -= back[axis] / length * ahead_m;
}

/* Time passes to the frame: occlusion around its camera, and the ticks of one frame. */
static bool record_step(shot *s, VkCommandBuffer cmd, uint32_t frame, char *error, size_t error_size)
{
    host_camera camera;
    const double time_s = shot_time(s, frame);
    host_camera_at(&s->path, time_s, s->options.width, s->options.height, NULL, &camera);
    const bool first = s->frame_index + 1 == s->scene->frames.first;
    virga_scene_frame info = {.dt_s = first ? 0 : 1 / s->scene->frames.fps,
                              .occluders = s->occluders,
                              .occluder_count = s->occluder_count,
                              .materials = s->materials};
    memcpy(info.camera_m, camera.position_m, sizeof info.camera_m);
    place_focus(s, &camera, time_s, info.focus_m);
    virga_scene_pane *panes = shot_panes_place(s, time_s);
    info.panes = panes;
    const bool stepped =
        set_weather(s, time_s, error, error_size) &&
        shot_ok(s, virga_scene_record(s->rain_scene, cmd, &info), "stepping the rain", error, error_size);
    free(panes);
    if (!stepped)
        return false;
    s->frame_index++;
    return !s->options.points || record_points(s, cmd, error, error_size);
}

bool shot_step(shot *s, uint32_t frame, char *error, size_t error_size)
{
    while (s->frame_index < frame || s->frame_index + 1 == s->scene->frames.first) {
        VkCommandBuffer cmd;
        if (!begin(s, &cmd, error, error_size) || !record_step(s, cmd, s->frame_index + 1, error, error_size) ||
            !host_submit(&s->device, error, error_size))
            return false;
        if (s->frame_index >= frame)
            break;
    }
    return true;
}

/* ---- drawing */

/* Splashes and rain as a view sees them: each into a layer of its own. The worse of the results. */
static virga_result prepare(shot *s, VkCommandBuffer cmd, const virga_view *view, double time_s)
{
    const virga_result splash = s->splash ? virga_splash_prepare(s->splash, cmd, view, time_s) : VIRGA_OK;
    return splash < 0 ? splash : virga_rain_prepare(s->rain, cmd, view, time_s);
}

static virga_result draw_layers(shot *s, VkCommandBuffer cmd)
{
    virga_result result = VIRGA_OK;
    if (s->splash) {
        host_target_begin_splash(&s->target, cmd);
        result = virga_splash_draw(s->splash, cmd, s->layer);
        host_target_end_layer(&s->target, cmd);
    }
    host_target_begin_layer(&s->target, cmd);
    const virga_result rain = virga_rain_draw(s->rain, cmd, s->layer);
    host_target_end_layer(&s->target, cmd);
    return result < 0 ? result : rain;
}

/* Panes show what is behind them: the plate with splashes and rain in it, which are drawn a second time for that. */
static virga_result draw_behind(shot *s, VkCommandBuffer cmd)
{
    host_target_begin_behind(&s->target, cmd);
    const virga_result splash = s->splash ? virga_splash_draw(s->splash, cmd, s->layer) : VIRGA_OK;
    const virga_result rain = virga_rain_draw(s->rain, cmd, s->layer);
    host_target_end_layer(&s->target, cmd);
    return splash < 0 ? splash : rain;
}

/* All panes of a kind of draw, far ones first. */
static virga_result draw_each_pane(shot *s, VkCommandBuffer cmd, const virga_target *target,
                                   virga_result (*draw)(virga_glass *, VkCommandBuffer, const virga_target *))
{
    virga_result result = VIRGA_OK;
    for (uint32_t i = 0; i < s->scene->pane_count && result >= 0; i++)
        result = draw(s->panes[i].glass, cmd, target);
    host_target_end_layer(&s->target, cmd);
    return result;
}

/* Now and a frame ago. */
static void pose_pane(const shot *s, const scene_pane *pane, double camera_s, virga_glass_pose *pose)
{
    virga_glass_pose before;
    const double shot_start = host_camera_shot_start(&s->path, camera_s);
    shot_pane_pose(s, pane, camera_s, pose);
    shot_pane_pose(s, pane, fmax(camera_s - 1 / s->scene->frames.fps, shot_start), &before);
    memcpy(pose->before_position_m, before.position_m, sizeof before.position_m);
    memcpy(pose->before_world_from_pane, before.world_from_pane, sizeof before.world_from_pane);
}

/* All that was drawn into layers once more, for its velocity. */
static virga_result draw_moving(shot *s, VkCommandBuffer cmd)
{
    host_target_begin_moving(&s->target, cmd);
    const virga_result splash = s->splash ? virga_splash_draw(s->splash, cmd, s->moving) : VIRGA_OK;
    const virga_result rain = virga_rain_draw(s->rain, cmd, s->moving);
    const virga_result panes = draw_each_pane(s, cmd, s->moving, virga_glass_draw); /* ends the pass */
    return splash < 0 ? splash : rain < 0 ? rain : panes;
}

/* `camera_s` is where the camera is on its path, `late_s` how long before the newest tick the picture is taken. */
static virga_result draw_panes(shot *s, VkCommandBuffer cmd, virga_view view, double camera_s, double late_s)
{
    virga_result result = draw_behind(s, cmd);
    view.color = host_target_behind(&s->target);
    for (uint32_t i = 0; i < s->scene->pane_count && result >= 0; i++) {
        virga_glass_pose pose;
        const shot_pane *pane = &s->panes[i];
        pose_pane(s, pane->from, camera_s, &pose);
        result = virga_glass_prepare(pane->glass, cmd, &view, &pose, virga_glass_time(pane->glass) - late_s);
    }
    if (result < 0)
        return result;
    host_target_begin_glass(&s->target, cmd);
    result = draw_each_pane(s, cmd, s->layer, virga_glass_draw);
    host_target_begin_refraction(&s->target, cmd);
    const virga_result refraction = draw_each_pane(s, cmd, s->layer, virga_glass_draw_refraction);
    return result < 0 ? result : refraction;
}

/* The opaque scene, or footage in its place. */
static bool record_plate(shot *s, VkCommandBuffer cmd, double camera_s, const host_camera *now,
                         const host_camera *frame_ago, char *error, size_t error_size)
{
    if (s->plate.pattern) {
        memcpy(s->plate_buffer.mapped, s->plate.rgba, s->plate_buffer.size);
        host_target_fill_plate(&s->target, cmd, &s->plate_buffer);
        return true;
    }
    if (!shot_panes_move_meshes(s, cmd, camera_s, error, error_size))
        return false;
    if (s->ground) {
        virga_ground_maps maps;
        virga_ground_maps_get(s->ground, &maps);
        host_renderer_set_ground(s->renderer, &maps);
    }
    host_renderer_plate(s->renderer, cmd, &s->target, now, frame_ago);
    return true;
}

/* When a picture is taken. */
typedef struct moment {
    double camera_s; /* on the camera's path */
    double late_s;   /* before the newest tick */
} moment;

static bool record_picture(shot *s, VkCommandBuffer cmd, const virga_view *view, moment at, const host_camera *now,
                           const host_camera *frame_ago, char *error, size_t error_size)
{
    if (!shot_ok(s, prepare(s, cmd, view, virga_rain_time(s->rain) - at.late_s), "preparing the rain", error,
                 error_size) ||
        !record_plate(s, cmd, at.camera_s, now, frame_ago, error, error_size) ||
        !shot_ok(s, draw_layers(s, cmd), "drawing the rain", error, error_size))
        return false;
    if (s->scene->pane_count &&
        !shot_ok(s, draw_panes(s, cmd, *view, at.camera_s, at.late_s), "drawing panes", error, error_size))
        return false;
    if (s->moving && !shot_ok(s, draw_moving(s, cmd), "drawing the velocity of water", error, error_size))
        return false;
    host_target_copy_out(&s->target, cmd, (1u << HOST_OUTPUT_COUNT) - 1);
    return true;
}

/* Motion vectors as the layer of velocities has them: from a frame ago on, in pixels. */
static void set_frame_ago(const shot *s, const host_camera *frame_ago, virga_view *view)
{
    virga_temporal *temporal = &view->temporal;
    memcpy(temporal->position_m, frame_ago->position_m, sizeof frame_ago->position_m);
    memcpy(temporal->view_from_world, frame_ago->view_from_world, sizeof frame_ago->view_from_world);
    memcpy(temporal->clip_from_view, frame_ago->clip_from_view, sizeof frame_ago->clip_from_view);
    temporal->ago_s = fmin(1 / s->scene->frames.fps, 1);
    temporal->motion_scale[0] = temporal->motion_scale[1] = -1;
    if (s->options.water_velocity)
        temporal->motion_coverage = 0.01f * (float)s->options.water_velocity;
}

/* One sub-frame: its share of the shutter time, seen with its jitter. The shutter closes at the frame's time. */
static bool draw_sample(shot *s, uint32_t sample, double time_s, char *error, size_t error_size)
{
    const double shutter_s = s->scene->frames.shutter_deg / 360 / s->scene->frames.fps;
    const double part_s = shutter_s / s->options.samples;
    const double close_s = time_s - part_s * (s->options.samples - 1 - sample);
    const double shot_start = host_camera_shot_start(&s->path, time_s);
    const uint32_t width = s->options.width, height = s->options.height;
    float jitter[2];
    host_camera now, open, frame_ago;
    host_camera_jitter(sample, s->options.samples, jitter);
    host_camera_at(&s->path, fmax(close_s, shot_start), width, height, jitter, &now);
    host_camera_at(&s->path, fmax(close_s - part_s, shot_start), width, height, jitter, &open);
    host_camera_at(&s->path, fmax(close_s - 1 / s->scene->frames.fps, shot_start), width, height, jitter, &frame_ago);

    VkCommandBuffer cmd;
    virga_view view = virga_default_view();
    view.depth = host_target_depth(&s->target);
    view.color = host_target_color(&s->target);
    host_camera_view(&now, &open, part_s, &view);
    set_frame_ago(s, &frame_ago, &view);
    const moment at = {fmax(close_s, shot_start), time_s - close_s};
    if (!begin(s, &cmd, error, error_size) || !record_picture(s, cmd, &view, at, &now, &frame_ago, error, error_size) ||
        !host_submit(&s->device, error, error_size) || !host_wait(&s->device, error, error_size))
        return false;
    host_accumulator_add(&s->frame, &s->device, &s->target, sample == s->options.samples / 2);
    return true;
}

bool shot_draw(shot *s, uint32_t frame, host_camera *camera, char *error, size_t error_size)
{
    if (!shot_step(s, frame, error, error_size) ||
        (s->plate.pattern && !plate_load(&s->plate, frame, error, error_size)))
        return false;
    const double time_s = shot_time(s, frame);
    host_camera_at(&s->path, time_s, s->options.width, s->options.height, NULL, camera);
    host_accumulator_reset(&s->frame);
    for (uint32_t sample = 0; sample < s->options.samples; sample++)
        if (!draw_sample(s, sample, time_s, error, error_size))
            return false;
    host_accumulator_finish(&s->frame);
    return true;
}
