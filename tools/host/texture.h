/* texture.h - 8-bit textures of a mesh: decoding, mip levels made on the CPU, and the coverage of cut-outs. */
#ifndef VIRGA_HOST_TEXTURE_H
#define VIRGA_HOST_TEXTURE_H

#include "memory.h"

/* A texture with its mip levels one after another: RGBA, with sRGB-coded color. */
typedef struct host_picture {
    uint32_t width, height, levels;
    uint8_t *texels;
    size_t size; /* bytes of all levels */
    bool alpha;  /* some texel is not opaque */
    bool joints; /* its alpha is no alpha: see host_picture_add_joints */
} host_picture;

/* Decodes PNG, JPEG, BMP, TGA and other formats of stb_image, from memory or from a file, without mip levels. */
bool host_picture_decode(const void *data, size_t size, const char *what, host_picture *picture, char *error,
                         size_t error_size);
bool host_picture_read(const char *path, host_picture *picture, char *error, size_t error_size);

/* Copies RGBA bytes. */
bool host_picture_from_rgba(const uint8_t *rgba, uint32_t width, uint32_t height, host_picture *picture);

/* Makes an opaque picture with joints from one without and glTF's occlusion: instead of alpha it has the occlusion's
 * red, repeated or left out where the sizes differ. False: no memory. */
bool host_picture_add_joints(const host_picture *color, const host_picture *occlusion, host_picture *out);

/* Builds the mip levels. `cutoff` >= 0 is the alpha below which a texel is cut out. Each level then keeps the first
 * level's share of texels above it, so that foliage does not get thinner with distance. -1: no cut-out. */
bool host_picture_make_mips(host_picture *picture, float cutoff);

/* Alpha [0; 1] at a texture coordinate, nearest texel, repeated. */
float host_picture_alpha(const host_picture *picture, float u, float v);

/* Mean of each channel in [0; 1], as stored. */
void host_picture_mean(const host_picture *picture, float mean[4]);
/* Mean of red, green and blue of a picture in sRGB, linear, over what is not transparent. */
float host_picture_light(const host_picture *picture);

void host_picture_free(host_picture *picture);

/* Creates an image with all levels, in an sRGB format. */
bool host_picture_upload(host_device *device, const host_picture *picture, const char *name, host_image *image,
                         char *error, size_t error_size);

#endif
