/* drive.c - a car in the rain: how a renderer takes Virga in. This is the file to read; it has all calls of Virga, in
 * the order that a host comes to them, and README.md walks through it. stage.c is a small renderer and car.c a car: any
 * others would do. They make no call of Virga; of it the renderer sees only the maps and lamps that its material reads.
 *
 *     drive [MODEL.glb] [--track FILE] [--outside] [--rain MM_H] [--wipers off|intermittent|slow|fast] [--start M]
 *           [--frames N --out FILE.png [--fps N]] [--size WxH] [--device N|gpu|cpu|NAME] [--pipelines FILE]
 *
 * Keys: C camera, W wipers, arrows drive (A: it drives itself again), + and - rain, Esc ends.
 */
#define GLFW_INCLUDE_VULKAN
#include <GLFW/glfw3.h>

#include <virga/virga.h>

#include "car.h"
#include "exr.h"
#include "png.h"
#include "stage.h"

#include <getopt.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define MOST_WINDOW_EXTENSIONS 8
#define PANE_POINTS            33  /* along each side of the windshield's grid */
#define PANE_TEXELS            256 /* and of its mask */
#define MOST_OCCLUDERS         4096
#define NEAR_ENOUGH_M          60 /* what is farther keeps no rain off that could be seen */
#define WIPERS                 2
#define MOST_PARTS             64 /* primitives of the car */

enum { OFF, INTERMITTENT, SLOW, FAST, WIPER_SPEEDS };
static const char *const wiper_names[WIPER_SPEEDS] = {"off", "intermittent", "slow", "fast"};

typedef struct choices {
    const char *model, *track, *out, *device, *pipelines;
    uint32_t frames, fps, width, height;
    double start_m;
} choices;

typedef struct drive {
    choices chosen;
    char error[1024];

    /* The host's own: Vulkan, a renderer, a street, a car. */
    VkInstance instance;
    host_instance listed; /* `instance`, as the list of devices takes it */
    host_device device;
    GLFWwindow *window;
    VkSurfaceKHR surface;
    stage stage;
    host_environment environment;
    host_mesh street, blocks, body, wipers;
    track track;
    car car;
    car_keys keys;
    bool outside;
    double eye_m[3]; /* of the camera outside, which lags behind */
    stage_camera camera, last_camera;
    bool has_last_camera;

    /* Virga's. */
    virga_context *context;
    virga_scene *rain;
    virga_target *target;
    virga_lighting lighting;
    virga_glass_settings glass;
    float pane[PANE_POINTS * PANE_POINTS * 3];
    uint8_t glass_at[PANE_TEXELS * PANE_TEXELS];
    virga_occluder occluders[MOST_OCCLUDERS];
    float rate_mm_h;
    int wiper_speed;
    double wiper_s; /* into the wipers' cycle */
} drive;

/* An error of Virga's is one line that names what was being done; the log has said why. Remarks are no errors. */
static bool fine(drive *d, virga_result result, const char *doing)
{
    return result >= 0 || host_fail(d->error, sizeof d->error, "%s: %s", doing, virga_result_name(result));
}

/* ---- 1. a device with the features that Virga needs ------------------------------------------------------------ */

static bool create_instance(drive *d)
{
    char *error = d->error;
    const size_t error_size = sizeof d->error;
    uint32_t count = 0;
    const char **asked = d->chosen.out ? NULL : glfwGetRequiredInstanceExtensions(&count);
    const char *extensions[MOST_WINDOW_EXTENSIONS + 1];
    count = count < MOST_WINDOW_EXTENSIONS ? count : MOST_WINDOW_EXTENSIONS;
    for (uint32_t i = 0; i < count; i++)
        extensions[i] = asked[i];
    const VkApplicationInfo application = {
        .sType = VK_STRUCTURE_TYPE_APPLICATION_INFO, .pApplicationName = "drive", .apiVersion = VIRGA_VULKAN_API};
    VkInstanceCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO,
        .pApplicationInfo = &application,
        .enabledExtensionCount = count,
        .ppEnabledExtensionNames = extensions,
    };
    host_ask_portability(&info, extensions);
    HOST_TRY(vkCreateInstance(&info, NULL, &d->instance));
    d->listed.instance = d->instance;
    if (!d->chosen.out) {
        d->window = glfwCreateWindow((int)d->chosen.width, (int)d->chosen.height, "drive", NULL, NULL);
        if (!d->window)
            return host_fail(error, error_size, "no window");
        HOST_TRY(glfwCreateWindowSurface(d->instance, d->window, NULL, &d->surface));
    }
    return true;
}

static bool create_device(drive *d, const host_device_info *chosen)
{
    char *error = d->error;
    const size_t error_size = sizeof d->error;
    VkPhysicalDeviceVulkan12Features features12 = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES};
    VkPhysicalDeviceFeatures2 features = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2, .pNext = &features12};
    if (!fine(d, virga_enable_features(&features), "features"))
        return false;
    /* ... and here a host sets its own. */
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
    HOST_TRY(vkCreateDevice(chosen->physical, &info, NULL, &d->device.device));
    return true;
}

