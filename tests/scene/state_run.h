/* state_run.h - a scene of all effects of rain that is saved and loaded, for tests of states. */
#ifndef VIRGA_TESTS_STATE_RUN_H
#define VIRGA_TESTS_STATE_RUN_H

#include "../gpu/gpu_fixture.h"
#include "../host/wrong_words.h"
#include "host_parts.h"

typedef struct state_run {
    gpu_fixture *f;
    virga_context *context;
    virga_scene *scene;
    gpu_picture picture;
    host_buffer vertices, indices, blob;
    bool walk; /* the ground's window follows */
    bool in_turns;
    bool sheltered; /* panes get a part of the rain, and catch none of its drops */
} state_run;

static inline void set_weather(state_run *run)
{
    virga_rain_settings rain;
    REQUIRE(small_shapes_set(run->scene) == VIRGA_OK && small_weather_set(run->scene) == VIRGA_OK);
    virga_rain_get(virga_scene_rain(run->scene), &rain);
    rain.occlusion_interval = run->in_turns ? 3 : 1;
    REQUIRE(virga_rain_set(virga_scene_rain(run->scene), &rain) == VIRGA_OK);
}

/* A buffer that a state can be saved to, and loaded from. */
static inline void open_blob(state_run *run, VkDeviceSize size, host_buffer *blob)
{
    REQUIRE(host_buffer_create(&run->f->gpu.device, size,
                               VK_BUFFER_USAGE_TRANSFER_DST_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT,
                               HOST_BUFFER_READBACK, "state", blob, run->f->gpu.error, sizeof run->f->gpu.error));
}

static inline void open_scene(state_run *run, uint32_t seed)
{
    virga_glass_def panes[SMALL_PANES];
    virga_scene_def def = small_scene_def(panes);
    def.rain.seed = seed;
    def.rain.occlusion_slants = 2;
    def.rain.occlusion_keeps = run->in_turns;
    run->context = gpu_context(run->f);
    gpu_picture_open(run->f, run->context, &run->picture);
    REQUIRE(virga_scene_create(run->context, &def, &run->scene) == VIRGA_OK);
    set_weather(run);
    REQUIRE(virga_scene_attach(run->scene, run->picture.target) == VIRGA_OK);
    host_parts_square(&run->f->gpu, &run->vertices, &run->indices);
    open_blob(run, virga_scene_state_bytes(run->scene), &run->blob);
    gpu_forget_log(run->f);
}

static inline void close_scene(state_run *run)
{
    host_buffer_destroy(&run->f->gpu.device, &run->vertices);
    host_buffer_destroy(&run->f->gpu.device, &run->indices);
    host_buffer_destroy(&run->f->gpu.device, &run->blob);
    virga_scene_destroy(&run->scene);
    gpu_picture_close(run->f, &run->picture);
    virga_context_destroy(&run->context);
}

/* Records the step and the draw of a frame. */
static inline virga_result try_record(state_run *run, VkCommandBuffer cmd, uint32_t number)
{
    const virga_occluder square = small_occluder(run->vertices.buffer, run->indices.buffer);
    virga_scene_pane panes[SMALL_PANES];
    virga_view view = gpu_view(&run->picture);
    const double ahead = run->walk ? 0.7 * number : 0;
    const virga_scene_frame frame = {.dt_s = 0.021, /* not a whole number of ticks */
                                     .camera_m = {0, 1.7, -ahead},
                                     .ripple_center_m = {0, 0, -ahead},
                                     .occluders = &square,
                                     .occluder_count = 1,
                                     .view = &view,
                                     .panes = panes};
    small_panes_lay(panes);
    for (int i = 0; i < SMALL_PANES; i++)
        panes[i].shelter = run->sheltered ? 0.2f : panes[i].shelter;
    view.position_m[1] = view.open_position_m[1] = 1.7;
    view.position_m[2] = view.open_position_m[2] = -ahead;
    virga_result result = virga_scene_record(run->scene, cmd, &frame);
    host_target_begin_layer(&run->picture.images, cmd);
    if (!result)
        result = virga_scene_draw(run->scene, cmd, run->picture.target);
    host_target_end_layer(&run->picture.images, cmd);
    return result;
}

static inline void record(state_run *run, VkCommandBuffer cmd, uint32_t number)
{
    assert_int_equal(try_record(run, cmd, number), VIRGA_OK);
}

static inline void save(state_run *run, VkCommandBuffer cmd)
{
    const virga_state_range range = {run->blob.buffer, 0, run->blob.size};
    assert_int_equal(virga_scene_save(run->scene, cmd, &range), VIRGA_OK);
}

/* Plays frames and saves the last one. `load` (may be NULL) is loaded before the first one. */
static inline void play(state_run *run, const host_buffer *load, uint32_t first, uint32_t last)
{
    virga_state_info info;
    for (uint32_t number = first; number <= last; number++) {
        VkCommandBuffer cmd = gpu_begin_frame(run->f, run->context);
        if (load && number == first) {
            const virga_state_source source = {load->mapped, load->size, load->buffer, 0};
            if (virga_scene_load(run->scene, cmd, &source) != VIRGA_OK)
                fail_msg("%s", run->f->last);
        }
        record(run, cmd, number);
        if (number == last)
            save(run, cmd);
        gpu_submit(run->f);
    }
    gpu_wait(run->f);
    assert_int_equal(virga_frame_completed(run->context, run->f->gpu.device.completed), VIRGA_OK);
    host_buffer_invalidate(&run->f->gpu.device, &run->blob);
    assert_int_equal(virga_state_seal(run->blob.mapped, run->blob.size, run->f->gpu.device.frame, &info), VIRGA_OK);
    assert_int_equal(info.bytes, virga_scene_state_bytes(run->scene));
}

static inline void keep(state_run *run, const host_buffer *blob, host_buffer *copy)
{
    open_blob(run, blob->size, copy);
    memcpy(copy->mapped, blob->mapped, blob->size);
}

#endif
