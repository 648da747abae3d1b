/* glass/glass_fog.c - condensation: what passes need to know of the air, the glass and breath, and the heater. */
#include "glass/glass_internal.h"

#include "core/settings.h"
#include "gpu/errors.h"
#include "gpu/record.h"
#include "gpu/state_check.h"
#include "gpu/timers.h"

#include <math.h>

#define PI    3.14159265358979323846
#define TURNS VIRGA_GLASS_FOG_TURNS
#define SITES \
    (VIRGA_GLASS_FILM_BLOCK / VIRGA_GLASS_FOG_SITE * (VIRGA_GLASS_FILM_BLOCK / VIRGA_GLASS_FOG_SITE)) /* in a block */

/* The share of glass that droplets cover once they merge. Beysens 1995, "The formation of dew", Atmospheric Research
 * 39: 0.55 for caps of every contact angle near 90 degrees and below, in experiments and in simulations. */
#define COVER 0.55

/* Vapour passes to the glass as heat does, so their coefficients are in a fixed ratio (Lewis' analogy, in Incropera and
 * DeWitt, "Fundamentals of heat and mass transfer", section 6.7): h_m = h / (rho c Le^(2/3)). Air at 20 degrees has rho
 * = 1.2 kg/m^3, c = 1005 J/(kg K), and Le = 0.85, the ratio of 2.12e-5 and 2.49e-5 m^2/s at which heat and vapour
 * spread. */
#define HEAT_OF_AIR (1.2 * 1005 * 0.8973)

/* Breath leaves the lungs saturated, at 34 degrees (Hoeppe 1981). A mouth of 3 cm that blows at 2 m/s has a Reynolds
 * number of 3750. A jet that meets a wall has, in its middle, Nu = 0.6 Re^(1/2) Pr^(2/5) = 32: 28 W/(m^2 K). */
#define BREATH_C      34.0
#define BREATH_W_M2_K 28.0

#define FOG_UNEVEN 0.8f /* where glass holds more water, more droplets begin: an estimate */

#define DIFFUSIVITY 4.8e-7 /* m^2/s, of heat in window glass: 1 W/(m K) / (2500 kg/m^3 x 840 J/(kg K)) */

uint32_t glass_fog_sites(const virga_glass_def *def)
{
    return def->condensation ? (uint32_t)(glass_film_blocks(def) + TURNS - 1) / TURNS * SITES : 0;
}

/* ---- breath */

virga_result virga_glass_breathe(virga_glass *glass, const virga_glass_breath *breath)
{
    if (!glass)
        return VIRGA_ERROR_INVALID;
    const virga_log *log = &glass->base.context->log;
    if (!breath)
        return virga_wrong_argument(log, "virga_glass_breathe: expected a breath, got NULL");
    if (!glass->def.condensation)
        return virga_wrong_argument(log, "virga_glass_breathe: expected a pane with glass_def.condensation");
    if (!(breath->start_s >= 0 && breath->start_s <= 1e9) || !(breath->duration_s > 0 && breath->duration_s <= 60))
        return virga_wrong_argument(log,
                                    "glass_breath: expected a start of 0 to 1e9 s and a duration of up to 60 s, "
                                    "got %g and %g",
                                    breath->start_s, (double)breath->duration_s);
    for (int axis = 0; axis < 2; axis++)
        if (!(fabsf(breath->position_m[axis]) <= 20))
            return virga_wrong_argument(log, "glass_breath.position_m: expected -20 to 20, got %g",
                                        (double)breath->position_m[axis]);
    if (!(breath->radius_m >= 0.001f && breath->radius_m <= 10) || !(breath->share >= 0 && breath->share <= 1))
        return virga_wrong_argument(log,
                                    "glass_breath: expected a radius of 0.001 to 10 m and a share of 0 to 1, "
                                    "got %g and %g",
                                    (double)breath->radius_m, (double)breath->share);
    if (glass->breath_count == VIRGA_GLASS_MAX_BREATHS)
        return virga_wrong_argument(log, "virga_glass_breathe: expected at most %d that have not ended",
                                    VIRGA_GLASS_MAX_BREATHS);
    virga_glass_breath *added = &glass->breaths[glass->breath_count++];
    *added = *breath;
    added->start_s = fmax(breath->start_s, virga_glass_time(glass));
    return VIRGA_OK;
}

