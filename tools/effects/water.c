/* water.c - what the program knows of water from simulated particles. */
#include "water.h"

#include "effect.h"
#include "scene_rows.h"
#include "water/bench_water.h"
#include "water/water_state.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* ---- keys of scene files -------------------------------------------------------------------------------------- */

static const scene_keyword water_ids[] = {
    {"file", SCENE_WATER_IDS_FILE}, {"rows", SCENE_WATER_IDS_ROWS}, {"none", SCENE_WATER_IDS_NONE}, {NULL, 0}};
static const scene_keyword water_ups[] = {{"y", SCENE_WATER_UP_Y}, {"z", SCENE_WATER_UP_Z}, {NULL, 0}};
static const scene_keyword water_kernels[] = {
    {"isotropic", SCENE_WATER_KERNEL_ISOTROPIC}, {"anisotropic", SCENE_WATER_KERNEL_ANISOTROPIC}, {NULL, 0}};
static const scene_keyword water_styles[] = {
    {"paper", SCENE_WATER_STYLE_PAPER}, {"physical", SCENE_WATER_STYLE_PHYSICAL}, {NULL, 0}};
static const scene_keyword water_shadings[] = {
    {"pixels", SCENE_WATER_SHADING_PIXELS}, {"surfels", SCENE_WATER_SHADING_SURFELS}, {NULL, 0}};

