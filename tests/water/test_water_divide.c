/* Light by surfels, and their division (section 5 of Iwasaki et al. 2006), against double precision: a flat sheet over
 * a floor with waves of color. */
#include "water_sheet.h"

#include <virga/shared/compact.h>

#define SIDE      256
#define MAX_PARTS 200000
#define WAVE_M    0.08 /* of the floor's colors */

static shot s;
static host_buffer down;

static double contrast;

static void floor_color(double x, double z, double rgb[3])
{
    for (int c = 0; c < 3; c++)
        rgb[c] = 0.5 + (1 - 0.2 * c) * contrast * sin(2 * M_PI * (x + 0.3 * z) / WAVE_M);
}

static double floor_scene(const shot *of, const double eye[3], const double direction[3], double rgb[3])
{
    (void)of;
    const double distance = direction[1] < -1e-3 ? (SHEET_FLOOR_M - eye[1]) / direction[1] : INFINITY;
    floor_color(eye[0] + distance * direction[0], eye[2] + distance * direction[2], rgb);
    return distance;
}

/* What a prepare has left. */
static const uint32_t *listed, *divisions;
static const virga_water_prepared_gpu *prepared;
static const float (*parts)[4];
static uint32_t list_count;

static void open_shot(uint32_t max_parts)
{
    const double at[3] = {0.05, 0.45, 0.3}, to[3] = {0, 0, -0.02};
    virga_water_def def = water_fixture_def();
    def.max_width = def.max_height = SIDE;
    def.max_surfels = 16384;
    def.max_parts = max_parts;
    shot_open_with(&s, &def, SIDE, SIDE, false);
    const water_picture *picture = &s.f.water->picture;
    REQUIRE(host_buffer_create(&s.f.gpu.device,
                               picture->list->size + picture->divisions->size + picture->prepared->size +
                                   picture->parts->size + 1024,
                               VK_BUFFER_USAGE_TRANSFER_DST_BIT, HOST_BUFFER_READBACK, "parts down", &down,
                               s.f.gpu.error, sizeof s.f.gpu.error));
    s.scene = floor_scene;
    sheet_fill(&s);
    contrast = 0.3;
    s.f.settings.shading = VIRGA_WATER_SHADING_SURFELS;
    shot_aim(&s, at, to);
}

static void close_shot(void)
{
    host_buffer_destroy(&s.f.gpu.device, &down);
    shot_close(&s);
}

static void draw_and_read(void)
{
    const water_picture *picture = &s.f.water->picture;
    VkDeviceSize offset = 0;
    shot_draw(&s);
    const VkCommandBuffer cmd = effect_fixture_begin(&s.f.gpu, s.f.context);
    effect_fixture_transfers(cmd);
    const virga_list_gpu *head = effect_fixture_copy(cmd, picture->list->buffer, picture->list->size, &down, &offset);
    divisions = effect_fixture_copy(cmd, picture->divisions->buffer, picture->divisions->size, &down, &offset);
    prepared = effect_fixture_copy(cmd, picture->prepared->buffer, picture->prepared->size, &down, &offset);
    offset = (offset + 15) & ~(VkDeviceSize)15;
    parts = effect_fixture_copy(cmd, picture->parts->buffer, picture->parts->size, &down, &offset);
    effect_fixture_complete(&s.f.gpu, s.f.context);
    host_buffer_invalidate(&s.f.gpu.device, &down);
    list_count = head->count;
    listed = (const uint32_t *)(head + 1);
}

/* ---- in double precision */

/* Center of a node in radii of its surfel, and its own radius, from the surfel down. */
static void node_disc(uint32_t node, double disc[3])
{
    uint32_t path[8], depth = 0;
    for (uint32_t at = node; at; at = (at - 1) / 4)
        path[depth++] = (at - 1) % 4;
    disc[0] = disc[1] = 0;
    disc[2] = 1;
    while (depth) {
        const uint32_t part = path[--depth];
        disc[0] += disc[2] * (double)VIRGA_WATER_PART_OFFSET * (part & 1 ? 1 : -1);
        disc[1] += disc[2] * (double)VIRGA_WATER_PART_OFFSET * (part & 2 ? 1 : -1);
        disc[2] *= 0.5;
    }
}

/* A point of a disc whose normal is +Y, relative to the camera: the axes are (0, 0, -1) and (-1, 0, 0). */
static void disc_point(uint32_t surfel, const double at[2], double relative[3])
{
    float center[3];
    const double radius = 1.2 * SHEET_STEP_M * (double)s.f.settings.surfel_radius;
    sheet_position(surfel, center);
    relative[0] = (double)center[0] - radius * at[1] - s.camera.position_m[0];
    relative[1] = -s.camera.position_m[1];
    relative[2] = (double)center[2] - radius * at[0] - s.camera.position_m[2];
}

