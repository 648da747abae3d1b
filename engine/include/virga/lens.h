/* virga/lens.h - focus: blurs a picture by depth as a lens does, with discs for lamps, or as a paper proposed.
 *
 * Two styles:
 *  - Physical: a thin lens. The circle of confusion follows from focal length, aperture and focus. What is in front of
 *    the focus blurs over the rest, what is behind it does not bleed over what is in front. A point of light becomes an
 *    image of the aperture that has as much light.
 *  - Paper: Sato, Dobashi and Yamamoto 2002, "A method for real-time rendering of water droplets taking into account
 *    interactive depth of field effects", section 3.5: two filters of 3 x 3 pixels, and two thresholds.
 *
 * Water can be given as layers over the scene, e.g. one of rain and one of the drops on a pane. Each is blurred by its
 * own depth and put over what is behind it.
 *
 * A frame, after the host has drawn scene and layers, outside rendering:
 *
 *     virga_lens_prepare(lens, cmd, &view, layers, layer_count, time_s);
 *
 * and inside rendering virga_lens_draw, which replaces the target's color. A host with passes of its own reads the
 * picture of virga_lens_picture instead. A host with a blur of its own asks for circles of confusion only
 * (virga_lens_def.circles).
 *
 * A virga_scene has no lens. A scene records before the host draws, and draws in the host's pass. A lens works on the
 * finished picture, among the host's own filters, and only the host knows whether that is before or after its
 * anti-aliasing and what it keeps in layers. They meet in the view, see virga_lens_fill_view.
 *
 * Deterministic: the same pictures, settings and times give the same bits.
 * Thread-safety: as virga/vulkan.h says. */
#ifndef VIRGA_LENS_H
#define VIRGA_LENS_H

#include <virga/vulkan.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct virga_lens virga_lens; /* opaque */

#define VIRGA_LENS_MAX_LAYERS 5 /* layers over the scene */

typedef struct virga_lens_def {
    uint32_t size, cookie;

    /* [16; 16384] largest viewport in pixels. Memory: 132 bytes per pixel, or 39 at half resolution. Default 1920 and
     * 1080. */
    uint32_t max_width, max_height;

    /* 0 or 1. 1: blurs a picture of half the width and height, for games. What is in focus stays as sharp as it is.
     * The cost falls to about a tenth for the same blur. Default 0. */
    uint32_t half_resolution;

    /* [1; VIRGA_MAX_VIEWS] views that live in a frame at the same time, see virga_prepared. Each follows its own focus
     * if the views of a frame are prepared in the same order. Each further one costs 64 bytes per pixel, or 22 at
     * half resolution. Default 1. */
    uint32_t max_views;

    /* 0 or 1. 1: for a host that blurs by itself. Prepares write circles of confusion (virga_lens_circles) instead of a
     * picture, so there is nothing to draw, and half_resolution, blades and cat's eye do nothing. Memory: 24 bytes per
     * pixel and view, and none for a picture. Cost: one read and one write per pixel of the scene and of each layer.
     * Default 0. */
    uint32_t circles;

    /* 0 or 1; needs half_resolution, and no circles. 1: for a host whose target already holds the scene. Draws blend
     * over it what is out of focus, and layers, see virga_lens_draw, in place of writing all of a picture. So the cost
     * follows what is out of focus. There is no picture (virga_lens_picture), no part (virga_lens_draw_part) and no
     * style of the paper. Memory: 1.5 bytes per pixel and view less. Default 0. */
    uint32_t in_place;
} virga_lens_def;

VIRGA_API virga_lens_def virga_default_lens_def(void);

typedef enum virga_lens_style {
    VIRGA_LENS_STYLE_PAPER = 0,
    VIRGA_LENS_STYLE_PHYSICAL = 1,
} virga_lens_style;

