// contact_tiles.comp - the tiles of the picture in which there is water, and those of them in which it may be near a
// solid: there alone the draw looks for contact lines. Software Vulkan executes a branch for all pixels even if none
// takes it, so this is for software Vulkan.
// A workgroup looks at a square of VIRGA_WATER_WIDE_TILES x VIRGA_WATER_WIDE_TILES tiles, with LANES_EACH invocations
// for each. If all are of a kind, they are drawn as one. The order of the lists does not matter, as no pixel is drawn
// twice. Reads: sums, motion, thickness, the host's depth. Writes: tiles.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "view.glsl"
#define SCENE_DEPTH_BINDING 17
#define PIXEL_HERE vec2(0.0) // not used
#include "gpu/scene_depth.glsl"
#define SCALED false
#include "surface.glsl"
#include "contact_limits.glsl"
#define TILES_ACCESS
#include "tiles.glsl"

#define LANES_EACH 4
#define TILES_EACH (VIRGA_WATER_WIDE_TILES * VIRGA_WATER_WIDE_TILES)
#define EMPTY   0u
#define PLAIN   1u
#define CONTACT 2u
#define WET     0.52 // sums of weights above are water, see coverage_of
#define LEAST   1e-4 // and those below are none
#define AROUND  1.01 // factor of distances, for rounding

layout(local_size_x = TILES_EACH * LANES_EACH) in;

shared uint kinds[TILES_EACH];

// Whether contact.glsl may draw the surface anew at a pixel.
bool is_near_solid(ivec2 texel, vec4 sums)
{
    // The pixel of the target whose middle is in this one.
    const vec2 pixel = ceil(vec2(texel) + vec2(view.viewport[0], view.viewport[1]) - 0.5);
    const float stored = buffer_depth(pixel), scene = view_depth(stored), before = scene - sums.z / max(sums.w, 1e-12);
    const bool far = look.pixel_angle * scene * MIN_PX > AROUND * look.spacing_m;
    const bool deep = sums.w > WET && before > AROUND * FAR_SPACINGS * look.spacing_m;
    return stored != view.far_depth && !far && !deep;
}

uint kind_of_texel(ivec2 texel)
{
    const vec4 sums = texelFetch(sums_image, texel, 0);
    const bool is_water = sums.w > LEAST || texelFetch(motion_image, texel, 0).z > 0.0;
    return (is_water ? PLAIN : EMPTY) | (is_near_solid(texel, sums) ? CONTACT : EMPTY);
}

// Whether thickness_at is more than 0 anywhere in a tile.
bool has_thickness(ivec2 first, int lane)
{
    const ivec2 size = ivec2(look.volume_columns, look.volume_rows), begin = first / VIRGA_WATER_VOLUME_PX - 1;
    const int side = VIRGA_WATER_TILE_PX / VIRGA_WATER_VOLUME_PX + 2;
    bool found = false;
    for (int i = lane; i < side * side && !found; i += LANES_EACH)
        found = texel_of(thickness_image, begin + ivec2(i % side, i / side), size).r > 0.0;
    return found;
}

#define THICK 4u

uint kind_of_part(ivec2 first, int lane)
{
    const ivec2 size = ivec2(look.width, look.height);
    uint bits = has_thickness(first, lane) ? THICK : EMPTY;
    for (int i = lane; i < VIRGA_WATER_TILE_PX * VIRGA_WATER_TILE_PX; i += LANES_EACH) {
        const ivec2 texel = first + ivec2(i % VIRGA_WATER_TILE_PX, i / VIRGA_WATER_TILE_PX);
        if (all(lessThan(texel, size)))
            bits |= kind_of_texel(texel);
    }
    return bits;
}

uint kind_of(uint bits)
{
    return (bits & (CONTACT | THICK)) == (CONTACT | THICK) ? CONTACT : bits & PLAIN;
}

void add(uint kind, uvec2 tile, uint side)
{
    const uint word = tile.x | tile.y << 12 | side << 24;
    if (kind == PLAIN)
        tile_words[atomicAdd(tiles.plain_vertices, TILE_CORNERS) / TILE_CORNERS] = word;
    else if (kind == CONTACT)
        tile_words[first_contact_tile() + atomicAdd(tiles.contact_vertices, TILE_CORNERS) / TILE_CORNERS] = word;
}

void add_tiles(uvec2 square, uint index)
{
    const uint kind = kind_of(kinds[index]);
    uint alike = 0u;
    for (uint i = 0u; i < TILES_EACH; i++)
        alike += uint(kind_of(kinds[i]) == kind);
    const uvec2 first = square * VIRGA_WATER_WIDE_TILES,
                tile = first + uvec2(index % VIRGA_WATER_WIDE_TILES, index / VIRGA_WATER_WIDE_TILES);
    if (alike < TILES_EACH)
        add(kind, tile, 1u);
    else if (index == 0u)
        add(kind, first, VIRGA_WATER_WIDE_TILES);
}

void main()
{
    const uint lane = gl_LocalInvocationIndex, index = lane / LANES_EACH;
    const uvec2 square = gl_WorkGroupID.xy;
    if (lane < TILES_EACH)
        kinds[lane] = EMPTY;
    if (square == uvec2(0u) && lane == 0u) {
        tiles.plain_instances = tiles.contact_instances = 1u;
        tiles.plain_first_vertex = FIRST_CORNER;
        tiles.contact_first_vertex = FIRST_CORNER + TILE_CORNERS * first_contact_tile();
    }
    barrier();
    const uvec2 tile = square * VIRGA_WATER_WIDE_TILES +
                       uvec2(index % VIRGA_WATER_WIDE_TILES, index / VIRGA_WATER_WIDE_TILES);
    atomicOr(kinds[index], kind_of_part(ivec2(tile * VIRGA_WATER_TILE_PX), int(lane % LANES_EACH)));
    barrier();
    if (lane < TILES_EACH)
        add_tiles(square, lane);
}
