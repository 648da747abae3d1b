// drop_cover.glsl - a pixel of a drop that is drawn as a quad.
layout(location = 0) in vec2 local; // these as in drop.vert
layout(location = 1) flat in vec4 tile;
layout(location = 2) flat in vec4 amount;
layout(location = 3) flat in uint quad;

bool is_point() { return amount.z != 0.0; }

// Alpha in the paper's equation 3, with a soft rim of one pixel. The corner of a point's pixels fades to 0.
float drop_cover()
{
    const vec2 near = max(1.0 - abs(local), vec2(0.0));
    const float radius = length(local), per_pixel = max(length(vec2(dFdx(radius), dFdy(radius))), 1e-6);
    const float rim = clamp((1.0 - radius) / per_pixel + 0.5, 0.0, 1.0);
    return amount.x * (is_point() ? near.x * near.y : rim);
}

bool is_behind_scene()
{
    if (!HAS_DEPTH)
        return false;
    const float stored = buffer_depth(gl_FragCoord.xy);
    return stored != view.far_depth && view_depth(stored) < 0.9999 / gl_FragCoord.w;
}