/* Mean color of a node, and how far its four colors are apart. */
static double node_color(uint32_t surfel, uint32_t node, double mean[3])
{
    double disc[3], low[3] = {1e9, 1e9, 1e9}, high[3] = {-1e9, -1e9, -1e9}, apart = 0, brightest = 0;
    node_disc(node, disc);
    memset(mean, 0, 3 * sizeof *mean);
    for (int part = 0; part < 4; part++) {
        double ray[3], rgb[3];
        const double at[2] = {disc[0] + disc[2] * (double)VIRGA_WATER_PART_OFFSET * (part & 1 ? 1 : -1),
                              disc[1] + disc[2] * (double)VIRGA_WATER_PART_OFFSET * (part & 2 ? 1 : -1)};
        disc_point(surfel, at, ray);
        sheet_seen(&s, ray, 1, floor_color, rgb);
        for (int c = 0; c < 3; c++) {
            mean[c] += rgb[c] / 4;
            low[c] = fmin(low[c], rgb[c]);
            high[c] = fmax(high[c], rgb[c]);
        }
    }
    for (int c = 0; c < 3; c++) {
        apart = fmax(apart, high[c] - low[c]);
        brightest = fmax(brightest, mean[c]);
    }
    return apart / brightest;
}

/* Whether all of a surfel is well inside the picture, where the host's picture is not cut off. */
static bool is_inside(uint32_t surfel)
{
    double p[3], x[2] = {0};
    disc_point(surfel, (const double[2]){0, 0}, p);
    const float *m = s.camera.view_from_world;
    const double depth = -((double)m[2] * p[0] + (double)m[6] * p[1] + (double)m[10] * p[2]);
    for (int i = 0; i < 2; i++)
        x[i] = ((double)m[i] * p[0] + (double)m[4 + i] * p[1] + (double)m[8 + i] * p[2]) / depth /
               tan(FOV_DEG * M_PI / 360);
    return depth > 0 && fabs(x[0]) < 0.7 && fabs(x[1]) < 0.7;
}

#define COLOR_ERROR      0.002
#define DIFFERENCE_ERROR 0.005 /* decisions that are nearer to the limit may be either */

typedef struct found {
    uint32_t checked, unsure, parts;
    uint32_t levels[4]; /* of what is not divided */
    double worst_color, worst_place;
} found;

/* The part of a node: its color, and where it is drawn. */
static void check_part(uint32_t surfel, uint32_t node, uint32_t part, found *f)
{
    double disc[3], mean[3], p[3];
    node_disc(node, disc);
    node_color(surfel, node, mean);
    disc_point(surfel, disc, p);
    const float *m = s.camera.view_from_world, (*texels)[4] = parts + 4 * (size_t)part;
    const double depth = -((double)m[2] * p[0] + (double)m[6] * p[1] + (double)m[10] * p[2]);
    for (int c = 0; c < 3; c++)
        f->worst_color = fmax(f->worst_color, fabs((double)texels[3][c] - mean[c]));
    f->worst_place = fmax(f->worst_place, fabs((double)texels[0][2] - depth));
    /* Its longer axis is level, so its length in clip coordinates is that on the sheet. */
    const double radius = 1.2 * SHEET_STEP_M * (double)s.f.settings.surfel_radius * disc[2];
    const double scale = (double)s.camera.clip_from_view[0];
    const double axis = hypot((double)texels[1][0], (double)texels[1][1]) / scale;
    const double toward = (double)texels[1][2];
    f->worst_place = fmax(f->worst_place, fabs(sqrt(axis * axis + toward * toward) - radius));
    f->levels[disc[2] > 0.9 ? 0 : disc[2] > 0.4 ? 1 : disc[2] > 0.2 ? 2 : 3]++;
    f->parts++;
}

static void check_surfel(uint32_t index, uint32_t first, found *f)
{
    const uint32_t surfel = listed[index], divided = divisions[2 * index];
    uint32_t part = first;
    for (uint32_t node = 0; node < 85; node++) {
        double mean[3];
        if (node && !(divided >> (node - 1) / 4 & 1))
            continue;
        const bool is_divided = node < 21 && divided >> node & 1;
        if (node < 21) {
            const double beyond = node_color(surfel, node, mean) - (double)s.f.settings.surfel_difference;
            f->unsure += fabs(beyond) < DIFFERENCE_ERROR;
            if (fabs(beyond) >= DIFFERENCE_ERROR && is_divided != (beyond > 0))
                fail_msg("surfel %u, node %u: is%s divided, and its colors differ by %g more than C_a", surfel, node,
                         is_divided ? "" : " not", beyond);
        }
        if (!is_divided)
            check_part(surfel, node, part++, f);
    }
    f->checked++;
}

