// paper.glsl - water as the paper shows it (Goto et al. 2009, section 5.4): the plate, displaced by the x and y of the
// normal in the picture.

// The height (m) of a density of 1, so that slopes do not depend on the resolution.
#define PAPER_RELIEF_M 0.005

// The pane's directions on the picture: parts to the right in xy, parts upwards in zw.
vec4 directions_on_picture(vec3 along_u, vec3 along_v)
{
    const vec3 u = normalize(along_u), v = normalize(along_v);
    const vec3 right = normalize(to_vec(view.right)), up = normalize(to_vec(view.up));
    return vec4(dot(u, right), dot(v, right), dot(u, up), dot(v, up));
}

// Where a pixel looks up the plate, by the slope of the density.
vec2 paper_pixel(vec2 pixel, vec2 slope, vec4 directions)
{
    const vec3 normal = normalize(vec3(-slope * PAPER_RELIEF_M, 1.0));
    const vec2 picture = vec2(dot(normal.xy, directions.xy), dot(normal.xy, directions.zw));
    return pixel - picture * threshold_shift.y * view_box.w;
}

// Texture coordinates; mirrored beyond the picture's borders.
vec2 paper_uv(vec2 pixel)
{
    const vec2 uv = (pixel - view_box.xy) / view_box.zw;
    return 1.0 - abs(1.0 - mod(uv, 2.0));
}
