// picture_film.comp - goes over the film of all cells: fine beads become mist, and tiles learn that they have film
// to show.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "picture.glsl"
#include "picture_tiles.glsl"
#include "picture_mist.glsl"
#include "picture_beads.glsl"

layout(local_size_x = VIRGA_GLASS_GROUP) in;

void show(uint number)
{
    const ivec2 cell = ivec2(number % look.pane.columns, number / look.pane.columns);
    const float fresh = film_fresh(number), broken_nl = float(film[number]) * (1.0 - fresh);
    bool shown = fresh > 0.0;
    for (uint i = 0u; i < BEADS; i++) {
        const vec3 bead = bead_of(cell, number, i, broken_nl);
        const float shape = shape_share(bead.z);
        if (shape < 1.0 && bead.z > 0.0)
            add_mist(bead.xy, bead.z, 1.0 - shape);
        shown = shown || shape > 0.0;
    }
    const float texel = max(look.texel_m[0], look.texel_m[1]);
    mark_tiles((vec2(cell) + 0.5) * look.pane.cell_m, (shown ? 1.6 : 0.4) * look.pane.cell_m + texel,
               shown ? VIRGA_GLASS_HAS_MIST | VIRGA_GLASS_HAS_FILM : VIRGA_GLASS_HAS_MIST);
}

void main()
{
    const uint number = gl_GlobalInvocationID.x;
    const uint cells = look.pane.columns * look.pane.rows;
    // Not by `&&`, that is a branch to software Vulkan, in which a read is one for each lane.
    const bool wet = number < cells, holds = film[min(number, cells - 1u)] != 0u;
    if (wet && holds)
        show(number);
}
