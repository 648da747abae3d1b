// foam_splats.glsl - particles of foam as they are drawn, two texels each:
//
//     clip x, y, z, w     of the center
//     radius              px of the target; 0: nothing is drawn
//     red, green          half floats: radiance of what is covered
//     blue, coverage      half floats: in the center
//     motion              half floats, px
#define FOAM_TEXELS 2u
