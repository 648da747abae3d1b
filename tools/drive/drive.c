/* drive.c - a car in the rain: how a renderer embeds Virga. This is the file to read: it has all calls of Virga, in
 * the order in which a host needs them. engine/README.md explains it. stage.c is a small renderer and car.c a car; any
 * other would do. options, window, world, windshield and game are the rest of the program. They make no call of Virga;
 * the renderer only sees the maps and lamps that its material reads.
 *
 *     drive [MODEL.glb] [--track FILE] [--outside] [--focus] [--rain MM_H] [--wipers off|intermittent|slow|fast]
 *           [--start M] [--frames N --out FILE.png [--fps N | --real-time]] [--size WxH] [--quality NAME] [--budget MS]
 *           [--device N|gpu|cpu|NAME] [--pipelines FILE]
 *
 * Keys: C camera, F focus, W wipers, arrows drive (A: it drives itself again), + and - rain, Esc ends.
 */
#include "game.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define PLACE_S       0.5f /* in which the light of a place becomes that of the next */
#define PLACE_SHARE   0.5f /* of it; the rest is the whole sky's. 1, as a camera records it, has less haze */
#define NEAR_ENOUGH_M 60   /* farther occluders have no visible effect on the rain */

/* Turns an error of Virga into one line that names what failed. The log has the reason. Warnings are not errors. */
static bool fine(drive *d, virga_result result, const char *doing)
{
    return result >= 0 || host_fail(d->error, sizeof d->error, "%s: %s", doing, virga_result_name(result));
}

/* ---- 1. a device with the features that Virga needs ------------------------------------------------------------ */

static bool create_device(drive *d, const host_device_info *chosen)
{
    char *error = d->error;
    const size_t error_size = sizeof d->error;
    VkPhysicalDeviceVulkan12Features features12 = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES};
    VkPhysicalDeviceFeatures2 features = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2, .pNext = &features12};
    if (!fine(d, virga_enable_features(&features), "features"))
        return false;
    /* ... and here a host sets its own. */
    VkPhysicalDeviceFeatures available;
    vkGetPhysicalDeviceFeatures(chosen->physical, &available);
    features.features.wideLines = available.wideLines; /* faster on software Vulkan */
    const float priority = 1;
    const char *extensions[HOST_DEVICE_EXTENSIONS];
    const VkDeviceQueueCreateInfo queue = {
        .sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO,
        .queueFamilyIndex = chosen->queue_family,
        .queueCount = 1,
        .pQueuePriorities = &priority,
    };
    const VkDeviceCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO,
        .pNext = &features,
        .queueCreateInfoCount = 1,
        .pQueueCreateInfos = &queue,
        .enabledExtensionCount = host_device_extensions(chosen->physical, d->window, extensions),
        .ppEnabledExtensionNames = extensions,
    };
    VkDevice device;
    HOST_TRY(vkCreateDevice(chosen->physical, &info, NULL, &device));
    if (!host_device_wrap(&d->device, &d->listed, chosen, device, error, error_size)) /* with two frames in flight */
        return false;
    d->device.wide_lines = available.wideLines;
    d->device.independent_blend = true; /* blending into one attachment needs no feature */
    return true;
}

static bool open_device(drive *d)
{
    host_device_info infos[HOST_MAX_DEVICES];
    uint32_t index = 0;
    if (!open_window(d))
        return false;
    const uint32_t count = host_devices_list(&d->listed, infos, HOST_MAX_DEVICES); /* calls virga_check_device */
    if (!host_device_pick(infos, count, d->chosen.device, &index, d->error, sizeof d->error))
        return false;
    VkBool32 shows = !d->window;
    if (d->window && vkGetPhysicalDeviceSurfaceSupportKHR(infos[index].physical, infos[index].queue_family, d->surface,
                                                          &shows) != VK_SUCCESS)
        shows = VK_FALSE;
    if (!shows)
        return host_fail(d->error, sizeof d->error, "%s does not show pictures in this window", infos[index].name);
    d->kind = infos[index].type;
    if (!d->chosen.has_quality)
        d->quality = infos[index].type == VK_PHYSICAL_DEVICE_TYPE_CPU              ? VIRGA_QUALITY_LOW
                     : infos[index].type == VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU ? VIRGA_QUALITY_MEDIUM
                                                                                   : VIRGA_QUALITY_HIGH;
    return create_device(d, &infos[index]);
}

