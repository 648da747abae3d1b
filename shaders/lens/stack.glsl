// stack.glsl - a pixel of the scene, and then the layers put over it one after the other, each before or behind what is
// out of focus in front. The includer has compose.glsl.
struct composed {
    vec4 color;   // so far
    vec4 near;    // the scene's near field
    float near_px;
    bool near_done; // it is in the color
    bool behind;    // see layer_cut
};

void put(uint layer, inout composed sum)
{
    if (ALL_SHARP) {
        sum.color = over(layer_at(layer, 0.0), sum.color);
        return;
    }
    if (!LAYER_IS_THERE(layer))
        return;
    float radius = 0.0; // where nothing is near and all is from the field, it changes nothing
    if (NEAR_IS_THERE || LAYER_IS_SEEN(layer))
        radius = layer_radius(layer);
    if (!sum.near_done && radius < sum.near_px) {
        sum.color = over(sum.near, sum.color);
        sum.near_done = true;
    }
    const vec4 cut = view.on_scene != 0u ? sum.near : vec4(0.0);
    sum.color = over(layer_cut(layer, radius, cut, sum.near_px, sum.behind), sum.color);
}

// The scene at the pixel that is looked at, or at another one, from its fields there.
composed begin_seen(vec4 behind, vec4 before)
{
    composed sum;
    scene_of(behind, before, sum.near, sum.color, sum.near_px);
    // What lies on the scene also lies on its near field, so the layers behind that field come after it, cut by it.
    sum.near_done = view.on_scene != 0u;
    sum.behind = true;
    if (sum.near_done)
        sum.color = over(sum.near, sum.color);
    return sum;
}

composed begin_pixel(uvec2 at, vec4 behind, vec4 before)
{
    look_at(min(at, uvec2(view.width, view.height) - 1u));
    return begin_seen(behind, before);
}

vec4 end_pixel(composed sum) { return sum.near_done ? sum.color : over(sum.near, sum.color); }
