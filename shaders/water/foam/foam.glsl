// foam.glsl - foam: what the passes that make and move it share.
//
// The method is that of Ihmsen et al. 2012, "Unified spray, foam and air bubbles for particle-based fluids". Water that
// moves fast, and traps air or breaks as a wave, makes particles of foam. They move with the water and do not move it.
// They are no water: the air in it, and drops too fine to count.
//
// Particles of foam are slots of a pool. In each step a list is made of the slots in use, followed by the free ones,
// each in the order of slots; new particles take the first free ones. So the first state.foam entries of the list are
// all that there is.
#include "water/grid.glsl"
#include "water/state.glsl"
#include "shared/foam.h"
#include "shared/random.h"

layout(std430, set = 0, binding = 8) readonly buffer Densities { float densities[]; };
layout(scalar, set = 0, binding = 10) buffer Foam { virga_foam_gpu foam[]; };
// For each sorted particle: the normal of the surface, 0 inside the water; w: how fast neighbours come nearer (m/s).
layout(std430, set = 0, binding = 11) buffer Normals { vec4 normals[]; };
// For each sorted particle: how many particles of foam it makes; from which potential, as a float's bits; and after
// starts.comp which of the new particles is its first.
layout(std430, set = 0, binding = 12) buffer Emissions { uvec4 emissions[]; };

#define MAX_GAP_US 250000 // steps that are farther apart have nothing in common

// Time since the last step that the device has executed (s). A frame that the host has thrown away left no trace, so
// the step after it moves foam over both. Negative: the foam begins anew.
float foam_gap_s()
{
    const int gap = int(frame.foam_now_us - state.foam_clock_us);
    return state.foam_started != 0u && gap >= 0 && gap <= MAX_GAP_US ? float(gap) * 1e-6 : -1.0;
}

// Equation 1 of Ihmsen et al.: 0 below `low`, 1 above it by 1 / inv_range.
float clamped(float x, float low, float inv_range) { return clamp((x - low) * inv_range, 0.0, 1.0); }
