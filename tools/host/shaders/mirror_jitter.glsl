// mirror_jitter.glsl - where the mirror's picture lies for this sub-frame: a jitter of pixels is one of half as many of
// its texels, which are twice as wide and more, and edges in it would stay stairs however many sub-frames are averaged.
// So it is moved by as many of its texels. After frame_gpu.h.

// In its clip space, right and down.
vec2 mirror_jitter()
{
    const vec2 texels = floor(0.5 * (frame.screen.xy + 1.0)); // as host_renderer_set_mirror has it
    return frame.screen.zw * (2.0 / texels - 2.0 * frame.mirror.y / frame.screen.xy);
}
