// swept.glsl - bars that move while the shutter is open, see ../swept.h.

// The share of the time for which a point is on the bar. How far it is to the side of the bar's middle, in half widths,
// goes from `side.x` to `side.y` as the shutter opens and closes, evenly: of that way, the part between -1 and 1. For a
// bar that turns by an angle a meanwhile this is right to a^2 / 24 of the way: 0.3 percent for 15 degrees.
float swept_share(vec2 side)
{
    const float low = min(side.x, side.y), high = max(side.x, side.y), way = high - low;
    const float inside = max(min(high, 1.0) - max(low, -1.0), 0.0);
    return way > 1e-3 ? inside / way : abs(low + high) <= 2.0 ? 1.0 : 0.0;
}
