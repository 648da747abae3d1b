// paper.glsl - the paper's way to show water (Goto et al. 2009, section 5.4): the plate, displaced by the
// normal's x and y, as they lie on the picture.

// Height (m) that a density of 1 stands for, so that its slopes do not depend on the resolution.
#define PAPER_RELIEF_M 0.005

// How far the pane's directions go to the right on the picture (x, y), and up (z, w).
vec4 ways_on_picture(vec3 along_u, vec3 along_v)
{
    const vec3 u = normalize(along_u), v = normalize(along_v);
    const vec3 right = normalize(to_vec(view.right)), up = normalize(to_vec(view.up));
    return vec4(dot(u, right), dot(v, right), dot(u, up), dot(v, up));
}

// Where a pixel has the plate looked up, by the density's slope.
vec2 paper_pixel(vec2 pixel, vec2 slope, vec4 ways)
{
    const vec3 normal = normalize(vec3(-slope * PAPER_RELIEF_M, 1.0));
    const vec2 picture = vec2(dot(normal.xy, ways.xy), dot(normal.xy, ways.zw));
    return pixel - picture * shown_by.y * view_box.w;
}

// Beyond the picture's borders it is looked up mirrored in them.
vec2 paper_uv(vec2 pixel)
{
    const vec2 uv = (pixel - view_box.xy) / view_box.zw;
    return 1.0 - abs(1.0 - mod(uv, 2.0));
}
