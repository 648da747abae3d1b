// line.glsl - what is drawn as a line in place of two triangles around it: rain/draw/streak.glsl says why. After a
// view.

// . (x, y, 1) of a pixel is how far (px) it is beside the line from an end (normalised device x, y), whose side (px) is
// of unit length. All pixels of a line across have the same inputs but for this.
vec3 line_equation(vec2 end, vec2 side)
{
    const vec2 size = vec2(view.viewport[2], view.viewport[3]);
    return vec3(side, -dot(side, vec2(view.viewport[0], view.viewport[1]) + (0.5 * end + 0.5) * size));
}

// Whether something between two ends (normalised device x, y) that reaches so many pixels beyond them is whole on the
// picture, by half a pixel: a line is cut off square where it leaves it.
bool is_whole(vec2 head, vec2 tail, float beyond_px)
{
    const vec2 margin = (2.0 * beyond_px + 1.0) / vec2(view.viewport[2], view.viewport[3]);
    return all(lessThan(max(abs(head), abs(tail)) + margin, vec2(1.0)));
}
