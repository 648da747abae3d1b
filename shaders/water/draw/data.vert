// data.vert - a triangle that covers the view, for what data.frag writes.
// One invocation per corner. The number of the instance says what is written.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "view.glsl"

layout(location = 0) flat out uint what;

#include "gpu/own_view.glsl"

void main()
{
    const vec2 corner = vec2(gl_VertexIndex & 1, gl_VertexIndex >> 1);
    gl_Position = vec4(4.0 * corner - 1.0, 0.0, 1.0);
    what = uint(gl_InstanceIndex);
}