/* Fills those that blow between two times, and forgets those that have ended by then. */
static void fill_breaths(virga_glass *glass, double from_s, double to_s, virga_glass_tick_gpu *tick)
{
    uint32_t kept = 0;
    tick->breath_count = 0;
    for (uint32_t i = 0; i < glass->breath_count; i++) {
        const virga_glass_breath breath = glass->breaths[i];
        const double begin_s = fmax(breath.start_s, from_s);
        const double end_s = fmin(breath.start_s + (double)breath.duration_s, to_s);
        if (end_s > begin_s) {
            const float radius_m = breath.radius_m;
            tick->breaths[tick->breath_count++] =
                (virga_glass_breath_gpu){.middle = {breath.position_m[0], breath.position_m[1]},
                                         .inv_radius2 = 1 / (radius_m * radius_m),
                                         .share = breath.share,
                                         .lasts = (float)((end_s - begin_s) / (to_s - from_s))};
        }
        /* Blocks whose turn is later see it in their own time. */
        if (breath.start_s + (double)breath.duration_s > from_s)
            glass->breaths[kept++] = breath;
    }
    glass->breath_count = kept;
}

/* ---- heater
 *
 * Glass of thickness d that loses heat at the rate h (both sides) and conducts it along v follows, with its rise T over
 * the unheated glass and the power P(v) of its wires,
 *
 *     rho c d dT/dt = k d d2T/dv2 - h T + P.
 *
 * With the time constant s = rho c d / h and the diffusivity D = k / (rho c) that is dT/dt = D d2T/dv2 - T / s + ...
 * Thin wires at the distance L have the power P0 (1 + 2 sum of cos(2 pi i x / L)), x from a wire. One that heats a
 * strip of the width b has these waves times sin(u) / u, u = pi i b / L; with b = L / 13 those from the 13th on are
 * small, and a sum without them has no ripples. Each wave decays on its own: with q = 1 + D s (2 pi i / L)^2 its time
 * constant is s / q, and its amplitude goes to 2 K sin(u) / (u q), where K = P0 / h is the mean rise in the end. The
 * mean has q = 1 and goes to K. */

static void advance_heater(virga_glass *glass, virga_glass_tick_gpu *tick)
{
    const virga_glass_condensation *c = &glass->settings.condensation;
    double *before_k = glass->heat_before_k + tick->tick % TURNS * VIRGA_GLASS_HEAT_WAVES;
    const double wave = c->heater_wires ? 2 * PI * c->heater_wires / (double)glass->def.height_m : 0;
    for (uint32_t i = 0; i < VIRGA_GLASS_HEAT_WAVES; i++) {
        const double q = 1 + DIFFUSIVITY * (double)c->heater_s * wave * wave * i * i;
        const double u = PI * i / VIRGA_GLASS_HEAT_WAVES, strip = i ? sin(u) / u : 1;
        const double goal = i == 0 ? (double)c->heater_k : c->heater_wires ? 2 * (double)c->heater_k * strip / q : 0;
        const double left = exp(-glass->def.tick_s * q / (double)c->heater_s);
        glass->heat_k[i] = goal + (glass->heat_k[i] - goal) * left;
        tick->heat_k[i] = (float)(0.5 * (glass->heat_k[i] + before_k[i])); /* the mean since then, nearly */
        before_k[i] = glass->heat_k[i];
    }
    tick->heat_wave = (float)wave;
    tick->heat_phase = (float)-PI; /* the first wire is half a distance above the lower edge */
}

/* ---- a tick */

