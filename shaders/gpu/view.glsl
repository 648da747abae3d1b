// view.glsl - positions in a view's picture. The includer has gpu/vectors.glsl and a block with a member
// `virga_view_gpu view`.

#define NEAR_W 0.01 // m; lines are clipped at this distance from the camera's plane

vec4 project(mat4 m, vec3 p) { return m * vec4(p, 1.0); }

// The motion (px) from a point's position on the picture now to that in the previous frame. 0 for what was behind the
// camera.
vec2 motion_px(vec4 now, vec4 before)
{
    if (now.w < NEAR_W || before.w < NEAR_W)
        return vec2(0.0);
    const vec2 moved = 0.5 * (before.xy / before.w - now.xy / now.w) * vec2(view.viewport[2], view.viewport[3]);
    return clamp(moved, vec2(-16384.0), vec2(16384.0)); // fits into half floats
}

// Clips the end `a` of a line (clip coordinates) at the near plane, if the other end is beyond it. The result lies
// exactly on the plane, however the device rounds.
void cut_at_near_plane(inout vec4 a, vec4 b)
{
    if (a.w < NEAR_W && b.w > NEAR_W)
        a = vec4(mix(a, b, (NEAR_W - a.w) / (b.w - a.w)).xyz, NEAR_W);
}

// The ray from the camera through a pixel, with a view depth of 1 m.
vec3 pixel_ray(vec2 pixel)
{
    const vec2 ndc = (pixel - vec2(view.viewport[0], view.viewport[1])) /
                         vec2(view.viewport[2], view.viewport[3]) * 2.0 - 1.0;
    return to_vec(view.right) * ndc.x + to_vec(view.up) * ndc.y + to_vec(view.ahead);
}
