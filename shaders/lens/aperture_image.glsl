// aperture_image.glsl - what aperture.comp writes.
#ifndef APERTURE_IMAGE_GLSL
#define APERTURE_IMAGE_GLSL
layout(set = 0, binding = 2) uniform sampler2D aperture_image;
#endif
