/* host_small_views.c - a device whose texel buffers hold less than the pools of a scene: nothing is made smaller, and
 * states, picture, motion vectors and reactive mask are those of a device where they hold all of it, bit for bit. */
#include "offline.h"

#include "../gpu/watch.h"

/* Fewer than Vulkan promises, so that all pools of a small street have more: 16384 drops and as many streaks of five
 * texels, 4096 splashes and 16384 droplets of four, 65536 cells of half a texel. */
enum { FEW_TEXELS = 4096 };

static void lie_few_texels(VkPhysicalDeviceProperties *properties)
{
    properties->limits.maxTexelBufferElements = FEW_TEXELS;
}

typedef struct seen {
    world_bits bits;
    float picture[WORLD_PIXELS * 3], motion[WORLD_PIXELS * 2], reactive[WORLD_PIXELS];
} seen;

/* Everything that can be seen of the last frame. A pool that is made smaller makes creating the scene VIRGA_DEGRADED,
 * which fails. */
static void look(void (*lie)(VkPhysicalDeviceProperties *), seen *s)
{
    static const float center[1][2] = {{0, 0}};
    static offline o;
    memset(&watch, 0, sizeof watch);
    watch.lie_properties = lie;
    offline_open_through(&o, 1, watch_get_instance_proc_addr);
    offline_add_moving(&o);
    offline_run(&o, &s->bits);
    offline_draw(&o, center, 1, s->picture);
    picture_read(&o.f.device, &o.moving);
    memcpy(s->motion, o.moving.motion, sizeof s->motion);
    memcpy(s->reactive, o.moving.reactive, sizeof s->reactive);
    offline_close(&o);
    assert_int_equal(watch_sum(watch.live), 0);
}

static void small_views_show_the_same(void **state)
{
    static seen whole, small;
    (void)state;
    look(NULL, &whole);
    look(lie_few_texels, &small);
    printf("%u impacts, %u droplets, %u drops on the pane\n", small.bits.impacts, small.bits.droplets,
           small.bits.pane_drops);
    assert_true(bits_equal(&whole.bits, &small.bits));
    assert_memory_equal(whole.picture, small.picture, sizeof whole.picture);
    assert_memory_equal(whole.motion, small.motion, sizeof whole.motion);
    assert_memory_equal(whole.reactive, small.reactive, sizeof whole.reactive);
    bits_free(&whole.bits);
    bits_free(&small.bits);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(small_views_show_the_same)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