static void surfels_are_divided_where_their_colors_differ(void **state)
{
    (void)state;
    found f = {0};
    uint32_t added = 0;
    open_shot(MAX_PARTS);
    s.f.settings.surfel_difference = 0.09f;
    draw_and_read();
    for (uint32_t i = 0; i < list_count; i++) {
        const uint32_t first = i + added;
        REQUIRE(divisions[2 * i + 1] == added);
        added += 3 * (uint32_t)__builtin_popcount(divisions[2 * i]);
        if (is_inside(listed[i]))
            check_surfel(i, first, &f);
    }
    printf("%u of %u surfels checked: %u, %u, %u and %u parts by level, %u decisions near the limit; colors off by up "
           "to %g, places by %g m\n",
           f.checked, list_count, f.levels[0], f.levels[1], f.levels[2], f.levels[3], f.unsure, f.worst_color,
           f.worst_place);
    REQUIRE(prepared->parts_added == added && prepared->part_vertices == 3 * (list_count + added));
    REQUIRE(f.checked > 300 && f.levels[0] > 50 && f.levels[1] > 50 && f.levels[2] > 50);
    REQUIRE(f.unsure < f.parts / 10);
    REQUIRE(f.worst_color < COLOR_ERROR);
    REQUIRE(f.worst_place < 1e-5);
    close_shot();
}

/* RMS of the picture's error against the light of each pixel. */
static double picture_error(void)
{
    double sum = 0;
    uint32_t compared = 0;
    shot_draw(&s);
    for (uint32_t y = SIDE / 8; y < SIDE * 7 / 8; y++)
        for (uint32_t x = SIDE / 8; x < SIDE * 7 / 8; x++) {
            double rgb[3];
            const float *pixel = shot_pixel(&s, x, y);
            if (!sheet_expected(&s, x, y, floor_color, rgb))
                continue;
            REQUIRE(pixel[3] > 0.99f);
            compared++;
            for (int c = 0; c < 3; c++)
                sum += pow((double)(pixel[c] / pixel[3]) - rgb[c], 2) / 3;
        }
    REQUIRE(compared > 10000);
    return sqrt(sum / compared);
}

static void division_makes_the_picture_sharper(void **state)
{
    (void)state;
    double errors[4];
    open_shot(MAX_PARTS);
    s.f.settings.surfel_difference = 0.05f;
    for (uint32_t i = 0; i < 4; i++) {
        s.f.settings.surfel_divisions = i;
        errors[i] = picture_error();
    }
    s.f.settings.shading = VIRGA_WATER_SHADING_PIXELS;
    printf("RMS error with 0 to 3 divisions: %.4f, %.4f, %.4f, %.4f; by pixels %.4f\n", errors[0], errors[1], errors[2],
           errors[3], picture_error());
    REQUIRE(errors[1] <= errors[0] && errors[2] < 0.6 * errors[0] && errors[3] < 0.3 * errors[0]);
    close_shot();
}

static void surfels_of_one_color_stay_whole(void **state)
{
    (void)state;
    open_shot(MAX_PARTS);
    contrast = 0;
    shot_make_scene(&s);
    draw_and_read();
    for (uint32_t i = 0; i < list_count; i++)
        if (is_inside(listed[i])) /* beyond the picture's border it is the environment that is seen */
            REQUIRE(divisions[2 * i] == 0);
    REQUIRE(list_count > 300);
    REQUIRE(picture_error() < 2e-3);
    close_shot();
}

static void without_room_surfels_stay_whole(void **state)
{
    (void)state;
    enum { ROOM = 1000 };
    uint32_t added = 0, whole = 0;
    open_shot(ROOM);
    s.f.settings.surfel_difference = 0;
    draw_and_read();
    for (uint32_t i = 0; i < list_count; i++) {
        const uint32_t own = 3 * (uint32_t)__builtin_popcount(divisions[2 * i]);
        if (divisions[2 * i + 1] + own <= ROOM)
            added = divisions[2 * i + 1] + own;
        else
            whole++;
    }
    REQUIRE(whole > 100 && added > ROOM - 200 && prepared->parts_added == added);
    REQUIRE(prepared->part_vertices == 3 * (list_count + added));
    picture_error(); /* no pixel is missing */
    close_shot();
}

static void without_parts_light_is_computed_in_pixels(void **state)
{
    (void)state;
    virga_water_def def = water_fixture_def();
    virga_water_settings settings = virga_default_water_settings();
    def.max_width = def.max_height = 64;
    shot_open_with(&s, &def, 64, 64, false);
    settings.shading = VIRGA_WATER_SHADING_SURFELS;
    assert_int_equal(virga_water_set(s.f.water, &settings), VIRGA_DEGRADED);
    virga_water_get(s.f.water, &settings);
    assert_int_equal(settings.shading, VIRGA_WATER_SHADING_PIXELS);
    shot_close(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(surfels_are_divided_where_their_colors_differ),
        cmocka_unit_test(division_makes_the_picture_sharper),
        cmocka_unit_test(surfels_of_one_color_stay_whole),
        cmocka_unit_test(without_room_surfels_stay_whole),
        cmocka_unit_test(without_parts_light_is_computed_in_pixels),
    };
    return effect_fixture_close(cmocka_run_group_tests(tests, NULL, NULL));
}