typedef struct virga_lens_settings {
    uint32_t size, cookie;

    /* Default physical. */
    virga_lens_style style;

    /* [0.001; 10] focal length (m). Default 0.05. */
    float focal_m;

    /* [0; 128] f-number: the aperture's diameter is focal_m / aperture_f. 0: a pinhole, everything is sharp. Default
     * 2.8. */
    float aperture_f;

    /* [0; 1e6] view depth that is sharp (m). 0: infinity. Default 10. */
    float focus_m;

    /* 0 or 1. 1: focuses on what is at focus_point, by the view's depth, and ignores focus_m. Default 0. */
    uint32_t follow;

    /* [0; 1] the focus point as a share of the viewport, right and down. Default 0.5, 0.5: the paper's reference point
     * in the centre. */
    float focus_point[2];

    /* [0; 60] time constant (s) with which the focus follows: after this time 63 % of the way is done, in 1/m. Default
     * 0.25. */
    float focus_time_s;

    /* [0; 16] blades of the aperture; below 3: a round aperture. Default 0. */
    uint32_t blades;

    /* [0; 1] how round the blades are: 0 is straight, 1 a circle. Default 0. */
    float blade_roundness;

    /* [-360; 360] rotation of the blades (degrees). Default 0. */
    float blade_rotation_deg;

    /* [0; 1] cat's eye: how far the barrel of the lens cuts discs in the picture's corners. 0: not at all. The picture
     * does not get darker there: as in a camera that corrects vignetting, the light at each pixel is divided by the
     * share of the aperture that is open there. So a disc has the light that passes the barrel, relative to what is in
     * focus beside it: more in front of the focus and less behind it, by about cats_eye times the disc's radius over
     * half the picture's diagonal (1.4 % for 0.35 and 30 px at 1280 x 720), as barrels do. Default 0. */
    float cats_eye;

    /* [1; 126] largest radius of a circle of confusion (px); larger ones are cut to it. At full resolution at most 63.
     * The cost grows as the square of a circle up to 8 texels of the work image (px, or 2 px at half resolution); wider
     * ones come from blocks of texels and cost about the same at any size. In place on GPUs, and without a layer on
     * the scene, up to 32 one pass does the scene, and one each layer that is out of focus; they take a fifth of the
     * time of those for wider discs, or less. Above 16 a layer with depths takes two, and each layer with `follow`. So
     * say no more than is seen. Default 32. */
    float max_radius_px;

    /* (paper) [0; 1e6] difference to the depth at focus (m) from which on the weaker filter is used, and the stronger
     * one. The second is raised to the first. Default 5 and 20. */
    float threshold_m[2];

    /* (paper) [0; 100] weight of the pixel itself in the two filters; its neighbours have 1. Default 1 and 5, as in the
     * paper. */
    float filter_weight[2];
} virga_lens_settings;

VIRGA_API virga_lens_settings virga_default_lens_settings(void);

/* Allocates, and builds pipelines when virga_context_def.pipeline_build_mode says so. Errors as virga_context_create;
 * *lens is NULL then. */
VIRGA_API virga_result virga_lens_create(virga_context *context, const virga_lens_def *def, virga_lens **lens);

/* Destroys it and sets *lens to NULL. Accepts NULL. Frames in flight may still use it: its resources are freed when
 * they have completed. */
VIRGA_API void virga_lens_destroy(virga_lens **lens);

/* Returns VIRGA_OK if its pipelines for preparing are built, VIRGA_NOT_READY if some are missing, or the error of one
 * that could not be built. See virga_pipelines_build. Costs nothing. */
VIRGA_API virga_result virga_lens_ready(const virga_lens *lens);

/* Applies new settings from the next prepare on. Out of range: clamped, logged, VIRGA_DEGRADED. NaN, infinity or a
 * wrong cookie: VIRGA_ERROR_INVALID, and nothing changes. New blades cost about 7 ms on the CPU; all else costs
 * nothing, e.g. another focus in every frame. The first VIRGA_LENS_STYLE_PAPER needs 12 pipelines. They are built as
 * virga_context_def.pipeline_build_mode says, and there is no picture until they are there. */
VIRGA_API virga_result virga_lens_set(virga_lens *lens, const virga_lens_settings *settings);

/* Reads the current settings. */
VIRGA_API void virga_lens_get(const virga_lens *lens, virga_lens_settings *settings);

