// own_view.glsl - in a pass of several views (multiview) a draw belongs to one of them, and is nowhere in the others. A
// vertex shader includes this right before its main, after a block with a member `view` that has multiview_index.
#ifdef MULTIVIEW
#extension GL_EXT_multiview : require

void draw_vertex();

void main()
{
    if (uint(gl_ViewIndex) == view.multiview_index)
        draw_vertex();
    else
        gl_Position = vec4(2.0, 2.0, 2.0, 1.0); // outside
}
#define main draw_vertex
#endif
