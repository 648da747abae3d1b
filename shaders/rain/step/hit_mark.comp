// hit_mark.comp - marks the slots of which a drop may have met the pane in the newest step.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "rain/field.glsl"
#include "rain/compact.glsl"
#include "gpu/compact_mark.glsl"
#include "hit.glsl"

layout(local_size_x = VIRGA_RAIN_GROUP) in;

void main() { mark_pick(walk_of(slot_at(gl_GlobalInvocationID.x)).left ? FIRST_KIND : NOT_PICKED); }
