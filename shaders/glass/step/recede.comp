// recede.comp - simulated water that stands against the pane takes up the film there. Where it has receded it leaves a
// film, as thick as its speed says (Landau and Levich 1942; Derjaguin 1943), or none.
// One workgroup per block of cells, once a step. Reads: what water does on cells. Writes: that, film, passed, counters.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "pane.glsl"
#include "counters.glsl"
#include "flood.glsl"

layout(local_size_x = VIRGA_GLASS_FILM_BLOCK, local_size_y = VIRGA_GLASS_FILM_BLOCK) in;

shared uint joined, left, any;

// Film (nl) that water leaves on a cell.
uint left_at(float speed_m_s, uint cell)
{
    if (speed_m_s < tick.left_from_m_s)
        return 0u;
    const float thickness = tick.left_m * pow(speed_m_s, 2.0 / 3.0);
    return round_randomly(thickness * tick.pane.cell_m * tick.pane.cell_m * 1e12,
                          virga_hash3(tick.pane.seed, tick.tick, cell));
}

// The new word of a cell that water reached in this step or before.
uint stand_or_recede(uint cell, uint word)
{
    const uint ticks = tick.tick_in_step + 1u, speed = word & ((1u << VIRGA_GLASS_SPEED) - 1u);
    const uint before = word << 2u >> (VIRGA_GLASS_SPEED + 2u);
    const uint since = flood_phase(word) == VIRGA_GLASS_REACHED ? 0u : before + ticks;
    if (since < tick.recede_ticks) {
        if (film[cell] != 0u)
            atomicAdd(joined, film[cell]);
        film[cell] = 0u;
        return VIRGA_GLASS_UNDER << VIRGA_GLASS_PHASE | since << VIRGA_GLASS_SPEED | speed;
    }
    const uint water = left_at(float(speed) * 0.001, cell);
    if (water == 0u)
        return 0u;
    film[cell] += water;
    mark_film(cell);
    passed[cell] = wetted_now();
    atomicAdd(left, water);
    return VIRGA_GLASS_BREAKS << VIRGA_GLASS_PHASE | (tick.tick & ((1u << VIRGA_GLASS_PHASE) - 1u));
}

void main()
{
    const uint block = gl_WorkGroupID.x, columns = film_block_counts().x;
    if (occupants[flood_flag(block)] == 0u)
        return;
    if (gl_LocalInvocationIndex == 0u)
        joined = left = any = 0u;
    barrier();
    const uvec2 at = uvec2(block % columns, block / columns) * VIRGA_GLASS_FILM_BLOCK + gl_LocalInvocationID.xy;
    if (at.x < tick.pane.columns && at.y < tick.pane.rows) {
        const uint cell = cell_number(ivec2(at));
        uint word = occupants[flood_word(cell)];
        if (flood_phase(word) >= VIRGA_GLASS_UNDER) {
            word = stand_or_recede(cell, word);
            occupants[flood_word(cell)] = word;
        }
        if (word != 0u)
            any = 1u;
    }
    barrier();
    if (gl_LocalInvocationIndex != 0u)
        return;
    count(VIRGA_GLASS_JOINED, joined);
    count(VIRGA_GLASS_TOUCHED, left);
    if (any == 0u)
        occupants[flood_flag(block)] = 0u;
}
