// directions.glsl - where the picture shows a direction from the camera, and how much of the environment is seen there.

// x, y: the pixel; z: how much it counts, less towards the picture's edges, 0 outside.
vec3 place_of(vec3 direction)
{
    const vec4 clip = to_mat(view.clip_from_rel) * vec4(direction, 0.0);
    const vec2 ndc = clip.xy / max(clip.w, 1e-4);
    const float inside = clip.w > 1e-4 ? clamp(8.0 - 8.0 * max(abs(ndc.x), abs(ndc.y)), 0.0, 1.0) : 0.0;
    const vec2 shown = clamp(ndc, vec2(-1.0), vec2(1.0)) * 0.5 + 0.5;
    return vec3(vec2(view.viewport[0], view.viewport[1]) + shown * vec2(view.viewport[2], view.viewport[3]), inside);
}

// Surroundings hide the environment below, at, and somewhat above the horizon.
float open_share(vec3 direction) { return smoothstep(-0.2, 0.4, direction.y); }
