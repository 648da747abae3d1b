// foam_splats.glsl - particles of foam as they are drawn, two texels each:
//
//     clip x, y, w        where it is when the shutter closes
//     streak              half floats, px: from where it was when the shutter opened
//     radius              px of the target; 0: nothing is drawn
//     red, green          half floats: radiance of what is covered
//     blue, coverage      half floats: in the center
//     motion              half floats, px
#define FOAM_TEXELS 2u

// A disc that moves while the shutter is open is drawn as a segment with half a disc at each end. A disc covers
// a (1 - q^4) at q radii from its center, see foam.frag: a (2 pi / 3) r^2 in all. With q from the nearest point of a
// segment it is (8 / 5) a r more for each length. The two ends are thus as much as ROUND radii of segment; the segment
// is shorter than the streak by that, so that its variance along its way is that of the streak. Shorter streaks are
// discs in the middle of their way.
#define ROUND 1.3089969

// What is left of its coverage with a streak of so many radii: all of it stays the same.
float kept_by_streak(float radii) { return min(1.0, ROUND / max(radii, 1e-6)); }
