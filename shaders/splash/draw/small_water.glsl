// small_water.glsl - what water shows that is too small for an image of its own: what is behind it, and what is above
// that, where the ground ends and what stands on it begins.
//
// A sprite of it is at most a few degrees wide, so all of it shows the same above. Where to look for that and what the
// environment is there are found at its vertices; the scene's picture may only be read by fragments.
#ifdef SMALL_WATER_OUT
#define SMALL_WATER flat out
#else
#define SMALL_WATER flat in
#endif

layout(location = 6) SMALL_WATER vec4 above_first;  // x, y: a pixel of the picture; z, w: another one
layout(location = 7) SMALL_WATER vec4 above_second; // x, y: a third one; z, w: shares of the first and the second
layout(location = 8) SMALL_WATER vec4 above_clear;  // rgb: of the environment, what none hides; w: share of the third
layout(location = 9) SMALL_WATER vec4 above_hidden; // rgb: what the scene hides where it is darker; w: its share
layout(location = 10) SMALL_WATER vec4 lit_torn;    // rgb: the light of lamps; w: how torn the water is

#ifdef SMALL_WATER_OUT

// Three heights of a direction over the horizon, and their shares of what is above.
const vec3 ABOVE_M = vec3(0.1, 0.3, 0.6), ABOVE_SHARES = vec3(0.4, 0.35, 0.25);

// `middle`: the sprite's, on the picture. `center`: its light under an open sky and of lamps.
void set_small_water(vec2 middle_ndc, vec3 center, float torn)
{
    const vec3 d = normalize(to_vec(view.right) * middle_ndc.x + to_vec(view.up) * middle_ndc.y + to_vec(view.ahead));
    const vec3 unlit = torn_light(environment(d, vec2(0.97, 0.90)), torn);
    const vec3 level = vec3(d.x, 0.0, d.z) * inversesqrt(max(dot(d.xz, d.xz), 1e-6));
    vec3 places[3], clear = vec3(0.0), hidden = vec3(0.0);
    float hides = 0.0;
    for (int i = 0; i < 3; i++) {
        const vec3 direction = level + vec3(0.0, ABOVE_M[i], 0.0), open = environment(direction, vec2(1.0));
        places[i] = place_of(direction);
        const float beside = ABOVE_SHARES[i] * (1.0 - places[i].z), sky = open_share(direction);
        clear += beside * sky * open;
        hidden += beside * (1.0 - sky) * open;
        hides += beside * (1.0 - sky);
        places[i].z *= ABOVE_SHARES[i];
    }
    above_first = vec4(places[0].xy, places[1].xy);
    above_second = vec4(places[2].xy, places[0].z, places[1].z);
    above_clear = vec4(clear, places[2].z);
    above_hidden = vec4(hidden, hides);
    lit_torn = vec4(max(center - unlit, vec3(0.0)), torn);
}

#else

// `open`: its light under an open sky, which is all that is known without a picture, and of lamps.
vec3 small_water(vec3 open)
{
    if (view.color_given == 0u)
        return open;
    vec3 behind = stored_at(gl_FragCoord.xy), first = stored_at(above_first.xy), second = stored_at(above_first.zw),
         third = stored_at(above_second.xy);
    host_colors(behind, first, second, third, view.color_given);
    const vec3 unlit = max(open - lit_torn.rgb, vec3(0.0));
    const vec3 above = above_clear.rgb + min(above_hidden.w * behind, above_hidden.rgb) + above_second.z * first +
                       above_second.w * second + above_clear.w * third;
    return mix(behind, min(above, 2.0 * unlit), 0.4 + 0.4 * lit_torn.w) + lit_torn.rgb;
}

#endif
