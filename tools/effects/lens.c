/* lens.c - the section `lens`, drops on the camera's lens, and `virga bench lens`. The drops are a pane, see
 * glass/front.c. The lens itself is the camera's: its keys are in tools/io, tools/virga/shot draws with it. */
#include "lens.h"

#include "effect.h"
#include "glass.h"
#include "scene_rows.h"

#include "bench/bench.h"
#include "options.h"
#include "progress.h"

#include <virga/lens.h>
#include <virga/shared/random.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- keys of scene files -------------------------------------------------------------------------------------- */

/* Ranges of what the library has are its own: virga/glass.h. */
static const scene_row lens_rows[] = {
    SWITCH(scene_lens, drops, "false", RESTARTS, "the camera's front element gets wet"),
    NUMBER(scene_lens, away_mm, 1, 500, "35", LIVE, "from the lens's opening to the element"),
    NUMBER(scene_lens, diameter_mm, 10, 300, "70", RESTARTS, "of the element; corners that look past it have no drops"),
    CHOICE(scene_lens, kind, scene_pane_kinds, "dirty", LIVE,
           "what drops sit on: coated is a coating that repels water"),
    OPTIONAL_NUMBER(scene_lens, advancing_deg, 5, 175, LIVE,
                    "contact angle at which a drop's front moves on; else its kind's"),
    OPTIONAL_NUMBER(scene_lens, receding_deg, 1, 175, LIVE, "contact angle at which its rear lets go; else its kind's"),
    NUMBER(scene_lens, shelter, 0, 1, "0", LIVE, "share of the rain that a hood keeps off"),
    NUMBER(scene_lens, air_share, 0, 2, "0.8", LIVE, "share of the air flow along the element that pulls at drops"),
    NUMBER(scene_lens, air_outward, 0, 2, "0.64", LIVE,
           "share of the air that meets it head-on and flows from its middle outwards, at its rim"),
    NUMBER(scene_lens, evaporation_mm_h, 0, 100, "0.5", LIVE, "from what is wet"),
    NUMBER(scene_lens, mist_max_mm, 0, 1, "0.6", LIVE, "smaller drops join the film, which is not seen"),
    NUMBER(scene_lens, veil, 0, 1, "0", LIVE, "share of the opening that mist covers: veiling glare"),
    NUMBER(scene_lens, starburst, 0, 1, "0", LIVE, "share of the opening that streaks of film cover: starbursts"),
    WHOLE(scene_lens, starburst_rays, 1, 8, "3", LIVE, "directions of their rays, of which each has two"),
    NUMBER(scene_lens, starburst_deg, -360, 360, "15", LIVE,
           "of the first ray: 0 is to the right seen from outside, 90 up"),
    NUMBER(scene_lens, wipe_every_s, 0, 3600, "0", LIVE, "a cloth wipes the element so often; 0: never"),
    NUMBER(scene_lens, wipe_s, 0.1, 60, "0.3", LIVE, "from one side to the other, and as long back"),
    NUMBER(scene_lens, cell_m, 0.0005, 0.01, "0.001", RESTARTS, "side of a cell, of which one drop has one"),
    WHOLE(scene_lens, max_drops, 256, 262144, "2048", RESTARTS, "500 bytes each"),
};
static const scene_group lens_group = SCENE_GROUP(scene_lens, lens_rows);
static const scene_row lens_section[] = {SECTION_GROUP("lens", &lens_group, "drops on the camera's lens")};

TOOL_SECTION_OF(lens)

static bool check_lens(const scene_file *scene, char *error, size_t error_size)
{
    const scene_lens *lens = scene_lens_of(scene);
    if ((lens->veil > 0 || lens->starburst > 0) && !lens->drops)
        return scene_file_refuse(scene, lens->veil > 0 ? "lens.veil" : "lens.starburst", error, error_size,
                                 "expected drops: true beside it");
    if (lens->wipe_every_s > 0 && lens->wipe_every_s < 2 * lens->wipe_s)
        return scene_file_refuse(scene, "lens.wipe_every_s", error, error_size,
                                 "expected 0, or at least twice wipe_s (%g), got %g", lens->wipe_s, lens->wipe_every_s);
    if (lens->advancing_deg && lens->receding_deg && *lens->receding_deg > *lens->advancing_deg)
        return scene_file_refuse(scene, "lens.receding_deg", error, error_size,
                                 "expected at most advancing_deg (%g), got %g", *lens->advancing_deg,
                                 *lens->receding_deg);
    return true;
}

