// splat_depth.frag - the depth of the nearest water, pushed back.
// One invocation per pixel of a splat. Writes: depth alone.
#version 460
layout(location = 0) in vec2 position;

void main()
{
    if (dot(position, position) > 1.0)
        discard;
}