/* Returns the device memory in bytes that virga_lens_create will allocate at most, with eight frames in flight. */
VIRGA_API VkDeviceSize virga_lens_estimate(const virga_lens_def *def);

/* A layer over the scene. */
typedef struct virga_lens_layer {
    /* Required, but not with def.circles. Premultiplied linear radiance and coverage, in the target's pixels, also
     * where view.color is encoded. `before` as in virga_view.color. */
    virga_image color;

    /* (optional) Depth of each pixel, as a value of the view's depth buffer, in the target's pixels. */
    virga_image depth;

    /* [0.001; 1e6] view depth of the whole layer (m), if it has no depth image. */
    float depth_m;

    /* 0 or 1. 1: the layer lies on the scene, as haze does, and is blurred as the scene's own color; it needs no depth.
     * One layer at most. */
    uint32_t on_scene;
} virga_lens_layer;

/* Blurs view->color by view->depth, and puts the layers over it, the first one first. Outside rendering, once per
 * frame, or up to VIRGA_MAX_VIEWS times for as many views. Without view->depth the scene is in focus everywhere. Color
 * that is NaN counts as 0; other values are clamped to +-65504.
 *
 * VIRGA_ERROR_INVALID: the view has no color (with def.circles it needs none), its viewport is larger than the
 * definition's, or a layer is wrong.
 *
 * Cost: for each texel of the work image, about pi (r + 1/2)^2 samples, r the largest radius (texels) that reaches
 * its tile of 16 x 16. Half resolution makes texels of 2 x 2 pixels, and pays only for tiles that something out of
 * focus reaches: for the others it reads depth, color and layers once and writes the picture. */
VIRGA_API virga_result virga_lens_prepare(virga_lens *lens, VkCommandBuffer cmd, const virga_view *view,
                                          const virga_lens_layer *layers, uint32_t layer_count, double time_s);

/* The same, and *prepared (may be NULL) gets the view's handle for virga_lens_draw_view; 0 if nothing was prepared. Up
 * to def.max_views of them live at the same time. */
VIRGA_API virga_result virga_lens_prepare_view(virga_lens *lens, VkCommandBuffer cmd, const virga_view *view,
                                               const virga_lens_layer *layers, uint32_t layer_count, double time_s,
                                               virga_prepared *prepared);

/* Builds the pipeline for a target. Errors as virga_target_create. Another call with the same target does nothing. */
VIRGA_API virga_result virga_lens_attach(virga_lens *lens, const virga_target *target);

/* Writes the picture into the target, over its viewport. Inside rendering. VIRGA_NOT_READY, and nothing is recorded, if
 * the target is not attached or nothing was prepared in this frame.
 *
 * With def.in_place it blends over the target, whose viewport must hold the colors that view.color held at the prepare.
 * It may be the same image: the host makes it readable, prepares, makes it an attachment again, and loads it. The draw
 * does not read view.color; it reads view.depth, and color and depth of layers.
 *  - Squares of 32 x 32 pixels that nothing out of focus reaches keep their bits, and are neither read nor written.
 *    Layers are put over all of the viewport. On GPUs, with max_radius_px up to 32 and no layer on the scene, those
 *    out of focus are put over blocks of up to 128 x 64 pixels that they reach.
 *  - The result is that of the other way but for the rounding of the target's format. On GPUs, without layers and with
 *    max_radius_px up to 16, what is out of focus has nine bits for each channel, rounded to 1/512 of the largest one,
 *    and no colors below 0. Alpha is blended as color is, so 1 stays 1. With several samples a pixel, what is in focus
 *    keeps its samples.
 *  - A pixel of the target that is NaN or infinite stays so or becomes NaN. It does not spread.
 *  - VIRGA_ERROR_INVALID for a target with VIRGA_ENCODING_SRGB, as light does not add up there; _SRGB formats work.
 *  - Draw once: a second draw blurs the edges of what is out of focus again. */
VIRGA_API virga_result virga_lens_draw(virga_lens *lens, VkCommandBuffer cmd, const virga_target *target);

