/* test_rain_live.c - settings that change in mid-run: no drop moves for them, nothing is made anew, nothing pops. */
#include "rain_fixture.h"

#include <math.h>

#include "camera.h"
#include "rain/rain_internal.h"

static const double tick_s = 1.0 / 60;

static void open_live(rain_fixture *f)
{
    virga_rain_def def = virga_default_rain_def();
    def.max_drops = 16384;
    def.range_m = 8;
    def.occlusion_size = 256;
    def.points = true;
    rain_fixture_open(f);
    rain_fixture_floor(f);
    rain_fixture_rain(f, &def);
    f->settings.rate_mm_h = 20;
    f->settings.wind_m_s[0] = 2;
    f->settings.gust_m_s = 1;
    f->camera[1] = 1.7;
    assert_int_equal(virga_rain_set(f->rain, &f->settings), VIRGA_OK);
}

static void set(rain_fixture *f)
{
    assert_int_equal(virga_rain_set(f->rain, &f->settings), VIRGA_OK);
}

/* ---- one change each */

static const double table_diameters[3] = {0.0004, 0.001, 0.003}, table_numbers[3] = {1, 3, 0};

static void rate_up(virga_rain_settings *s)
{
    s->rate_mm_h = 90;
}

static void rate_down(virga_rain_settings *s)
{
    s->rate_mm_h = 0.5f;
}

static void other_sizes(virga_rain_settings *s)
{
    s->sizes.kind = VIRGA_SIZES_BEST;
}

static void table_of_sizes(virga_rain_settings *s)
{
    s->sizes = (virga_sizes){VIRGA_SIZES_TABLE, table_diameters, table_numbers, 3};
}

static void more_haze(virga_rain_settings *s)
{
    s->haze = 4;
    s->bodies_min_mm = 2;
}

static void another_sky(virga_rain_settings *s)
{
    for (int i = 0; i < 27; i++)
        s->lighting.environment_sh[i / 3][i % 3] = 0.1f * (float)i;
}

static void lamps_on(virga_rain_settings *s)
{
    s->lighting.light_count = 3;
    for (int i = 0; i < 3; i++)
        s->lighting.lights[i] = (virga_light){.position_m = {i, 4, -5}, .intensity = {10, 20, 30}, .range_m = 20};
    s->light_gain = 2;
}

static void another_look(virga_rain_settings *s)
{
    s->streak_gain = 5;
    s->min_width_px = 2;
    s->soft_m = 0.5f;
    s->near_m = 1;
    s->oscillation = 0;
    s->default_material = 7;
}

static void stronger_wind(virga_rain_settings *s)
{
    s->wind_m_s[0] = -9;
    s->wind_m_s[1] = 1;
    s->wind_m_s[2] = 4;
}

static void wilder_gusts(virga_rain_settings *s)
{
    s->gust_m_s = 6;
    s->gust_time_s = 0.5f;
}

static void thinner_air(virga_rain_settings *s)
{
    s->air_density = 0.5f;
}

typedef void (*change)(virga_rain_settings *settings);

static const change only_weighting[] = {rate_up,   rate_down,   other_sizes, table_of_sizes,
                                        more_haze, another_sky, lamps_on,    another_look};
static const change moving[] = {stronger_wind, wilder_gusts, thinner_air};

enum { WEIGHTING = sizeof only_weighting / sizeof only_weighting[0], MOVING = sizeof moving / sizeof moving[0] };

/* ---- drops stay where they are */

static void run_and_hash(change changed, uint64_t hashes[4])
{
    rain_fixture f;
    open_live(&f);
    for (int i = 0; i < 4; i++) {
        if (changed && i == 1) {
            changed(&f.settings);
            set(&f);
        }
        rain_fixture_step(&f, 0.1);
        hashes[i] = rain_fixture_hash(rain_fixture_drops(&f), f.slots * sizeof(virga_drop_gpu), HASH_START);
    }
    rain_fixture_close(&f);
}

