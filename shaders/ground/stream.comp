// stream.comp - finds where water runs around the middle of the ripple map, and what waves it has.
// One invocation per cell of that area, in blocks. Reads: cells, floors. Writes: streams, blocks with waves, the
// variance of slopes.
//
// Each layer of waves is a picture that is carried along. A place shows what was `moved_m` upstream of it when the
// layer began: the speed there, summed over the time since then. The speed changes a little from tick to tick, the sum
// of it does not, so nothing jitters.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "cells.glsl"
#include "rings.glsl"
#include "flow_average.glsl"
#include "streams.glsl"
#include "speed.glsl"
#include "stream.glsl"

#define BLOCK VIRGA_STREAM_BLOCK
layout(local_size_x = BLOCK * BLOCK) in;

#define MEAN_S 0.3 // time over which speed and depth are means
// Variance of slope from which on waves are drawn, and from which on all of them: 2.5 % and 10 % of 0.002, that of the
// rings of a heavy rain. Less is not seen among those.
#define SHOWN_FROM 5e-5
#define SHOWN_ALL  2e-4

// Octaves of less than 2 % of a cell's variance are left out, those of 5 % and more drawn as they are. Each costs the
// same time.
#define OCTAVE_FROM 0.02
#define OCTAVE_ALL  0.05

shared uint any_octaves;

// Ticks of this step.
uint new_ticks() { return tick.tick > 0u ? tick.tick_in_step + 1u : 0u; }

// What waves there are, and their variance of slope.
float make_waves(inout virga_stream_gpu stream, uint material)
{
    const float manning = 1.0 / tick.soils[min(material, uint(VIRGA_GROUND_MATERIALS - 1))].inv_manning;
    const float mean_m_s = MEAN_SHARE * length(vec2(stream.flow[0], stream.flow[1]));
    float variance = 0.0, drawn = 0.0, part[VIRGA_STREAM_OCTAVES];
    for (int i = 0; i < VIRGA_STREAM_OCTAVES; i++) {
        const StreamWave wave = stream_wave(i, stream.depth_m, mean_m_s, manning);
        const float k = stream_number(i), blur = k * 0.5 * tick.stream_texel_m;
        // along an axis
        variance += 0.5 * k * k * (wave.standing_m * wave.standing_m + wave.height_m * wave.height_m);
        // As the table of rings, it is smoothed by half a texel: shorter waves would alias.
        stream.standing_m[i] = wave.standing_m * exp(-0.5 * blur * blur);
        stream.height_m[i] = wave.height_m * exp(-0.5 * blur * blur);
        stream.turn_rad_s[i] = wave.turn_rad_s;
        part[i] = k * k * (stream.standing_m[i] * stream.standing_m[i] + stream.height_m[i] * stream.height_m[i]);
        drawn += part[i];
    }
    const float shown = smoothstep(SHOWN_FROM, SHOWN_ALL, variance);
    for (int i = 0; i < VIRGA_STREAM_OCTAVES; i++) {
        const float share = shown * smoothstep(OCTAVE_FROM, OCTAVE_ALL, part[i] / max(drawn, 1e-12));
        stream.standing_m[i] *= share;
        stream.height_m[i] *= share;
    }
    return variance * shown * shown;
}

void follow(inout virga_stream_gpu stream, ivec2 cell, vec2 flow, float depth_m)
{
    const uint ticks = new_ticks();
    // A saved state may hold anything: what is no number, or no speed, begins anew.
    const bool is_sound = abs(stream.flow[0]) + abs(stream.flow[1]) + abs(stream.depth_m) < 1e4;
    const bool is_new = !stream_is_of(stream, cell) || !is_sound;
    const float share = 1.0 - exp(-float(ticks) * tick.tick_s / MEAN_S);
    stream.cell = int[2](cell.x, cell.y);
    stream.depth_m = is_new ? depth_m : mix(stream.depth_m, depth_m, share);
    stream.flow[0] = is_new ? flow.x : mix(stream.flow[0], flow.x, share);
    stream.flow[1] = is_new ? flow.y : mix(stream.flow[1], flow.y, share);
    for (uint layer = 0u; layer < VIRGA_STREAM_LAYERS; layer++) {
        const uint age = stream_age(layer);
        const bool begins = is_new || age < ticks;
        const float s = float(begins ? age : ticks) * tick.tick_s;
        for (uint axis = 0u; axis < 2u; axis++) {
            const float before_m = begins ? 0.0 : stream.moved_m[2u * layer + axis];
            stream.moved_m[2u * layer + axis] = before_m + s * stream.flow[axis];
        }
    }
}

void main()
{
    const ivec2 block = ivec2(gl_WorkGroupID.xy), inside = ivec2(gl_LocalInvocationIndex % BLOCK,
                                                                 gl_LocalInvocationIndex / BLOCK);
    const ivec2 cell = ivec2(tick.stream_low[0], tick.stream_low[1]) + block * BLOCK + inside;
    const uint cell_index = index_of_cell(cell), index = stream_index(cell);
    if (gl_LocalInvocationIndex == 0u)
        any_octaves = 0u;
    barrier();
    float depth_m;
    uint material;
    const vec2 flow = speed_at(cell, depth_m, material) / MEAN_SHARE;
    virga_stream_gpu stream = streams[index];
    follow(stream, cell, flow, depth_m);
    const float variance = make_waves(stream, material);
    streams[index] = stream;
    uint octaves = 0u;
    for (int i = 0; i < VIRGA_STREAM_OCTAVES; i++)
        octaves |= uint(stream.standing_m[i] + stream.height_m[i] > 0.0) << i;
    if (octaves != 0u)
        atomicOr(any_octaves, octaves);
    // Beside the variance that drops bring, which map.comp calms: as much as it takes away from this in the step.
    if (cell_index != NO_CELL && variance > 0.0) {
        const float step_s = float(new_ticks()) * tick.tick_s;
        const float shown = variance * tick.stream_waves * tick.stream_waves;
        const float brought = shown * (exp(min(step_s / cell_calm_time(stream.depth_m), 10.0)) - 1.0);
        stirs[cell_index] += uint(min(brought * 1e6, 1e8));
    }
    barrier();
    if (gl_LocalInvocationIndex == 0u)
        streams_head.shown[gl_WorkGroupID.y * tick.stream_blocks + gl_WorkGroupID.x] = any_octaves;
}
