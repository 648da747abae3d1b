/* Materials from a picture, over those of meshes: whose cells are whose, to the cell, near the origin and far from it;
 * and when the picture is looked at. */
#include "ground_fixture.h"

#include <math.h>

#define MESH VIRGA_MATERIAL_ASPHALT
#define NONE 255

static ground_fixture f;
static host_image picture;

/* A level floor of asphalt 100 m wide around a point, and a window of cells in its middle. */
static void begin_with(double x, double z, uint32_t cells)
{
    virga_ground_def def = virga_default_ground_def();
    def.cells = cells;
    def.cached_tiles = 0;
    def.max_impacts = MAX_DROPS;
    memset(&picture, 0, sizeof picture); /* a test that failed has left its own behind */
    ground_fixture_open(&f);
    ground_fixture_floor(&f, MESH);
    f.meshes[0].world_from_mesh[3] = (float)x;
    f.meshes[0].world_from_mesh[11] = (float)z;
    f.camera[0] = x;
    f.camera[2] = z;
    ground_fixture_ground(&f, &def);
}

/* 6.4 m of cells. */
static void begin(double x, double z)
{
    begin_with(x, z, 128);
}

static void end(void)
{
    host_image_destroy(&f.gpu.device, &picture);
    ground_fixture_close(&f);
}

static void put_picture(VkFormat format, uint32_t width, uint32_t height, const void *texels, uint32_t texel)
{
    host_image_destroy(&f.gpu.device, &picture);
    const host_image_def def = {.format = format,
                                .extent = {width, height, 1},
                                .usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT,
                                .name = "materials"};
    REQUIRE(host_image_create(&f.gpu.device, &def, &picture, f.gpu.error, sizeof f.gpu.error));
    REQUIRE(host_image_upload(&f.gpu.device, &picture, texels, (VkDeviceSize)width * height * texel, texel, f.gpu.error,
                              sizeof f.gpu.error));
    f.materials.image = (virga_image){.image = picture.image,
                                      .view = picture.view,
                                      .format = format,
                                      .extent = picture.extent,
                                      .before = {VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
                                                 VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, VK_ACCESS_SHADER_READ_BIT}};
}

static void put_corners(double low_x, double low_z, double high_x, double high_z)
{
    f.materials.low_m[0] = low_x;
    f.materials.low_m[1] = low_z;
    f.materials.high_m[0] = high_x;
    f.materials.high_m[1] = high_z;
}

static uint32_t material_at(int x, int z)
{
    return f.floors[ground_fixture_index(&f, x, z)].material;
}

/* The material at a position by the rule in the header. */
static uint32_t expected_at(const uint32_t *texels, uint32_t width, uint32_t height, double x_m, double z_m)
{
    const virga_ground_material_map *map = &f.materials;
    const double x = (x_m - map->low_m[0]) / (map->high_m[0] - map->low_m[0]) * width;
    const double z = (z_m - map->low_m[1]) / (map->high_m[1] - map->low_m[1]) * height;
    if (x < 0 || x >= width || z < 0 || z >= height)
        return MESH;
    const uint32_t material = texels[(uint32_t)z * width + (uint32_t)x];
    return material < VIRGA_GROUND_MATERIALS ? material : MESH;
}

/* Every cell of the window, by its middle. Returns how many are not the mesh's. */
static uint32_t check_all(const uint32_t *texels, uint32_t width, uint32_t height)
{
    uint32_t mapped = 0;
    const double cell = (double)f.ground->def.cell_m;
    const int side = (int)f.ground->def.cells;
    for (int i = 0; i < side * side; i++) {
        const int x = f.ground->window.low[0] * VIRGA_GROUND_TILE + i % side;
        const int z = f.ground->window.low[1] * VIRGA_GROUND_TILE + i / side;
        const uint32_t expected = expected_at(texels, width, height, (x + 0.5) * cell, (z + 0.5) * cell);
        if (material_at(x, z) != expected)
            fail_msg("cell %d %d is %u, expected %u", x, z, material_at(x, z), expected);
        mapped += expected != MESH;
    }
    return mapped;
}