static void what_only_weights_moves_no_drop(void **state)
{
    (void)state;
    uint64_t unchanged[4];
    run_and_hash(NULL, unchanged);
    assert_true(unchanged[0] != unchanged[1]);
    for (int i = 0; i < WEIGHTING; i++) {
        uint64_t hashes[4];
        run_and_hash(only_weighting[i], hashes);
        assert_memory_equal(hashes, unchanged, sizeof hashes);
    }
}

/* Each drop that stays in its box has moved by its velocity times the tick, also in the tick that follows a change. */
static void check_continuous(const virga_point_gpu *before, const virga_point_gpu *after, uint32_t slots)
{
    uint32_t same = 0, strange = 0;
    for (uint32_t i = 0; i < slots; i++) {
        double off = 0;
        if (before[i].id != after[i].id)
            continue;
        for (int axis = 0; axis < 3; axis++) {
            const double moved = (double)after[i].position[axis] - (double)before[i].position[axis];
            off = fmax(off, fabs(moved - (double)after[i].velocity[axis] * tick_s));
        }
        same++;
        strange += off > 2e-5; /* another drop with the same id: once in 1024 times of those that left */
    }
    assert_true(same > slots / 2);
    assert_true(strange <= slots / 1000);
}

static void what_moves_drops_moves_them_without_a_jump(void **state)
{
    (void)state;
    for (int i = 0; i < MOVING; i++) {
        rain_fixture f;
        host_buffer read = {0};
        open_live(&f);
        rain_fixture_points_step(&f, 0.2, &read);
        virga_point_gpu *before = malloc(f.slots * sizeof *before);
        for (int tick = 0; tick < 12; tick++) {
            memcpy(before, read.mapped, f.slots * sizeof *before);
            if (tick == 2) {
                moving[i](&f.settings);
                set(&f);
            }
            check_continuous(before, rain_fixture_points_step(&f, tick_s, &read), f.slots);
        }
        free(before);
        host_buffer_destroy(&f.gpu.device, &read);
        rain_fixture_close(&f);
    }
}

/* And velocities take the change on by drag, at most g (|v - w| / vt)^2 a tick. */
static void velocities_change_by_drag_only(void **state)
{
    (void)state;
    rain_fixture f;
    host_buffer read = {0};
    open_live(&f);
    f.settings.gust_m_s = 0;
    set(&f);
    rain_fixture_points_step(&f, 0.2, &read);
    virga_point_gpu *before = malloc(f.slots * sizeof *before);
    stronger_wind(&f.settings);
    set(&f);
    for (int tick = 0; tick < 5; tick++) {
        memcpy(before, read.mapped, f.slots * sizeof *before);
        const virga_point_gpu *after = rain_fixture_points_step(&f, tick_s, &read);
        for (uint32_t i = 0; i < f.slots; i++) {
            const double terminal = virga_drop_terminal_speed((double)after[i].diameter_m, 0);
            double against2 = 0, most;
            for (int axis = 0; axis < 3; axis++)
                against2 += pow((double)before[i].velocity[axis] - (double)f.settings.wind_m_s[axis], 2);
            most = VIRGA_GRAVITY * (against2 / (terminal * terminal) + 1) * tick_s;
            for (int axis = 0; axis < 3; axis++)
                assert_true(fabs((double)after[i].velocity[axis] - (double)before[i].velocity[axis]) <= most + 1e-4);
        }
    }
    free(before);
    host_buffer_destroy(&f.gpu.device, &read);
    rain_fixture_close(&f);
}

/* ---- nothing is made anew */

