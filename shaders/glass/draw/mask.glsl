// mask.glsl - which texels of the height map are glass. The includer defines MASKED: whether there may be others.
layout(scalar, set = 0, binding = 4) readonly buffer Surface { uint surface[]; };

bool is_glass(ivec2 texel)
{
    if (!MASKED)
        return true;
    const vec2 at = (vec2(texel) + 0.5) * texel_m() / look.pane.cell_m;
    const uvec2 cell = uvec2(clamp(at, vec2(0.0), vec2(look.pane.columns, look.pane.rows) - 1.0));
    return (surface[cell.x + cell.y * look.pane.columns] & 0x1000000u) != 0u;
}