/* As saturated_vapour in shaders/glass/step/vapour.glsl. */
static double saturated_vapour(double celsius)
{
    return 611.2 * exp(17.62 * celsius / (243.12 + celsius)) / (461.5 * (celsius + 273.15));
}

/* The mean thickness (m) at which droplets have this radius (m). Caps of the radius r that cover the share e hold e r
 * volume(1) / pi per area, where volume(1) is that of the cap with a base of 1 m. */
static double thickness_of(const virga_glass_settings *settings, double radius_m)
{
    return COVER * radius_m * glass_cap_volume(glass_rest_deg(settings)) / PI;
}

static void fill_amounts(const virga_glass *glass, double since_s, virga_glass_tick_gpu *tick)
{
    const virga_glass_condensation *c = &glass->settings.condensation;
    const double square_m2 = (double)glass->def.cell_m * (double)glass->def.cell_m, pl_of_m = square_m2 * 1e15;
    const double per_w = since_s / HEAT_OF_AIR / VIRGA_WATER_DENSITY * pl_of_m;
    tick->fog_pl = (float)((double)c->heat_w_m2_k * per_w);
    tick->breath_pl = (float)(BREATH_W_M2_K * per_w);
    tick->air_vapour = (float)((double)c->humidity * saturated_vapour((double)c->air_c));
    tick->breath_vapour = (float)saturated_vapour(BREATH_C);
    tick->glass_c = c->glass_c;
    tick->fog_drop_pl = (float)(thickness_of(&glass->settings, (double)c->drop_radius_mm * 1e-3) * pl_of_m);
    tick->fog_start_pl = (float)((double)c->start_um * 1e-6 * pl_of_m);
}

void glass_fill_fog(virga_glass *glass, virga_glass_tick_gpu *tick)
{
    const virga_glass_fog_side side = glass->settings.condensation.side;
    if (!glass->def.condensation)
        return;
    advance_heater(glass, tick);
    const double to_s = tick->tick * glass->def.tick_s;
    if (side == VIRGA_GLASS_FOG_NONE) {
        glass->fog_since = 0;
        fill_breaths(glass, to_s, to_s + glass->def.tick_s, tick);
        tick->breath_count = 0;
        return;
    }
    if (!glass->fog_since)
        glass->fog_since = tick->tick;
    /* A block had its last turn that many ticks ago, or condensation began since. */
    const uint32_t on = tick->tick - glass->fog_since + 1, since = on < TURNS ? on : TURNS;
    const double since_s = since * glass->def.tick_s;
    tick->fog_side = (uint32_t)side;
    tick->fog_groups = (uint32_t)(glass_film_blocks(&glass->def) + TURNS - 1) / TURNS;
    tick->fog_sites = side == VIRGA_GLASS_FOG_OUTSIDE ? glass_fog_sites(&glass->def) : 0;
    fill_amounts(glass, since_s, tick);
    fill_breaths(glass, to_s - since_s, to_s, tick);
}

/* ---- passes */

void glass_record_fog_begin(virga_glass *glass, VkCommandBuffer cmd)
{
    if (!glass->blades.fog_side || glass->fog_begun)
        return;
    glass->fog_begun = true;
    virga_dispatch_and_barrier(glass->base.context, cmd, glass->fog_begin,
                               virga_groups_of(glass->columns * glass->rows, VIRGA_GLASS_GROUP));
}

void glass_record_fog_grow(virga_glass *glass, VkCommandBuffer cmd)
{
    if (glass->blades.fog_side)
        virga_dispatch_and_barrier(glass->base.context, cmd, glass->fog_grow, glass->blades.fog_groups);
}

void glass_record_fog_take(virga_glass *glass, VkCommandBuffer cmd)
{
    virga_context *context = glass->base.context;
    if (glass->blades.fog_side != VIRGA_GLASS_FOG_OUTSIDE)
        return;
    const virga_pass_scope scope = virga_pass_begin(context, cmd, "glass.fog");
    virga_dispatch_indirect_and_barrier(context, cmd, glass->fog_claim, glass->state->buffer,
                                        offsetof(virga_glass_state_gpu, alive_groups));
    virga_dispatch_indirect_and_barrier(context, cmd, glass->fog_take, glass->state->buffer,
                                        offsetof(virga_glass_state_gpu, alive_groups));
    virga_pass_end(context, cmd, scope);
}