static void print(const scene_file *scene)
{
    const scene_lens *lens = scene_lens_of(scene);
    if (lens->drops)
        printf("  lens drops   %g mm wide, %g mm before its opening, %s\n", lens->diameter_mm, lens->away_mm,
               scene_pane_kind_name(lens->kind));
}

/* ---- virga bench ---------------------------------------------------------------------------------------------- */

#define FOCUS_M  0.3f
#define LAYER_M  (0.5f * FOCUS_M) /* of a layer out of focus: in 1/m as far from the focus as infinity is */
#define DROPS    1000             /* on the layer, as in the paper's picture */
#define RUNS     41               /* of a case: a small picture takes as long as a wake of a thread may */
#define ENOUGH_S 6.0              /* fewer runs are enough after it */
#define GAME_PX  7.2              /* radius of discs of the rows in place: 1 % of 720 rows */
#define WIDE_PX  21.6             /* and of 2160 rows: the same lens */

/* (in place) The layer of drops: none, or one out of focus by as much as what is farthest away, but in front of it. */
typedef enum case_layer {
    NO_LAYER,
    PLANE,      /* all at one depth */
    WITH_DEPTHS /* a depth for each pixel */
} case_layer;

typedef struct lens_case {
    const char *what;
    virga_lens_style style;
    uint32_t half_resolution;
    double radius_share; /* largest circle of confusion, as a share of the picture's height; 0: everything is sharp */
    uint32_t blurred;    /* index into `shares` */
    bool in_place;       /* and drawn */
    double disc_px;      /* (in place) radius of the largest circle of confusion in place of the share */
    case_layer layer;    /* (in place) others have it in focus */
} lens_case;

/* How much of the picture is out of focus, from above. The rest is as far away as the focus. */
static const double shares[] = {1, 1.0 / 3, 0.1, 0};
#define SHARES (sizeof shares / sizeof *shares)

