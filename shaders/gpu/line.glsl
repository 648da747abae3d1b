// line.glsl - thin sprites drawn as lines instead of two triangles; rain/draw/streak.glsl says why. Include a view
// first.

// The dot product with (x, y, 1) of a pixel is its signed distance (px) from the line through `end` (normalised device
// coordinates) with the normal `side` (unit length, in pixels). A line's vertices can not hand on how far across it a
// pixel is, but this equation is the same for all of its pixels.
vec3 line_equation(vec2 end, vec2 side)
{
    const vec2 size = vec2(view.viewport[2], view.viewport[3]);
    return vec3(side, -dot(side, vec2(view.viewport[0], view.viewport[1]) + (0.5 * end + 0.5) * size));
}

// Whether a line between two ends (normalised device coordinates), longer by beyond_px at each end, lies inside the
// viewport by half a pixel. The device cuts a line off square where it leaves the viewport.
bool is_whole(vec2 head, vec2 tail, float beyond_px)
{
    const vec2 margin = (2.0 * beyond_px + 1.0) / vec2(view.viewport[2], view.viewport[3]);
    return all(lessThan(max(abs(head), abs(tail)) + margin, vec2(1.0)));
}