/* ---- 2. a context: Virga on the device --------------------------------------------------------------------------- */

static void print_log(void *user, virga_log_level level, virga_log_id id, const char *text)
{
    (void)user;
    if (level != VIRGA_LOG_INFO)
        fprintf(stderr, "virga (%s): %s\n", virga_log_name(id), text);
}

static bool create_context(drive *d)
{
    size_t size = 0;
    void *compiled = NULL;
    FILE *file = d->chosen.pipelines ? fopen(d->chosen.pipelines, "rb") : NULL;
    if (file) { /* pipelines that an earlier run compiled; the data of another driver is ignored */
        compiled = malloc(64u << 20);
        size = compiled ? fread(compiled, 1, 64u << 20, file) : 0;
        fclose(file);
    }
    virga_context_def def = virga_default_context_def();
    def.instance = d->instance;
    def.physical_device = d->device.physical;
    def.device = d->device.device;
    def.queue_family = d->device.queue_family;
    def.get_instance_proc_addr = vkGetInstanceProcAddr;
    def.frames_in_flight = HOST_FRAMES;
    def.pipeline_cache = compiled;
    def.pipeline_cache_size = size;
    def.log = print_log;
    def.timings = d->chosen.out;               /* they are printed then. Without them effects share barriers on GPUs */
    if (d->chosen.out && !d->chosen.real_time) /* a frame may take longer: only what is used is compiled */
        def.pipeline_build_mode = VIRGA_PIPELINES_ON_USE;
    def.wide_lines = d->device.wide_lines;
    const virga_result result = virga_context_create(&def, &d->context);
    free(compiled); /* copied */
    return fine(d, result, "context");
}

static void keep_pipelines(drive *d)
{
    size_t size = 0;
    if (!d->chosen.pipelines || virga_pipeline_cache_get(d->context, &size, NULL) < 0)
        return;
    void *compiled = malloc(size);
    FILE *file = compiled && virga_pipeline_cache_get(d->context, &size, compiled) >= 0
                     ? fopen(d->chosen.pipelines, "wb")
                     : NULL;
    if (file) {
        fwrite(compiled, 1, size, file);
        fclose(file);
    }
    free(compiled);
}

/* ---- 3. a scene: rain, the ground that it wets, splashes, a windshield ------------------------------------------- */

static bool create_rain(drive *d)
{
    virga_glass_def windshield = virga_default_glass_def();
    virga_scene_def def = virga_default_scene_def();
    virga_scene_apply_quality(d->quality, &def);
    virga_glass_apply_quality(d->quality, &windshield);
    windshield.width_m = CAR_GLASS_WIDTH_M;
    windshield.height_m = CAR_GLASS_HEIGHT_M;
    windshield.max_texels = 2048; /* enough for a pane that fills the picture */

    if (d->chosen.out && !d->chosen.real_time)
        def.rain.max_ticks_per_step = 64; /* frames of files may be long, and are simulated in full */
    def.rain.occlusion_slants = 1;
    def.rain.max_panes = 1; /* the windshield catches the same drops that are drawn */
    def.rain.occluder_strides[0] = sizeof(host_vertex);
    def.with_ground = true;
    def.with_splash = true;
    def.with_contacts = true; /* the wheels throw water */
    def.splash.max_drips = MAX_DRIPS + MAX_CAR_DRIPS;
    def.panes = &windshield;
    def.pane_count = 1;
    virga_scene_cost(&def, d->kind, d->stage.width, d->stage.height, &d->expected);
    return fine(d, virga_scene_create(d->context, &def, &d->rain), "scene");
}

static virga_glass_wiper wiper(float pivot_u_m, float reach_m, float blade_m)
{
    virga_glass_wiper w = virga_default_glass_wiper();
    w.pivot_m[0] = pivot_u_m; /* u runs to the right seen from outside: 0 is on the passenger's side */
    w.pivot_m[1] = -0.05f;
    w.reach_m = reach_m;
    w.blade_m = blade_m;
    w.low_deg = 177;
    w.high_deg = 78;
    w.drive = VIRGA_GLASS_HOST; /* the host sets the angle: the key W controls it */
    w.host_deg = w.low_deg;
    return w;
}