/* Ranges and defaults of what the library has are its own: virga/water.h. */
static const scene_row water_rows[] = {
    FILE_NAME(scene_water, files, OPTIONAL | SCENE_ROW_NUMBERED,
              "PLY, legacy VTK or bgeo of each frame of a simulation, like dam_%04d.ply"),
    OPTIONAL_GROUP(scene_water, solver, &water_solver_group, RESTARTS, "simulates water; in place of files"),
    NUMBER(scene_water, rate_hz, 0.001, 100000, "@frames.fps", RESTARTS, "numbers of the files in a second"),
    WHOLE(scene_water, step, 1, 1000000, "1", RESTARTS, "from the number of a file to that of the next"),
    OPTIONAL_NUMBER(scene_water, first, 0, 999999999, RESTARTS, "number of the first file; else the smallest"),
    NUMBER(scene_water, start_s, -100000, 100000, "0", LIVE,
           "time of the first file in the scene; of a solver: when the water begins to move"),
    CHOICE(scene_water, ids, water_ids, "file", RESTARTS,
           "what tells which particle is which: an attribute, the row in the file, or nothing"),
    NUMBER(scene_water, fade_s, 0, 10, "0.1", RESTARTS,
           "time in which particles of files appear and vanish, at most 16 times that between files"),
    CHOICE(scene_water, up, water_ups, "y", LIVE, "axis of the files that points up"),
    NUMBER(scene_water, unit_m, 0.000001, 1000000, "1", RESTARTS, "metres of a unit of length in the files"),
    NUMBER(scene_water, position_m, -MAX_METERS, MAX_METERS, "[0, 0, 0]", LIVE, "of the origin of files or solver"),
    NUMBER(scene_water, rotation_deg, -36000, 36000, "[0, 0, 0]", LIVE, "about the world's X, then Y, then Z axis"),
    NUMBER(scene_water, spacing_m, 0, 10, "0", RESTARTS,
           "distance of particles at rest; 0: guessed from the files, or that of the solver"),
    NUMBER(scene_water, volume, 0.01, 100, "1", LIVE,
           "of a particle, in spacing_m^3. 1 fits a guessed spacing; SPlisHSPlasH has 0.8 of the cube of its own"),
    NUMBER(scene_water, kernel_spacings, 1, 4, "2", LIVE, "radius of the kernel, in spacings; larger is smoother"),
    NUMBER(scene_water, level, 0.05, 0.95, "0.5", LIVE, "density of the surface; 1 is inside the water"),
    CHOICE(scene_water, kernel, water_kernels, "isotropic", LIVE,
           "isotropic: balls; anisotropic: ellipsoids along the neighbours of each particle"),
    NUMBER(scene_water, smoothing, 0, 1, "0.9", LIVE,
           "(anisotropic) how far centers of kernels move towards the mean of their neighbours"),
    NUMBER(scene_water, stretch, 1, 4, "2", LIVE, "(anisotropic) largest ratio of two axes of a kernel"),
    CHOICE(scene_water, style, water_styles, "physical", LIVE,
           "of spray; paper: equal droplets in a pattern; physical: of many sizes, with drag"),
    NUMBER(scene_water, spray_density, 0, 0.9, "0.35", LIVE, "particles with less density become droplets; 0: none do"),
    WHOLE(scene_water, spray_pieces, 1, 32, "25", LIVE, "droplets that a particle becomes at most"),
    NUMBER(scene_water, spray_speed_m_s, 0.01, 1000, "4", LIVE, "speed at which it becomes so many"),
    NUMBER(scene_water, spray_pattern, 0, 4, "1.25", LIVE, "radius of the ball that they are in, in spacings"),
    SWITCH(scene_water, hand_over, "true", LIVE,
           "spray flies on as droplets of splashes, and wets what it hits; needs splash.on"),
    NUMBER(scene_water, hand_over_s, 0, 10, "0.03", LIVE, "time after which spray is handed over"),
    NUMBER(scene_water, foam_air_hz, 0, 1000000, "600", LIVE,
           "particles of foam that one of water makes in a second where it traps air; 0: none"),
    NUMBER(scene_water, foam_crest_hz, 0, 1000000, "600", LIVE, "the same at the crests of waves"),
    NUMBER(scene_water, foam_speed_m_s, 0, 1000, "[0.6, 2]", LIVE, "speeds at which foam begins, and is fully made"),
    NUMBER(scene_water, foam_air_m_s, 0, 1000, "[0.25, 0.8]", LIVE, "the same of the speed at which water meets water"),
    NUMBER(scene_water, foam_crest, 0, 10, "[0.25, 0.6]", LIVE, "the same of how sharp a crest is: 1 - cos of angles"),
    NUMBER(scene_water, foam_life_s, 0.01, 1000, "[1, 4]", LIVE, "life time of foam, from weak and strong causes"),
    NUMBER(scene_water, foam_radius_m, 0.00001, 1, "0.002", LIVE, "mean radius of a particle of foam"),
    NUMBER(scene_water, foam_rise_m_s, 0, 10, "0.25", LIVE, "speed at which bubbles rise"),
    NUMBER(scene_water, foam_drag_hz, 0.01, 1000, "40", LIVE, "rate at which bubbles take on the water's velocity"),
    NUMBER(scene_water, foam_coverage, 0, 1, "0.3", LIVE, "how much a particle of foam covers in its middle"),
    NUMBER(scene_water, absorption_1_m, 0, 1000, "[0.29, 0.056, 0.0103]", LIVE,
           "of light in the water (red, green, blue); that of pure water if left out"),
    NUMBER(scene_water, scattering_1_m, 0, 1000, "[0, 0, 0]", LIVE,
           "of light in the water (red, green, blue), which makes it milky"),
    NUMBER(scene_water, reflection, 0, 4, "1", LIVE, "multiplies what the surface mirrors; 1: Fresnel"),
    NUMBER(scene_water, refraction, 0, 4, "1", LIVE, "multiplies how far what is seen through the water is shifted"),
    NUMBER(scene_water, surfel_radius, 0.5, 4, "1.25", LIVE, "multiplies the size of surfels; larger is smoother"),
    CHOICE(scene_water, shading, water_shadings, "pixels", RESTARTS,
           "where light is computed; surfels: as the paper does, for comparisons"),
    NUMBER(scene_water, surfel_difference, 0, 1000, "0.1", LIVE,
           "(surfels) one whose colors differ by this part of their mean is divided: C_a"),
    WHOLE(scene_water, surfel_divisions, 0, 3, "3", LIVE, "(surfels) how often one is divided at most; 0: never"),
    NUMBER(scene_water, soft_m, 0, 10, "0.002", LIVE, "water fades over this depth where it meets geometry"),
    SWITCH(scene_water, contact, "true", LIVE, "the surface goes on to solids, with a meniscus; slower"),
    NUMBER(scene_water, light_gain, 0, 1000, "1", LIVE, "multiplies the light of lamps on the water"),
    WHOLE(scene_water, max_particles, 0, WATER_MAX_PARTICLES, "0", RESTARTS, "64 bytes each; 0: as many as there are"),
    WHOLE(scene_water, max_cells, 0, 16777216, "0", RESTARTS, "of the neighbour grid; 17 bytes each; 0: by the water"),
    WHOLE(scene_water, max_blocks, 0, 1048576, "0", RESTARTS,
          "cells that the surface runs through; 280 bytes each; 0: by the water"),
    WHOLE(scene_water, max_foam, 0, 1048576, "131072", RESTARTS, "particles of foam; 80 bytes each; 0: none"),
    WHOLE(scene_water, max_parts, 1, 4194304, "1048576", RESTARTS,
          "(surfels) parts that divisions add at most; 64 bytes each"),
    WHOLE(scene_water, max_surfels, 0, 8388608, "0", RESTARTS, "of the surface; 32 bytes each; 0: by the water"),
};
static const scene_group water_group = SCENE_GROUP(scene_water, water_rows);

