/* ground/ground_contacts.c - wheels and feet: checks them, and describes them to the passes of a tick. */
#include "ground/ground_internal.h"

#include "core/settings.h"
#include "gpu/checks.h"
#include "gpu/errors.h"
#include "gpu/record.h"
#include "gpu/timers.h"

#include <math.h>

_Static_assert(VIRGA_GROUND_MAX_CONTACTS == VIRGA_GROUND_CONTACTS, "the same number in the public header");

#define MARGIN_CELLS    3   /* around a patch: water is pushed into the second cell beside it */
#define MAX_SWEPT_CELLS 64  /* in a tick */
#define AT_REST_M_S     0.1 /* a slower contact points where its axle or its toe says */
#define PUSH_GROUP      64  /* invocations of contact_soak.comp */

virga_wheel virga_default_wheel(void)
{
    return (virga_wheel){
        .axle = {1, 0, 0}, .radius_m = 0.32f, .width_m = 0.19f, .patch_m = 0.12f, .slip = 0, .open_deg = 35};
}

virga_foot virga_default_foot(void)
{
    return (virga_foot){.heading = {0, 0, -1}, .length_m = 0.28f, .width_m = 0.1f};
}

/* ---- checks */

typedef struct field {
    const char *name;
    double value, low, high;
} field;

/* NaN is out of any range. */
static virga_result check_fields(const virga_log *log, const char *what, uint32_t index, const field *fields,
                                 uint32_t count)
{
    for (uint32_t i = 0; i < count; i++)
        if (!(fields[i].value >= fields[i].low && fields[i].value <= fields[i].high))
            return virga_wrong_argument(log, "%s[%u].%s: expected %g to %g, got %g", what, index, fields[i].name,
                                        fields[i].low, fields[i].high, fields[i].value);
    return VIRGA_OK;
}

static virga_result check_placed(const virga_log *log, const char *what, uint32_t index, const double at_m[3],
                                 const float velocity_m_s[3], const float direction[3], const char *direction_name)
{
    if (virga_settings_check_positions(log, what, at_m, 3) || virga_settings_check_finite(log, what, velocity_m_s, 3) ||
        virga_settings_check_finite(log, what, direction, 3))
        return VIRGA_ERROR_INVALID;
    for (int axis = 0; axis < 3; axis++)
        if (!(fabsf(velocity_m_s[axis]) <= VIRGA_MAX_SPEED_M_S))
            return virga_wrong_argument(log, "%s[%u].velocity_m_s: expected -1000 to 1000, got %g", what, index,
                                        (double)velocity_m_s[axis]);
    const double level = hypot((double)direction[0], (double)direction[2]);
    if (!(level > 0 && level > 1e-3 * fabs((double)direction[1])))
        return virga_wrong_argument(log, "%s[%u].%s: expected a direction that is not vertical", what, index,
                                    direction_name);
    return VIRGA_OK;
}

static virga_result check_wheel(const virga_log *log, uint32_t index, const virga_wheel *wheel)
{
    const field fields[] = {{"radius_m", (double)wheel->radius_m, 0.01f, 3},
                            {"width_m", (double)wheel->width_m, 0.01f, 2},
                            {"patch_m", (double)wheel->patch_m, 0.01f, 2},
                            {"slip", (double)wheel->slip, -1, 20},
                            {"open_deg", (double)wheel->open_deg, 0, 180}};
    const virga_result result = check_fields(log, "wheels", index, fields, VIRGA_ROWS(fields));
    return result ? result
                  : check_placed(log, "wheels", index, wheel->contact_m, wheel->velocity_m_s, wheel->axle, "axle");
}

static virga_result check_foot(const virga_log *log, uint32_t index, const virga_foot *foot)
{
    const field fields[] = {{"length_m", (double)foot->length_m, 0.01f, 2},
                            {"width_m", (double)foot->width_m, 0.01f, 2}};
    const virga_result result = check_fields(log, "feet", index, fields, VIRGA_ROWS(fields));
    return result ? result
                  : check_placed(log, "feet", index, foot->sole_m, foot->velocity_m_s, foot->heading, "heading");
}