/* Shapes and settings can be set at the start and at any time later. */
static bool set_rain(drive *d)
{
    virga_glass *glass = virga_scene_glass(d->rain, 0);
    virga_glass_shape shape = virga_default_glass_shape();
    virga_glass_fill_windshield(CAR_GLASS_WIDTH_M, CAR_GLASS_HEIGHT_M, CAR_GLASS_RAKE_DEG, CAR_GLASS_BEND_M,
                                PANE_POINTS, PANE_POINTS, d->pane);
    shape.positions = d->pane;
    shape.columns = shape.rows = PANE_POINTS;
    mask_pane(d);
    shape.mask = d->glass_at;
    shape.mask_columns = shape.mask_rows = PANE_TEXELS;
    if (!fine(d, virga_glass_shape_set(glass, &shape), "windshield"))
        return false;
    d->glass = virga_default_glass_settings();
    virga_glass_apply_kind(VIRGA_GLASS_KIND_CLEAN, &d->glass);
    d->glass.wiper_count = WIPERS;
    d->glass.wipers[0] = wiper(1.12f, 1.0f, 0.8f);
    d->glass.wipers[1] = wiper(0.58f, 0.72f, 0.6f);

    virga_ground_settings ground = virga_default_ground_settings(); /* wet from an hour of rain */
    ground.start_wetness = 0.8f;
    ground.start_water_mm = 1.6f;
    ground.measure = false;
    virga_splash_settings splash = virga_default_splash_settings();
    splash.gain = 2; /* 1 is what a camera records */
    for (int state = 0; state < VIRGA_GROUND_STATES; state++)
        splash.rules[VIRGA_MATERIAL_GLASS][state].model = VIRGA_SPLASH_NONE; /* parts of the car without splashes */
    return fine(d, virga_ground_set(virga_scene_ground(d->rain), &ground), "ground") &&
           fine(d, virga_splash_set(virga_scene_splash(d->rain), &splash), "splashes");
}

/* Edges of awnings, balconies and trees, of all that were found those near the camera, and those of the car. */
static bool set_drips(drive *d)
{
    move_drips(d);
    return fine(d, virga_splash_set_drips(virga_scene_splash(d->rain), d->drips, d->drip_count + d->car_drip_count),
                "edges that drip");
}

static bool set_rate(drive *d)
{
    virga_rain_settings rain = virga_default_rain_settings();
    d->set_mm_h = rain.rate_mm_h = d->rate_mm_h;
    rain.wind_m_s[0] = 1.2f;
    rain.wind_m_s[2] = 0.4f;
    rain.gust_m_s = 0.8f;
    rain.streak_gain = 2;
    rain.light_gain = 2;
    rain.walls.start_h = 1;  /* walls are wet from that hour as well */
    rain.near_fade_m = 1.6f; /* hides nearer drops, so that none falls inside the car */
    rain.lighting = d->place;
    return fine(d, virga_rain_set(virga_scene_rain(d->rain), &rain), "rain");
}

/* ---- 4. a target: what it is drawn into -------------------------------------------------------------------------- */

static bool attach(drive *d)
{
    virga_target_def def = virga_default_target_def();
    def.kind = VIRGA_TARGET_RENDER_PASS;
    def.render_pass = d->stage.over_pass; /* color alone: a depth that is sampled (virga_view.depth) is not attached */
    def.depth_attached = false;
    return fine(d, virga_target_create(d->context, &def, &d->target), "target") &&
           fine(d, virga_scene_attach(d->rain, d->target), "pipelines");
}

/* (optional) A lens in place: it blends what is out of focus over the picture, and leaves all else alone. A lens is for
 * pictures up to a size, so there is another one after the window has grown. */
static bool create_lens(drive *d)
{
    virga_lens_def def = virga_default_lens_def();
    virga_lens_destroy(&d->lens);
    def.max_width = d->stage.width > 16 ? d->stage.width : 16;
    def.max_height = d->stage.height > 16 ? d->stage.height : 16;
    def.half_resolution = 1;
    def.in_place = 1;
    return fine(d, virga_lens_create(d->context, &def, &d->lens), "lens") &&
           fine(d, virga_lens_attach(d->lens, d->target), "pipelines of the lens");
}