static const lens_case cases[] = {
    {"paper", VIRGA_LENS_STYLE_PAPER, 0, 0.02, 0, false, 0, NO_LAYER},
    {"half, in focus", VIRGA_LENS_STYLE_PHYSICAL, 1, 0, 0, false, 0, NO_LAYER},
    {"half, 1 %, tenth", VIRGA_LENS_STYLE_PHYSICAL, 1, 0.01, 2, false, 0, NO_LAYER},
    {"half, 1 %, third", VIRGA_LENS_STYLE_PHYSICAL, 1, 0.01, 1, false, 0, NO_LAYER},
    {"half, 1 %", VIRGA_LENS_STYLE_PHYSICAL, 1, 0.01, 0, false, 0, NO_LAYER},
    {"half, 2 %", VIRGA_LENS_STYLE_PHYSICAL, 1, 0.02, 0, false, 0, NO_LAYER},
    {"in place, in focus", VIRGA_LENS_STYLE_PHYSICAL, 1, 0.01, 3, true, GAME_PX, NO_LAYER},
    {"in place, tenth", VIRGA_LENS_STYLE_PHYSICAL, 1, 0.01, 2, true, GAME_PX, NO_LAYER},
    {"in place, third", VIRGA_LENS_STYLE_PHYSICAL, 1, 0.01, 1, true, GAME_PX, NO_LAYER},
    {"in place, all", VIRGA_LENS_STYLE_PHYSICAL, 1, 0.01, 0, true, GAME_PX, NO_LAYER},
    {"wide, in focus", VIRGA_LENS_STYLE_PHYSICAL, 1, 0.01, 3, true, WIDE_PX, NO_LAYER},
    {"wide, tenth", VIRGA_LENS_STYLE_PHYSICAL, 1, 0.01, 2, true, WIDE_PX, NO_LAYER},
    {"wide, third", VIRGA_LENS_STYLE_PHYSICAL, 1, 0.01, 1, true, WIDE_PX, NO_LAYER},
    {"wide, all", VIRGA_LENS_STYLE_PHYSICAL, 1, 0.01, 0, true, WIDE_PX, NO_LAYER},
    {"plane, in focus", VIRGA_LENS_STYLE_PHYSICAL, 1, 0.01, 3, true, GAME_PX, PLANE},
    {"plane, all", VIRGA_LENS_STYLE_PHYSICAL, 1, 0.01, 0, true, GAME_PX, PLANE},
    {"depths, in focus", VIRGA_LENS_STYLE_PHYSICAL, 1, 0.01, 3, true, GAME_PX, WITH_DEPTHS},
    {"depths, all", VIRGA_LENS_STYLE_PHYSICAL, 1, 0.01, 0, true, GAME_PX, WITH_DEPTHS},
    {"wide plane, in focus", VIRGA_LENS_STYLE_PHYSICAL, 1, 0.01, 3, true, WIDE_PX, PLANE},
    {"wide plane, all", VIRGA_LENS_STYLE_PHYSICAL, 1, 0.01, 0, true, WIDE_PX, PLANE},
    {"wide depths, in focus", VIRGA_LENS_STYLE_PHYSICAL, 1, 0.01, 3, true, WIDE_PX, WITH_DEPTHS},
    {"wide depths, all", VIRGA_LENS_STYLE_PHYSICAL, 1, 0.01, 0, true, WIDE_PX, WITH_DEPTHS},
    {"full, in focus", VIRGA_LENS_STYLE_PHYSICAL, 0, 0, 0, false, 0, NO_LAYER},
    {"full, 1 %", VIRGA_LENS_STYLE_PHYSICAL, 0, 0.01, 0, false, 0, NO_LAYER},
};

static const uint32_t sizes[][2] = {{320, 240}, {1280, 720}, {3840, 2160}};
static const uint32_t game_sizes[][2] = {{1280, 720}, {1920, 1080}, {3840, 2160}}; /* of the rows in place alone */

/* What a lens reads: a street of lamps, and drops on a pane before it. */
typedef struct pictures {
    host_image color, depths[SHARES], layer; /* depths: by the share that is out of focus */
    uint32_t width, height;
    /* A game's color, of half floats: it is read, and then drawn into. */
    host_image game, game_layer, layer_depth;
    VkRenderPass pass;
    VkFramebuffer framebuffer;
    virga_target *target;
} pictures;

/* ---- the pictures */

static void paint(float *color, float *depth, float *layer, uint32_t width, uint32_t height)
{
    uint32_t hash = 1;
    for (uint32_t i = 0; i < width * height; i++) {
        const double down = (double)(i / width) / height;
        hash = virga_hash1(hash);
        const bool lamp = virga_unit(hash) < 0.001f && down < 0.5;
        depth[i] = down > 0.5 ? (float)((down - 0.5) / 1.5) : 0.02f; /* 1/m: a floor, and fronts 50 m away */
        for (int c = 0; c < 4; c++) {
            color[4 * i + (uint32_t)c] = c == 3 ? 1 : lamp ? 40.0f : 0.1f;
            layer[4 * i + (uint32_t)c] = 0;
        }
    }
    const int radius = (int)(height / 120);
    for (int k = 0; k < DROPS; k++) {
        hash = virga_hash1(hash);
        const int column = (int)(virga_unit(hash) * (float)width);
        hash = virga_hash1(hash);
        const int row = (int)(virga_unit(hash) * (float)height);
        for (int y = row - radius; y <= row + radius; y++)
            for (int x = column - radius; x <= column + radius; x++)
                if (x >= 0 && y >= 0 && x < (int)width && y < (int)height &&
                    (x - column) * (x - column) + (y - row) * (y - row) <= radius * radius)
                    for (size_t c = 0; c < 4; c++)
                        layer[4 * ((size_t)y * width + (size_t)x) + c] = c == 3 ? 0.8f : 0.3f;
    }
}