virga_result ground_check_wheels_and_feet(const virga_log *log, const virga_wheel *wheels, uint32_t wheel_count,
                                          const virga_foot *feet, uint32_t foot_count)
{
    const uint64_t count = (uint64_t)wheel_count + foot_count;
    if (count > VIRGA_GROUND_MAX_CONTACTS || (wheel_count && !wheels) || (foot_count && !feet))
        return virga_wrong_argument(log, "wheels and feet: expected up to %d of them, got %u at %p and %u at %p",
                                    VIRGA_GROUND_MAX_CONTACTS, wheel_count, (const void *)wheels, foot_count,
                                    (const void *)feet);
    for (uint32_t i = 0; i < wheel_count; i++)
        if (check_wheel(log, i, &wheels[i]))
            return VIRGA_ERROR_INVALID;
    for (uint32_t i = 0; i < foot_count; i++)
        if (check_foot(log, i, &feet[i]))
            return VIRGA_ERROR_INVALID;
    return VIRGA_OK;
}

virga_result ground_contacts_check(const virga_ground *ground, const virga_ground_step_info *info)
{
    const virga_context *context = ground->base.context;
    const virga_log *log = &context->log;
    if (ground_check_wheels_and_feet(log, info->wheels, info->wheel_count, info->feet, info->foot_count))
        return VIRGA_ERROR_INVALID;
    if (virga_settings_check_positions(log, "step_info.handed_origin_m", info->handed_origin_m, 3))
        return VIRGA_ERROR_INVALID;
    if (!(info->handed_late_s >= 0 && info->handed_late_s <= 1))
        return virga_wrong_argument(log, "step_info.handed_late_s: expected 0 to 1, got %g",
                                    (double)info->handed_late_s);
    return info->handed ? virga_host_list_check(context, "step_info.handed", info->handed, info->handed_offset,
                                                info->handed_size, sizeof(virga_handed_droplets_gpu))
                        : VIRGA_OK;
}

/* ---- a tick */

typedef struct rectangle {
    double at_m[3]; /* middle at the end of the tick */
    double heading[2];
    double length_m, width_m;
} rectangle;

/* The rectangle around the patch whose sides are along and across its motion; the cells near it. */
static void place(const virga_ground *ground, const rectangle *patch, const float velocity_m_s[3],
                  virga_contact_gpu *out, uint32_t *cells)
{
    const double cell = (double)ground->def.cell_m, tile_m = VIRGA_GROUND_TILE * cell;
    const double speed = hypot((double)velocity_m_s[0], (double)velocity_m_s[2]);
    const bool moves = speed > AT_REST_M_S;
    const double ahead[2] = {moves ? (double)velocity_m_s[0] / speed : patch->heading[0],
                             moves ? (double)velocity_m_s[2] / speed : patch->heading[1]};
    const double c = fabs(ahead[0] * patch->heading[0] + ahead[1] * patch->heading[1]),
                 s = fabs(ahead[0] * patch->heading[1] - ahead[1] * patch->heading[0]);
    const double half[2] = {0.5 * (c * patch->length_m + s * patch->width_m),
                            0.5 * (s * patch->length_m + c * patch->width_m)};
    const double swept = moves ? fmin(speed * ground->def.tick_s, MAX_SWEPT_CELLS * cell) : 0;
    int32_t high[2];
    for (int axis = 0; axis < 2; axis++) {
        const double middle = patch->at_m[2 * axis] - 0.5 * swept * ahead[axis];
        const double reach = (half[0] + 0.5 * swept) * fabs(ahead[axis]) + half[1] * fabs(ahead[1 - axis]);
        /* Far from the window nothing is covered, and numbers of cells must fit. */
        const double low = ground->window.low[axis] * (double)VIRGA_GROUND_TILE, end = low + ground->def.cells;
        out->low[axis] = (int32_t)fmin(fmax(floor((middle - reach) / cell) - MARGIN_CELLS, low), end);
        high[axis] = (int32_t)fmin(fmax(floor((middle + reach) / cell) + MARGIN_CELLS + 1, low), end);
        out->middle[axis] = (float)(patch->at_m[2 * axis] - ground->window.low[axis] * tile_m);
        out->ahead[axis] = (float)ahead[axis];
        out->half_m[axis] = (float)half[axis];
    }
    out->width = (uint32_t)(high[0] - out->low[0]);
    *cells += out->width * (uint32_t)(high[1] - out->low[1]);
    out->end = *cells;
    out->swept_m = (float)swept;
    out->speed = (float)speed;
    out->height_m = (float)(patch->at_m[1] - ground->base_m);
}

