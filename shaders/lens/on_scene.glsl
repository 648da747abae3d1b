// on_scene.glsl - the layer that lies on the scene. The includer has lens.glsl and pixels.glsl.
layout(set = 0, binding = 26) uniform sampler2D on_scene;

// The mean of its pixels in a texel.
vec4 on_scene_mean(ivec2 texel)
{
    vec4 sum = vec4(0.0);
    for (uint i = 0u; i < STEP * STEP; i++)
        sum += finite(texelFetch(on_scene, pixel_of(texel, i), 0));
    return sum / float(STEP * STEP);
}
