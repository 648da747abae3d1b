/* test_rain_subframes.c - a picture averaged from views with parts of the shutter has as much rain as one view. */
#include "rain_picture_fixture.h"

#define SHUTTER_S (1.0 / 48)

/* Mean coverage of a pixel over all views of one shutter. */
static double mean_coverage(shot *s, uint32_t sub_frames)
{
    double sum = 0;
    s->sub_frames = sub_frames;
    s->shutter_s = SHUTTER_S / sub_frames;
    for (uint32_t i = 0; i < sub_frames; i++) {
        s->frame_interval_s = s->shutter_s * i;
        sum += sum_of(s, draw_frame(s, 0), 3);
    }
    return sum / sub_frames / s->picture.width / s->picture.height;
}

/* Slots stand for many drops here, of which one view alone would show no more than a part. */
static void parts_of_a_shutter_cover_as_much_as_all_of_it(void **state)
{
    (void)state;
    static const float gains[] = {1, 6};
    static const uint32_t parts[] = {2, 7, 16};
    shot s;
    virga_rain_def def = virga_default_rain_def();
    def.max_drops = 8192;
    def.range_m = 24;
    def.occlusion_size = 0;
    open_shot_of(&s, &def, 50);
    add_picture(&s, 320, 240);
    aim_level(&s);
    draw_frame(&s, 0.2);
    for (int g = 0; g < 2; g++) {
        s.f.settings.streak_gain = gains[g];
        apply_settings(&s);
        const double one = mean_coverage(&s, 1);
        for (int i = 0; i < 3; i++) {
            const double many = mean_coverage(&s, parts[i]);
            printf("gain %g: one view covers %.5f, %u views %.5f\n", (double)gains[g], one, parts[i], many);
            assert_true(fabs(many / one - 1) < 0.02);
        }
    }
    close_shot(&s);
}

/* Height of a streak's lower end, seen by a level camera. */
static double head_height(const shot *s, const virga_streak_gpu *streak)
{
    return s->f.camera[1] -
           (double)streak->head[1] * (double)streak->distance[0] / fabs((double)s->camera.clip_from_view[5]);
}

/* Lengthened as they are where they have to cover more than all. */
static void longer_streaks_end_at_the_ground(void **state)
{
    (void)state;
    shot s;
    virga_rain_def def = virga_default_rain_def();
    def.max_drops = 8192;
    def.range_m = 24;
    open_shot_of(&s, &def, 50);
    rain_fixture_floor(&s.f);
    s.f.camera[1] = 0.4;
    add_picture(&s, 320, 240);
    s.f.settings.streak_gain = 6;
    apply_settings(&s);
    aim_level(&s);
    s.sub_frames = 16;
    s.shutter_s = SHUTTER_S / 16;
    const VkCommandBuffer cmd = rain_fixture_begin_frame(&s.f);
    REQUIRE(virga_rain_draw_occlusion(s.f.rain, cmd, s.f.camera, s.f.occluders, s.f.occluder_count) == VIRGA_OK);
    rain_fixture_record_step(&s.f, cmd, 0.2);
    draw_without_step(&s, cmd);
    uint32_t cut = 0, longer = 0;
    for (uint32_t i = 0; i < streak_count(&s); i++) {
        const virga_streak_gpu *streak = &streak_list(&s)[i];
        if (high_half(streak->width_alpha) <= 0)
            continue;
        const double height = head_height(&s, streak);
        assert_true(height > -0.01);
        cut += height < 0.01;
        /* The fastest drop falls 9.2 m/s. */
        const double way = ((double)streak->head[1] - (double)streak->tail[1]) * (double)streak->distance[0] /
                           fabs((double)s.camera.clip_from_view[5]);
        longer += way > 1.2 * 9.2 * s.shutter_s;
    }
    printf("%u of %u streaks are longer than a drop falls, %u end at the ground\n", longer, streak_count(&s), cut);
    assert_true(longer > 50 && cut > 0);
    close_shot(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(parts_of_a_shutter_cover_as_much_as_all_of_it),
        cmocka_unit_test(longer_streaks_end_at_the_ground),
    };
    return effect_fixture_close(cmocka_run_group_tests(tests, NULL, NULL));
}