/* All different, so that rows and columns cannot be mistaken for one another; one is the mesh's. */
static const uint8_t bytes[6] = {5, 15, NONE, 6, 2, 31};
static const uint32_t expected_materials[6] = {5, 15, NONE, 6, 2, 31};

static void test_texels_lie_where_their_corners_say(void **state)
{
    (void)state;
    begin(0, 0);
    put_picture(VK_FORMAT_R8_UINT, 3, 2, bytes, 1);
    put_corners(-1.3, -0.7, 0.2, 0.3); /* texels of 50 cm */
    ground_fixture_step(&f, 0);
    assert_int_equal(check_all(expected_materials, 3, 2), 5 * 100);
    /* By hand: the first texel at low_m, the next in its row along x. */
    assert_int_equal(material_at(-26, -14), 5);
    assert_int_equal(material_at(-27, -14), MESH);
    assert_int_equal(material_at(-26, -15), MESH);
    assert_int_equal(material_at(-17, -5), 5);
    assert_int_equal(material_at(-16, -5), 15);
    assert_int_equal(material_at(-17, -4), 6);
    assert_int_equal(material_at(3, 5), 31);
    assert_int_equal(material_at(4, 5), MESH);
    assert_int_equal(material_at(3, 6), MESH);
    assert_int_equal(material_at(0, -14), MESH); /* 255 */
    end();
}

static void test_far_from_the_origin_they_lie_as_exactly(void **state)
{
    (void)state;
    begin(10001, -7001);
    put_picture(VK_FORMAT_R8_UINT, 3, 2, bytes, 1);
    put_corners(10000 - 0.8, -7000 - 0.7, 10000 + 0.7, -7000 + 0.3);
    ground_fixture_step(&f, 0);
    assert_int_equal(check_all(expected_materials, 3, 2), 5 * 100);
    end();
}

/* 8192 texels in a row, one a cell, 100 km away: few bits are left for a position in a texel at its far end. */
static void test_a_wide_picture_is_as_exact(void **state)
{
    (void)state;
    enum { WIDE = 8192 };
    static uint8_t texels[WIDE];
    static uint32_t same[WIDE];
    for (uint32_t i = 0; i < WIDE; i++)
        same[i] = texels[i] = (uint8_t)(i * 7 % 29 + 3);
    begin(100000, 0);
    put_picture(VK_FORMAT_R8_UINT, WIDE, 1, texels, 1);
    const double cell = (double)f.ground->def.cell_m, middle = (floor(100000 / cell) + 0.5) * cell;
    /* Borders a third of a millimetre to the left of the middles of cells, and to the right. */
    for (int side = -1; side <= 1; side += 2) {
        const double low_m = middle - 7800 * cell + side * 0.00033;
        put_corners(low_m, -1, low_m + WIDE * cell, 1);
        virga_ground_refresh_heights(f.ground);
        ground_fixture_step(&f, 0);
        assert_int_equal(check_all(same, WIDE, 1), 128 * 40);
    }
    end();
}

/* Any format of one unsigned integer, any layout that it can be read in; no number that is none of a material. */
static void test_wide_integers_and_other_layouts_are_read(void **state)
{
    (void)state;
    static const uint32_t texels[6] = {4, 32, 0x10005, 256 + 6, 0, 0xffffffff};
    VkCommandBuffer cmd;
    begin(0, 0);
    put_picture(VK_FORMAT_R32_UINT, 3, 2, texels, 4);
    REQUIRE(host_begin_frame(&f.gpu.device, &cmd, f.gpu.error, sizeof f.gpu.error));
    host_image_barrier(cmd, &picture, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, VK_IMAGE_LAYOUT_GENERAL,
                       VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, 0, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT,
                       VK_ACCESS_SHADER_READ_BIT);
    REQUIRE(host_submit(&f.gpu.device, f.gpu.error, sizeof f.gpu.error));
    f.materials.image.before.layout = VK_IMAGE_LAYOUT_GENERAL;
    put_corners(-1.3, -0.7, 0.2, 0.3);
    ground_fixture_step(&f, 0);
    assert_int_equal(check_all(texels, 3, 2), 2 * 100);
    assert_int_equal(material_at(-10, 0), 0);
    end();
}