static void changes_allocate_nothing_on_the_device(void **state)
{
    (void)state;
    rain_fixture f;
    virga_memory_stats before, after;
    virga_rain_buffer drops[2], impacts[2];
    open_live(&f);
    for (int i = 0; i < 5; i++)
        rain_fixture_step(&f, tick_s); /* until what the first frame uploaded is gone */
    const virga_rain_settings original = f.settings;
    virga_memory_get(f.context, &before);
    virga_rain_drops(f.rain, &drops[0], NULL, NULL);
    virga_rain_impacts(f.rain, &impacts[0]);
    for (int i = 0; i < WEIGHTING + MOVING; i++) {
        (i < WEIGHTING ? only_weighting[i] : moving[i - WEIGHTING])(&f.settings);
        set(&f);
        rain_fixture_step(&f, 2 * tick_s);
        virga_memory_get(f.context, &after);
        assert_true(after.device_bytes == before.device_bytes);
        assert_true(after.device_used == before.device_used);
        assert_int_equal(after.device_allocations, before.device_allocations);
        assert_int_equal(after.objects, before.objects);
    }
    f.settings = original;
    set(&f);
    virga_memory_get(f.context, &after);
    assert_true(after.host_bytes == before.host_bytes);
    assert_int_equal(after.host_allocations, before.host_allocations);
    virga_rain_drops(f.rain, &drops[1], NULL, NULL);
    virga_rain_impacts(f.rain, &impacts[1]);
    assert_true(drops[0].buffer == drops[1].buffer && impacts[0].buffer == impacts[1].buffer);
    assert_int_equal(f.errors, 0);
    rain_fixture_close(&f);
}

/* What virga_rain_get gives can be given back, with the table of sizes that it points to. */
static void settings_can_be_read_changed_and_set(void **state)
{
    (void)state;
    rain_fixture f;
    virga_rain_settings read;
    open_live(&f);
    table_of_sizes(&f.settings);
    set(&f);
    for (int i = 0; i < 3; i++) {
        virga_rain_get(f.rain, &read);
        assert_int_equal(read.sizes.table_count, 3);
        assert_memory_equal(read.sizes.table_diameter_m, table_diameters, sizeof table_diameters);
        assert_memory_equal(read.sizes.table_number, table_numbers, sizeof table_numbers);
        read.rate_mm_h += 1;
        assert_int_equal(virga_rain_set(f.rain, &read), VIRGA_OK);
        rain_fixture_step(&f, tick_s);
    }
    virga_rain_get(f.rain, &read);
    assert_true(read.rate_mm_h == 23);
    rain_fixture_close(&f);
}

/* ---- nothing pops */

/* The sum of weights is the number of drops in the air. */
static double drops_in_the_air(const virga_point_gpu *points, uint32_t slots)
{
    double sum = 0;
    for (uint32_t i = 0; i < slots; i++)
        sum += (double)points[i].weight;
    return sum;
}

static void open_sky(rain_fixture *f, float rate_mm_h, float transition_s)
{
    open_live(f);
    f->settings.wind_m_s[0] = 0;
    f->settings.gust_m_s = 0;
    f->settings.rate_mm_h = rate_mm_h;
    f->settings.transition_s = transition_s;
    set(f);
}

/* From one rate to another the number of drops goes in a straight line. That of the drops seen is theirs, give or take
 * the noise of drops that come and go; 4 % of it are far more than 3 deviations here. */
static void check_transition(float from, float to)
{
    enum { TICKS = 30 };
    rain_fixture f;
    host_buffer read = {0};
    double numbers[TICKS + 6];
    open_sky(&f, from, (float)(TICKS * tick_s));
    const double first = drops_in_the_air(rain_fixture_points_step(&f, 0.2, &read), f.slots);
    f.settings.rate_mm_h = to;
    set(&f);
    for (int i = 0; i < TICKS + 6; i++)
        numbers[i] = drops_in_the_air(rain_fixture_points_step(&f, tick_s, &read), f.slots);
    const double last = numbers[TICKS + 5], noise = 0.04 * fmax(first, last);
    printf("from %.0f to %.0f drops\n", first, last);
    assert_true(fabs(last - first) > 0.3 * first);
    for (int i = 0; i < TICKS + 6; i++) {
        const double share = i + 1 < TICKS ? (i + 1.0) / TICKS : 1;
        assert_true(fabs(numbers[i] - (first + share * (last - first))) < noise);
        assert_true(fabs(numbers[i] - (i ? numbers[i - 1] : first)) < 2 * fabs(last - first) / TICKS + 0.02 * last);
    }
    host_buffer_destroy(&f.gpu.device, &read);
    rain_fixture_close(&f);
}

