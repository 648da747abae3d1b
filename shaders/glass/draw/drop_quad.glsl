// drop_quad.glsl - reads the quads that drop_quads.comp wrote.
layout(scalar, set = 0, binding = 19) readonly buffer Corners { uint corners[]; };

uint quad_word(uint quad, uint word)
{
    return corners[look.quads_offset + 3u * (look.pane.max_drops + 2u) + VIRGA_GLASS_QUAD_WORDS * quad + word];
}

float quad_float(uint quad, uint word) { return uintBitsToFloat(quad_word(quad, word)); }

vec4 quad_vec4(uint quad, uint word)
{
    return vec4(quad_float(quad, word), quad_float(quad, word + 1u), quad_float(quad, word + 2u),
                quad_float(quad, word + 3u));
}
