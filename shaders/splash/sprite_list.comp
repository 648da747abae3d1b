// sprite_list.comp - writes what a view sees into the list, each at its place.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#define VIRGA_GLSL
#include "shared/splash_gpu.h"
#include "compact.glsl"
#include "gpu/compact_list.glsl"

layout(local_size_x = VIRGA_SPLASH_GROUP) in;

void main() { list_pick(gl_GlobalInvocationID.x); }
