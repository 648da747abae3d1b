// fluid.glsl - the buffers of the fluid. Passes after the sort work on sorted particles: neighbours lie side by side.
//
// Positions of sorted particles are in spacings, so that the kernel has no factors of its radius. `sorted` of the grid
// has the pressure behind them, with which the next iteration begins.
#define VIRGA_GLSL
#include "shared/fluid_gpu.h"
#define GRID_STEP virga_fluid_step_gpu
#include "particles/grid.glsl"
#include "gpu/texels.glsl"

layout(constant_id = 0) const uint FORM = 0u;
const bool WITH_BODIES = (FORM & VIRGA_FLUID_FORM_BODIES) != 0u;
const bool WITH_EXCHANGE = (FORM & VIRGA_FLUID_FORM_EXCHANGE) != 0u;

#ifndef STATE_ACCESS
#define STATE_ACCESS readonly
#endif
#ifndef FLUID_ACCESS
#define FLUID_ACCESS readonly
#endif

layout(scalar, set = 0, binding = 1) STATE_ACCESS buffer State { virga_fluid_state_gpu state; };

// For each slot: the pressure for the host, and that with which the next substep begins.
layout(std430, set = 0, binding = 8) FLUID_ACCESS buffer SlotPressures { vec2 slot_pressures[]; };

// For each sorted particle. Pressures are divided by the density of water (m^2/s^2).
// The pressure of the last iteration, and what only positions decide, see pairs.glsl:
layout(std430, set = 0, binding = 9) FLUID_ACCESS buffer Solved { vec2 solved[]; };
// Its velocity without pressure, and its density, which is 1 at rest:
layout(std430, set = 0, binding = 10) FLUID_ACCESS buffer Velocities { vec4 velocities[]; };
// The gradients of its neighbours, beside `lists`:
layout(std430, set = 0, binding = 11) FLUID_ACCESS buffer Gradients { uvec4 gradients[]; };
// Its velocity with pressure:
layout(std430, set = 0, binding = 12) FLUID_ACCESS buffer Moved { vec4 moved[]; };
// The gradient of the walls' part of its density, and alpha:
layout(std430, set = 0, binding = 13) FLUID_ACCESS buffer Walls { vec4 walls[]; };
// Its neighbours, four in a texel. Texel t of particle i is number t frame.stride + i.
layout(std430, set = 0, binding = 14) FLUID_ACCESS buffer Lists { uvec4 lists[]; };
TEXELS(place_texel, 15, 5)
TEXELS(velocity_texel, 16, 10)
TEXELS(gradient_texel, 17, 11)
TEXELS(moved_texel, 18, 12)
TEXELS(wall_texel, 19, 13)
TEXELS(list_texel, 20, 14)

vec4 place_at(uint i) { return uintBitsToFloat(place_texel(i)); }
vec4 moved_at(uint i) { return uintBitsToFloat(moved_texel(i)); }
