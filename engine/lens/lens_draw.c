/* lens/lens_draw.c - draw copies a prepared picture into a target, or blends over it what is out of focus. */
#include "lens/lens_internal.h"

#include "gpu/builds.h"
#include "gpu/errors.h"
#include "gpu/record.h"
#include "gpu/timers.h"

#include "shaders/lens_shaders.h"

/* Forms of the draws in place: kinds of tiles, with no layer, one or any number. Without layers nothing has to be drawn
 * in tiles in focus. */
#define FORM_OF(kind, layers) ((kind) * (VIRGA_LENS_LAYERS + 1) + (layers))
#define BLURRED_FORMS(layers) FORM_OF(VIRGA_LENS_TILES_BLURRED, layers), FORM_OF(VIRGA_LENS_TILES_FAR, layers)
#define TILE_FORMS(layers)    BLURRED_FORMS(layers), FORM_OF(VIRGA_LENS_TILES_SHARP, layers)
static const uint32_t tile_forms[] = {BLURRED_FORMS(0), TILE_FORMS(1), TILE_FORMS(VIRGA_LENS_LAYERS)};
static const uint32_t sharp_forms[] = {FORM_OF(VIRGA_LENS_ALL_SHARP, 1),
                                       FORM_OF(VIRGA_LENS_ALL_SHARP, VIRGA_LENS_LAYERS)};
#define KIND_FORMS(kind)                                                     \
    {                                                                        \
        FORM_OF(kind, 0), FORM_OF(kind, 1), FORM_OF(kind, VIRGA_LENS_LAYERS) \
    }
static const uint32_t both_forms[] = KIND_FORMS(VIRGA_LENS_TILES_BOTH);
static const uint32_t wide_forms[] = KIND_FORMS(VIRGA_LENS_TILES_WIDE);
static const uint32_t soft_forms[] = KIND_FORMS(VIRGA_LENS_TILES_SOFT);

const virga_effect_draw lens_draws[LENS_DRAWS] = {
    [LENS_DRAW_PICTURE] = {"lens.draw", VIRGA_VERTEX_FORM(lens_show_vert), VIRGA_FORM(lens_show_frag), .no_depth = true,
                           .replace = true},
    [LENS_DRAW_PART] = {"lens.part", VIRGA_VERTEX_FORM(lens_show_vert), VIRGA_FORM(lens_part_frag), .no_depth = true,
                        .replace = true},
    [LENS_DRAW_TILES] = {"lens.draw", VIRGA_VERTEX_FORM(lens_overlay_vert), VIRGA_FORM(lens_overlay_frag), tile_forms,
                         VIRGA_ROWS(tile_forms), .no_depth = true},
    [LENS_DRAW_SOFT] = {"lens.draw", VIRGA_VERTEX_FORM(lens_overlay_vert), VIRGA_FORM(lens_overlay_frag), soft_forms,
                        VIRGA_ROWS(soft_forms), .no_depth = true, .replace = true},
    [LENS_DRAW_BOTH] = {"lens.draw", VIRGA_VERTEX_FORM(lens_overlay_vert), VIRGA_FORM(lens_overlay_frag), both_forms,
                        VIRGA_ROWS(both_forms), .no_depth = true},
    [LENS_DRAW_WIDE] = {"lens.draw", VIRGA_VERTEX_FORM(lens_overlay_vert), VIRGA_FORM(lens_overlay_frag), wide_forms,
                        VIRGA_ROWS(wide_forms), .no_depth = true, .replace = true},
    [LENS_DRAW_LAYERS] = {"lens.draw", VIRGA_VERTEX_FORM(lens_show_vert), VIRGA_FORM(lens_overlay_frag), sharp_forms,
                          VIRGA_ROWS(sharp_forms), .no_depth = true},
};

/* What a draw call was given, and the pipelines of the target's class. */
typedef struct draw_call {
    const char *name;
    VkCommandBuffer cmd;
    const virga_target *target;
    virga_prepared prepared;
    const virga_effect_target *found;
} draw_call;

/* The first pipeline of a row. */
static const virga_pipeline *const *pipelines_of(const draw_call *to, uint32_t row)
{
    uint32_t first = 0;
    for (uint32_t i = 0; i < row; i++)
        first += lens_draws[i].constants ? lens_draws[i].constant_count : 1;
    return (const virga_pipeline *const *)&to->found->draws[first];
}

/* Selects the view. */
static virga_result check_draw(virga_lens *lens, draw_call *to)
{
    const virga_log *log = &lens->base.context->log;
    if (lens->def.circles)
        return virga_wrong_argument(log, "%s: expected a lens with a picture; lens_def.circles is 1", to->name);
    return virga_effect_check_draw(&lens->base, to->name, to->cmd, to->target, to->prepared, true, &to->found);
}