/* The section has one key: all of the struct. */
static const scene_row water_section[] = {SECTION_GROUP("water", &water_group, "water from simulated particles")};

static bool is_used(const scene_file *scene)
{
    return scene_water_of(scene)->files || water_is_solved(scene);
}

/* ---- checks --------------------------------------------------------------------------------------------------- */

static bool check_water(const scene_file *scene, char *error, size_t error_size)
{
    const scene_water *from = scene_water_of(scene);
    if (from->first && *from->first != floor(*from->first))
        return scene_file_refuse(scene, "water.first", error, error_size, "expected a whole number, got %g",
                                 *from->first);
    return water_check_solver(scene, error, error_size);
}

/* That all files are there; they are read later. */
static bool check(const scene_file *scene, char *error, size_t error_size)
{
    particle_sequence *sequence = NULL;
    const bool good = !scene_water_of(scene)->files || water_open_sequence(scene, &sequence, error, error_size);
    particle_sequence_close(sequence);
    return good;
}

static bool check_files(const scene_file *scene, char *error, size_t error_size)
{
    const scene_water *from = scene_water_of(scene);
    water_source source = {0};
    if (!from->files)
        return true;
    const bool good = water_open_source(scene, &source, error, error_size);
    const uint32_t left_out = good ? water_left_out(scene, &source) : 0;
    if (good)
        printf("  particles    %s: %u files, %g s, up to %u particles with%s velocity and with%s ids; spacing %.4g m, "
               "volume %.3g m^3 each\n",
               from->files, particle_sequence_length(source.sequence), particle_sequence_duration(source.sequence),
               source.most, source.has_velocity ? "" : "out", source.has_ids ? "" : "out", source.spacing_m,
               from->volume * pow(source.spacing_m, 3));
    if (left_out)
        printf("               %u of them are left out\n", left_out);
    particle_sequence_close(source.sequence);
    return good;
}

static void print(const scene_file *scene)
{
    const scene_water *from = scene_water_of(scene);
    if (from->files)
        printf("  water        %s\n", from->files);
    if (water_is_solved(scene)) {
        water_source source = {0};
        water_describe_solver(scene, &source);
        printf("  water        %u particles of %g m in a box of %g x %g x %g m\n", source.most, source.spacing_m,
               source.extent_m[0], source.extent_m[1], source.extent_m[2]);
    }
}

/* ---- life ----------------------------------------------------------------------------------------------------- */

/* A size that the scene gives, or one by the particles within the library's limits. */
static uint32_t size_of(uint32_t given, double wanted, uint32_t low, uint32_t high)
{
    return given ? given : (uint32_t)fmin(fmax(wanted, low), high);
}

/* Particles of files may become more than in those that were read; without ids those of two files are there at once.
 * The box around them may become half as wide again. */
