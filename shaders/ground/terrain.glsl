// terrain.glsl - the ground at a position of a height map: its material and unevenness, which decides where puddles
// form, and whether it is level enough for puddles. Include cells.glsl before.
#include "shared/surface.glsl"

float knot(ivec2 at) { return virga_unit(virga_hash3(0x6b756d70u, uint(at.x), uint(at.y))) * 2.0 - 1.0; }

// Smooth noise between knots. Its standard deviation is about 0.43, and that of the three octaves below 1.18.
float noise(vec2 at)
{
    const ivec2 low = ivec2(floor(at));
    vec2 t = at - vec2(low);
    t = t * t * (3.0 - 2.0 * t);
    return mix(mix(knot(low), knot(low + ivec2(1, 0)), t.x), mix(knot(low + ivec2(0, 1)), knot(low + ivec2(1, 1)), t.x),
               t.y);
}

float bumps_um(ivec2 cell, virga_soil_gpu soil)
{
    if (soil.bumps_um <= 0.0)
        return 0.0;
    // Three octaves. Cells are counted modulo a large period, whose seam is 26 km away, so that floats stay precise far
    // from the origin.
    const vec2 at = vec2((cell + 0x80000) & 0xfffff) / soil.bump_cells;
    return soil.bumps_um * (2.4 * noise(at) + 1.2 * noise(2.0 * at + 17.3) + 0.6 * noise(4.0 * at + 5.1));
}

// The material of the mesh, or of the host's map there. A texel of the height map is this many cells wide.
uint material_of(usampler2D material_map, uint surface, ivec2 texel, float cells, vec2 offset)
{
    const uint mesh = min(surface_material(surface), uint(VIRGA_GROUND_MATERIALS - 1));
    const vec2 at = (vec2(texel) + 0.5) * cells * vec2(tick.material_scale[0], tick.material_scale[1]) + offset;
    // Written so that it is false for NaN, which a position in a map of size 0 is.
    if (!(all(greaterThanEqual(at, vec2(0.0))) && all(lessThan(at, vec2(1.0)))))
        return mesh;
    const uint mapped = texelFetch(material_map, ivec2(at * vec2(textureSize(material_map, 0))), 0).r;
    return mapped < VIRGA_GROUND_MATERIALS ? mapped : mesh;
}

// How much of its hollows can hold water: none on a slope that is steeper than its bumps, which rise by about two
// standard deviations over a bump's width.
float level_share(uint surface, virga_soil_gpu soil)
{
    const vec3 n = unpack_normal(surface);
    // over a bump's width
    const float slope_um = length(n.xz) / max(abs(n.y), 0.1) * soil.bump_cells * tick.cell_m * 1e6;
    return 1.0 - smoothstep(1.0, 5.0, slope_um / max(soil.bumps_um, 1.0));
}