static virga_pass_scope begin_draw(virga_lens *lens, const draw_call *to, const char *name)
{
    virga_context *context = lens->base.context;
    const virga_effect_view *view = virga_effect_selected(&lens->base);
    const virga_pass_scope scope = virga_draw_begin(context, to->cmd, name);
    virga_set_draw_area(context, to->cmd, view->viewport);
    virga_bind(context, to->cmd, VK_PIPELINE_BIND_POINT_GRAPHICS, lens->bindings, view->set, 1, &view->offset);
    return scope;
}

/* Over the viewport. */
static void draw_viewport(virga_lens *lens, const draw_call *to, const virga_pipeline *pipeline, uint32_t part)
{
    virga_context *context = lens->base.context;
    virga_bind_pipeline(context, to->cmd, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
    context->vk.CmdPushConstants(to->cmd, lens->bindings->layout, VIRGA_ALL_STAGES, 0, sizeof part, &part);
    context->vk.CmdDraw(to->cmd, 3, 1, 0, 0);
}

/* Tiles of a kind, from the entries of all. */
static void draw_of_all(virga_lens *lens, const draw_call *to, const virga_pipeline *pipeline, uint32_t kind)
{
    virga_context *context = lens->base.context;
    const uint32_t pushed = kind | VIRGA_LENS_EVERY;
    virga_bind_pipeline(context, to->cmd, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
    context->vk.CmdPushConstants(to->cmd, lens->bindings->layout, VIRGA_ALL_STAGES, 0, sizeof pushed, &pushed);
    context->vk.CmdDraw(to->cmd, VIRGA_LENS_TILE_VERTICES * lens->prepared[lens->base.slot].tiles, 1, 0, 0);
}

/* A list of tiles. The device wrote how many there are. */
static void draw_tiles(virga_lens *lens, const draw_call *to, const virga_pipeline *pipeline, uint32_t kind)
{
    virga_context *context = lens->base.context;
    const VkDeviceSize head = kind * sizeof(virga_lens_list_gpu);
    virga_bind_pipeline(context, to->cmd, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
    context->vk.CmdPushConstants(to->cmd, lens->bindings->layout, VIRGA_ALL_STAGES, 0, sizeof kind, &kind);
    context->vk.CmdDrawIndirect(to->cmd, lens->lists_of_view[lens->base.slot]->buffer,
                                head + offsetof(virga_lens_list_gpu, vertices), 1, 0);
}

static virga_result draw(virga_lens *lens, draw_call *to, uint32_t row, uint32_t part)
{
    virga_result result = check_draw(lens, to);
    if (!result)
        result = virga_pipelines_ready(pipelines_of(to, row), 1);
    if (result)
        return result;
    const virga_pass_scope scope = begin_draw(lens, to, lens_draws[row].name);
    draw_viewport(lens, to, *pipelines_of(to, row), part);
    virga_pass_end(lens->base.context, to->cmd, scope);
    return VIRGA_OK;
}

/* All is sharp, and there are no layers. The state of the command buffer changes as by any other draw. */
static virga_result leave_as_it_is(virga_lens *lens, const draw_call *to)
{
    virga_pass_end(lens->base.context, to->cmd, begin_draw(lens, to, lens_draws[LENS_DRAW_TILES].name));
    return VIRGA_OK;
}

/* The form of a row for so many layers. */
static const virga_pipeline *const *of_layers(const draw_call *to, uint32_t row, uint32_t many)
{
    static const uint32_t first_forms[] = {0, 2, 5}; /* of tile_forms */
    return pipelines_of(to, row) + (row == LENS_DRAW_TILES ? first_forms[many] : many);
}

/* After one pass made the fields: tiles that are blended, whether something is in front of the focus there or not, then
 * those in focus, which have layers only, then those that overwrite the target. */
static virga_result draw_all_tiles(virga_lens *lens, const draw_call *to, uint32_t many)
{
    const bool has_wide = lens->prepared[lens->base.slot].wide;
    const virga_pipeline *const *blended = of_layers(to, LENS_DRAW_TILES, many);
    const virga_pipeline *const *both = of_layers(to, LENS_DRAW_BOTH, many);
    const virga_pipeline *const *soft = of_layers(to, has_wide ? LENS_DRAW_WIDE : LENS_DRAW_SOFT, many);
    virga_result result = virga_pipelines_ready(blended, many ? VIRGA_LENS_TILE_KINDS : 1);
    if (!result)
        result = virga_pipelines_ready(soft, 1);
    if (!result && has_wide)
        result = virga_pipelines_ready(both, 1);
    if (result)
        return result;
    const virga_pass_scope scope = begin_draw(lens, to, lens_draws[LENS_DRAW_TILES].name);
    draw_of_all(lens, to, has_wide ? *both : blended[VIRGA_LENS_TILES_BLURRED], VIRGA_LENS_TILES_BLURRED);
    if (many)
        draw_of_all(lens, to, blended[VIRGA_LENS_TILES_SHARP], VIRGA_LENS_TILES_SHARP);
    draw_of_all(lens, to, *soft, has_wide ? VIRGA_LENS_TILES_WIDE : VIRGA_LENS_TILES_SOFT);
    virga_pass_end(lens->base.context, to->cmd, scope);
    return VIRGA_OK;
}

/* Blends over the target what is out of focus, and layers. */
static virga_result draw_in_place(virga_lens *lens, draw_call *to)
{
    if (to->target && to->target->def.encoding == VIRGA_ENCODING_SRGB)
        return virga_wrong_argument(&lens->base.context->log,
                                    "%s: expected a target of linear light to blend over, as lens_def.in_place is 1",
                                    to->name);
    virga_result result = check_draw(lens, to);
    if (result)
        return result;
    const lens_prepared *seen = &lens->prepared[lens->base.slot];
    const uint32_t many = seen->layers > 1 ? 2 : seen->layers;
    const uint32_t kinds = seen->all_sharp ? many > 0 : many ? VIRGA_LENS_TILE_KINDS : VIRGA_LENS_TILES_SHARP;
    if (!kinds)
        return leave_as_it_is(lens, to);
    if (seen->tiles)
        return draw_all_tiles(lens, to, many);
    const virga_pipeline *const *pipelines =
        seen->all_sharp ? pipelines_of(to, LENS_DRAW_LAYERS) + many - 1 : of_layers(to, LENS_DRAW_TILES, many);
    result = virga_pipelines_ready(pipelines, kinds);
    if (result)
        return result;
    const virga_pass_scope scope = begin_draw(lens, to, lens_draws[LENS_DRAW_TILES].name);
    if (seen->all_sharp)
        draw_viewport(lens, to, *pipelines, 0);
    for (uint32_t kind = 0; kind < kinds && !seen->all_sharp; kind++)
        draw_tiles(lens, to, pipelines[kind], kind);
    virga_pass_end(lens->base.context, to->cmd, scope);
    return VIRGA_OK;
}

virga_result lens_draw(virga_lens *lens, VkCommandBuffer cmd, const virga_target *target, virga_prepared prepared,
                       const char *call)
{
    draw_call to = {call, cmd, target, prepared, NULL};
    return lens->def.in_place ? draw_in_place(lens, &to) : draw(lens, &to, LENS_DRAW_PICTURE, 0);
}

static virga_result draw_part(virga_lens *lens, const char *call, VkCommandBuffer cmd, const virga_target *target,
                              virga_prepared prepared, uint32_t part)
{
    const virga_log *log = &lens->base.context->log;
    if (lens->def.in_place)
        return virga_wrong_argument(log, "%s: expected a lens that has parts; lens_def.in_place is 1", call);
    const virga_result result = prepared ? virga_effect_find_view(&lens->base, call, prepared) : VIRGA_OK;
    if (result)
        return result;
    const uint32_t layers = lens->prepared[lens->base.slot].layers;
    if (part > layers)
        return virga_wrong_argument(log, "%s: expected up to %u, the layers of the prepare, got %u", call, layers,
                                    part);
    if (lens->settings.style == VIRGA_LENS_STYLE_PAPER)
        return virga_wrong_argument(log, "%s: expected the physical style; the paper's has no parts", call);
    draw_call to = {call, cmd, target, prepared, NULL};
    return draw(lens, &to, LENS_DRAW_PART, part);
}

virga_result virga_lens_draw_part(virga_lens *lens, VkCommandBuffer cmd, const virga_target *target, uint32_t part)
{
    return lens ? draw_part(lens, "virga_lens_draw_part", cmd, target, virga_effect_newest(&lens->base), part)
                : VIRGA_ERROR_INVALID;
}

virga_result virga_lens_draw_part_view(virga_lens *lens, VkCommandBuffer cmd, const virga_target *target,
                                       virga_prepared prepared, uint32_t part)
{
    return lens ? draw_part(lens, "virga_lens_draw_part_view", cmd, target, prepared, part) : VIRGA_ERROR_INVALID;
}
