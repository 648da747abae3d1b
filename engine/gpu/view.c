/* gpu/view.c - see view.h. */
#include "gpu/view.h"

#include "core/phase.h"
#include "core/settings.h"
#include "gpu/context.h"
#include "gpu/errors.h"

#include <math.h>
#include <string.h>

#include <virga/drops.h>

/* Limits of the first two diagonal elements of a projection. These are the cotangents of half the field of view, which
 * is between a tenth of a microradian and 179.99 degrees. Larger elements are useless, and their products exceed the
 * range of floats. */
#define MIN_PROJECTION 1e-4f
#define MAX_PROJECTION 1e7f
#define MAX_TIME_S     1e9
#define MAX_SUB_FRAMES 65536
#define MAX_JITTER_PX  16

virga_view virga_default_view(void)
{
    static const float identity[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    virga_view view = {
        .size = sizeof view, .cookie = virga_settings_cookie("view"), .shutter_s = 1.0 / 96, .sub_frames = 1};
    view.temporal = (virga_temporal){.motion_scale = {1, 1}, .motion_coverage = 0.5f, .reactive_gain = 8};
    memcpy(view.view_from_world, identity, sizeof identity);
    memcpy(view.clip_from_view, identity, sizeof identity);
    memcpy(view.open_view_from_world, identity, sizeof identity);
    memcpy(view.open_clip_from_view, identity, sizeof identity);
    return view;
}

/* Checks that a projection is finite, has w = -z and a sensible field of view, so that rays can be computed from it. */
static virga_result check_projection(const virga_log *log, const char *name, const float p[16])
{
    bool sound = p[11] == -1;
    for (int i = 0; i < 16; i++)
        sound = sound && fabsf(p[i]) <= MAX_PROJECTION;
    if (!sound || !(fabsf(p[0]) >= MIN_PROJECTION) || !(fabsf(p[5]) >= MIN_PROJECTION))
        return virga_wrong_argument(log, "%s: expected a perspective projection with w = -z", name);
    return VIRGA_OK;
}

static virga_result check_camera(const virga_log *log, const virga_view *view)
{
    if (virga_settings_check_positions(log, "view.position_m", view->position_m, 3) ||
        virga_settings_check_positions(log, "view.open_position_m", view->open_position_m, 3) ||
        virga_settings_check_rotation(log, "view.view_from_world", view->view_from_world, 4) ||
        virga_settings_check_rotation(log, "view.open_view_from_world", view->open_view_from_world, 4) ||
        check_projection(log, "view.clip_from_view", view->clip_from_view) ||
        check_projection(log, "view.open_clip_from_view", view->open_clip_from_view))
        return VIRGA_ERROR_INVALID;
    /* depth = -p10 + p14 / distance: it rises with the distance where p14 < 0. */
    const float slope = view->clip_from_view[14];
    if (slope != 0 && view->reversed_depth != (slope > 0))
        return virga_wrong_argument(log, "view.reversed_depth: is %s, and by clip_from_view what is nearer is %s",
                                    view->reversed_depth ? "true" : "false", slope > 0 ? "greater" : "less");
    return VIRGA_OK;
}

/* Formats of integers, whose samples are not floats. */
static bool is_integer(VkFormat format)
{
    switch (format) {
    case VK_FORMAT_R8_UINT:
    case VK_FORMAT_R8_SINT:
    case VK_FORMAT_R8G8B8A8_UINT:
    case VK_FORMAT_R8G8B8A8_SINT:
    case VK_FORMAT_R16_UINT:
    case VK_FORMAT_R16_SINT:
    case VK_FORMAT_R16G16_UINT:
    case VK_FORMAT_R16G16_SINT:
    case VK_FORMAT_R16G16B16A16_UINT:
    case VK_FORMAT_R16G16B16A16_SINT:
    case VK_FORMAT_R32_UINT:
    case VK_FORMAT_R32_SINT:
    case VK_FORMAT_R32G32_UINT:
    case VK_FORMAT_R32G32_SINT:
    case VK_FORMAT_R32G32B32A32_UINT:
    case VK_FORMAT_R32G32B32A32_SINT:
    case VK_FORMAT_S8_UINT: return true;
    default: return false;
    }
}

virga_result virga_image_check(const virga_log *log, const char *name, const virga_image *image)
{
    if (!image->image != !image->view)
        return virga_wrong_argument(log, "%s: expected an image and its view or neither, got no %s", name,
                                    image->view ? "image" : "view");
    if (image->view && image->before.layout == VK_IMAGE_LAYOUT_UNDEFINED)
        return virga_wrong_argument(log, "%s.before.layout: expected the layout while drawing, got UNDEFINED", name);
    if (image->view && is_integer(image->format))
        return virga_wrong_argument(log, "%s.format: expected one that is sampled as floats, got VkFormat %d", name,
                                    (int)image->format);
    return VIRGA_OK;
}

static bool is_srgb_format(VkFormat format)
{
    switch (format) {
    case VK_FORMAT_R8_SRGB:
    case VK_FORMAT_R8G8_SRGB:
    case VK_FORMAT_R8G8B8_SRGB:
    case VK_FORMAT_B8G8R8_SRGB:
    case VK_FORMAT_R8G8B8A8_SRGB:
    case VK_FORMAT_B8G8R8A8_SRGB:
    case VK_FORMAT_A8B8G8R8_SRGB_PACK32: return true;
    default: return false;
    }
}

virga_result virga_encoding_check(const virga_log *log, const char *name, virga_encoding encoding, VkFormat format)
{
    if ((uint32_t)encoding > VIRGA_ENCODING_SRGB)
        return virga_wrong_argument(log, "%s: there is no encoding %d", name, (int)encoding);
    if (encoding == VIRGA_ENCODING_SRGB && is_srgb_format(format))
        return virga_wrong_argument(log, "%s: expected linear, as the device converts the _SRGB VkFormat %d itself",
                                    name, (int)format);
    return VIRGA_OK;
}

static virga_result check_images(const virga_log *log, const virga_view *view)
{
    if (virga_encoding_check(log, "view.color_encoding", view->color_encoding, view->color.format))
        return VIRGA_ERROR_INVALID;
    if (virga_image_check(log, "view.depth", &view->depth) || virga_image_check(log, "view.color", &view->color) ||
        virga_image_check(log, "view.temporal.motion", &view->temporal.motion))
        return VIRGA_ERROR_INVALID;
    return VIRGA_OK;
}

static virga_result check_temporal(const virga_log *log, const virga_temporal *temporal)
{
    const float *scale = temporal->motion_scale;
    bool given = false; /* all zero: use the open camera */
    for (int i = 0; i < 16; i++)
        given = given || temporal->clip_from_view[i] != 0; /* also true for NaN */
    if (given && (virga_settings_check_positions(log, "view.temporal.position_m", temporal->position_m, 3) ||
                  virga_settings_check_rotation(log, "view.temporal.view_from_world", temporal->view_from_world, 4) ||
                  check_projection(log, "view.temporal.clip_from_view", temporal->clip_from_view)))
        return VIRGA_ERROR_INVALID;
    if (virga_settings_check_finite_double(log, "view.temporal.position_m", temporal->position_m, 3) ||
        virga_settings_check_finite(log, "view.temporal.view_from_world", temporal->view_from_world, 16) ||
        virga_settings_check_finite(log, "view.temporal.motion_scale", scale, 2))
        return VIRGA_ERROR_INVALID;
    if (!(temporal->frame_interval_s >= 0 && temporal->frame_interval_s <= 1))
        return virga_wrong_argument(log, "view.temporal.frame_interval_s: expected 0 to 1 s, got %g",
                                    temporal->frame_interval_s);
    if (scale[0] == 0 || scale[1] == 0)
        return virga_wrong_argument(log, "view.temporal.motion_scale: expected other numbers than 0");
    if (!(temporal->motion_coverage > 0 && temporal->motion_coverage <= 1))
        return virga_wrong_argument(log, "view.temporal.motion_coverage: expected above 0 to 1, got %g",
                                    (double)temporal->motion_coverage);
    if (!(temporal->reactive_gain >= 0 && temporal->reactive_gain <= 64))
        return virga_wrong_argument(log, "view.temporal.reactive_gain: expected 0 to 64, got %g",
                                    (double)temporal->reactive_gain);
    return VIRGA_OK;
}

/* Checks a viewport against Vulkan's limits on this device. */
static virga_result check_viewport(const virga_context *context, const float box[4])
{
    const VkPhysicalDeviceLimits *limits = &context->properties.limits;
    const virga_log *log = &context->log;
    if (virga_settings_check_finite(log, "view.viewport", box, 4))
        return VIRGA_ERROR_INVALID;
    for (int axis = 0; axis < 2; axis++)
        if (box[axis] < limits->viewportBoundsRange[0] ||
            (double)box[axis] + (double)box[2 + axis] > (double)limits->viewportBoundsRange[1] ||
            box[2 + axis] > (float)limits->maxViewportDimensions[axis])
            return virga_wrong_argument(log,
                                        "view.viewport: %g x %g pixels at (%g, %g) are more than the device allows",
                                        (double)box[2], (double)box[3], (double)box[0], (double)box[1]);
    if (box[2] >= 1 && box[3] >= 1)
        return VIRGA_OK;
    virga_log_write(log, VIRGA_LOG_WARNING, VIRGA_LOG_ARGUMENT,
                    "view.viewport: %g x %g pixels, there is nothing to draw%s", (double)box[2], (double)box[3],
                    box[3] < 0 ? "; for a picture upside down negate clip_from_view[5]" : "");
    return VIRGA_NOT_READY;
}

virga_result virga_view_check(const virga_context *context, const virga_view *view, double time_s)
{
    const virga_log *log = &context->log;
    const virga_result result = virga_settings_check(log, "view", view->size, sizeof *view, view->cookie);
    if (result)
        return result;
    if (check_camera(log, view) || check_images(log, view))
        return VIRGA_ERROR_INVALID;
    if (!(view->shutter_s >= 0 && view->shutter_s <= 1))
        return virga_wrong_argument(log, "view.shutter_s: expected 0 to 1 s, got %g", view->shutter_s);
    if (!view->sub_frames || view->sub_frames > MAX_SUB_FRAMES)
        return virga_wrong_argument(log, "view.sub_frames: expected 1 to %d, got %u", MAX_SUB_FRAMES, view->sub_frames);
    for (int axis = 0; axis < 2; axis++)
        if (!(fabsf(view->jitter_px[axis]) <= MAX_JITTER_PX))
            return virga_wrong_argument(log, "view.jitter_px: expected -%d to %d pixels, got %g", MAX_JITTER_PX,
                                        MAX_JITTER_PX, (double)view->jitter_px[axis]);
    if (view->multiview_index >= 32)
        return virga_wrong_argument(log, "view.multiview_index: expected 0 to 31, got %u", view->multiview_index);
    if (!(view->aperture_m >= 0 && view->aperture_m <= 1))
        return virga_wrong_argument(log, "view.aperture_m: expected 0 to 1 m, got %g", (double)view->aperture_m);
    if (!(view->focus_m >= 0 && view->focus_m <= 1e6f))
        return virga_wrong_argument(log, "view.focus_m: expected 0 to 1e6 m, got %g", (double)view->focus_m);
    if (!(view->open_camera_s >= 0 && view->open_camera_s <= MAX_TIME_S))
        return virga_wrong_argument(log, "view.open_camera_s: expected 0 to %g s, got %g", MAX_TIME_S,
                                    view->open_camera_s);
    if (!(fabs(time_s) <= MAX_TIME_S))
        return virga_wrong_argument(log, "time_s: expected a time within %g s, got %g", MAX_TIME_S, time_s);
    const virga_result temporal = check_temporal(log, &view->temporal);
    return temporal ? temporal : check_viewport(context, view->viewport);
}

/* out = projection x rotation x translation(offset), column-major. */
static void clip_from_relative(const float clip_from_view[16], const float view_from_world[16], const double offset[3],
                               float out[16])
{
    double view[16] = {0};
    for (int column = 0; column < 3; column++)
        for (int row = 0; row < 3; row++)
            view[column * 4 + row] = (double)view_from_world[column * 4 + row];
    for (int row = 0; row < 3; row++)
        view[12 + row] = view[row] * offset[0] + view[4 + row] * offset[1] + view[8 + row] * offset[2];
    view[15] = 1;
    for (int column = 0; column < 4; column++)
        for (int row = 0; row < 4; row++) {
            double sum = 0;
            for (int i = 0; i < 4; i++)
                sum += (double)clip_from_view[i * 4 + row] * view[column * 4 + i];
            out[column * 4 + row] = (float)sum;
        }
}

/* Fills the axes of the camera in the world, scaled to rays: a pixel at ndc (x, y) has the direction right x + up y +
 * ahead. With a projection clip.x = a x + c z, clip.w = -z this means x = (ndc + c) / a at depth 1, including jitter
 * and shift. */
static void fill_rays(const virga_view *view, virga_view_gpu *out)
{
    const float *m = view->view_from_world, *p = view->clip_from_view;
    for (int i = 0; i < 3; i++) {
        const float x = m[i * 4], y = m[i * 4 + 1], z = -m[i * 4 + 2]; /* rows of the rotation */
        out->right[i] = x / p[0];
        out->up[i] = y / p[5];
        out->ahead[i] = z + x * p[8] / p[0] + y * p[9] / p[5];
    }
    /* clip.z = p10 z + p14 and clip.w = -z, so depth = -p10 + p14 / w. */
    out->depth_a = p[10];
    out->depth_b = p[14];
    out->pixel_angle = 2 / (fabsf(p[5]) * view->viewport[3]);
}

static void fill_lights(const virga_lighting *lighting, const double camera[3], virga_view_gpu *out)
{
    out->light_count = lighting->light_count;
    for (uint32_t i = 0; i < out->light_count; i++) {
        const virga_light *light = &lighting->lights[i];
        virga_light_gpu *to = &out->lights[i];
        const float *d = light->direction;
        const float length = sqrtf(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
        for (int axis = 0; axis < 3; axis++) {
            to->position[axis] = (float)(light->position_m[axis] - camera[axis]);
            to->intensity[axis] = light->intensity[axis];
            to->direction[axis] = length > 0 ? d[axis] / length : 0;
        }
        to->inv_range = light->range_m > 0 ? 1 / light->range_m : 0;
        const float width = light->cos_inner - light->cos_outer;
        /* A point light has no cone: every cosine passes. */
        to->cos_outer = length > 0 ? light->cos_outer : -2;
        to->inv_cos_width = length > 0 && width > 1e-4f ? 1 / width : 1e4f;
    }
}

/* Fills the environment and the phase function of drops: the same for all effects. */
static void fill_environment(const virga_lighting *lighting, virga_view_gpu *out)
{
    _Static_assert(sizeof out->phase / sizeof out->phase[0] == VIRGA_PHASE_BINS, "bins of the phase function");
    for (int i = 0; i < 9; i++)
        for (int c = 0; c < 3; c++)
            out->sh[i * 3 + c] = lighting->environment_sh[i][c];
    double moments[3];
    virga_drop_phase_moments(moments);
    for (int i = 0; i < 3; i++)
        out->phase_moment[i] = (float)moments[i];
    for (int i = 0; i < VIRGA_PHASE_BINS; i++)
        out->phase[i] = (float)virga_phase_table[i];
}

/* Fills the transforms of positions relative to the camera to clip coordinates, at both ends of the shutter. */
static void fill_matrices(const virga_view *view, virga_view_gpu *out)
{
    const double none[3] = {0, 0, 0};
    clip_from_relative(view->clip_from_view, view->view_from_world, none, out->clip_from_rel);
    /* The open camera may be at a different time than the opening of the shutter: use the part of its motion within the
     * shutter. */
    const double share = view->open_camera_s > 0 ? view->shutter_s / view->open_camera_s : view->shutter_s > 0 ? 1 : 0;
    double moved[3];
    for (int i = 0; i < 3; i++)
        moved[i] = (view->position_m[i] - view->open_position_m[i]);
    float open[16];
    clip_from_relative(view->open_clip_from_view, view->open_view_from_world, moved, open);
    for (int i = 0; i < 16; i++)
        out->open_clip_from_rel[i] = out->clip_from_rel[i] + (float)share * (open[i] - out->clip_from_rel[i]);
}

uint32_t virga_view_color_given(const virga_view *view)
{
    if (!view->color.view)
        return 0;
    return view->color_encoding == VIRGA_ENCODING_SRGB ? VIRGA_COLOR_SRGB : VIRGA_COLOR_LINEAR;
}

bool virga_view_has_previous(const virga_view *view)
{
    for (int i = 0; i < 16; i++)
        if (view->temporal.clip_from_view[i] != 0)
            return true;
    return false;
}

void virga_view_previous(const virga_view *view, double position_m[3], float clip_from_rel[16])
{
    const double none[3] = {0, 0, 0};
    const bool given = virga_view_has_previous(view);
    memcpy(position_m, given ? view->temporal.position_m : view->open_position_m, sizeof none);
    clip_from_relative(given ? view->temporal.clip_from_view : view->open_clip_from_view,
                       given ? view->temporal.view_from_world : view->open_view_from_world, none, clip_from_rel);
}

/* Fills the camera of the previous frame, and its time. */
static void fill_temporal(const virga_view *view, virga_view_gpu *out)
{
    const virga_temporal *temporal = &view->temporal;
    const bool given = virga_view_has_previous(view);
    const double *position = given ? temporal->position_m : view->open_position_m;
    const double open_s = view->open_camera_s > 0 ? view->open_camera_s : view->shutter_s;
    double moved[3];
    for (int i = 0; i < 3; i++)
        moved[i] = view->position_m[i] - position[i];
    clip_from_relative(given ? temporal->clip_from_view : view->open_clip_from_view,
                       given ? temporal->view_from_world : view->open_view_from_world, moved,
                       out->previous_clip_from_rel);
    out->frame_interval_s = (float)(temporal->frame_interval_s > 0 ? temporal->frame_interval_s : open_s);
    memcpy(out->motion_scale, temporal->motion_scale, sizeof out->motion_scale);
    out->motion_coverage = temporal->motion_coverage;
    out->reactive_gain = temporal->reactive_gain;
    out->motion_given = temporal->motion.view != VK_NULL_HANDLE;
}

void virga_view_fill(const virga_view *view, const virga_lighting *lighting, const double origin_m[3], double state_s,
                     double time_s, virga_view_gpu *out)
{
    memset(out, 0, sizeof *out);
    out->light_gain = 1;
    out->min_width_px = 1;
    fill_matrices(view, out);
    fill_temporal(view, out);
    fill_rays(view, out);
    out->lens_px = view->aperture_m / out->pixel_angle;
    out->inv_focus = view->focus_m > 0 ? 1 / view->focus_m : 0;
    for (int i = 0; i < 3; i++)
        out->origin_offset[i] = (float)(origin_m[i] - view->position_m[i]);
    out->time_close_s = (float)(time_s - state_s);
    out->time_open_s = (float)(time_s - state_s - view->shutter_s);
    memcpy(out->viewport, view->viewport, sizeof out->viewport);
    out->far_depth = view->reversed_depth ? 0.0f : 1.0f;
    out->depth_given = view->depth.view != VK_NULL_HANDLE;
    out->color_given = virga_view_color_given(view);
    out->multiview_index = view->multiview_index;
    for (int axis = 0; axis < 2; axis++)
        out->jitter[axis] = 2 * view->jitter_px[axis] / view->viewport[2 + axis];
    fill_lights(lighting, view->position_m, out);
    fill_environment(lighting, out);
}
