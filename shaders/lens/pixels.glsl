// pixels.glsl - the pixels of the picture that make up a texel of the work image: one, or four at half resolution.
ivec2 pixel_of(ivec2 texel, uint i)
{
#ifdef NOT_SPECIALISED
    const ivec2 first = texel * int(STEP);
#else
    const ivec2 first = texel << BY_SCALE(2, (HALVED ? 1 : 0)); // a product costs four times as much
#endif
    const ivec2 inside = min(first + ivec2(i & 1u, i >> 1u), ivec2(view.width, view.height) - 1);
    return ivec2(view.left, view.top) + inside;
}

// The nearest texel of the work image.
ivec2 inside(ivec2 texel) { return clamp(texel, ivec2(0), WORK_SIZE - 1); }
