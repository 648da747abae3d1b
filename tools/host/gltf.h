/* gltf.h - what Assimp does not read in a glTF file: the strength of emitted light, KHR_materials_emissive_strength,
 * light that comes through thin cloth, KHR_materials_diffuse_transmission, and that a material has joints. */
#ifndef VIRGA_HOST_GLTF_H
#define VIRGA_HOST_GLTF_H

#include "device.h"

typedef struct host_gltf host_gltf;

/* Reads the materials of a .gltf or .glb file. NULL, without a word, if the file is of another format; NULL with a
 * warning if its JSON cannot be read. */
host_gltf *host_gltf_read(const host_device *device, const char *path);

/* The strength, 1 or what the file says, of the material with this name and emissive factor: Assimp keeps no indices of
 * the file. If several materials have both and differ in strength, the first counts and the device is warned. Without
 * a file (NULL) it is 1. */
float host_gltf_strength(const host_gltf *gltf, const host_device *device, const char *name, const float factor[3]);

/* diffuseTransmissionFactor, [0; 1], of the first material with this name; 0 if it has none or without a file. Its
 * color is that of the base: color and textures of the extension are not read. */
float host_gltf_transmission(const host_gltf *gltf, const char *name);

/* Whether the first material with this name says in its `extras` that its occlusion texture is a map of joints:
 * "virga_joints": true. Without a file false. */
bool host_gltf_has_joints(const host_gltf *gltf, const char *name);

void host_gltf_free(host_gltf *gltf);

#endif