/* Two frames in flight, each with a command buffer and a fence. */
static bool create_frames(drive *d, const host_device_info *chosen)
{
    char *error = d->error;
    const size_t error_size = sizeof d->error;
    host_device *device = &d->device;
    device->instance = &d->listed;
    device->physical = chosen->physical;
    device->queue_family = chosen->queue_family;
    device->independent_blend = true; /* glass is blended: one attachment needs no feature for it */
    vkGetPhysicalDeviceProperties(device->physical, &device->properties);
    vkGetPhysicalDeviceMemoryProperties(device->physical, &device->memory);
    vkGetDeviceQueue(device->device, device->queue_family, 0, &device->queue);
    for (uint32_t i = 0; i < HOST_FRAMES; i++) {
        host_frame *frame = &device->frames[i];
        const VkFenceCreateInfo fence = {.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO};
        const VkCommandPoolCreateInfo pool = {.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
                                              .flags = VK_COMMAND_POOL_CREATE_TRANSIENT_BIT,
                                              .queueFamilyIndex = device->queue_family};
        HOST_TRY(vkCreateFence(device->device, &fence, NULL, &frame->fence));
        HOST_TRY(vkCreateCommandPool(device->device, &pool, NULL, &frame->pool));
        const VkCommandBufferAllocateInfo cmd = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
                                                 .commandPool = frame->pool,
                                                 .level = VK_COMMAND_BUFFER_LEVEL_PRIMARY,
                                                 .commandBufferCount = 1};
        HOST_TRY(vkAllocateCommandBuffers(device->device, &cmd, &frame->cmd));
    }
    return true;
}

static bool open_device(drive *d)
{
    host_device_info infos[HOST_MAX_DEVICES];
    uint32_t index = 0;
    if (!create_instance(d))
        return false;
    const uint32_t count = host_devices_list(&d->listed, infos, HOST_MAX_DEVICES); /* asks virga_check_device */
    if (!host_device_pick(infos, count, d->chosen.device, &index, d->error, sizeof d->error))
        return false;
    VkBool32 shows = !d->window;
    if (d->window && vkGetPhysicalDeviceSurfaceSupportKHR(infos[index].physical, infos[index].queue_family, d->surface,
                                                          &shows) != VK_SUCCESS)
        shows = VK_FALSE;
    if (!shows)
        return host_fail(d->error, sizeof d->error, "%s does not show pictures in this window", infos[index].name);
    return create_device(d, &infos[index]) && create_frames(d, &infos[index]);
}

/* ---- 2. a context: the device taken into use --------------------------------------------------------------------- */

static void say(void *user, virga_log_level level, virga_log_id id, const char *text)
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
    if (file) { /* what an earlier run compiled; a blob from another driver is ignored */
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
    def.log = say;
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
    const bool software = d->device.properties.deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU;
    virga_glass_def windshield = virga_default_glass_def();
    windshield.width_m = CAR_GLASS_WIDTH_M;
    windshield.height_m = CAR_GLASS_HEIGHT_M;
    windshield.max_texels = software ? 1024 : 2048; /* fine enough for one that fills the picture */

    virga_scene_def def = virga_default_scene_def();
    def.rain.max_drops = software ? 32768 : 131072;
    def.rain.occlusion_size = software ? 512 : 1024;
    def.rain.occlusion_slants = 1;
    def.rain.max_panes = 1; /* the windshield catches the very drops that are seen to fall */
    def.rain.occluder_strides[0] = sizeof(host_vertex);
    def.with_ground = true;
    def.ground.cells = software ? 512 : 1024;
    def.with_splash = true;
    def.panes = &windshield;
    def.pane_count = 1;
    return fine(d, virga_scene_create(d->context, &def, &d->rain), "scene");
}

static virga_glass_wiper wiper(float pivot_u_m, float reach_m, float blade_m)
{
    virga_glass_wiper w = virga_default_glass_wiper();
    w.pivot_m[0] = pivot_u_m; /* u runs to the right seen from outside: 0 is before the passenger */
    w.pivot_m[1] = -0.05f;
    w.reach_m = reach_m;
    w.blade_m = blade_m;
    w.low_deg = 177;
    w.high_deg = 78;
    w.drive = VIRGA_GLASS_HOST; /* stands where `host_deg` says: the key W is ours */
    w.host_deg = w.low_deg;
    return w;
}

/* The pillars lean in: above, the pane is narrower than below. */
static const uint8_t *mask_pane(drive *d)
{
    for (int row = 0; row < PANE_TEXELS; row++) {
        const float up = ((float)row + 0.5f) / PANE_TEXELS,
                    half = 0.5f - 0.5f * up * (1 - CAR_GLASS_TOP_M / CAR_GLASS_WIDTH_M);
        for (int column = 0; column < PANE_TEXELS; column++)
            d->glass_at[row * PANE_TEXELS + column] = fabsf(((float)column + 0.5f) / PANE_TEXELS - 0.5f) < half;
    }
    return d->glass_at;
}