/* ---- pictures */

/* The far side of what is not glass is not seen. */
bool glass_shows_fog(const virga_glass_settings *settings)
{
    return settings->condensation.side == VIRGA_GLASS_FOG_OUTSIDE ||
           (settings->condensation.side == VIRGA_GLASS_FOG_INSIDE && !settings->opaque);
}

void glass_fill_fog_look(const virga_glass *glass, virga_glass_picture_gpu *look)
{
    if (!glass->def.condensation)
        return;
    look->fog_m_of_pl = 1e-15f / (glass->def.cell_m * glass->def.cell_m);
    look->fog_dense = glass->settings.condensation.droplets_per_mm2 * 1e6f;
    look->fog_uneven = FOG_UNEVEN * glass->settings.affinity;
    look->fog_offset = (uint32_t)glass_fog_offset(&glass->picture, &glass->def);
    look->fog_indices = 6 * look->max_blocks;
}

void glass_record_fog_map(virga_glass *glass, VkCommandBuffer cmd)
{
    const VkExtent2D size = glass->picture.mist_size;
    const uint32_t side = VIRGA_GLASS_MIST_BLOCK;
    if (!glass_shows_fog(&glass->settings))
        return;
    virga_context *context = glass->base.context;
    const virga_pass_scope scope = virga_pass_begin(context, cmd, "glass.fog_map");
    virga_wait(context, cmd, VIRGA_PASSES | VIRGA_ARGUMENTS, VIRGA_PASSES); /* passes over film read the same buffer */
    virga_dispatch(context, cmd, glass->picture.fog_map_pass,
                   virga_groups_of(size.width, side) * virga_groups_of(size.height, side));
    virga_indirect_barrier(context, cmd);
    virga_pass_end(context, cmd, scope);
}

/* ---- settings and state */

virga_result glass_check_condensation(const virga_glass *glass, const virga_glass_settings *settings)
{
    const virga_log *log = &glass->base.context->log;
    if (settings->condensation.side == VIRGA_GLASS_FOG_NONE)
        return VIRGA_OK;
    if (!glass->def.condensation)
        return virga_wrong_argument(log, "glass_settings.condensation.side: expected none for a pane without "
                                         "glass_def.condensation");
    /* Fog there is out of focus, as drops are: it only takes contrast away. */
    if (glass_is_front(settings))
        return virga_wrong_argument(log, "glass_settings.condensation.side: expected none with the style front, whose "
                                         "fog is `veil`");
    return VIRGA_OK;
}

void glass_check_fog_state(const virga_glass *glass, virga_state_check *check)
{
    const virga_glass_breath *breaths = virga_state_saved_row(check, &glass->breaths);
    const uint32_t count = VIRGA_STATE_SAVED(check, glass->breath_count);
    virga_state_expect(check, "glass.breath_count", count, 0, VIRGA_GLASS_MAX_BREATHS);
    for (uint32_t i = 0; i < count && !check->failed; i++) {
        virga_state_expect(check, "glass.breaths.start_s", breaths[i].start_s, 0, VIRGA_STATE_MAX_TICKS);
        virga_state_expect(check, "glass.breaths.duration_s", (double)breaths[i].duration_s, 0, 60);
        virga_state_expect(check, "glass.breaths.radius_m", (double)breaths[i].radius_m, 0.0009, 10);
        virga_state_expect(check, "glass.breaths.share", (double)breaths[i].share, 0, 1);
        for (int axis = 0; axis < 2; axis++)
            virga_state_expect(check, "glass.breaths.position_m", (double)breaths[i].position_m[axis], -20, 20);
    }
}
