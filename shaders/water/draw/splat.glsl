// splat.glsl - a splat: a surfel as it is drawn, an ellipse in the picture. Three texels:
//
//     center x, y, w   clip coordinates
//     facing           two half floats, see facing_of
//     first axis       clip coordinates x, y, w, per radius
//     weight, push     half floats: weight at its center; how much farther away the depth pass draws it, as a
//                      share of its distance
//     second axis      clip coordinates x, y, w, per radius
//     motion           two half floats, px
struct Splat {
    vec3 center, first, second;
    vec2 facing;
    float weight, push;
    vec2 motion;
};