static void more_rain_eases_in(void **state)
{
    (void)state;
    check_transition(5, 60);
}

static void less_rain_eases_out(void **state)
{
    (void)state;
    check_transition(60, 5);
}

static bool in_the_middle(const virga_point_gpu *point)
{
    const float *p = point->position;
    return fmaxf(fabsf(p[0]), fmaxf(fabsf(p[1]), fabsf(p[2]))) < 0.2f;
}

/* A slot fades as the rate passes its rank: over a twentieth of all ranks, so over as many ticks as that takes. */
static void single_drops_fade_too(void **state)
{
    (void)state;
    rain_fixture f;
    host_buffer read = {0};
    uint32_t fading = 0;
    open_sky(&f, 10, 4);
    rain_fixture_points_step(&f, 0.2, &read);
    virga_point_gpu *before = malloc(f.slots * sizeof *before);
    f.settings.rate_mm_h = 40;
    set(&f);
    for (int tick = 0; tick < 20; tick++) {
        memcpy(before, read.mapped, f.slots * sizeof *before);
        const virga_point_gpu *after = rain_fixture_points_step(&f, tick_s, &read);
        for (uint32_t i = 0; i < f.slots; i++) {
            /* In the middle of the first box, where the rate alone changes the weight. */
            if (i >= f.slots / f.rain->levels || before[i].id != after[i].id || !in_the_middle(&before[i]) ||
                !in_the_middle(&after[i]))
                continue;
            fading += before[i].weight != after[i].weight;
            assert_true(fabsf(after[i].weight - before[i].weight) < 0.25f);
        }
    }
    printf("%u steps of weights\n", fading);
    assert_true(fading > 20);
    free(before);
    host_buffer_destroy(&f.gpu.device, &read);
    rain_fixture_close(&f);
}

/* A change in the middle of another goes on from where that was. */
static void a_change_in_the_middle_of_another_makes_no_jump(void **state)
{
    (void)state;
    rain_fixture f;
    host_buffer read = {0};
    open_sky(&f, 5, 0.5f);
    double before = drops_in_the_air(rain_fixture_points_step(&f, 0.2, &read), f.slots);
    const double first = before;
    for (int tick = 0; tick < 30; tick++) {
        f.settings.rate_mm_h = tick % 3 ? 60 : 5;
        f.settings.sizes.kind = tick % 2 ? VIRGA_SIZES_BEST : VIRGA_SIZES_MARSHALL_PALMER;
        set(&f);
        const double now = drops_in_the_air(rain_fixture_points_step(&f, tick_s, &read), f.slots);
        assert_true(fabs(now - before) < 0.15 * first); /* the whole way is more than its double */
        before = now;
    }
    host_buffer_destroy(&f.gpu.device, &read);
    rain_fixture_close(&f);
}

static void transition_0_is_at_once(void **state)
{
    (void)state;
    rain_fixture f;
    host_buffer read = {0};
    open_sky(&f, 5, 0);
    const double before = drops_in_the_air(rain_fixture_points_step(&f, 0.2, &read), f.slots);
    f.settings.rate_mm_h = 60;
    set(&f);
    const double next = drops_in_the_air(rain_fixture_points_step(&f, tick_s, &read), f.slots);
    const double later = drops_in_the_air(rain_fixture_points_step(&f, 0.2, &read), f.slots);
    assert_true(next > 1.3 * before && fabs(later - next) < 0.04 * next);
    host_buffer_destroy(&f.gpu.device, &read);
    rain_fixture_close(&f);
}

