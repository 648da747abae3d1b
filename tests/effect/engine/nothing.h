/* nothing.h - an effect that exists in the tests only: it counts its ticks. One setting, one pass, one statistic. */
#ifndef VIRGA_TESTS_NOTHING_H
#define VIRGA_TESTS_NOTHING_H

#include <virga/scene.h>

typedef struct virga_nothing virga_nothing;

typedef struct virga_nothing_settings {
    uint32_t size, cookie;
    uint32_t weight; /* [0; 100] what each tick adds to the sum. Default 1 */
} virga_nothing_settings;

typedef struct virga_nothing_stats {
    uint64_t frame_index; /* that they are of; 0: none yet */
    uint32_t sum;         /* of the weights of all ticks */
} virga_nothing_stats;

virga_nothing_settings virga_default_nothing_settings(void);
virga_result virga_nothing_set(virga_nothing *nothing, const virga_nothing_settings *settings);
void virga_nothing_stats_get(virga_nothing *nothing, virga_nothing_stats *stats);

/* The one of a scene; owned by the scene. */
virga_nothing *virga_scene_nothing(virga_scene *scene);

#endif