static void size_pools(const scene_water *from, const water_source *source, virga_water_def *def)
{
    const double cell_m = from->kernel_spacings * source->spacing_m;
    double cells = 1;
    for (int axis = 0; axis < 3; axis++)
        cells *= ceil(1.5 * source->extent_m[axis] / cell_m) + 4;
    const double more = source->sequence ? 2 : 1;
    def->max_particles = size_of(from->max_particles, more * source->most, 4096, WATER_MAX_PARTICLES);
    def->max_cells = size_of(from->max_cells, cells, def->max_cells, 16777216);
    def->max_blocks = size_of(from->max_blocks, source->most, def->max_blocks, 1048576);
    def->max_surfels = size_of(from->max_surfels, 4.0 * source->most, def->max_surfels, 2097152);
    def->max_spray = size_of(0, 0.25 * source->most, def->max_spray, 262144);
    def->max_foam = from->max_foam;
    def->max_parts = from->shading == SCENE_WATER_SHADING_SURFELS ? from->max_parts : 0;
    def->max_droplets = size_of(0, 4.0 * source->most, def->max_droplets, 1048576);
    def->max_particles = def->max_particles < WATER_MIN_PARTICLES ? WATER_MIN_PARTICLES : def->max_particles;
    def->max_cells = def->max_cells < 4096 ? 4096 : def->max_cells;
    def->max_blocks = def->max_blocks < 64 ? 64 : def->max_blocks;
    def->max_surfels = def->max_surfels < 256 ? 256 : def->max_surfels;
}

static bool define(shot *s, void *state, virga_scene_def *def, char *error, size_t error_size)
{
    water_state *p = state;
    if (!is_used(s->scene))
        return true;
    if (!shot_blame_input(s, water_open_source(s->scene, &p->source, error, error_size)))
        return false;
    def->with_water = true;
    size_pools(scene_water_of(s->scene), &p->source, &def->water);
    p->max_particles = def->water.max_particles;
    def->water.max_width = s->options.draw ? s->options.width : 0;
    def->water.max_height = s->options.draw ? s->options.height : 0;
    return true;
}

/* A panorama that is turned is seen by its harmonics alone: the library has no angle for it. */
static bool mirror_environment(shot *s, virga_water *water, char *error, size_t error_size)
{
    const host_image *sky = &s->environment.sky;
    const virga_image panorama = {.image = sky->image,
                                  .view = sky->view,
                                  .format = sky->format,
                                  .extent = {sky->extent.width, sky->extent.height},
                                  .layers = 1,
                                  .before = {VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
                                             VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT, VK_ACCESS_SHADER_READ_BIT},
                                  .after = {VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
                                            VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT, VK_ACCESS_SHADER_READ_BIT}};
    return s->environment.rotation != 0 ||
           shot_ok(s, virga_water_environment(water, &panorama), "mirroring the environment", error, error_size);
}

static bool open_state(shot *s, void *state, char *error, size_t error_size)
{
    water_state *p = state;
    p->water = virga_scene_water(s->simulation);
    if (p->water && (!mirror_environment(s, p->water, error, error_size) ||
                     (water_is_solved(s->scene) && !water_open_solver(s, p, error, error_size))))
        return false;
    return !p->water ||
           host_buffer_create(&s->device, (VkDeviceSize)p->max_particles * sizeof(virga_particle_gpu) * HOST_FRAMES,
                              VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, HOST_BUFFER_UPLOAD, "particles", &p->particles, error,
                              error_size);
}

static void close_state(shot *s, void *state)
{
    water_state *p = state;
    if (p->water)
        virga_frame_completed(s->context, s->device.completed); /* so that the log has what the last frames lacked */
    water_close_solver(s, p);
    particle_sequence_close(p->source.sequence);
    host_buffer_destroy(&s->device, &p->particles);
    host_buffer_destroy(&s->device, &p->surfels.buffer);
    host_buffer_destroy(&s->device, &p->droplets.buffer);
    host_buffer_destroy(&s->device, &p->foam.buffer);
}

/* ---- time ----------------------------------------------------------------------------------------------------- */

static void apply_foam(const scene_water *from, virga_water_settings *settings)
{
    settings->foam_air_hz = (float)from->foam_air_hz;
    settings->foam_crest_hz = (float)from->foam_crest_hz;
    for (int i = 0; i < 2; i++) {
        settings->foam_speed_m_s[i] = (float)from->foam_speed_m_s[i];
        settings->foam_air_m_s[i] = (float)from->foam_air_m_s[i];
        settings->foam_crest[i] = (float)from->foam_crest[i];
        settings->foam_life_s[i] = (float)from->foam_life_s[i];
    }
    settings->foam_radius_m = (float)from->foam_radius_m;
    settings->foam_rise_m_s = (float)from->foam_rise_m_s;
    settings->foam_drag_hz = (float)from->foam_drag_hz;
    settings->foam_coverage = (float)from->foam_coverage;
}

