/* test_texels.c - bytes of a texel, without a device, for the formats of all images that effects have. Estimates of
 * memory and saved states are made of them. */
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>

#include <cmocka.h>

#include "fluid/fluid.h"
#include "glass/glass.h"
#include "gpu/effect.h"
#include "ground/ground.h"
#include "lens/lens.h"
#include "rain/rain.h"
#include "splash/splash.h"
#include "water/water.h"

/* Bits of all channels, as in the format's name. 0: a format that no effect had. */
static uint32_t bits_of(VkFormat format)
{
    switch ((int)format) {
    case VK_FORMAT_R8_UINT:
    case VK_FORMAT_R8_UNORM: return 8;
    case VK_FORMAT_R32_UINT:
    case VK_FORMAT_R32_SFLOAT:
    case VK_FORMAT_R8G8B8A8_UNORM:
    case VK_FORMAT_D32_SFLOAT: return 32;
    case VK_FORMAT_R16G16B16A16_SFLOAT: return 4 * 16;
    case VK_FORMAT_R32G32B32A32_UINT:
    case VK_FORMAT_R32G32B32A32_SFLOAT: return 4 * 32;
    default: return 0;
    }
}

static void texels_of_all_images_have_their_bytes(void **state)
{
    static const virga_effect_type *const types[] = {&rain_type,  &ground_type, &splash_type, &glass_type,
                                                     &water_type, &fluid_type,  &lens_type};
    (void)state;
    for (size_t i = 0; i < sizeof types / sizeof *types; i++)
        for (uint32_t k = 0; k < types[i]->image_count; k++) {
            const virga_effect_image *image = &types[i]->images[k];
            if (8 * virga_texel_bytes(image->format) != bits_of(image->format))
                fail_msg("%s: format %d has %u bits here", image->name, image->format, bits_of(image->format));
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(texels_of_all_images_have_their_bytes)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
