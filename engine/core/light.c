/* core/light.c - see light.h. */
#include "core/light.h"
#include "core/settings.h"

#include <stdio.h>

virga_lighting virga_default_lighting(void)
{
    virga_lighting lighting = {.light_count = 0};
    /* Grey sky 0.5 and ground 0.1: mean 0.3, and a gradient in y, which is the first spherical-harmonics band of a step
     * of height 0.4. Its coefficient is 0.4 pi / 2 x 0.488603 x 2. */
    for (int c = 0; c < 3; c++) {
        lighting.environment_sh[0][c] = 0.3f / 0.282095f;
        lighting.environment_sh[1][c] = 0.614f;
    }
    return lighting;
}

typedef struct field_name {
    char text[96];
} field_name;

static field_name name_field(const char *owner, const char *field)
{
    field_name name;
    snprintf(name.text, sizeof name.text, "%s.lighting.%s", owner, field);
    return name;
}

/* Settings may be set every frame, so the name is formatted only if it is logged. */
static virga_result check_floats(const virga_log *log, const char *owner, const char *field, const float *values,
                                 uint32_t count)
{
    if (!virga_settings_check_finite(NULL, field, values, count))
        return VIRGA_OK;
    return virga_settings_check_finite(log, name_field(owner, field).text, values, count);
}

static virga_result check_light(const virga_log *log, const char *owner, const virga_light *light)
{
    if (virga_settings_check_positions(NULL, "position_m", light->position_m, 3))
        return virga_settings_check_positions(log, name_field(owner, "lights.position_m").text, light->position_m, 3);
    if (check_floats(log, owner, "lights.intensity", light->intensity, 3) ||
        check_floats(log, owner, "lights.direction", light->direction, 3) ||
        check_floats(log, owner, "lights.range_m", &light->range_m, 1) ||
        check_floats(log, owner, "lights.cos_inner", &light->cos_inner, 1) ||
        check_floats(log, owner, "lights.cos_outer", &light->cos_outer, 1))
        return VIRGA_ERROR_INVALID;
    return VIRGA_OK;
}

virga_result virga_lighting_check(const virga_log *log, const char *owner, virga_lighting *lighting, bool *changed)
{
    if (check_floats(log, owner, "environment_sh", &lighting->environment_sh[0][0], 27))
        return VIRGA_ERROR_INVALID;
    for (uint32_t i = 0; i < lighting->light_count && i < VIRGA_MAX_LIGHTS; i++)
        if (check_light(log, owner, &lighting->lights[i]))
            return VIRGA_ERROR_INVALID;
    lighting->light_count = virga_clamp_setting_u32(log, name_field(owner, "light_count").text, lighting->light_count,
                                                    0, VIRGA_MAX_LIGHTS, changed);
    return VIRGA_OK;
}