static bool apply(shot *s, void *state, double time_s, char *error, size_t error_size)
{
    const water_state *p = state;
    const scene_water *from = scene_water_of(s->scene);
    virga_water_settings settings = virga_default_water_settings();
    (void)time_s;
    if (!p->water)
        return true;
    settings.spacing_m = (float)p->source.spacing_m;
    settings.volume_m3 = (float)(from->volume * pow(p->source.spacing_m, 3));
    settings.kernel_spacings = (float)from->kernel_spacings;
    settings.level = (float)from->level;
    settings.fading = water_mixes_files(s->scene, &p->source) ? VIRGA_WATER_FADING_VOLUME : VIRGA_WATER_FADING_COVERAGE;
    settings.style = (virga_water_style)from->style;
    settings.shading = (virga_water_shading)from->shading;
    settings.surfel_difference = (float)from->surfel_difference;
    settings.surfel_divisions = from->surfel_divisions;
    settings.spray_density = (float)from->spray_density;
    settings.spray_pieces = from->spray_pieces;
    settings.spray_speed_m_s = (float)from->spray_speed_m_s;
    settings.spray_pattern = (float)from->spray_pattern;
    settings.hand_over = from->hand_over;
    settings.hand_over_s = (float)from->hand_over_s;
    settings.kernel = (virga_water_kernel)from->kernel;
    settings.smoothing = (float)from->smoothing;
    settings.stretch = (float)from->stretch;
    apply_foam(from, &settings);
    water_foam_walls(s->scene, &settings);
    for (int c = 0; c < 3; c++) {
        settings.absorption_1_m[c] = (float)from->absorption_1_m[c];
        settings.scattering_1_m[c] = (float)from->scattering_1_m[c];
    }
    settings.reflection = (float)from->reflection;
    settings.refraction = (float)from->refraction;
    settings.surfel_radius = (float)from->surfel_radius;
    settings.soft_m = (float)from->soft_m;
    settings.contact = from->contact ? VIRGA_WATER_CONTACT_PREPARE : VIRGA_WATER_CONTACT_OFF; /* after the plate */
    settings.light_gain = (float)from->light_gain;
    settings.lighting = s->lighting;
    return shot_ok(s, virga_water_set(p->water, &settings), "setting the water", error, error_size);
}

static VkDeviceSize saved_bytes(const void *state)
{
    const water_state *p = state;
    return p->solver.fluid ? virga_fluid_state_bytes(p->solver.fluid) : 0;
}

static bool save_state(shot *s, void *state, VkCommandBuffer cmd, const virga_state_range *to, char *error,
                       size_t error_size)
{
    return water_save_solver(s, state, cmd, to, error, error_size);
}

static bool load_state(shot *s, void *state, VkCommandBuffer cmd, const virga_state_source *from, double time_s,
                       char *error, size_t error_size)
{
    return water_load_solver(s, state, cmd, from, time_s - scene_water_of(s->scene)->start_s, error, error_size);
}

static bool before_step(shot *s, void *state, VkCommandBuffer cmd, double time_s, double dt_s, char *error,
                        size_t error_size)
{
    water_state *p = state;
    const double frame_s = time_s - scene_water_of(s->scene)->start_s;
    return !p->solver.fluid || water_step_solver(s, p, cmd, frame_s, dt_s, error, error_size);
}

static bool step(shot *s, void *state, VkCommandBuffer cmd, double dt_s, char *error, size_t error_size)
{
    water_state *p = state;
    (void)dt_s;
    return !p->solver.fluid || !s->options.stats || water_read_solver(s, p, cmd, error, error_size);
}

/* Fills the particles of a step, and keeps in mind where they are. */
static bool fill_step(shot *s, water_state *p, double time_s, virga_water_step_info *info, char *error,
                      size_t error_size)
{
    if (!water_fill_particles(s, p, time_s, info, error, error_size))
        return false;
    p->shown = info->particles;
    p->shown_offset = info->offset;
    p->shown_count = info->count < p->max_particles ? info->count : p->max_particles;
    return true;
}