/* Shapes and settings: at the start, and any time later. */
static bool set_rain(drive *d)
{
    virga_glass *glass = virga_scene_glass(d->rain, 0);
    virga_glass_shape shape = virga_default_glass_shape();
    virga_glass_windshield(CAR_GLASS_WIDTH_M, CAR_GLASS_HEIGHT_M, CAR_GLASS_RAKE_DEG, CAR_GLASS_BEND_M, PANE_POINTS,
                           PANE_POINTS, d->pane);
    shape.positions = d->pane;
    shape.columns = shape.rows = PANE_POINTS;
    shape.mask = mask_pane(d);
    shape.mask_columns = shape.mask_rows = PANE_TEXELS;
    if (!fine(d, virga_glass_shape_set(glass, &shape), "windshield"))
        return false;
    d->glass = virga_default_glass_settings();
    virga_glass_settings_of(VIRGA_GLASS_KIND_CLEAN, &d->glass);
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
        splash.rows[VIRGA_MATERIAL_GLASS][state].model = VIRGA_SPLASH_NONE; /* what of the car is to have none */
    return fine(d, virga_ground_set(virga_scene_ground(d->rain), &ground), "ground") &&
           fine(d, virga_splash_set(virga_scene_splash(d->rain), &splash), "splashes");
}