static void test_a_map_is_looked_at_where_the_window_moves(void **state)
{
    (void)state;
    static const uint8_t grass = VIRGA_MATERIAL_GRASS;
    begin_with(0, 0, 256);
    ground_fixture_step(&f, 0);
    put_picture(VK_FORMAT_R8_UINT, 1, 1, &grass, 1);
    put_corners(-50, -50, 50, 50);
    ground_fixture_step(&f, 0);
    assert_int_equal(material_at(127, 0), MESH);
    f.camera[0] += 2.5 * VIRGA_GROUND_TILE * 0.05;
    ground_fixture_step(&f, 0);
    assert_int_equal(material_at(127, 0), MESH);
    assert_int_equal(material_at(128, 0), VIRGA_MATERIAL_GRASS); /* came in */
    end();
}

static void test_a_survey_looks_at_it_again_and_water_stays(void **state)
{
    (void)state;
    static const uint8_t before = VIRGA_MATERIAL_TILE, after = VIRGA_MATERIAL_CUSTOM + 3;
    begin(0, 0);
    put_picture(VK_FORMAT_R8_UINT, 1, 1, &before, 1);
    put_corners(-1, -1, 1, 1);
    f.settings.materials[before].bump_height_mm = 0;
    REQUIRE(virga_ground_set(f.ground, &f.settings) == VIRGA_OK);
    ground_fixture_step(&f, 0);
    ground_fixture_drop(&f, 3, 3, 0, 9000);
    ground_fixture_step(&f, 1);
    const uint64_t water = ground_fixture_sum(&f);
    assert_int_equal(water, 9000);
    put_picture(VK_FORMAT_R8_UINT, 1, 1, &after, 1);
    ground_fixture_step(&f, 0);
    assert_int_equal(material_at(3, 3), before);
    virga_ground_refresh_heights(f.ground);
    ground_fixture_step(&f, 0);
    assert_int_equal(material_at(3, 3), after);
    assert_int_equal(material_at(20, 3), MESH);
    f.materials.image.view = VK_NULL_HANDLE;
    virga_ground_refresh_heights(f.ground);
    ground_fixture_step(&f, 0);
    assert_int_equal(material_at(3, 3), MESH);
    assert_int_equal(ground_fixture_sum(&f), water);
    end();
}

/* On what is no ground there are no cells, whatever the map says. */
static void test_a_map_makes_no_ground(void **state)
{
    (void)state;
    static const uint8_t grass = VIRGA_MATERIAL_GRASS;
    static const float small[1][4][3] = {{{-1, 0, -1}, {1, 0, -1}, {1, 0, 1}, {-1, 0, 1}}};
    ground_fixture_open(&f);
    ground_fixture_quads(&f, small, NULL, 1);
    ground_fixture_ground(&f, NULL);
    put_picture(VK_FORMAT_R8_UINT, 1, 1, &grass, 1);
    put_corners(-50, -50, 50, 50);
    ground_fixture_step(&f, 0);
    assert_int_equal(material_at(0, 0), VIRGA_MATERIAL_GRASS);
    assert_int_equal(material_at(30, 0), 0xff);
    end();
}

static void test_a_map_without_a_place_is_none(void **state)
{
    (void)state;
    static const uint8_t grass = VIRGA_MATERIAL_GRASS;
    static const double corners[][4] = {{1, -1, -1, 1}, {-1, 1, 1, -1},         {-1, 0, 1, 0},
                                        {0, -1, 0, 1},  {0, 0, 1e-300, 1e-300}, {0, 0, 0, 0}};
    begin(0, 0);
    put_picture(VK_FORMAT_R8_UINT, 1, 1, &grass, 1);
    for (size_t i = 0; i < sizeof corners / sizeof corners[0]; i++) {
        put_corners(corners[i][0], corners[i][1], corners[i][2], corners[i][3]);
        virga_ground_refresh_heights(f.ground);
        ground_fixture_step(&f, 0);
        for (int cell = -64; cell < 64; cell++)
            if (material_at(cell, cell) != MESH || material_at(cell, 0) != MESH || material_at(0, cell) != MESH)
                fail_msg("corners %zu cover cell %d", i, cell);
    }
    end();
}

