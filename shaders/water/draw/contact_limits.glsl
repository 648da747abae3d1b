// contact_limits.glsl - where contact.glsl draws nothing anew.
#define MIN_PX       2.0 // of a spacing: nothing smaller is drawn anew
#define FAR_SPACINGS 8.0 // along the ray, to the scene: farther solids are not beside the surface