/* ---- 5. a frame -------------------------------------------------------------------------------------------------- */

/* Lamps of the street and of the car. They light both the street and the water. */
static void light_up(drive *d)
{
    d->lighting = virga_default_lighting();
    memcpy(d->lighting.environment_sh, d->environment.sh, sizeof d->lighting.environment_sh);
    for (uint32_t i = 0; i < d->track.lamp_count; i++) {
        virga_light *lamp = &d->lighting.lights[d->lighting.light_count++];
        memcpy(lamp->position_m, d->track.lamps[i].position_m, sizeof lamp->position_m);
        memcpy(lamp->intensity, d->track.lamps[i].intensity, sizeof lamp->intensity);
        lamp->range_m = 30;
    }
    for (int i = 0; i < 4; i++) {
        const bool head = i < 2;
        virga_light *lamp = &d->lighting.lights[d->lighting.light_count++];
        car_point(&d->car, head ? car_head_lamps_m[i] : car_tail_lamps_m[i - 2], lamp->position_m);
        memcpy(lamp->intensity, head ? (float[3]){16, 14, 11.5f} : (float[3]){0.5f, 0.02f, 0.01f},
               sizeof lamp->intensity);
        for (int axis = 0; axis < 3; axis++)
            lamp->direction[axis] = (head ? -1 : 1) * d->car.axes[6 + axis] - 0.07f * d->car.axes[3 + axis];
        lamp->range_m = head ? 45 : 8;
        lamp->cos_inner = head ? 0.985f : 0.5f;
        lamp->cos_outer = head ? 0.87f : 0;
    }
}

/* Between houses drops show their fronts as well as the sky. Found from heights for the camera in each frame, and
 * eased, as it jumps where one passes a corner. A host with light probes takes those. */
static void light_place(drive *d, double dt_s)
{
    const float part = d->placed ? 1 - expf(-(float)dt_s / PLACE_S) : 1;
    float now[9][3], before[9][3];
    place_light(&d->heights, d->environment.sh, d->camera.position_m, now);
    memcpy(before, d->place.environment_sh, sizeof before);
    d->place = d->lighting;
    for (int k = 0; k < 9; k++)
        for (int c = 0; c < 3; c++) {
            const float sky = d->environment.sh[k][c], wanted = sky + PLACE_SHARE * (now[k][c] - sky);
            d->place.environment_sh[k][c] = before[k][c] + part * (wanted - before[k][c]);
        }
    d->placed = true;
}

/* Occluders keep rain off, get wet and have splashes: all meshes nearby, and the moving car. */
static uint32_t fill_occluders(drive *d)
{
    uint32_t count = host_mesh_occluders(&d->street, d->occluders, MAX_OCCLUDERS - 2), kept = 0;
    for (uint32_t i = 0; i < count && i < MAX_OCCLUDERS - 2; i++) {
        const host_primitive *primitive = &d->street.primitives[i];
        double off2 = 0;
        for (int axis = 0; axis < 3; axis += 2) {
            const double at = d->camera.position_m[axis];
            const double off = fmax(fmax((double)primitive->low[axis] - at, at - (double)primitive->high[axis]), 0);
            off2 += off * off;
        }
        if (off2 < (double)NEAR_ENOUGH_M * NEAR_ENOUGH_M || d->occluders[i].ground)
            d->occluders[kept++] = d->occluders[i];
    }
    /* Splashes do not move with the car, so a moving car has none. */
    const bool still = d->car.speed_m_s < 1;
    virga_occluder of_car[MAX_PARTS];
    count = host_mesh_occluders(&d->body, of_car, MAX_PARTS);
    for (uint32_t i = 0; i < count && i < MAX_PARTS && kept < MAX_OCCLUDERS; i++) {
        const car_part part = car_part_of(d->body.materials[d->body.primitives[i].material].name);
        if (part != CAR_COVER && part != CAR_SCREEN)
            continue;
        virga_occluder *cover = &d->occluders[kept++];
        *cover = of_car[i];
        cover->material = part == CAR_COVER && still ? VIRGA_MATERIAL_STEEL : VIRGA_MATERIAL_GLASS;
        cover->ground = false;
        cover->is_dynamic = true;
        for (int row = 0; row < 3; row++) {
            for (int column = 0; column < 3; column++)
                cover->world_from_mesh[4 * row + column] = d->car.axes[3 * column + row];
            cover->world_from_mesh[4 * row + 3] = (float)d->car.position_m[row];
        }
    }
    return kept;
}

