/* test_rain_import.c - occlusion that the host has drawn: where drops land on it, and with which normals. */
#include "rain_live_fixture.h"

#include "rain/rain_internal.h"

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
    assert_int_equal(virga_rain_plan_occlusion(f->rain, f->camera, views), maps->count);
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
    assert_int_equal(virga_rain_import_occlusion(f->rain, cmd, &maps->given), VIRGA_OK);
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
        cmocka_unit_test(imported_depth_is_where_drops_land),
        cmocka_unit_test(imported_depth_may_be_r32),
        cmocka_unit_test(imported_depth_holds_in_slanted_rain),
        cmocka_unit_test(imported_slopes_have_their_normals),
    };
    return effect_fixture_close(cmocka_run_group_tests(tests, NULL, NULL));
}