/* A step that is refused with one line, and does nothing. */
static void refuse(double *corner, double value, const char *name)
{
    VkCommandBuffer cmd;
    const double right = *corner;
    *corner = value;
    f.logged[0] = 0;
    REQUIRE(host_begin_frame(&f.gpu.device, &cmd, f.gpu.error, sizeof f.gpu.error));
    REQUIRE(virga_frame_begin(f.context, f.gpu.device.frame, f.gpu.device.completed) == VIRGA_OK);
    const virga_ground_step_info info = {.camera_m = {f.camera[0], f.camera[1], f.camera[2]},
                                         .meshes = f.meshes,
                                         .mesh_count = f.mesh_count,
                                         .materials = f.materials,
                                         .impacts = f.impacts.buffer};
    assert_int_equal(virga_ground_step(f.ground, cmd, &info), VIRGA_ERROR_INVALID);
    ground_fixture_submit(&f);
    if (!strstr(f.logged, name) || strchr(f.logged, '\n'))
        fail_msg("said '%s', expected a line with %s", f.logged, name);
    *corner = right;
}

static void test_corners_that_are_no_numbers_are_refused(void **state)
{
    (void)state;
    begin(0, 0);
    put_picture(VK_FORMAT_R8_UINT, 3, 2, bytes, 1);
    put_corners(-1.3, -0.7, 0.2, 0.3);
    for (int axis = 0; axis < 2; axis++) {
        refuse(&f.materials.low_m[axis], NAN, "materials.low_m");
        refuse(&f.materials.high_m[axis], NAN, "materials.high_m");
        refuse(&f.materials.low_m[axis], -INFINITY, "materials.low_m");
        refuse(&f.materials.high_m[axis], INFINITY, "materials.high_m");
    }
    ground_fixture_step(&f, 0);
    assert_int_equal(check_all(expected_materials, 3, 2), 5 * 100);
    end();
}

/* A host that goes by the header alone finds the cell that the test finds, far from the origin and left of it too. */
static void test_a_host_finds_cells_where_the_header_says(void **state)
{
    (void)state;
    begin(-80.2, 61.7);
    ground_fixture_step(&f, 0);
    virga_ground_cells cells;
    virga_ground_cells_get(f.ground, &cells);
    assert_int_equal(cells.tiles, 2);
    assert_int_equal(cells.size, 128 * 128 * sizeof(virga_cell_gpu));
    assert_int_equal(cells.nl_per_um, 2500); /* 5 cm x 5 cm x 1 um */
    assert_ptr_equal(cells.cells, f.ground->cells->buffer);
    assert_ptr_equal(cells.floors, f.ground->floors->buffer);
    const int x = cells.low_tile[0] * 64 + 70, z = cells.low_tile[1] * 64 + 5;
    assert_true(x < 0 && z > 0);
    const int tile_x = (int)floor(x / 64.0), tile_z = (int)floor(z / 64.0);
    const int column = ((tile_x % 2) + 2) % 2, row = ((tile_z % 2) + 2) % 2;
    assert_int_equal((row * 2 + column) * 4096 + (z - 64 * tile_z) * 64 + x - 64 * tile_x,
                     ground_fixture_index(&f, x, z));
    virga_ground_cells_get(NULL, &cells);
    assert_int_equal(cells.size, 0);
    end();
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_texels_lie_where_their_corners_say),
        cmocka_unit_test(test_far_from_the_origin_they_lie_as_exactly),
        cmocka_unit_test(test_a_wide_picture_is_as_exact),
        cmocka_unit_test(test_wide_integers_and_other_layouts_are_read),
        cmocka_unit_test(test_a_map_is_looked_at_where_the_window_moves),
        cmocka_unit_test(test_a_survey_looks_at_it_again_and_water_stays),
        cmocka_unit_test(test_a_map_makes_no_ground),
        cmocka_unit_test(test_a_map_without_a_place_is_none),
        cmocka_unit_test(test_corners_that_are_no_numbers_are_refused),
        cmocka_unit_test(test_a_host_finds_cells_where_the_header_says),
    };
    return effect_fixture_close(cmocka_run_group_tests(tests, NULL, NULL));
}