/* The pose and the motion of the windshield. Head wind and accelerations move its drops. */
static virga_scene_pane place_windshield(const drive *d)
{
    virga_scene_pane pane = {.shelter = 0};
    car_point(&d->car, car_windshield_m, pane.pose.position_m);
    for (int i = 0; i < 3; i++) { /* seen from outside: x points to the left of the car, z forward */
        pane.pose.world_from_pane[i] = -d->car.axes[i];
        pane.pose.world_from_pane[3 + i] = d->car.axes[3 + i];
        pane.pose.world_from_pane[6 + i] = -d->car.axes[6 + i];
        pane.velocity_m_s[i] = d->car.velocity_m_s[i];
        pane.acceleration_m_s2[i] = d->car.acceleration_m_s2[i];
        pane.angular_velocity_rad_s[i] = d->car.angular_velocity_rad_s[i];
    }
    return pane;
}

/* The wheels on the wet road. The body covers the tread behind them. */
static void place_wheels(const drive *d, virga_wheel wheels[4])
{
    for (int i = 0; i < 4; i++) {
        float axes[9];
        wheels[i] = virga_default_wheel();
        wheels[i].id = (uint32_t)i;
        wheels[i].radius_m = CAR_WHEEL_RADIUS_M;
        wheels[i].width_m = CAR_WHEEL_WIDTH_M;
        car_wheel(&d->car, i, wheels[i].contact_m, axes);
        for (int axis = 0; axis < 3; axis++) {
            wheels[i].contact_m[axis] -= (double)(CAR_WHEEL_RADIUS_M * d->car.axes[3 + axis]);
            wheels[i].velocity_m_s[axis] = d->car.velocity_m_s[axis];
            wheels[i].axle[axis] = axes[axis];
        }
    }
}

static virga_image seen(const host_image *image, VkImageLayout layout)
{
    return (virga_image){.image = image->image,
                         .view = image->view,
                         .format = image->format,
                         .extent = image->extent,
                         .before = {layout, VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT, VK_ACCESS_SHADER_READ_BIT},
                         .after = {layout, VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT, VK_ACCESS_SHADER_READ_BIT}};
}

