// fog_map.comp - the fog map: which share of the glass droplets of fog cover, and how large they are. Its texels are
// those of the mist map. Blocks with fog get a quad to draw.
// One workgroup per block. Reads: fog, the surface. Writes: the fog map, index buffer, draw arguments.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "view.glsl"
#include "fog_cells.glsl"

layout(local_size_x = VIRGA_GLASS_MIST_BLOCK, local_size_y = VIRGA_GLASS_MIST_BLOCK) in;
layout(scalar, set = 0, binding = 2) readonly buffer Film { uint film[]; }; // nl of film, then pl of fog
layout(scalar, set = 0, binding = 4) readonly buffer Surface { uint surface[]; };
layout(scalar, set = 0, binding = 18) buffer Work
{
    virga_glass_work_gpu work;
    uint work_list[];
};
layout(scalar, set = 0, binding = 19) writeonly buffer Corners { uint corners[]; };
// red: cover; green: cover x radius (micrometres), so that filtering weights radii by what they cover
layout(set = 0, binding = 31, rgba16f) writeonly uniform image2D fog_map;

shared uint any_fog; // 1: there is fog, 2: with droplets that are seen

vec2 cell_fog(uvec2 cell)
{
    if (cell.x >= look.pane.columns || cell.y >= look.pane.rows)
        return vec2(0.0);
    const uint number = cell.x + cell.y * look.pane.columns, packed_cell = surface[number];
    const uint water = film[number + look.pane.columns * look.pane.rows];
    if (water == 0u || (packed_cell & 0x1000000u) == 0u)
        return vec2(0.0);
    const float affinity = (float(packed_cell & 0xffu) - 128.0) * (1.0 / 32.0);
    const Droplets fog = droplets_of(float(water) * look.fog_m_of_pl, look.fog_dense * exp(look.fog_uneven * affinity));
    return vec2(fog.cover, fog.cover * fog.radius * 1e6);
}

// As draw_block in mist.comp.
void draw_block(uvec2 block, uint list)
{
    const uint columns = look.mist_pitch / VIRGA_GLASS_MIST_BLOCK + 1u, first = block.x + block.y * columns;
    const uint indices[6] =
        uint[6](first, first + 1u, first + columns, first + columns, first + 1u, first + columns + 1u);
    const uint at = look.fog_offset + list * look.fog_indices + atomicAdd(work.fog[list].index_count, 6u);
    for (uint i = 0u; i < 6u; i++)
        corners[at + i] = indices[i];
}

void main()
{
    if (gl_LocalInvocationIndex == 0u)
        any_fog = 0u;
    barrier();
    if (gl_WorkGroupID.x == 0u && gl_LocalInvocationIndex < 2u) {
        work.fog[gl_LocalInvocationIndex].instance_count = 1u;
        work.fog[gl_LocalInvocationIndex].first_index = look.fog_offset + gl_LocalInvocationIndex * look.fog_indices;
    }
    const uint columns = look.mist_pitch / VIRGA_GLASS_MIST_BLOCK;
    const uvec2 block = uvec2(gl_WorkGroupID.x % columns, gl_WorkGroupID.x / columns);
    const uvec2 texel = block * VIRGA_GLASS_MIST_BLOCK + gl_LocalInvocationID.xy;
    vec2 sum = vec2(0.0);
    for (uint i = 0u; i < look.mist_cells * look.mist_cells; i++)
        sum += cell_fog(texel * look.mist_cells + uvec2(i % look.mist_cells, i / look.mist_cells));
    imageStore(fog_map, ivec2(texel), vec4(sum / float(look.mist_cells * look.mist_cells), 0.0, 1.0));
    if (sum.x > 0.0)
        atomicMax(any_fog, sum.y * 1e-6 > sum.x * look.fog_single_m ? 2u : 1u);
    barrier();
    if (gl_LocalInvocationIndex == 0u && any_fog != 0u)
        draw_block(block, any_fog - 1u);
}
