/* droplet_list.h - level ground of 128 x 128 cells with water, and the list of droplets that contacts hand over. The
 * test that includes it has one ground at a time. */
#ifndef TESTS_GROUND_DROPLET_LIST_H
#define TESTS_GROUND_DROPLET_LIST_H

#include "ground_fixture.h"

enum { SIDE = 128, CELLS = SIDE * SIDE, MAX_LISTED = 8192 };

#define CELL_M 0.05
#define FILM   50.0   /* um that stay */
#define NL_UM  2500.0 /* nl of a cell that are 1 um deep */

static ground_fixture f;
static host_buffer list;

static virga_handed_droplets_gpu *head(void)
{
    return list.mapped;
}

static const virga_handed_droplet_gpu *droplets(void)
{
    return (const virga_handed_droplet_gpu *)(head() + 1);
}

static void empty_list(uint32_t capacity)
{
    *head() = (virga_handed_droplets_gpu){.capacity = capacity, .group_count = {0, 1, 1}};
}

/* `flow_ticks` 60: nothing flows in the first 15 ticks. */
static void open_level_ground(uint32_t flow_ticks, uint32_t max_spawns)
{
    virga_ground_def def = virga_default_ground_def();
    def.cells = SIDE;
    def.far_cells = 0;
    def.cached_tiles = 0;
    def.max_impacts = MAX_DROPS;
    def.max_spawns = max_spawns;
    def.flow_ticks = flow_ticks;
    ground_fixture_open(&f);
    ground_fixture_floor(&f, VIRGA_MATERIAL_CUSTOM);
    ground_fixture_ground(&f, &def);
    REQUIRE(host_buffer_create(&f.gpu.device, sizeof *head() + MAX_LISTED * sizeof *droplets(),
                               VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, HOST_BUFFER_UPLOAD, "list", &list, f.gpu.error,
                               sizeof f.gpu.error));
    f.handed = list.buffer;
    empty_list(MAX_LISTED);
}

static void close_level_ground(void)
{
    virga_ground_destroy(&f.ground);
    virga_context_destroy(&f.context);
    host_buffer *const buffers[] = {&f.vertices, &f.indices, &f.impacts, &f.upload, &f.download, &list};
    assert_int_equal(effect_fixture_end(&f.gpu, buffers, 6), 0);
}

#endif