static bool upload(bench *b, const float *pixels, uint32_t channels, const pictures *p, host_image *image)
{
    const host_image_def def = {.format = channels == 1 ? VK_FORMAT_R32_SFLOAT : VK_FORMAT_R32G32B32A32_SFLOAT,
                                .extent = {p->width, p->height, 1},
                                .name = "bench"};
    return host_image_create_with(&b->device, &def, pixels, (VkDeviceSize)p->width * p->height * channels * 4,
                                  channels * 4, image, b->error, sizeof b->error);
}

/* ---- what a lens in place draws into */

#define GAME_FORMAT VK_FORMAT_R16G16B16A16_SFLOAT

static bool create_game_pass(bench *b, pictures *p)
{
    const VkAttachmentDescription attachment = {.format = GAME_FORMAT,
                                                .samples = VK_SAMPLE_COUNT_1_BIT,
                                                .loadOp = VK_ATTACHMENT_LOAD_OP_LOAD,
                                                .storeOp = VK_ATTACHMENT_STORE_OP_STORE,
                                                .initialLayout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
                                                .finalLayout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
    const VkAttachmentReference color = {0, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
    const VkSubpassDescription subpass = {.colorAttachmentCount = 1, .pColorAttachments = &color};
    const VkRenderPassCreateInfo info = {.sType = VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO,
                                         .attachmentCount = 1,
                                         .pAttachments = &attachment,
                                         .subpassCount = 1,
                                         .pSubpasses = &subpass};
    return vkCreateRenderPass(b->device.device, &info, NULL, &p->pass) == VK_SUCCESS;
}

/* Black, which costs as much as the street. */
static bool create_game_image(bench *b, pictures *p, host_image *image)
{
    const size_t bytes = (size_t)p->width * p->height * 8;
    const host_image_def def = {.format = GAME_FORMAT,
                                .extent = {p->width, p->height, 1},
                                .usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT,
                                .name = "bench game"};
    void *black = calloc(1, bytes);
    const bool good =
        black && host_image_create_with(&b->device, &def, black, bytes, 8, image, b->error, sizeof b->error);
    free(black);
    return good;
}

/* The drops as a game has them: half floats, and depths of what is not empty. */
static bool create_game_layer(bench *b, const float *layer, pictures *p)
{
    const size_t pixels = (size_t)p->width * p->height;
    const host_image_def def = {.format = GAME_FORMAT, .extent = {p->width, p->height, 1}, .name = "bench layer"};
    uint16_t(*halves)[4] = malloc(pixels * sizeof *halves);
    float *depth = malloc(pixels * sizeof *depth);
    bool good = halves && depth;
    for (size_t i = 0; good && i < pixels; i++) {
        const bool drop = layer[4 * i + 3] > 0;
        for (size_t c = 0; c < 4; c++)
            halves[i][c] = !drop ? 0 : c == 3 ? 0x3A66 : 0x34CD; /* 0.8 and 0.3 */
        depth[i] = drop ? 1 / LAYER_M : 0;
    }
    good = good && upload(b, depth, 1, p, &p->layer_depth) &&
           host_image_create_with(&b->device, &def, halves, pixels * sizeof *halves, sizeof *halves, &p->game_layer,
                                  b->error, sizeof b->error);
    free(halves);
    free(depth);
    return good;
}

static bool open_game(bench *b, pictures *p)
{
    virga_target_def def = virga_default_target_def();
    if (!create_game_pass(b, p) || !create_game_image(b, p, &p->game))
        return false;
    const VkFramebufferCreateInfo info = {.sType = VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO,
                                          .renderPass = p->pass,
                                          .attachmentCount = 1,
                                          .pAttachments = &p->game.view,
                                          .width = p->width,
                                          .height = p->height,
                                          .layers = 1};
    def.render_pass = p->pass;
    def.color_formats[0] = GAME_FORMAT;
    def.depth_attached = false;
    def.reversed_depth = true;
    return vkCreateFramebuffer(b->device.device, &info, NULL, &p->framebuffer) == VK_SUCCESS &&
           virga_target_create(b->context, &def, &p->target) == VIRGA_OK;
}

static void close_game(bench *b, pictures *p)
{
    virga_target_destroy(&p->target);
    vkDestroyFramebuffer(b->device.device, p->framebuffer, NULL);
    vkDestroyRenderPass(b->device.device, p->pass, NULL);
    host_image_destroy(&b->device, &p->game);
    host_image_destroy(&b->device, &p->game_layer);
    host_image_destroy(&b->device, &p->layer_depth);
}

/* The host's barriers around the pass are part of what it costs. */
static bool draw_in_place(virga_lens *lens, const pictures *p, VkCommandBuffer cmd)
{
    const VkRenderPassBeginInfo begin = {.sType = VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO,
                                         .renderPass = p->pass,
                                         .framebuffer = p->framebuffer,
                                         .renderArea = {{0, 0}, {p->width, p->height}}};
    vkCmdBeginRenderPass(cmd, &begin, VK_SUBPASS_CONTENTS_INLINE);
    const bool good = virga_lens_draw(lens, cmd, p->target) == VIRGA_OK;
    vkCmdEndRenderPass(cmd);
    return good;
}

/* ---- all pictures */

static bool open_pictures(bench *b, pictures *p)
{
    const size_t pixels = (size_t)p->width * p->height;
    float *color = malloc(pixels * 16), *depth = malloc(pixels * 4), *layer = malloc(pixels * 16);
    bool good = color && depth && layer;
    if (good) {
        paint(color, depth, layer, p->width, p->height);
        good = upload(b, color, 4, p, &p->color) && upload(b, layer, 4, p, &p->layer) && create_game_layer(b, layer, p);
    }
    for (size_t i = 0; i < SHARES && good; i++) {
        for (size_t k = (size_t)(shares[i] * p->height) * p->width; k < pixels; k++)
            depth[k] = 1 / FOCUS_M;
        good = upload(b, depth, 1, p, &p->depths[i]);
    }
    free(color);
    free(depth);
    free(layer);
    good = good && open_game(b, p);
    const host_image *const read[] = {&p->color,     &p->layer,     &p->game,      &p->game_layer, &p->layer_depth,
                                      &p->depths[0], &p->depths[1], &p->depths[2], &p->depths[3]};
    for (size_t i = 0; good && i < sizeof read / sizeof *read; i++)
        bench_know_image(b, read[i]);
    return good || bench_fail(b, "pictures");
}

static void close_pictures(bench *b, pictures *p)
{
    host_image_destroy(&b->device, &p->color);
    for (size_t i = 0; i < SHARES; i++)
        host_image_destroy(&b->device, &p->depths[i]);
    host_image_destroy(&b->device, &p->layer);
    close_game(b, p);
}

static virga_image sampled(const host_image *image)
{
    return (virga_image){.image = image->image,
                         .view = image->view,
                         .format = image->format,
                         .before.layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
}

/* The depth buffer is reversed and has no far plane, so that it stores 1 / view depth. */
static virga_view view_of(const pictures *p, const lens_case *row)
{
    virga_view view = virga_default_view();
    memset(view.clip_from_view, 0, sizeof view.clip_from_view);
    view.clip_from_view[0] = 2 * (float)p->height / (float)p->width;
    view.clip_from_view[5] = -2;
    view.clip_from_view[11] = -1;
    view.clip_from_view[14] = 1;
    memcpy(view.open_clip_from_view, view.clip_from_view, sizeof view.clip_from_view);
    view.reversed_depth = true;
    view.viewport[2] = (float)p->width;
    view.viewport[3] = (float)p->height;
    view.color = sampled(row->in_place ? &p->game : &p->color);
    view.depth = sampled(&p->depths[row->blurred]);
    return view;
}

static virga_lens_layer layer_of(const pictures *p, const lens_case *row)
{
    virga_lens_layer layer = {.color = sampled(row->in_place ? &p->game_layer : &p->layer),
                              .depth_m = row->in_place ? LAYER_M : FOCUS_M};
    if (row->layer == WITH_DEPTHS)
        layer.depth = sampled(&p->layer_depth);
    return layer;
}

/* ---- measuring */

typedef struct frame_times {
    double waited[RUNS]; /* ms, of submitting and waiting */
    double worked[RUNS]; /* ms, that all threads worked, which other programs on the machine hardly change */
} frame_times;

/* Times of a submission, with or without a lens. */
static bool time_frame(bench *b, virga_lens *lens, const pictures *p, const lens_case *row, frame_times *times,
                       size_t run)
{
    VkCommandBuffer cmd;
    const virga_view view = view_of(p, row);
    const virga_lens_layer layer = layer_of(p, row);
    const bool has_layer = !row->in_place || row->layer != NO_LAYER;
    if (!bench_begin(b, &cmd))
        return false;
    if (lens && virga_lens_prepare(lens, cmd, &view, &layer, has_layer, 0) != VIRGA_OK)
        return options_complain("bench", "a prepare failed");
    if (lens && row->in_place && !draw_in_place(lens, p, cmd))
        return options_complain("bench", "a draw failed");
    const double start = bench_worked_ms();
    const bool good = bench_submit(b, &times->waited[run]);
    times->worked[run] = bench_worked_ms() - start;
    return good;
}

/* The focus is on the pane, 0.3 m away, so that what is farthest is blurred by the case's share. */
static virga_lens_settings settings_of(const lens_case *row, const pictures *p)
{
    virga_lens_settings settings = virga_default_lens_settings();
    const double pixels = p->height, radius_px = row->in_place ? row->disc_px : row->radius_share * p->height;
    settings.style = row->style;
    settings.focus_m = FOCUS_M;
    settings.max_radius_px = row->half_resolution ? 126 : 63;
    if (row->in_place) /* a game knows how large its discs get; at least that they are not wider than by default */
        settings.max_radius_px = fminf(2 * (float)row->disc_px, virga_default_lens_settings().max_radius_px);
    /* r = A p / 2 (1 / s), A = focal / f-number, p = half the height times the cotangent, 2 */
    settings.aperture_f =
        radius_px > 0 ? (float)((double)settings.focal_m * pixels / (2 * radius_px * (double)settings.focus_m)) : 0;
    return settings;
}

/* A fill of a picture of this size. */
typedef struct fill_cost {
    double waited, worked; /* ms, as in frame_times */
} fill_cost;

/* What a copy of the same pictures costs: the pass that puts the layer over the scene where all is in focus. It reads
 * each picture that the lens is given once, and writes the picture once. A host without a lens has that pass. */
typedef struct copy_cost {
    double worked; /* ms, as in frame_times; 0: not known yet */
} copy_cost;

#define COPY_BYTES (16 + 16 + 8.0) /* per pixel: color and layer of this bench are floats, the picture half floats */

#define FINE_RADIUS 8 /* texels, VIRGA_LENS_FINE in shared/lens_gpu.h: wider discs come from blocks of texels */

/* Texels, or blocks of them for wide discs, that a gather reads for one texel of the work image: see row_reach in
 * shaders/lens/aperture.glsl and levels.glsl. */
static double reads_of_disc(double radius)
{
    double sum = 0;
    while (radius > FINE_RADIUS)
        radius /= 2;
    for (int y = -(int)(radius + 0.5); y <= (int)(radius + 0.5); y++)
        sum += 2 * floor(sqrt((radius + 0.5) * (radius + 0.5) - y * y)) + 1;
    return sum;
}

/* A model, not a measurement: bytes that the passes of the physical style move from and to memory for each pixel. A
 * pass moves each texel that it reads once, as neighbours find it in a cache: a tile's discs of 20 texels are 56 x 56
 * samples, which are 50 kB. Depth has 4 bytes, samples and spreads 16, a field 8. What is out of focus is behind the
 * focus; the layer is sharp. Blocks of 16 bytes are written and read once, a quarter of the texels or less. At full
 * resolution passes read both fields and the spreads, and do all tiles. */
static double model_bytes(const lens_case *row, const pictures *p)
{
    const double texels = row->half_resolution ? 0.25 : 1; /* of the work image, per pixel */
    const double near = row->half_resolution ? 0 : 1;      /* half resolution leaves out what no near tile needs */
    if (row->radius_share <= 0)
        return COPY_BYTES;
    const double share = row->half_resolution ? shares[row->blurred] : 1, tiles = row->half_resolution ? 6 : 4;
    const double sample = 16 + 4 + texels * (16 + 16);
    const double blocks = row->radius_share * p->height * sqrt(texels) > FINE_RADIUS ? texels * (32 + 2 * 4 + 4) : 0;
    const double gather = texels * (16 + near * 16 + 2 * 8), fields = 4 + texels * (8 + near * 8);
    return COPY_BYTES + tiles + share * (sample + blocks + gather + fields);
}

static const char *const pass_names[] = {"paper",  "sample", "tiles",  "blocks", "gather",
                                         "narrow", "wide",   "layers", "combine"};
#define PASSES (sizeof pass_names / sizeof *pass_names)

/* The passes' own times: the smallest, as other programs on the machine only make them longer. */
static void print_passes(double times[PASSES][RUNS], size_t runs)
{
    printf("  %-18s ", "");
    for (size_t i = 0; i < PASSES; i++) {
        double ms = times[i][0];
        for (size_t run = 1; run < runs; run++)
            ms = fmin(ms, times[i][run]);
        if (ms > 0)
            printf(" %s %.2f", pass_names[i], ms);
    }
    printf(" ms\n");
}

static void print_costs(const lens_case *row, const pictures *p, double worked, copy_cost *copy)
{
    const double texels = row->half_resolution ? 0.25 : 1;
    if (row->radius_share <= 0 && copy->worked <= 0)
        copy->worked = worked;
    printf("  %-18s %10.1f x a copy of the same, processors; by a model %.0f bytes a pixel, %.1f x a copy", "",
           worked / copy->worked, model_bytes(row, p), model_bytes(row, p) / COPY_BYTES);
    if (row->radius_share > 0)
        printf(", and %.0f reads of discs", texels * reads_of_disc(row->radius_share * p->height * sqrt(texels)));
    printf("\n");
}

static bool measure(bench *b, const lens_case *row, const pictures *p, const fill_cost *fill, copy_cost *copy)
{
    virga_lens_def def = virga_default_lens_def();
    virga_lens *lens = NULL;
    frame_times times, empty;
    double passes[PASSES][RUNS];
    def.max_width = p->width;
    def.max_height = p->height;
    def.half_resolution = row->half_resolution;
    def.in_place = row->in_place;
    const virga_lens_settings settings = settings_of(row, p);
    bool good = virga_lens_create(b->context, &def, &lens) == VIRGA_OK && virga_lens_set(lens, &settings) >= VIRGA_OK &&
                virga_lens_attach(lens, p->target) == VIRGA_OK && time_frame(b, lens, p, row, &times, 0);
    bench_forget_model(b);
    const double start = progress_now();
    size_t runs = 0;
    const size_t most = b->model ? 1 : RUNS; /* counts are the same in each */
    while (good && runs < most && (!runs || progress_now() - start < ENOUGH_S)) {
        good = time_frame(b, NULL, p, row, &empty, runs) && time_frame(b, lens, p, row, &times, runs);
        for (size_t i = 0; i < PASSES; i++) {
            char name[32];
            snprintf(name, sizeof name, "lens.%s", pass_names[i]);
            passes[i][runs] = bench_pass_ms(b, name);
        }
        runs++;
    }
    virga_lens_destroy(&lens);
    if (!good)
        return options_complain("bench", "no lens could be measured");
    const double ms = fmax(bench_median(times.waited, runs) - bench_median(empty.waited, runs), 1e-3);
    const double worked = fmax(bench_median(times.worked, runs) - bench_median(empty.worked, runs), 1e-3);
    printf("  %-18s %10.3f ms %9.1f frames/s %8.1f x a fill, processors %10.3f ms %8.1f x a fill, median of %zu\n",
           row->what, ms, 1e3 / ms, ms / fill->waited, worked, worked / fill->worked, runs);
    if (row->style == VIRGA_LENS_STYLE_PHYSICAL && !row->in_place)
        print_costs(row, p, worked, copy);
    print_passes(passes, runs);
    fflush(stdout);
    const double modelled_ms = bench_print_model(b);
    const double fills = modelled_ms > 0 ? modelled_ms / model_fill_ms(b->model, (double)p->width * p->height) : 0;
    if (fills > 0 && row->layer == NO_LAYER)
        printf("    %.1f x a fill of all pixels, modelled\n", fills);
    if (fills > 0 && row->layer != NO_LAYER)
        printf("    %.1f x a fill of all pixels, modelled: %.1f x a fill of those of the scene and of the layer\n",
               fills, fills / 2);
    return true;
}

static bool measure_fill(bench *b, const pictures *p, fill_cost *cost)
{
    host_target target;
    limits *l;
    if (!host_target_create(&b->device, p->width, p->height, &target, b->error, sizeof b->error))
        return bench_fail(b, "picture");
    bool good = limits_create(&b->device, &target, 1024, &l, b->error, sizeof b->error);
    cost->waited = good ? limits_fill_ms(&b->device, l, &target) : -1; /* the first compiles */
    const double start = bench_worked_ms();
    cost->waited = good ? limits_fill_ms(&b->device, l, &target) : -1;
    cost->worked = (bench_worked_ms() - start) / BENCH_RUNS;
    if (good)
        limits_destroy(&b->device, &l);
    host_target_destroy(&b->device, &target);
    return cost->waited > 0 || bench_fail(b, "fill");
}

static bool measure_size(bench *b, const uint32_t size[2], bool in_place)
{
    pictures p = {.width = size[0], .height = size[1]};
    fill_cost fill = {0};
    copy_cost copy = {0};
    bool good = open_pictures(b, &p) && measure_fill(b, &p, &fill);
    if (good)
        printf("%u x %u, a fill takes %.3f ms, processors %.3f ms\n", p.width, p.height, fill.waited, fill.worked);
    for (size_t k = 0; good && k < sizeof cases / sizeof cases[0] && !interrupt_requested(); k++)
        if (!in_place || cases[k].in_place)
            good = measure(b, &cases[k], &p, &fill, &copy);
    close_pictures(b, &p);
    return good;
}

static const option_row bench_rows[] = {
    {"--in-place", 0, NULL, "lens: measure the rows in place only, also at 1920 x 1080", false},
};

static bool run(bench *b, const options *parsed)
{
    const bool in_place = options_value(parsed, "--in-place");
    const uint32_t(*size)[2] = in_place ? game_sizes : sizes;
    printf("a street of lamps behind a pane with %d drops in focus; blur as a share of the picture's height\n", DROPS);
    for (size_t i = 0; i < sizeof sizes / sizeof sizes[0] && !interrupt_requested(); i++)
        if (!measure_size(b, size[i], in_place))
            return false;
    return true;
}

static const tool_bench lens_bench = {
    .help = "focus as in the paper and as of a lens, at half and full resolution, three sizes\n",
    .rows = bench_rows,
    .row_count = sizeof bench_rows / sizeof bench_rows[0],
    .run = run,
};

const tool_effect lens_effect = {
    .name = "lens",
    .title = "Drops on the lens",
    .scene = {.group = SCENE_GROUP(scene_lens, lens_section), .check = check_lens},
    .print = print,
    .bench = &lens_bench,
};
