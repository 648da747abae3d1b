// streak_form.glsl - what a pipeline of streaks is specialised for.
layout(constant_id = 0) const uint STREAKS = VIRGA_RAIN_STREAKS_DEPTH;
const bool HAS_DEPTH = (STREAKS & VIRGA_RAIN_STREAKS_DEPTH) != 0u, LINES = (STREAKS & VIRGA_RAIN_STREAKS_LINES) != 0u,
           HAS_LENS = (STREAKS & VIRGA_RAIN_STREAKS_LENS) != 0u;
