// street_block.glsl - what a frame of the street needs; street_block of world.h is the same in C.
layout(set = 0, binding = 0, std140) uniform street_block {
    mat4 clip_now;
    mat4 clip_before;  // a frame ago, with the jitter of now
    ivec2 low_cell;    // of the ground's window, see ground_map.glsl
    int cells;
    float cell_m;
    vec2 low_m;
    float base_m;
    float wetted;      // 0: there are no maps yet
    vec2 size_px;
} street;
