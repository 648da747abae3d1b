// lens_edge.glsl - what the scene hides of a drop that is out of focus. The includer has gpu/scene_depth.glsl.
//
// Light of a drop at image position D with signed circle of confusion R comes to a pixel X through the point
// (X - D) / R of the aperture. On its way it passes the depth of an edge in front, whose circle is r, where the picture
// in focus shows X - r (X - D) / R = D + (1 - r / R) (X - D). So the scene's depth there says whether it is hidden: at
// the pixel where the edge is in focus, at the drop where both are equally far from the focus. In both cases the edge
// is as sharp as it should be. The circles are linear in 1 / depth, and only their ratio counts.
#define LENS_EDGE_DROPS 4 // positions of the drop on its path that cover the pixel

// The depth buffer at a pixel of the viewport, or the nearest one to it.
float depth_near(vec2 pixel)
{
    const vec2 first = vec2(view.viewport[0], view.viewport[1]), size = vec2(view.viewport[2], view.viewport[3]);
    return buffer_depth(clamp(pixel, first, first + size - 1.0));
}

// 1 / view depth (1/m); 0 for the background.
float inverse_depth(float stored, vec4 terms) { return stored == terms.z ? 0.0 : (terms.x + stored) / terms.y; }

// `at`: px from the middle line, and from the tail; `axes`: the directions in which these two grow. `terms` as in
// soft_edge.
float lens_edge(vec2 at, float half_width, float path_px, mat2 axes, float distance, vec4 terms)
{
    const float reach = sqrt(max(half_width * half_width - at.x * at.x, 0.0));
    const vec2 ends = clamp(vec2(at.y - reach, at.y + reach), 0.0, path_px);
    const float inverse_here = inverse_depth(depth_near(gl_FragCoord.xy), terms);
    float seen = 0.0;
    for (int i = 0; i < LENS_EDGE_DROPS; i++) {
        const float along = mix(ends.x, ends.y, (float(i) + 0.5) / float(LENS_EDGE_DROPS));
        const vec2 drop = gl_FragCoord.xy - axes * vec2(at.x, at.y - along);
        const float inverse = max(inverse_here, inverse_depth(depth_near(drop), terms));
        const float circles = inverse * distance > 1.0
                                  ? (view.inv_focus - inverse) / (view.inv_focus - 1.0 / distance) : 1.0;
        const float stored = depth_near(mix(drop, gl_FragCoord.xy, clamp(1.0 - circles, -3.0, 4.0)));
        seen += soft_step(stored == terms.z ? 1e9 : terms.y / (terms.x + stored) - distance, terms.w);
    }
    return seen / float(LENS_EDGE_DROPS);
}