/* ---- haze */

/* Extinction beyond all boxes, as a prepare has it. */
static double haze_of_a_prepare(rain_fixture *f)
{
    const host_camera_key key = {0, {0, 1.7, 0}, {0, 1.7, -5}, 0, false};
    const host_camera_path path = {&key, 1, 40, 0.1, 100};
    host_camera camera;
    virga_view view = virga_default_view();
    host_camera_at(&path, 0, 160, 120, NULL, &camera);
    host_camera_view(&camera, &camera, 1.0 / 96, &view);
    const VkCommandBuffer cmd = rain_fixture_begin_frame(f);
    rain_fixture_record_step(f, cmd, tick_s);
    REQUIRE(virga_rain_prepare(f->rain, cmd, &view, virga_rain_time(f->rain)) == VIRGA_OK);
    const rain_view_block *written =
        (const void *)((const char *)f->rain->view_ring->memory.block.mapped + f->rain->view_offset);
    const double extinction = (double)written->look.haze_per_m[f->rain->levels];
    rain_fixture_end_frame(f);
    return extinction;
}

static void haze_eases_with_the_rate(void **state)
{
    (void)state;
    enum { TICKS = 30 };
    for (int up = 0; up < 2; up++) {
        rain_fixture f;
        open_sky(&f, up ? 2 : 60, (float)(TICKS * tick_s));
        double before = haze_of_a_prepare(&f);
        assert_true(fabs(before / virga_rain_extinction(up ? 2 : 60) - 1) < 1e-3);
        f.settings.rate_mm_h = up ? 60 : 0;
        set(&f);
        const double target = virga_rain_extinction(up ? 60 : 0), way = fabs(target - before);
        for (int tick = 0; tick < TICKS; tick++) {
            const double now = haze_of_a_prepare(&f);
            assert_true(fabs(now - before) < 0.2 * way);
            before = now;
        }
        assert_true(fabs(haze_of_a_prepare(&f) - target) < 1e-3 * way);
        rain_fixture_close(&f);
    }
}

/* ---- no rain */

static void no_rate_is_no_impacts_after_the_transition(void **state)
{
    (void)state;
    rain_fixture f;
    const virga_impact_gpu *list;
    open_live(&f);
    f.settings.transition_s = 0.2f;
    set(&f);
    rain_fixture_step(&f, 0.2);
    assert_true(rain_fixture_impacts(&f, &list)->count > 100);
    f.settings.rate_mm_h = 0;
    set(&f);
    rain_fixture_step(&f, 0.1);
    assert_true(rain_fixture_impacts(&f, &list)->count > 10); /* still raining a little */
    rain_fixture_step(&f, 0.1);
    for (int i = 0; i < 4; i++) {
        rain_fixture_step(&f, 0.2);
        const virga_impacts_gpu *head = rain_fixture_impacts(&f, &list);
        assert_int_equal(head->count, 0);
        assert_int_equal(head->water_nl_low | head->water_nl_high, 0);
    }
    f.settings.rate_mm_h = 20;
    set(&f);
    rain_fixture_step(&f, 0.25);
    rain_fixture_step(&f, 0.2);
    assert_true(rain_fixture_impacts(&f, &list)->count > 100);
    rain_fixture_close(&f);
}

/* ---- occlusion that the host has drawn */

enum { MAP_SIZE = 256 };

typedef struct host_maps {
    host_image depth;
    host_buffer texels;
    virga_image given;
    uint32_t count;
} host_maps;