static bool fill_frame(shot *s, void *state, double time_s, const host_camera *camera, virga_scene_frame *frame,
                       char *error, size_t error_size)
{
    water_state *p = state;
    (void)camera;
    p->frame_s = time_s - scene_water_of(s->scene)->start_s;
    water_move_occluders(s, p, time_s);
    if (p->solver.fluid && scene_water_of(s->scene)->solver.exchange.max_particles) {
        frame->exchange.fluid = p->solver.fluid;
        memcpy(frame->exchange.origin_m, scene_water_of(s->scene)->position_m, sizeof frame->exchange.origin_m);
    }
    return !p->water || fill_step(s, p, p->frame_s, &frame->water, error, error_size);
}

/* ---- picture -------------------------------------------------------------------------------------------------- */

/* Water is drawn where the particles of its step are. So each sub-frame has a step at its own time, unless the shot has
 * stepped in this very frame. */
static bool step_sub_frame(shot *s, water_state *p, VkCommandBuffer cmd, double late_s, char *error, size_t error_size)
{
    virga_water_step_info info = {.sub_frame = true};
    return (p->step_frame == s->device.frame && p->time_s == p->frame_s - late_s) ||
           (fill_step(s, p, p->frame_s - late_s, &info, error, error_size) &&
            shot_ok(s, virga_water_step(p->water, cmd, &info), "stepping the water", error, error_size));
}

static bool prepare(shot *s, void *state, VkCommandBuffer cmd, const tool_moment *at, char *error, size_t error_size)
{
    water_state *p = state;
    return !p->water ||
           (step_sub_frame(s, p, cmd, at->late_s, error, error_size) &&
            shot_ok(s, virga_water_prepare(p->water, cmd, at->jittered), "preparing the water", error, error_size));
}

static bool before_plate(shot *s, void *state, VkCommandBuffer cmd, double camera_s, char *error, size_t error_size)
{
    return water_draw_bodies(s, state, cmd, camera_s, error, error_size);
}

static virga_result draw(void *state, VkCommandBuffer cmd, const virga_target *target)
{
    const water_state *p = state;
    return p->water ? virga_water_draw(p->water, cmd, target) : VIRGA_OK;
}

static virga_result draw_foam(void *state, VkCommandBuffer cmd, const virga_target *target)
{
    const water_state *p = state;
    return p->water ? virga_water_draw_foam(p->water, cmd, target) : VIRGA_OK;
}

static virga_result draw_data(void *state, VkCommandBuffer cmd, const virga_target *target, virga_water_data what)
{
    const water_state *p = state;
    return p->water ? virga_water_draw_data(p->water, cmd, target, what) : VIRGA_OK;
}

static virga_result draw_thickness(void *state, VkCommandBuffer cmd, const virga_target *target)
{
    return draw_data(state, cmd, target, VIRGA_WATER_DATA_THICKNESS);
}

static virga_result draw_normal(void *state, VkCommandBuffer cmd, const virga_target *target)
{
    return draw_data(state, cmd, target, VIRGA_WATER_DATA_NORMAL);
}

static virga_result draw_velocity(void *state, VkCommandBuffer cmd, const virga_target *target)
{
    return draw_data(state, cmd, target, VIRGA_WATER_DATA_MOTION);
}

static const tool_layer layers[] = {
    {TOOL_COLOR_LAYER("water", draw, 15, "water", "the water alone")},
    {TOOL_COLOR_LAYER("foam", draw_foam, 16, "foam", "foam, spray and bubbles of the water alone")},
    {.name = "water_thickness",
     .channels = {"water_thickness.Y"},
     .type = EXR_SAMPLE_FLOAT,
     .help = "metres of water along the direction of view",
     .draw = draw_thickness,
     .order = 32,
     .is_data = true,
     .view_title = "Layer: thickness of water",
     .view_help = "metres of water along the direction of view, as red"},
    {.name = "water_normal",
     .channels = {"water_normal.X", "water_normal.Y", "water_normal.Z"},
     .type = EXR_SAMPLE_HALF,
     .help = "normal of the water's surface in the world",
     .draw = draw_normal,
     .order = 33,
     .is_data = true,
     .view_title = "Layer: normal of water",
     .view_help = "normal of the water's surface in the world, as color"},
    {.name = "water_velocity",
     .channels = {"water_velocity.X", "water_velocity.Y"},
     .type = EXR_SAMPLE_HALF,
     .help = "motion of the surface, pixels per frame right, down",
     .draw = draw_velocity,
     .order = 34,
     .is_data = true,
     .offset = -1,
     .view_title = "Layer: velocity of water",
     .view_help = "motion of the water's surface: red right, green down"},
};

