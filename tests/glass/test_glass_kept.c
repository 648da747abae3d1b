/* test_glass_kept.c - tiles of the height map that show the same as in the view before are not written again, and what
 * is written is what a new map would be, to the bit. */
#include "glass_ball_fixture.h"

#define ROUNDS 24
#define DROPS  80

/* What a frame left. */
typedef struct frame {
    float *pixels, *relief; /* to be freed */
    size_t relief_bytes;
    virga_glass_work_gpu work;
    uint32_t tiles;
} frame;

static void open_kept(shot *s, virga_glass_style style)
{
    virga_glass_def def = shot_def();
    def.height_map = false; /* a host that reads the map gets all of it anew */
    shot_open(s, &def, WIDTH, HEIGHT, false);
    s->settings.style = style;
    s->settings.pinning = 0.5f;
    shot_face(s, 1, 30);
}

static void *copy_of(const void *bytes, size_t size)
{
    void *copy = malloc(size);
    REQUIRE(copy);
    return memcpy(copy, bytes, size);
}

/* Draws, and reads what the view's passes left. */
static frame draw_frame(shot *s)
{
    const struct glass_picture *picture = &s->glass->picture;
    frame f = {.relief_bytes = 16ull * picture->max_columns * picture->max_rows};
    host_buffer down = {0};
    VkCommandBuffer cmd;
    f.pixels = copy_of(shot_draw(s, false), 16ull * WIDTH * HEIGHT);
    REQUIRE(host_buffer_create(&s->gpu.device, f.relief_bytes + sizeof f.work, VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                               HOST_BUFFER_READBACK, "kept down", &down, s->gpu.error, sizeof s->gpu.error));
    shot_begin(s, &cmd);
    effect_fixture_transfers(cmd);
    const VkBufferImageCopy image = {.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
                                     .imageExtent = {picture->max_columns, picture->max_rows, 1}};
    const VkBufferCopy work = {0, f.relief_bytes, sizeof f.work};
    vkCmdCopyImageToBuffer(cmd, picture->relief->image, VK_IMAGE_LAYOUT_GENERAL, down.buffer, 1, &image);
    vkCmdCopyBuffer(cmd, picture->work->buffer, down.buffer, 1, &work);
    shot_submit(s);
    host_buffer_invalidate(&s->gpu.device, &down);
    f.relief = copy_of(down.mapped, f.relief_bytes);
    memcpy(&f.work, (const char *)down.mapped + f.relief_bytes, sizeof f.work);
    f.tiles = picture->columns / VIRGA_GLASS_TILE * (picture->rows / VIRGA_GLASS_TILE);
    host_buffer_destroy(&s->gpu.device, &down);
    return f;
}

static void free_frame(frame *f)
{
    free(f->pixels);
    free(f->relief);
}

/* A quarter of the drops have just landed. */
static void put_some_drops(shot *s, uint32_t *random)
{
    shot_forget(s);
    for (int i = 0; i < DROPS; i++) {
        const double u = random_in(random, -1e-3, 0.097), v = random_in(random, -1e-3, 0.065);
        virga_glass_drop_gpu *drop = shot_drop(s, u, v, shot_water(s, random_in(random, 2e-4, 3e-3)));
        if (i % 4 == 0)
            drop->age_s = (float)random_in(random, 0, 0.2);
    }
}

static void put_some_film(shot *s, uint32_t *random)
{
    const uint32_t columns = s->glass->columns;
    for (uint32_t i = 0; i < columns * s->glass->rows; i++)
        if (i % columns / 12 % 2 == 0) {
            s->film[i] = (uint32_t)random_in(random, 0, 200);
            s->passed[i] = s->glass->last_tick - (uint32_t)random_in(random, 0, 400);
        }
}

/* What may happen from one view to the next. */
static void change(shot *s, uint32_t round, uint32_t *random)
{
    virga_glass_drop_gpu *drop = &s->drops[(uint32_t)random_in(random, 0, DROPS)];
    const uint32_t cell = (uint32_t)random_in(random, 0, s->glass->columns * s->glass->rows);
    s->late_s = random_in(random, 0, s->glass->def.tick_s);
    switch (round % 6) {
    case 0: drop->water_nl += 1 + drop->water_nl / 5; break;
    case 1: drop->water_nl = 0; break;
    case 2: /* runs */
        drop->previous_position[1] += 4e-3f;
        drop->velocity[1] = -0.3f;
        drop->kind |= VIRGA_GLASS_RUNNING;
        break;
    case 3: /* film changes in ticks only */
        s->film[cell] = s->film[cell] ? 0 : 150;
        s->glass->last_tick++;
        break;
    case 4: s->glass->last_tick += 3; break;
    default: drop->position[0] = drop->previous_position[0] = (float)random_in(random, 0, 0.096); break;
    }
}

/* The next view of what is there, from the map of the views before, and from one that is all anew. */
static void compare_with_new(shot *s, uint32_t round, uint32_t *kept)
{
    frame from_kept = draw_frame(s);
    glass_picture_forget(s->glass);
    frame anew = draw_frame(s);
    if (memcmp(from_kept.relief, anew.relief, anew.relief_bytes))
        fail_msg("round %u: the relief is not that of a new map", round);
    if (memcmp(from_kept.pixels, anew.pixels, 16ull * WIDTH * HEIGHT))
        fail_msg("round %u: the picture is not that of a new map", round);
    *kept += from_kept.work.tiles + from_kept.work.film_tiles < anew.work.tiles + anew.work.film_tiles;
    free_frame(&from_kept);
    free_frame(&anew);
}