static void fill_wheel(const virga_ground *ground, const virga_wheel *wheel, double before_s, virga_contact_gpu *out,
                       uint32_t *cells)
{
    const double axle = hypot((double)wheel->axle[0], (double)wheel->axle[2]);
    rectangle patch = {.heading = {-(double)wheel->axle[2] / axle, (double)wheel->axle[0] / axle},
                       .length_m = (double)wheel->patch_m,
                       .width_m = (double)wheel->width_m};
    for (int axis = 0; axis < 3; axis++)
        patch.at_m[axis] = wheel->contact_m[axis] - before_s * (double)wheel->velocity_m_s[axis];
    place(ground, &patch, wheel->velocity_m_s, out, cells);
    out->tread = out->speed * (1 + wheel->slip);
    out->radius_m = wheel->radius_m;
    out->open_rad = (float)((double)wheel->open_deg * M_PI / 180);
    out->id = wheel->id;
}

static void fill_foot(const virga_ground *ground, const virga_foot *foot, double before_s, virga_contact_gpu *out,
                      uint32_t *cells)
{
    const double toe = hypot((double)foot->heading[0], (double)foot->heading[2]);
    rectangle patch = {.heading = {(double)foot->heading[0] / toe, (double)foot->heading[2] / toe},
                       .length_m = (double)foot->length_m,
                       .width_m = (double)foot->width_m};
    for (int axis = 0; axis < 3; axis++)
        patch.at_m[axis] = foot->sole_m[axis] - before_s * (double)foot->velocity_m_s[axis];
    place(ground, &patch, foot->velocity_m_s, out, cells);
    out->press = fmaxf(-foot->velocity_m_s[1], 0);
    out->id = foot->id;
}

void ground_contacts_fill(const virga_ground *ground, virga_ground_tick_gpu *out)
{
    const virga_ground_step_info *info = &ground->info;
    const uint32_t left = info->ticks > ground->tick_in_step + 1 ? info->ticks - ground->tick_in_step - 1 : 0;
    const double before_s = left * ground->def.tick_s, tile_m = VIRGA_GROUND_TILE * (double)ground->def.cell_m;
    uint32_t cells = 0;
    for (uint32_t i = 0; i < info->wheel_count; i++)
        fill_wheel(ground, &info->wheels[i], before_s, &out->contacts[out->contact_count++], &cells);
    for (uint32_t i = 0; i < info->foot_count; i++)
        fill_foot(ground, &info->feet[i], before_s, &out->contacts[out->contact_count++], &cells);
    if (!info->handed)
        return;
    out->contact_droplets = ground->settings.contact_droplets;
    /* A droplet of a tick before the newest one has flown on when the list is read. */
    out->handed_late_s = info->handed_late_s + (float)before_s;
    for (int axis = 0; axis < 2; axis++)
        out->handed_offset[2 * axis] = (float)(info->handed_origin_m[2 * axis] - ground->window.low[axis] * tile_m);
    out->handed_offset[1] = (float)(info->handed_origin_m[1] - ground->base_m);
}

void ground_wakes_live(virga_ground *ground)
{
    ground->wakes_end = ground->ticks + 1 + (uint64_t)ceil(VIRGA_WAKE_LIFE_S / ground->def.tick_s);
}

void ground_contacts_record(virga_ground *ground, VkCommandBuffer cmd)
{
    virga_context *context = ground->base.context;
    const virga_ground_tick_gpu *tick = &ground->far.tick; /* the newest */
    const uint32_t cells = tick->contact_count ? tick->contacts[tick->contact_count - 1].end : 0;
    if (!cells)
        return;
    ground_wakes_live(ground);
    const virga_pass_scope scope = virga_pass_begin(context, cmd, "ground.contact");
    virga_dispatch_and_barrier(context, cmd, ground->contact, 1);
    virga_dispatch_and_barrier(context, cmd, ground->contact_soak, (cells + PUSH_GROUP - 1) / PUSH_GROUP);
    virga_pass_end(context, cmd, scope);
}
