// pixels.glsl - the pixels of the picture that make up a texel of the work image: one, or four at half resolution.
ivec2 pixel_of(ivec2 texel, uint i)
{
    const ivec2 inside = min(texel * int(STEP) + ivec2(i & 1u, i >> 1u), ivec2(view.width, view.height) - 1);
    return ivec2(view.left, view.top) + inside;
}

// The nearest texel of the work image.
ivec2 inside(ivec2 texel) { return clamp(texel, ivec2(0), ivec2(view.columns, view.rows) - 1); }