/* (physical) Writes one part of the picture into the target instead, over its viewport: 0 is the scene without layers,
 * 1 the first layer, and so on. Layers are premultiplied, and cut by what of the scene is out of focus before
 * them. So a host can put them over the scene in their order. Inside rendering; view.color and the images of the layers
 * are read again. Errors as virga_lens_draw; VIRGA_ERROR_INVALID for a part that the prepare did not have. */
VIRGA_API virga_result virga_lens_draw_part(virga_lens *lens, VkCommandBuffer cmd, const virga_target *target,
                                            uint32_t part);

/* The same two for any view that was prepared in this frame, see virga_prepared. VIRGA_ERROR_INVALID for one that was
 * not, or that a later prepare has replaced. */
VIRGA_API virga_result virga_lens_draw_view(virga_lens *lens, VkCommandBuffer cmd, const virga_target *target,
                                            virga_prepared prepared);
VIRGA_API virga_result virga_lens_draw_part_view(virga_lens *lens, VkCommandBuffer cmd, const virga_target *target,
                                                 virga_prepared prepared, uint32_t part);

/* The picture of the newest prepare: R16G16B16A16_SFLOAT, its pixel (0, 0) is the viewport's first. Its layout is
 * VK_IMAGE_LAYOUT_GENERAL. Ready to be read by compute and fragment shaders and transfers after the prepare. */
typedef struct virga_lens_image {
    VkImage image;
    VkImageView view;
    uint32_t width, height; /* px that were written */
} virga_lens_image;

VIRGA_API void virga_lens_picture(const virga_lens *lens, virga_lens_image *picture);

/* The same of any view that was prepared in this frame. All zero, with a line in the log, if there is no such view. */
VIRGA_API void virga_lens_picture_view(virga_lens *lens, virga_prepared prepared, virga_lens_image *picture);

/* (def.circles) Circles of confusion of the newest prepare: R32_SFLOAT, the signed radius in pixels of the target, by
 * the settings and the focus of that prepare. Less than 0: in front of the focus; 0: sharp. It is cut to max_radius_px,
 * here up to 126. `part` as in virga_lens_draw_part: 0 is the scene, 1 the first layer. All parts are layers of one
 * array image, and `view` shows the one of this part. Pixel (0, 0) is the viewport's first. Where a layer has nothing
 * its radius is that of its depth there. Layout and readiness as virga_lens_picture. All zero for a part that the
 * prepare did not have, or without def.circles. */
VIRGA_API void virga_lens_circles(const virga_lens *lens, uint32_t part, virga_lens_image *circles);

/* The same of any view that was prepared in this frame. All zero, with a line in the log, if there is no such view. */
VIRGA_API void virga_lens_circles_view(virga_lens *lens, virga_prepared prepared, uint32_t part,
                                       virga_lens_image *circles);

/* Sets aperture_m and focus_m of a view to this lens, so that rain streaks are as wide as it blurs them. Such streaks
 * belong on the picture after virga_lens_draw, or into a layer at the focus. With `follow` it uses the newest known
 * focus. */
VIRGA_API void virga_lens_fill_view(virga_lens *lens, virga_view *view);

/* Breathing: how much larger the picture gets when a lens focuses at focus_m (0: infinity) than at infinity. The sensor
 * stays, and the lens moves away from it: focus_m / (focus_m - focal_m). Multiply the first two elements of the
 * projection's diagonal by it. 1 where focus_m <= focal_m, as no lens focuses there. Thread-safety: any thread. */
VIRGA_API double virga_lens_breathing(double focal_m, double focus_m);

/* The newest statistics of completed frames. */
typedef struct virga_lens_stats {
    uint64_t frame_index; /* 0: none yet */
    float focus_m;        /* view depth that was sharp; infinite: infinity */

    /* Prepares of that frame (at most VIRGA_MAX_VIEWS are listed), and the focus of each, in their order. */
    uint32_t views;
    float view_focus_m[VIRGA_MAX_VIEWS];
} virga_lens_stats;

VIRGA_API void virga_lens_stats_get(virga_lens *lens, virga_lens_stats *stats);

#ifdef __cplusplus
}
#endif
#endif