/* ---- files of a frame ----------------------------------------------------------------------------------------- */

bool water_step_stats(shot *s, const water_state *state, virga_water_stats *stats)
{
    virga_frame_completed(s->context, s->device.completed);
    virga_water_stats_get(state->water, stats);
    return stats->frame_index == state->step_frame;
}

/* Litres of the particles of the newest step that the water has room for. */
static double shown_volume_l(shot *s, const water_state *p, uint32_t room)
{
    char ignored[256];
    if (p->solver.fluid && !water_wait_for_solver(s, &p->solver, ignored, sizeof ignored))
        return 0;
    return water_volume_l(scene_water_of(s->scene), &p->source, p->given, p->count < room ? p->count : room);
}

static void write_stats(shot *s, void *state, jsonl *stats)
{
    water_state *p = state;
    virga_water_stats now;
    if (!p->water || !water_step_stats(s, p, &now))
        return;
    jsonl_begin_object(stats, "water");
    jsonl_uint64(stats, "particles", now.particles);
    jsonl_uint64(stats, "invalid", now.invalid);
    jsonl_uint64(stats, "in_grid", now.in_grid);
    jsonl_number(stats, "volume_l", shown_volume_l(s, p, now.particles));
    jsonl_uint64(stats, "surfels", now.surfels);
    jsonl_uint64(stats, "surfels_dropped", now.surfels_dropped);
    jsonl_uint64(stats, "splashes", now.splashes);
    jsonl_uint64(stats, "splashes_dropped", now.splashes_dropped);
    jsonl_uint64(stats, "droplets", now.droplets);
    jsonl_uint64(stats, "droplets_dropped", now.droplets_dropped);
    jsonl_uint64(stats, "foam", now.foam);
    jsonl_uint64(stats, "foam_dropped", now.foam_dropped);
    jsonl_uint64(stats, "foam_spray", now.foam_spray);
    jsonl_uint64(stats, "foam_surface", now.foam_surface);
    jsonl_uint64(stats, "foam_bubbles", now.foam_bubbles);
    jsonl_uint64(stats, "blocks", now.blocks);
    jsonl_uint64(stats, "blocks_dropped", now.blocks_dropped);
    if (p->solver.fluid)
        water_write_solver_stats(s, p, stats);
    jsonl_end(stats);
}

/* ---- virga view ----------------------------------------------------------------------------------------------- */

static double count_particles(const void *state)
{
    return ((const water_state *)state)->count;
}

static virga_water_stats newest(const void *state)
{
    const water_state *p = state;
    virga_water_stats stats = {0};
    if (p->water)
        virga_water_stats_get(p->water, &stats);
    return stats;
}

static double count_surfels(const void *state)
{
    return newest(state).surfels;
}

static double count_foam(const void *state)
{
    return newest(state).foam;
}

static const tool_count counts[] = {
    {"particles of water", count_particles}, {"surfels of water", count_surfels}, {"foam", count_foam}};

/* ---- the effect ----------------------------------------------------------------------------------------------- */

TOOL_SECTION_OF(water)

const tool_effect water_effect = {
    .name = "water",
    .scene = {.group = SCENE_GROUP(scene_water, water_section), .check = check_water},
    .is_used = is_used,
    .has_slow_steps = water_is_solved,
    .missing = "water; expected water.files or water.solver",
    .check = check,
    .check_files = check_files,
    .print = print,
    .state_size = sizeof(water_state),
    .define = define,
    .open = open_state,
    .close = close_state,
    .apply = apply,
    .before_step = before_step,
    .saved_bytes = saved_bytes,
    .save = save_state,
    .load = load_state,
    .fill_frame = fill_frame,
    .step = step,
    TOOL_ROWS(layer, layers),
    .before_plate = before_plate,
    .after_plate = true,
    .prepare = prepare,
    .points = &water_points,
    .mesh = &water_surface_mesh,
    .volume = &water_density_volume,
    .write_stats = write_stats,
    .bench = &water_bench,
    .title = "Water",
    TOOL_ROWS(count, counts),
    TOOL_ROWS(view, water_views),
};
