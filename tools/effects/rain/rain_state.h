/* rain_state.h - the rain of a shot: what the files of the effect `rain` share. */
#ifndef VIRGA_EFFECTS_RAIN_STATE_H
#define VIRGA_EFFECTS_RAIN_STATE_H

#include "effect.h"

typedef struct rain_state {
    virga_rain *rain;
    virga_rain_settings settings;
    virga_target *mirror; /* of the pass that draws haze over what puddles mirror; NULL where there is no mirror */
    virga_result mirror_result; /* of that, in the newest plate */
    shot_read drops;
} rain_state;

/* ---- bench.c */

extern const tool_bench rain_bench;

/* ---- view.c */

#define RAIN_VIEWS  1
#define RAIN_COUNTS 2

extern const tool_view rain_views[RAIN_VIEWS];
extern const tool_count rain_counts[RAIN_COUNTS];
uint64_t rain_water_nl(const void *state);

#endif