/* The view for Virga: this camera, that of the previous frame, and the scene's depth and color. */
static virga_view look(const drive *d, double dt_s)
{
    const stage_camera *now = &d->camera, *then = d->has_last_camera ? &d->last_camera : now;
    virga_view view = virga_default_view();
    memcpy(view.position_m, now->position_m, sizeof view.position_m);
    memcpy(view.view_from_world, now->view_from_world, sizeof view.view_from_world);
    memcpy(view.clip_from_view, now->clip_from_view, sizeof view.clip_from_view);
    memcpy(view.open_position_m, then->position_m, sizeof view.open_position_m);
    memcpy(view.open_view_from_world, then->view_from_world, sizeof view.open_view_from_world);
    memcpy(view.open_clip_from_view, now->clip_from_view, sizeof view.open_clip_from_view);
    view.open_camera_s = dt_s;
    view.shutter_s = fmin(1.0 / 60, dt_s);
    view.viewport[2] = (float)d->stage.width;
    view.viewport[3] = (float)d->stage.height;
    view.depth = seen(&d->stage.depth, VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL);
    view.color = seen(&d->stage.behind, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
    return view;
}

/* The focus is on the windshield: the street behind it gets soft. Rain is a part of the picture here. A host that keeps
 * it apart gives it as a layer, with a depth of its own. */
static bool blur_street(drive *d, VkCommandBuffer cmd, virga_view view)
{
    virga_lens_settings lens = virga_default_lens_settings();
    double glass_m[3], off2 = 0;
    car_point(&d->car, car_windshield_m, glass_m);
    for (int axis = 0; axis < 3; axis++)
        off2 += (glass_m[axis] - d->camera.position_m[axis]) * (glass_m[axis] - d->camera.position_m[axis]);
    lens.focal_m = 0.035f;
    lens.aperture_f = (float)(2 / d->focus); /* it opens while the focus changes */
    lens.focus_m = (float)sqrt(off2);
    lens.max_radius_px = 16; /* up to this, one pass does it all */
    view.color = seen(&d->stage.color, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
    if (!fine(d, virga_lens_set(d->lens, &lens), "lens") ||
        !fine(d, virga_lens_prepare(d->lens, cmd, &view, NULL, 0, d->time_s), "focus"))
        return false;
    stage_sampled(&d->stage, cmd);
    stage_over_begin(&d->stage, cmd);
    const virga_result drawn = virga_lens_draw(d->lens, cmd, d->target);
    stage_over_end(&d->stage, cmd);
    return fine(d, drawn, "draw of the lens");
}

/* Drops show what is behind them with its haze and its rain, so it is copied once more. Else they would be dark spots
 * before a street that the haze has made bright. */
static bool draw_windshield(drive *d, VkCommandBuffer cmd, virga_view view, const virga_scene_pane *pane)
{
    stage_through(&d->stage, cmd);
    view.color = seen(&d->stage.through, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
    if (!fine(d, virga_scene_prepare_panes(d->rain, cmd, &view, pane), "windshield"))
        return false;
    stage_over_begin(&d->stage, cmd);
    const virga_result drawn = virga_glass_draw(virga_scene_glass(d->rain, 0), cmd, d->target);
    stage_over_end(&d->stage, cmd);
    return fine(d, drawn, "draw");
}

/* Records a whole frame. */
static bool record(drive *d, VkCommandBuffer cmd, double dt_s)
{
    const virga_view view = look(d, dt_s);
    const virga_scene_pane pane = place_windshield(d);
    virga_wheel wheels[4];
    virga_scene_frame frame = {.dt_s = dt_s, .view = &view, .panes = &pane, .defer_panes = true};
    place_wheels(d, wheels);
    frame.wheels = wheels;
    frame.wheel_count = 4;
    frame.occluders = d->occluders;
    frame.occluder_count = fill_occluders(d);
    frame.step_budget_ms = d->budget_ms;
    for (int axis = 0; axis < 3; axis++) {
        frame.camera_m[axis] = d->camera.position_m[axis];
        frame.ripple_center_m[axis] = d->car.position_m[axis] - 3.0 * (double)d->car.axes[6 + axis];
    }
    if (!fine(d, virga_frame_begin(d->context, d->device.frame, d->device.completed), "frame") ||
        !fine(d, virga_scene_lighting_set(d->rain, &d->place), "light") || !set_drips(d) ||
        !fine(d, virga_scene_record(d->rain, cmd, &frame), "step"))
        return false;

    virga_ground_maps maps; /* sampled by the street's material */
    virga_ground_maps_get(virga_scene_ground(d->rain), &maps);
    virga_walls walls;
    virga_rain_walls_get(virga_scene_rain(d->rain), &walls);
    draw_world(d, cmd, &maps, &walls); /* color, depth; `behind` is a copy of color now */

    stage_over_begin(&d->stage, cmd);
    const bool splashes = fine(d, virga_splash_draw(virga_scene_splash(d->rain), cmd, d->target), "splashes");
    const bool rain = fine(d, virga_rain_draw(virga_scene_rain(d->rain), cmd, d->target), "rain");
    stage_over_end(&d->stage, cmd);
    return splashes && rain && (d->focus <= 0 || blur_street(d, cmd, view)) && draw_windshield(d, cmd, view, &pane);
}

/* Binds the images that the street's material samples: once, and after a resize. */
static void bind_maps(drive *d)
{
    virga_ground_maps maps;
    virga_ground_maps_get(virga_scene_ground(d->rain), &maps);
    stage_bind(&d->stage, &maps, &d->environment);
}

/* Advances the world by dt_s and draws it. With `keep`, its picture can be read afterwards. */
static bool run_frame(drive *d, double dt_s, bool keep)
{
    VkCommandBuffer cmd;
    bool resized;
    if (d->rate_mm_h != d->set_mm_h && !set_rate(d))
        return false;
    if (!stage_begin(&d->stage, &cmd, &resized, d->error, sizeof d->error))
        return false;
    if (resized) {
        bind_maps(d);
        if (d->lens && d->stage.width && !create_lens(d))
            return false;
    }
    if (!cmd) {
        if (d->window && !resized)
            glfwWaitEventsTimeout(0.1); /* minimised */
        return true;
    }
    car_drive(&d->car, &d->track, &d->keys, dt_s);
    move_wipers(d, dt_s);
    move_camera(d, d->has_last_camera ? dt_s : 0);
    move_focus(d, dt_s);
    light_up(d);
    light_place(d, dt_s);
    put_wipers(d);
    host_mesh_move(cmd, &d->wipers, d->boxes.vertices);
    if (!fine(d, virga_glass_set(virga_scene_glass(d->rain, 0), &d->glass), "wipers") || !record(d, cmd, dt_s))
        return false;
    d->last_camera = d->camera;
    d->has_last_camera = true;
    return stage_end(&d->stage, cmd, &d->camera, keep, d->error, sizeof d->error);
}

/* ---- 6. the end of it -------------------------------------------------------------------------------------------- */

static void print_cost(const drive *d)
{
    virga_pass_time times[64];
    virga_memory_stats memory;
    const uint32_t count = virga_timings_get(d->context, times, 64);
    virga_memory_get(d->context, &memory);
    for (uint32_t i = 0; i < count && i < 64; i++)
        printf("%-24s %8.3f ms\n", times[i].name, times[i].milliseconds);
    printf("%-24s %8.3f ms a tick, %.3f a frame, %.3f to draw\n", "expected (of kind)", (double)d->expected.tick_ms,
           (double)d->expected.frame_ms, (double)d->expected.draw_ms);
    printf("%-24s %8.1f MiB in %u allocations\n", "device memory", (double)memory.device_bytes / 1048576,
           memory.device_allocations);
}

/* All recorded commands must have completed. The order is free, but the context is last. */
static void destroy_rain(drive *d)
{
    virga_lens_destroy(&d->lens);
    virga_scene_destroy(&d->rain);
    virga_target_destroy(&d->target);
    virga_context_destroy(&d->context);
}

/* ---- all of it --------------------------------------------------------------------------------------------------- */

static bool run(drive *d)
{
    if (!open_device(d) ||
        !stage_create(&d->stage, &d->device, d->window, d->surface, d->chosen.width, d->chosen.height, d->error,
                      sizeof d->error) ||
        !create_context(d) || !create_rain(d) || !set_rain(d) || !load_world(d))
        return false;
    car_place(&d->car, &d->track, d->chosen.start_m);
    light_up(d);
    d->place = d->lighting;
    bind_maps(d);
    if (!set_rate(d) || !attach(d) || !create_lens(d))
        return false;
    double dt_s;
    while (next_frame(d, &dt_s))
        if (!run_frame(d, dt_s, d->chosen.out && d->frame == d->chosen.frames))
            return false;
    if (!host_wait(&d->device, d->error, sizeof d->error))
        return false;
    if (!d->chosen.out)
        return true;
    if (!finish_file(d) || !fine(d, virga_frame_completed(d->context, d->device.completed), "end"))
        return false;
    print_cost(d);
    return true;
}

static void close_all(drive *d)
{
    if (d->device.device)
        vkDeviceWaitIdle(d->device.device);
    if (d->context)
        keep_pipelines(d);
    destroy_rain(d);
    unload_world(d);
    free(d->frame_s);
    free(d->work_s);
    stage_destroy(&d->stage);
    host_device_destroy(&d->device);
    close_window(d);
}

int main(int argc, char **argv)
{
    static drive d;
    if (argc == 2 && strcmp(argv[1], "--help") == 0) {
        print_help();
        return 0;
    }
    if (!read_command_line(&d, argc, argv))
        return 2;
    if (!d.chosen.out && !glfwInit()) {
        fprintf(stderr, "drive: no display to open a window on; --frames N --out FILE.png needs none\n");
        return 1;
    }
    if (!d.chosen.out)
        glfwWindowHint(GLFW_CLIENT_API, GLFW_NO_API);
    const bool good = run(&d);
    close_all(&d);
    if (!d.chosen.out)
        glfwTerminate();
    if (!good)
        fprintf(stderr, "drive: %s\n", d.error[0] ? d.error : "out of memory");
    return good ? 0 : 1;
}