static void create_maps(rain_fixture *f, VkFormat format, uint32_t count, host_maps *maps)
{
    const host_image_def def = {.format = format,
                                .extent = {MAP_SIZE, MAP_SIZE, 1},
                                .layers = count,
                                .usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT,
                                .name = "host's maps"};
    maps->count = count;
    REQUIRE(host_image_create(&f->gpu.device, &def, &maps->depth, f->gpu.error, sizeof f->gpu.error));
    REQUIRE(host_buffer_create(&f->gpu.device, (VkDeviceSize)count * MAP_SIZE * MAP_SIZE * 4,
                               VK_BUFFER_USAGE_TRANSFER_SRC_BIT, HOST_BUFFER_UPLOAD, "depths", &maps->texels,
                               f->gpu.error, sizeof f->gpu.error));
    const virga_image_state read = {VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT,
                                    VK_ACCESS_SHADER_READ_BIT};
    maps->given = (virga_image){.image = maps->depth.image,
                                .view = maps->depth.view,
                                .format = format,
                                .extent = maps->depth.extent,
                                .layers = count,
                                .before = read,
                                .after = read};
}

/* Depth in a view of a point of the plane y = height + slope x, for the middle of a texel: clip.x is linear in x and y,
 * so the point is where the plane meets the texel's line of fall. */
static float plane_depth(const virga_occlusion_view *view, uint32_t column, double height, double slope)
{
    const float *m = view->clip_from_world;
    const double clip_x = (column + 0.5) / MAP_SIZE * 2 - 1;
    /* clip_x = m0 x' + m4 y' + m12, with x', y' from the view's origin and y' = h + slope x'. */
    const double h = height + slope * view->origin_m[0] - view->origin_m[1];
    const double x = (clip_x - (double)m[12] - (double)m[4] * h) / ((double)m[0] + (double)m[4] * slope);
    return (float)((double)m[6] * (h + slope * x) + (double)m[14]);
}

static void draw_maps(rain_fixture *f, VkCommandBuffer cmd, host_maps *maps, double height, double slope)
{
    virga_occlusion_view views[VIRGA_RAIN_MAX_MAPS];
    assert_int_equal(virga_rain_occlusion_views(f->rain, f->camera, views), maps->count);
    float *texels = maps->texels.mapped;
    for (uint32_t i = 0; i < maps->count * MAP_SIZE * MAP_SIZE; i++)
        texels[i] = plane_depth(&views[i / (MAP_SIZE * MAP_SIZE)], i % MAP_SIZE, height, slope);
    const bool depth = maps->depth.format == VK_FORMAT_D32_SFLOAT;
    const VkBufferImageCopy region = {
        .imageSubresource = {depth ? VK_IMAGE_ASPECT_DEPTH_BIT : VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, maps->count},
        .imageExtent = {MAP_SIZE, MAP_SIZE, 1}};
    host_image_barrier(cmd, &maps->depth, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                       VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, 0, VK_PIPELINE_STAGE_TRANSFER_BIT,
                       VK_ACCESS_TRANSFER_WRITE_BIT);
    vkCmdCopyBufferToImage(cmd, maps->texels.buffer, maps->depth.image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1,
                           &region);
    host_image_barrier(cmd, &maps->depth, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                       VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, VK_PIPELINE_STAGE_TRANSFER_BIT,
                       VK_ACCESS_TRANSFER_WRITE_BIT, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, VK_ACCESS_SHADER_READ_BIT);
    assert_int_equal(virga_rain_occlusion_import(f->rain, cmd, &maps->given), VIRGA_OK);
}

static const virga_impacts_gpu *step_with_maps(rain_fixture *f, host_maps *maps, double height, double slope,
                                               const virga_impact_gpu **list)
{
    virga_rain_buffer impacts;
    const VkCommandBuffer cmd = rain_fixture_begin_frame(f);
    draw_maps(f, cmd, maps, height, slope);
    rain_fixture_record_step(f, cmd, 0.2);
    virga_rain_impacts(f->rain, &impacts);
    rain_fixture_copy(cmd, &impacts, &f->impacts);
    rain_fixture_end_frame(f);
    host_buffer_invalidate(&f->gpu.device, &f->impacts);
    return rain_fixture_impacts(f, list);
}