static void compare_rounds(virga_glass_style style, float pinning)
{
    shot s;
    uint32_t random = 3, kept = 0;
    open_kept(&s, style);
    s.settings.pinning = pinning;
    s.glass->last_tick += 1000;
    put_some_drops(&s, &random);
    put_some_film(&s, &random);
    for (uint32_t round = 0; round < ROUNDS; round++) {
        change(&s, round, &random);
        compare_with_new(&s, round, &kept);
    }
    REQUIRE(kept > ROUNDS / 2);
    shot_close(&s);
}

static void a_kept_map_is_that_of_a_new_one(void **state)
{
    (void)state;
    compare_rounds(VIRGA_GLASS_STYLE_PHYSICAL, 0.5f);
    compare_rounds(VIRGA_GLASS_STYLE_PHYSICAL, 0); /* balls end in their last tile, not beyond */
}

static void a_kept_map_of_the_paper_is_that_of_a_new_one(void **state)
{
    (void)state;
    compare_rounds(VIRGA_GLASS_STYLE_PAPER, 0.5f);
}

/* Settings and sizes that change the map change it all. */
static void settings_make_all_of_it_anew(void **state)
{
    (void)state;
    shot s;
    uint32_t random = 4, kept = 0;
    open_kept(&s, VIRGA_GLASS_STYLE_PHYSICAL);
    s.glass->last_tick += 1000;
    put_some_drops(&s, &random);
    put_some_film(&s, &random);
    virga_glass_settings *look = &s.settings;
    for (uint32_t i = 0; i < 9; i++) {
        switch (i) {
        case 1: look->threshold *= 1.2f; break;
        case 2: look->density = VIRGA_GLASS_DENSITY_WYVILL; break;
        case 3: look->pinning = 0; break;
        case 4: look->film_break_s *= 0.7f; break;
        case 5: look->compress_k *= 0.7f; break;
        case 6: look->compress = !look->compress; break;
        case 7: look->blend = VIRGA_GLASS_BLEND_WEIGHTED; break;
        case 8: shot_face(&s, 1, 3); break; /* from afar: a smaller map */
        default: break;
        }
        compare_with_new(&s, i, &kept);
    }
    shot_face(&s, 1, 30);
    compare_with_new(&s, 9, &kept);
    shot_close(&s);
}

static void a_mask_makes_all_of_it_anew_when_it_is_there(void **state)
{
    (void)state;
    shot s;
    uint32_t random = 4, kept = 0;
    open_kept(&s, VIRGA_GLASS_STYLE_PHYSICAL);
    put_some_drops(&s, &random);
    compare_with_new(&s, 0, &kept);
    uint8_t *mask = malloc((size_t)s.glass->columns * s.glass->rows);
    REQUIRE(mask);
    for (uint32_t i = 0; i < s.glass->columns * s.glass->rows; i++)
        mask[i] = i % s.glass->columns < s.glass->columns / 2;
    virga_glass_shape shape = virga_default_glass_shape();
    shape.mask = mask;
    REQUIRE(virga_glass_shape_set(s.glass, &shape) == VIRGA_OK);
    compare_with_new(&s, 1, &kept); /* not before the next step */
    shot_step(&s, 1);
    compare_with_new(&s, 2, &kept);
    free(mask);
    shot_close(&s);
}

/* Where nothing changes nothing is written, and where one drop does, only the tiles around it. */
static void only_what_changes_is_written(void **state)
{
    (void)state;
    shot s;
    uint32_t random = 7;
    open_kept(&s, VIRGA_GLASS_STYLE_PHYSICAL);
    s.glass->last_tick += 1000;
    put_some_drops(&s, &random);
    put_some_film(&s, &random);
    s.glass->last_tick += 1000; /* film has broken, drops have landed */
    for (uint32_t i = 0; i < s.drop_count; i++)
        s.drops[i].age_s = 100;
    frame first = draw_frame(&s), second = draw_frame(&s);
    s.drops[DROPS / 2].water_nl += 5;
    frame third = draw_frame(&s);
    assert_int_equal(first.work.tiles + first.work.film_tiles, first.tiles);
    assert_in_range(first.work.film_tiles, 1, first.tiles - 1);
    assert_int_equal(second.work.tiles + second.work.film_tiles + second.work.relief_tiles, 0);
    assert_int_equal(second.work.drops.index_count, first.work.drops.index_count);
    const uint32_t written = third.work.tiles + third.work.film_tiles;
    assert_in_range(written, 1, 16);
    assert_in_range(third.work.relief_tiles, 1, 36);
    free_frame(&first);
    free_frame(&second);
    free_frame(&third);
    shot_close(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_kept_map_is_that_of_a_new_one),
        cmocka_unit_test(a_kept_map_of_the_paper_is_that_of_a_new_one),
        cmocka_unit_test(settings_make_all_of_it_anew),
        cmocka_unit_test(a_mask_makes_all_of_it_anew_when_it_is_there),
        cmocka_unit_test(only_what_changes_is_written),
    };
    return effect_fixture_close(cmocka_run_group_tests(tests, NULL, NULL));
}