static bool set_rate(drive *d, float rate_mm_h)
{
    virga_rain_settings rain = virga_default_rain_settings();
    d->rate_mm_h = rain.rate_mm_h = fminf(fmaxf(rate_mm_h, 0), 200);
    rain.wind_m_s[0] = 1.2f;
    rain.wind_m_s[2] = 0.4f;
    rain.gust_m_s = 0.8f;
    rain.streak_gain = 3;
    rain.light_gain = 2;
    rain.near_m = 0.6f;
    rain.lighting = d->lighting;
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

/* ---- 5. a frame -------------------------------------------------------------------------------------------------- */

/* Street lamps and the car's own: one light for the street's material and for the water. */
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

/* All that is near and the car, which moves: what keeps rain off, gets wet, and is splashed on. */
static uint32_t fill_occluders(drive *d)
{
    uint32_t count = host_mesh_occluders(&d->street, d->occluders, MOST_OCCLUDERS - 2), kept = 0;
    for (uint32_t i = 0; i < count && i < MOST_OCCLUDERS - 2; i++) {
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
    /* Splashes stay where they were made: a car that moves would drive into its own. */
    const bool still = d->car.speed_m_s < 1;
    virga_occluder of_car[MOST_PARTS];
    count = host_mesh_occluders(&d->body, of_car, MOST_PARTS);
    for (uint32_t i = 0; i < count && i < MOST_PARTS && kept < MOST_OCCLUDERS; i++) {
        const car_part part = car_part_of(d->body.materials[d->body.primitives[i].material].name);
        if (part != CAR_COVER && part != CAR_SCREEN)
            continue;
        virga_occluder *cover = &d->occluders[kept++];
        *cover = of_car[i];
        cover->material = part == CAR_COVER && still ? VIRGA_MATERIAL_STEEL : VIRGA_MATERIAL_GLASS;
        cover->ground = false;
        for (int row = 0; row < 3; row++) {
            for (int column = 0; column < 3; column++)
                cover->world_from_mesh[4 * row + column] = d->car.axes[3 * column + row];
            cover->world_from_mesh[4 * row + 3] = (float)d->car.position_m[row];
        }
    }
    return kept;
}

/* Where the windshield is and how it moves: the wind of the drive and its jolts pull at the drops. */
static virga_scene_pane place_windshield(const drive *d)
{
    virga_scene_pane pane = {.shelter = 0};
    car_point(&d->car, car_windshield_m, pane.pose.position_m);
    for (int i = 0; i < 3; i++) { /* seen from outside: x to the left of the car, z to where it drives */
        pane.pose.world_from_pane[i] = -d->car.axes[i];
        pane.pose.world_from_pane[3 + i] = d->car.axes[3 + i];
        pane.pose.world_from_pane[6 + i] = -d->car.axes[6 + i];
        pane.velocity_m_s[i] = d->car.velocity_m_s[i];
        pane.acceleration_m_s2[i] = d->car.acceleration_m_s2[i];
        pane.turn_rad_s[i] = d->car.turn_rad_s[i];
    }
    return pane;
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

/* The camera, the one of the frame before, and the scene's depth and colour, as Virga wants them. */
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

static void draw_car(drive *d, VkCommandBuffer cmd)
{
    float skies[MOST_PARTS], of_wheel[MOST_PARTS];
    stage_draw draw = {.mesh = &d->body, .skies = of_wheel};
    for (uint32_t i = 0; i < d->body.primitive_count; i++) {
        const car_part part = car_part_of(d->body.materials[d->body.primitives[i].material].name);
        const bool drawn = part == CAR_BODY || part == CAR_CABIN || (part == CAR_WINDOWS && d->outside);
        skies[i] = drawn ? part == CAR_CABIN ? 0.45f : 1 : -1;
        of_wheel[i] = part == CAR_WHEEL ? 1 : -1;
    }
    for (int wheel = 0; wheel < 4; wheel++) {
        car_wheel(&d->car, wheel, draw.position_m, draw.axes);
        stage_draw_mesh(&d->stage, cmd, &d->camera, &draw);
    }
    memcpy(draw.axes, d->car.axes, sizeof draw.axes);
    memcpy(draw.position_m, d->car.position_m, sizeof draw.position_m);
    draw.mesh = &d->wipers;
    draw.skies = NULL;
    draw.sky = 0.5f;
    stage_draw_mesh(&d->stage, cmd, &d->camera, &draw);
    draw.mesh = &d->body;
    draw.skies = skies;
    stage_draw_mesh(&d->stage, cmd, &d->camera, &draw);
}

static void draw_world(drive *d, VkCommandBuffer cmd)
{
    const float upright[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    stage_draw draw = {.mesh = &d->street, .sky = 1};
    virga_ground_maps maps;
    virga_ground_maps_get(virga_scene_ground(d->rain), &maps); /* what the street's material samples */
    memcpy(draw.axes, upright, sizeof upright);
    d->stage.shade = (stage_shade){.half_m = {CAR_HALF_WIDTH_M, CAR_HALF_LENGTH_M}};
    memcpy(d->stage.shade.position_m, d->car.position_m, sizeof d->car.position_m);
    memcpy(d->stage.shade.axes, d->car.axes, sizeof d->car.axes);
    stage_world_begin(&d->stage, cmd, &d->camera, &maps, &d->lighting);
    stage_draw_mesh(&d->stage, cmd, &d->camera, &draw);
    draw.mesh = &d->blocks;
    if (d->track.box_count)
        stage_draw_mesh(&d->stage, cmd, &d->camera, &draw);
    draw_car(d, cmd);
    stage_world_end(&d->stage, cmd);
}

/* All of a frame; what is above makes what it needs. */
static bool record(drive *d, VkCommandBuffer cmd, double dt_s)
{
    const virga_view view = look(d, dt_s);
    const virga_scene_pane pane = place_windshield(d);
    virga_scene_frame frame = {.dt_s = dt_s, .view = &view, .panes = &pane, .panes_later = true};
    frame.occluders = d->occluders;
    frame.occluder_count = fill_occluders(d);
    for (int axis = 0; axis < 3; axis++) {
        frame.camera_m[axis] = d->camera.position_m[axis];
        frame.focus_m[axis] = d->car.position_m[axis] - 3.0 * (double)d->car.axes[6 + axis];
    }
    if (!fine(d, virga_frame_begin(d->context, d->device.frame, d->device.completed), "frame") ||
        !fine(d, virga_scene_light(d->rain, &d->lighting), "light") ||
        !fine(d, virga_scene_record(d->rain, cmd, &frame), "step"))
        return false;

    draw_world(d, cmd); /* color, depth; `behind` is a copy of color now */

    if (!fine(d, virga_scene_prepare_panes(d->rain, cmd, &view, &pane), "windshield"))
        return false;
    stage_over_begin(&d->stage, cmd);
    const virga_result drawn = virga_scene_draw(d->rain, cmd, d->target);
    stage_over_end(&d->stage, cmd);
    return fine(d, drawn, "draw");
}

/* ---- 6. the end of it -------------------------------------------------------------------------------------------- */

static void tell_cost(const drive *d)
{
    virga_pass_time times[64];
    virga_memory_stats memory;
    const uint32_t count = virga_timings_get(d->context, times, 64);
    virga_memory_get(d->context, &memory);
    for (uint32_t i = 0; i < count && i < 64; i++)
        printf("%-24s %8.3f ms\n", times[i].name, times[i].milliseconds);
    printf("%-24s %8.1f MiB in %u allocations\n", "device memory", (double)memory.device_bytes / 1048576,
           memory.device_allocations);
}

/* Everything that was recorded must be complete; then in any order, so long as the context goes last. */
static void destroy_rain(drive *d)
{
    virga_scene_destroy(&d->rain);
    virga_target_destroy(&d->target);
    virga_context_destroy(&d->context);
}

/* ---- the rest is the game ---------------------------------------------------------------------------------------- */

static void pane_point(const drive *d, const virga_glass_wiper *w, double along_m, double over_m, double angle,
                       float out[3])
{
    const double u = (double)w->pivot_m[0] + along_m * cos(angle), v = (double)w->pivot_m[1] + along_m * sin(angle);
    const double x = fmin(fmax(u / (double)CAR_GLASS_WIDTH_M, 0), 1) * (PANE_POINTS - 1);
    const double y = fmin(fmax(v / (double)CAR_GLASS_HEIGHT_M, 0), 1) * (PANE_POINTS - 1);
    const int column = (int)fmin(x, PANE_POINTS - 2), row = (int)fmin(y, PANE_POINTS - 2);
    const double s = x - column, t = y - row, rake = (double)CAR_GLASS_RAKE_DEG * M_PI / 180;
    const double below = fmin(v, 0); /* arms begin under the pane's edge */
    double at[3];
    for (int i = 0; i < 3; i++) {
        const float *p = d->pane + 3 * (row * PANE_POINTS + column) + i;
        at[i] = (1 - t) * ((1 - s) * (double)p[0] + s * (double)p[3]) +
                t * ((1 - s) * (double)p[3 * PANE_POINTS] + s * (double)p[3 * PANE_POINTS + 3]);
    }
    at[1] += below * cos(rake) + over_m * sin(rake);
    at[2] += -below * sin(rake) + over_m * cos(rake);
    out[0] = (float)(car_windshield_m[0] - at[0]);
    out[1] = (float)(car_windshield_m[1] + at[1]);
    out[2] = (float)(car_windshield_m[2] - at[2]);
}

/* Arms and blades, bent with the glass: 6 bars each. */
static void put_wipers(const drive *d, boxes *b)
{
    const float up[3] = {0, 0.82f, -0.57f};
    b->count = 0;
    for (int i = 0; i < WIPERS; i++) {
        const virga_glass_wiper *w = &d->glass.wipers[i];
        const double angle = (double)w->host_deg * M_PI / 180, first = (double)(w->reach_m - w->blade_m);
        float from[3], to[3];
        pane_point(d, w, 0, 0.03, angle, from);
        pane_point(d, w, first + 0.5 * (double)w->blade_m, 0.03, angle, to);
        boxes_put_bar(b, from, to, up, 0.012f, 0.007f);
        for (int k = 0; k < 5; k++) {
            pane_point(d, w, first + (double)w->blade_m * k / 5, 0.012, angle, from);
            pane_point(d, w, first + (double)w->blade_m * (k + 1) / 5, 0.012, angle, to);
            boxes_put_bar(b, from, to, up, 0.007f, 0.013f);
        }
    }
}

/* There and back in two sweeps, then a pause; switched off they finish what they began. */
static void move_wipers(drive *d, double dt_s)
{
    static const double sweep_s[WIPER_SPEEDS] = {0.7, 0.7, 0.7, 0.45}, pause_s[WIPER_SPEEDS] = {0, 2.5, 0, 0};
    const double sweep = sweep_s[d->wiper_speed], whole = 2 * sweep + pause_s[d->wiper_speed];
    if (d->wiper_speed != OFF || d->wiper_s > 0)
        d->wiper_s += dt_s;
    if (d->wiper_s >= whole)
        d->wiper_s = d->wiper_speed == OFF ? 0 : fmod(d->wiper_s, whole);
    const double share = d->wiper_s < 2 * sweep ? 0.5 - 0.5 * cos(M_PI * d->wiper_s / sweep) : 0;
    for (int i = 0; i < WIPERS; i++) {
        virga_glass_wiper *w = &d->glass.wipers[i];
        w->host_deg = w->low_deg + (w->high_deg - w->low_deg) * (float)share;
    }
}

static void move_camera(drive *d, double dt_s)
{
    const double behind[3] = {0.5, 2.1, 6.2}, at[3] = {0, 1.0, -2};
    double wanted[3], aim[3], length = 0;
    car_point(&d->car, behind, wanted);
    for (int i = 0; i < 3; i++)
        d->eye_m[i] = dt_s > 0 ? d->eye_m[i] + (wanted[i] - d->eye_m[i]) * fmin(5 * dt_s, 1) : wanted[i];
    car_point(&d->car, car_eye_m, d->camera.position_m);
    car_point(&d->car, at, aim);
    for (int i = 0; i < 3; i++) { /* the driver looks a little down the road */
        const double down = 0.03 * (double)d->car.axes[3 + i];
        if (d->outside)
            d->camera.position_m[i] = d->eye_m[i];
        d->camera.forward[i] = d->outside ? aim[i] - d->eye_m[i] : -(double)d->car.axes[6 + i] - down;
        length += d->camera.forward[i] * d->camera.forward[i];
    }
    double f[3], up[3] = {0, 1, 0}, lifted = 0, upright = 0;
    for (int i = 0; i < 3; i++)
        f[i] = d->camera.forward[i] /= sqrt(length);
    for (int i = 0; i < 3; i++)
        lifted += up[i] * f[i];
    for (int i = 0; i < 3; i++) {
        up[i] -= lifted * f[i];
        upright += up[i] * up[i];
    }
    for (int i = 0; i < 3; i++)
        d->camera.up[i] = up[i] / sqrt(upright);
    d->camera.fov_deg = d->outside ? 48 : 50;
    stage_camera_set(&d->stage, &d->camera);
}

static bool add_boxes(drive *d, const boxes *b, const host_material *material, host_mesh *mesh)
{
    return host_mesh_create(&d->device, b->vertices, b->count * 24, b->indices, b->count * 36, material, mesh, d->error,
                            sizeof d->error) &&
           stage_add(&d->stage, mesh, d->error, sizeof d->error);
}

static bool load_world(drive *d, boxes *b)
{
    char *error = d->error;
    const size_t error_size = sizeof d->error;
    host_environment_def sky = host_default_environment();
    float *pixels = NULL;
    host_material material;
    if (!exr_read_rgb(DRIVE_ASSETS "/environments/dusk.exr", &sky.width, &sky.height, &pixels, NULL, error, error_size))
        return false;
    sky.pixels = pixels;
    const bool lit = host_environment_create(&d->device, &sky, &d->environment, error, error_size);
    free(pixels);
    if (!lit || !track_load(d->chosen.track, &d->track, error, error_size) ||
        !host_mesh_load(&d->device, d->chosen.model, NULL, &d->street, error, error_size) ||
        !stage_add(&d->stage, &d->street, error, error_size))
        return false;
    b->count = 0;
    for (uint32_t i = 0; i < d->track.box_count; i++)
        boxes_put_cuboid(b, d->track.boxes[i].low, d->track.boxes[i].high);
    material = (host_material){.name = "wall", .base_color = {0.16f, 0.14f, 0.13f, 1}, .roughness = 0.9f};
    if (b->count && !add_boxes(d, b, &material, &d->blocks))
        return false;
    if (!host_mesh_load(&d->device, DRIVE_ASSETS "/scenes/car.glb", NULL, &d->body, error, error_size) ||
        !stage_add(&d->stage, &d->body, error, error_size))
        return false;
    if (d->body.primitive_count > MOST_PARTS)
        return host_fail(error, error_size, "car.glb has more than %d parts", MOST_PARTS);
    put_wipers(d, b);
    material = (host_material){.name = "wiper", .base_color = {0.015f, 0.015f, 0.016f, 1}, .roughness = 0.55f};
    return add_boxes(d, b, &material, &d->wipers);
}

static void on_key(GLFWwindow *window, int key, int code, int action, int modifiers)
{
    drive *d = glfwGetWindowUserPointer(window);
    (void)code;
    (void)modifiers;
    if (action == GLFW_RELEASE)
        return;
    switch (key) {
    case GLFW_KEY_C:
        d->outside = !d->outside;
        d->has_last_camera = d->stage.has_last = false; /* a cut: motion does not reach back beyond it */
        break;
    case GLFW_KEY_W: d->wiper_speed = (d->wiper_speed + 1) % WIPER_SPEEDS; break;
    case GLFW_KEY_A: d->car.autopilot = true; break;
    case GLFW_KEY_EQUAL:
    case GLFW_KEY_KP_ADD: set_rate(d, d->rate_mm_h < 1 ? 1 : d->rate_mm_h * 1.25f); break;
    case GLFW_KEY_MINUS:
    case GLFW_KEY_KP_SUBTRACT: set_rate(d, d->rate_mm_h < 1 ? 0 : d->rate_mm_h / 1.25f); break;
    case GLFW_KEY_ESCAPE: glfwSetWindowShouldClose(window, GLFW_TRUE); break;
    default: break;
    }
}

static void read_keys(drive *d)
{
    d->keys = (car_keys){.gas = glfwGetKey(d->window, GLFW_KEY_UP) == GLFW_PRESS,
                         .brake = glfwGetKey(d->window, GLFW_KEY_DOWN) == GLFW_PRESS,
                         .left = glfwGetKey(d->window, GLFW_KEY_LEFT) == GLFW_PRESS,
                         .right = glfwGetKey(d->window, GLFW_KEY_RIGHT) == GLFW_PRESS};
}

/* Rate, speed and frames a second, twice a second. */
static void tell_title(drive *d, double now_s)
{
    static double since_s;
    static uint32_t frames;
    char title[160];
    frames++;
    if (now_s - since_s < 0.5)
        return;
    snprintf(title, sizeof title, "drive - rain %.1f mm/h - %.0f km/h - wipers %s - %.0f fps", (double)d->rate_mm_h,
             d->car.speed_m_s * 3.6, wiper_names[d->wiper_speed], frames / (now_s - since_s));
    glfwSetWindowTitle(d->window, title);
    since_s = now_s;
    frames = 0;
}

/* The world moves on by dt_s, and is drawn. */
static bool run_frame(drive *d, boxes *b, double dt_s, bool keep)
{
    VkCommandBuffer cmd;
    bool resized;
    if (!stage_begin(&d->stage, &cmd, &resized, d->error, sizeof d->error))
        return false;
    if (resized) {
        virga_ground_maps maps;
        virga_ground_maps_get(virga_scene_ground(d->rain), &maps);
        stage_bind(&d->stage, &maps, &d->environment);
    }
    if (!cmd) {
        if (d->window && !resized)
            glfwWaitEventsTimeout(0.1); /* minimised */
        return true;
    }
    car_drive(&d->car, &d->track, &d->keys, dt_s);
    move_wipers(d, dt_s);
    move_camera(d, d->has_last_camera ? dt_s : 0);
    light_up(d);
    put_wipers(d, b);
    host_mesh_move(cmd, &d->wipers, b->vertices);
    if (!fine(d, virga_glass_set(virga_scene_glass(d->rain, 0), &d->glass), "wipers") || !record(d, cmd, dt_s))
        return false;
    d->last_camera = d->camera;
    d->has_last_camera = true;
    return stage_end(&d->stage, cmd, &d->camera, keep, d->error, sizeof d->error);
}

static bool run_window(drive *d, boxes *b)
{
    double then_s = glfwGetTime();
    glfwSetWindowUserPointer(d->window, d);
    glfwSetKeyCallback(d->window, on_key);
    for (uint32_t i = 0; !glfwWindowShouldClose(d->window) && (!d->chosen.frames || i < d->chosen.frames); i++) {
        glfwPollEvents();
        read_keys(d);
        const double now_s = glfwGetTime(),
                     dt_s = fmin(fmax(now_s - then_s, 0), 0.1); /* a hitch is not driven through */
        then_s = now_s;
        if (!run_frame(d, b, dt_s, false))
            return false;
        tell_title(d, now_s);
    }
    return host_wait(&d->device, d->error, sizeof d->error);
}

static bool run_file(drive *d, boxes *b)
{
    for (uint32_t i = 0; i < d->chosen.frames; i++)
        if (!run_frame(d, b, 1.0 / d->chosen.fps, i + 1 == d->chosen.frames))
            return false;
    if (!host_wait(&d->device, d->error, sizeof d->error) ||
        !fine(d, virga_frame_completed(d->context, d->device.completed), "end"))
        return false;
    tell_cost(d);
    return png_write(d->chosen.out, d->stage.width, d->stage.height, 4, stage_picture(&d->stage), d->error,
                     sizeof d->error);
}

static bool run(drive *d)
{
    boxes *b = calloc(1, sizeof *b);
    virga_ground_maps maps;
    bool good = b && open_device(d) &&
                stage_create(&d->stage, &d->device, d->window, d->surface, d->chosen.width, d->chosen.height, d->error,
                             sizeof d->error) &&
                create_context(d) && create_rain(d) && set_rain(d) && load_world(d, b);
    if (good) {
        car_place(&d->car, &d->track, d->chosen.start_m);
        light_up(d);
        virga_ground_maps_get(virga_scene_ground(d->rain), &maps);
        stage_bind(&d->stage, &maps, &d->environment);
        good = set_rate(d, d->rate_mm_h) && attach(d) && (d->window ? run_window(d, b) : run_file(d, b));
    }
    free(b);
    return good;
}

static void close_device(drive *d)
{
    if (d->device.device)
        vkDeviceWaitIdle(d->device.device);
    if (d->context)
        keep_pipelines(d);
    destroy_rain(d);
    host_mesh_destroy(&d->device, &d->street);
    host_mesh_destroy(&d->device, &d->blocks);
    host_mesh_destroy(&d->device, &d->wipers);
    host_mesh_destroy(&d->device, &d->body);
    if (d->environment.sky.image)
        host_environment_destroy(&d->device, &d->environment);
    track_free(&d->track);
    stage_destroy(&d->stage);
    host_device_destroy(&d->device);
    if (d->surface)
        vkDestroySurfaceKHR(d->instance, d->surface, NULL);
    if (d->window)
        glfwDestroyWindow(d->window);
    if (d->instance)
        vkDestroyInstance(d->instance, NULL);
}

/* ---- the command line */

static bool complain(const char *what, const char *expected)
{
    fprintf(stderr, "drive: %s: expected %s\n", what, expected);
    return false;
}

static bool number(const char *text, double low, double high, double *value)
{
    char *end;
    *value = strtod(text, &end);
    return end != text && !*end && *value >= low && *value <= high;
}

static bool take_wipers(drive *d, const char *name)
{
    for (d->wiper_speed = 0; d->wiper_speed < WIPER_SPEEDS; d->wiper_speed++)
        if (strcmp(name, wiper_names[d->wiper_speed]) == 0)
            return true;
    return complain("--wipers", "off, intermittent, slow or fast");
}

static bool take_option(drive *d, int option, const char *value)
{
    double n = 0, m = 0;
    char *x = value ? strchr(value, 'x') : NULL;
    switch (option) {
    case 't': d->chosen.track = value; return true;
    case 'd': d->chosen.device = value; return true;
    case 'o': d->chosen.out = value; return true;
    case 'p': d->chosen.pipelines = value; return true;
    case 'O': d->outside = true; return true;
    case 'w': return take_wipers(d, value);
    case 'r':
        d->rate_mm_h = number(value, 0, 200, &n) ? (float)n : -1;
        return d->rate_mm_h >= 0 || complain("--rain", "0 to 200 mm/h");
    case 's': return number(value, 0, 1e5, &d->chosen.start_m) || complain("--start", "0 to 100000 metres");
    case 'n':
        d->chosen.frames = number(value, 1, 1e6, &n) ? (uint32_t)n : 0;
        return d->chosen.frames || complain("--frames", "1 to 1000000");
    case 'f':
        d->chosen.fps = number(value, 10, 1000, &n) ? (uint32_t)n : 0;
        return d->chosen.fps || complain("--fps", "10 to 1000");
    case 'S':
        if (x && number(x + 1, 16, 8192, &m)) {
            *x = 0;
            if (number(value, 16, 8192, &n)) {
                d->chosen.width = (uint32_t)n;
                d->chosen.height = (uint32_t)m;
                return true;
            }
        }
        return complain("--size", "WxH, 16 to 8192 pixels a side");
    default: return false; /* getopt has said what is wrong */
    }
}

static bool take_command_line(drive *d, int argc, char **argv)
{
    static const struct option options[] = {
        {"track", required_argument, NULL, 't'},  {"device", required_argument, NULL, 'd'},
        {"out", required_argument, NULL, 'o'},    {"pipelines", required_argument, NULL, 'p'},
        {"outside", no_argument, NULL, 'O'},      {"wipers", required_argument, NULL, 'w'},
        {"rain", required_argument, NULL, 'r'},   {"start", required_argument, NULL, 's'},
        {"frames", required_argument, NULL, 'n'}, {"fps", required_argument, NULL, 'f'},
        {"size", required_argument, NULL, 'S'},   {0}};
    static char track_path[4096];
    d->chosen = (choices){.model = DRIVE_ASSETS "/scenes/street.glb", .fps = 30, .width = 1280, .height = 720};
    d->rate_mm_h = 30;
    d->wiper_speed = SLOW;
    for (int option; (option = getopt_long(argc, argv, "", options, NULL)) != -1;)
        if (!take_option(d, option, optarg))
            return false;
    if (argc - optind > 1)
        return complain(argv[optind + 1], "one model");
    if (argc > optind)
        d->chosen.model = argv[optind];
    if (d->chosen.out && !d->chosen.frames)
        return complain("--out", "--frames N with it");
    if (!d->chosen.track) { /* the model's name, among our scenes */
        const char *name = strrchr(d->chosen.model, '/') ? strrchr(d->chosen.model, '/') + 1 : d->chosen.model;
        snprintf(track_path, sizeof track_path, "%s/scenes/%.*s.track", DRIVE_ASSETS, (int)strcspn(name, "."), name);
        d->chosen.track = track_path;
    }
    return true;
}

static void print_help(void)
{
    printf("drive [MODEL.glb] [options]: a car in the rain, in our own street or in another model\n\n"
           "      --track FILE         where it drives. Default: assets/scenes/MODEL.track\n"
           "      --start M            how far along it begins\n"
           "      --outside            seen from outside\n"
           "      --rain MM_H          0 to 200. Default 30\n"
           "      --wipers SPEED       off, intermittent, slow or fast. Default slow\n"
           "      --frames N           ends after so many\n"
           "      --out FILE.png       the last of them as a picture, and no window\n"
           "      --fps N              frames a second of --out. Default 30\n"
           "      --size WxH           Default 1280x720\n"
           "      --device N|gpu|cpu|NAME\n"
           "      --pipelines FILE     keeps compiled pipelines for the next start\n\n"
           "Keys: C camera, W wipers, arrows drive (A: it drives itself again), + and - rain, Esc ends.\n");
}

int main(int argc, char **argv)
{
    static drive d;
    if (argc == 2 && strcmp(argv[1], "--help") == 0) {
        print_help();
        return 0;
    }
    if (!take_command_line(&d, argc, argv))
        return 2;
    if (!d.chosen.out && !glfwInit()) {
        fprintf(stderr, "drive: no display to open a window on; --frames N --out FILE.png needs none\n");
        return 1;
    }
    if (!d.chosen.out)
        glfwWindowHint(GLFW_CLIENT_API, GLFW_NO_API);
    const bool good = run(&d);
    close_device(&d);
    if (!d.chosen.out)
        glfwTerminate();
    if (!good)
        fprintf(stderr, "drive: %s\n", d.error[0] ? d.error : "out of memory");
    return good ? 0 : 1;
}