static void check_import(VkFormat format, double height, double slope, float wind_x)
{
    rain_fixture f;
    host_maps maps = {0};
    const virga_impact_gpu *list;
    open_live(&f);
    f.settings.gust_m_s = 0;
    f.settings.wind_m_s[0] = wind_x;
    f.settings.default_material = 9;
    set(&f);
    f.camera[0] = 12.3;
    create_maps(&f, format, 4, &maps);
    const virga_impacts_gpu *head = step_with_maps(&f, &maps, height, slope, &list);
    /* Half of a texel of the wider map on the slope. */
    const double side = 2 * f.rain->maps[f.rain->map_count - 1].half_m;
    const double tolerance = 1e-3 + fabs(slope) * 0.5 * side / MAP_SIZE * 1.2, length = sqrt(1 + slope * slope);
    assert_true(head->count > 100);
    for (uint32_t i = 0; i < head->count; i++) {
        const double x = (double)list[i].position[0] + (double)head->origin[0],
                     y = (double)list[i].position[1] + (double)head->origin[1];
        assert_true(fabs(y - (height + slope * x)) < tolerance);
        assert_int_equal(list[i].material, 9);
        assert_true(fabs((double)list[i].normal[0] + slope / length) < 0.02);
        assert_true(fabs((double)list[i].normal[1] - 1 / length) < 0.02);
    }
    /* The rain's own maps again, with the floor in them. */
    rain_fixture_step(&f, 0.2);
    rain_fixture_step(&f, 0.2);
    head = rain_fixture_impacts(&f, &list);
    assert_true(head->count > 100);
    for (uint32_t i = 0; i < head->count; i++) {
        assert_int_equal(list[i].material, 1);
        assert_true(fabsf(list[i].position[1] + head->origin[1]) < 1e-3f);
    }
    host_buffer_destroy(&f.gpu.device, &maps.texels);
    host_image_destroy(&f.gpu.device, &maps.depth);
    rain_fixture_close(&f);
}

static void imported_depth_is_where_drops_land(void **state)
{
    (void)state;
    check_import(VK_FORMAT_D32_SFLOAT, 1.25, 0, 0);
}

static void imported_depth_may_be_r32(void **state)
{
    (void)state;
    check_import(VK_FORMAT_R32_SFLOAT, 0.6, 0, 0);
}

static void imported_depth_holds_in_slanted_rain(void **state)
{
    (void)state;
    check_import(VK_FORMAT_D32_SFLOAT, 1.25, 0, 5);
}

static void imported_slopes_have_their_normals(void **state)
{
    (void)state;
    check_import(VK_FORMAT_D32_SFLOAT, -0.5, 0.1, 0);
    check_import(VK_FORMAT_D32_SFLOAT, -0.5, 0.1, 3);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_only_weights_moves_no_drop),
        cmocka_unit_test(what_moves_drops_moves_them_without_a_jump),
        cmocka_unit_test(velocities_change_by_drag_only),
        cmocka_unit_test(changes_allocate_nothing_on_the_device),
        cmocka_unit_test(settings_can_be_read_changed_and_set),
        cmocka_unit_test(more_rain_eases_in),
        cmocka_unit_test(less_rain_eases_out),
        cmocka_unit_test(single_drops_fade_too),
        cmocka_unit_test(a_change_in_the_middle_of_another_makes_no_jump),
        cmocka_unit_test(transition_0_is_at_once),
        cmocka_unit_test(haze_eases_with_the_rate),
        cmocka_unit_test(no_rate_is_no_impacts_after_the_transition),
        cmocka_unit_test(imported_depth_is_where_drops_land),
        cmocka_unit_test(imported_depth_may_be_r32),
        cmocka_unit_test(imported_depth_holds_in_slanted_rain),
        cmocka_unit_test(imported_slopes_have_their_normals),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
