/* mesh_material.c - materials of a model: factors, textures (inside the file or beside it), cut-outs and glass. */
#include <assimp/GltfMaterial.h>
#include <assimp/cimport.h>
#include <assimp/material.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "mesh_geometry.h"

/* ---- pictures ----------------------------------------------------------------------------------------------- */

/* A texture inside the file: by number ("*3") or by name. */
static const struct aiTexture *find_embedded(const struct aiScene *scene, const char *name)
{
    if (name[0] == '*') {
        unsigned long index = strtoul(name + 1, NULL, 10);
        return index < scene->mNumTextures ? scene->mTextures[index] : NULL;
    }
    for (uint32_t i = 0; i < scene->mNumTextures; i++)
        if (scene->mTextures[i]->mFilename.length && strcmp(scene->mTextures[i]->mFilename.data, name) == 0)
            return scene->mTextures[i];
    return NULL;
}

static bool decode_embedded(const struct aiTexture *texture, const char *what, host_picture *picture, char *error,
                            size_t error_size)
{
    if (texture->mHeight == 0)
        return host_picture_decode(texture->pcData, texture->mWidth, what, picture, error, error_size);
    size_t count = (size_t)texture->mWidth * texture->mHeight;
    uint8_t *rgba = malloc(count * 4 + 1);
    for (size_t i = 0; rgba && i < count; i++) {
        const struct aiTexel *t = &texture->pcData[i];
        const uint8_t texel[4] = {t->r, t->g, t->b, t->a};
        memcpy(&rgba[i * 4], texel, sizeof texel);
    }
    bool ok = rgba && host_picture_from_rgba(rgba, texture->mWidth, texture->mHeight, picture);
    free(rgba);
    return ok || host_fail(error, error_size, "%s: no memory for it", what);
}

/* The path of a texture beside the model. Backslashes come from other systems. */
static void resolve(const char *model, const char *name, char *path, size_t size)
{
    const char *slash = strrchr(model, '/');
    int folder = slash && name[0] != '/' ? (int)(slash - model) + 1 : 0;
    snprintf(path, size, "%.*s%s", folder, model, name);
    for (char *c = path + folder; *c; c++)
        if (*c == '\\')
            *c = '/';
}

static bool load_picture(host_mesh_build *build, const char *name, host_picture *picture)
{
    char path[4096], problem[1024];
    const struct aiTexture *embedded = find_embedded(build->scene, name);
    if (embedded) {
        snprintf(path, sizeof path, "%s: texture %s", build->path, name);
        if (decode_embedded(embedded, path, picture, problem, sizeof problem))
            return true;
    } else {
        resolve(build->path, name, path, sizeof path);
        if (host_picture_read(path, picture, problem, sizeof problem))
            return true;
    }
    host_warn(build->device, "%s; its material is drawn without it", problem);
    return false;
}

/* Index of the entry with this name, empty if it is new; -1 without memory. A failed texture keeps its entry, so that
 * there is only one warning. */
static int32_t add_picture(host_mesh_build *build, const char *name, bool *is_new)
{
    host_mesh *mesh = build->mesh;
    *is_new = false;
    for (uint32_t i = 0; i < mesh->texture_count; i++)
        if (strcmp(build->picture_keys[i], name) == 0)
            return (int32_t)i;
    host_picture *pictures = realloc(build->pictures, (mesh->texture_count + 1) * sizeof *pictures);
    if (!pictures)
        return -1;
    build->pictures = pictures;
    char **keys = realloc(build->picture_keys, (mesh->texture_count + 1) * sizeof *keys);
    if (!keys)
        return -1;
    build->picture_keys = keys;
    keys[mesh->texture_count] = strdup(name);
    if (!keys[mesh->texture_count])
        return -1;
    memset(&pictures[mesh->texture_count], 0, sizeof *pictures);
    *is_new = true;
    return (int32_t)mesh->texture_count++;
}

/* Index of the texture with this name, which is loaded on first use; -1 if that fails. */
static int32_t find_picture(host_mesh_build *build, const char *name)
{
    bool is_new;
    const int32_t index = add_picture(build, name, &is_new);
    if (index < 0)
        return -1;
    const bool good =
        is_new ? load_picture(build, name, &build->pictures[index]) : build->pictures[index].texels != NULL;
    return good ? index : -1;
}

static int32_t find_texture(host_mesh_build *build, const struct aiMaterial *in, enum aiTextureType type)
{
    struct aiString name;
    if (aiGetMaterialTexture(in, type, 0, &name, NULL, NULL, NULL, NULL, NULL, NULL) != aiReturn_SUCCESS ||
        name.length == 0)
        return -1;
    return find_picture(build, name.data);
}

/* ---- factors ------------------------------------------------------------------------------------------------ */

static float get_float(const struct aiMaterial *in, const char *key, unsigned type, unsigned index, float otherwise)
{
    float value = otherwise;
    if (aiGetMaterialFloatArray(in, key, type, index, &value, NULL) != aiReturn_SUCCESS || !isfinite(value))
        return otherwise;
    return value;
}

static bool get_color(const struct aiMaterial *in, const char *key, unsigned type, unsigned index, float color[4])
{
    struct aiColor4D value;
    if (aiGetMaterialColor(in, key, type, index, &value) != aiReturn_SUCCESS)
        return false;
    const float all[4] = {value.r, value.g, value.b, value.a};
    for (int c = 0; c < 4; c++)
        color[c] = isfinite(all[c]) && all[c] > 0.0f ? all[c] : 0.0f;
    return true;
}

static float clamp01(float value)
{
    return fminf(fmaxf(value, 0.0f), 1.0f);
}

static void read_emission(const host_mesh_build *build, const struct aiMaterial *in, host_material *out)
{
    float emissive[4] = {0.0f, 0.0f, 0.0f, 1.0f};
    get_color(in, AI_MATKEY_COLOR_EMISSIVE, emissive);
    /* What Assimp makes of a glTF file depends on its version: 5.2.5 reads no strength. */
    const float strength = build->gltf ? host_gltf_strength(build->gltf, build->device, out->name, emissive)
                                       : get_float(in, AI_MATKEY_EMISSIVE_INTENSITY, 1.0f);
    for (int c = 0; c < 3; c++)
        out->emissive[c] = emissive[c] * fmaxf(strength, 0.0f);
}

static void read_surface(const struct aiMaterial *in, host_material *out)
{
    float shininess = get_float(in, AI_MATKEY_SHININESS, 0.0f);
    /* Older files have a Phong exponent instead of a roughness. */
    float otherwise = shininess > 0.0f ? sqrtf(2.0f / (shininess + 2.0f)) : 0.9f;
    out->roughness = clamp01(get_float(in, AI_MATKEY_ROUGHNESS_FACTOR, otherwise));
    out->metallic = clamp01(get_float(in, AI_MATKEY_METALLIC_FACTOR, 0.0f));
    if (!get_color(in, AI_MATKEY_BASE_COLOR, out->base_color) &&
        !get_color(in, AI_MATKEY_COLOR_DIFFUSE, out->base_color))
        out->base_color[0] = out->base_color[1] = out->base_color[2] = 0.8f, out->base_color[3] = 1.0f;

    int two_sided = 1; /* glTF always has it; in formats without it, surfaces are two-sided */
    aiGetMaterialIntegerArray(in, AI_MATKEY_TWOSIDED, &two_sided, NULL);
    out->two_sided = two_sided != 0;
}

/* A blended material is a cut-out if its texture has alpha, and thin glass if all of it is transparent. */
static void read_alpha(const host_mesh_build *build, const struct aiMaterial *in, host_material *out)
{
    struct aiString mode = {0};
    bool picture_alpha = out->base_texture >= 0 && build->pictures[out->base_texture].alpha;
    bool has_mode = aiGetMaterialString(in, AI_MATKEY_GLTF_ALPHAMODE, &mode) == aiReturn_SUCCESS;
    float opacity = clamp01(get_float(in, AI_MATKEY_OPACITY, 1.0f)) * clamp01(out->base_color[3]);
    out->cutoff = get_float(in, AI_MATKEY_GLTF_ALPHACUTOFF, 0.5f);
    out->alpha = HOST_ALPHA_OPAQUE;
    if (has_mode && strcmp(mode.data, "OPAQUE") == 0)
        return;
    if (has_mode && strcmp(mode.data, "MASK") == 0) {
        out->alpha = picture_alpha ? HOST_ALPHA_MASK : HOST_ALPHA_OPAQUE;
    } else if (opacity < 0.99f) {
        out->alpha = build->device->independent_blend ? HOST_ALPHA_GLASS : HOST_ALPHA_OPAQUE;
        if (!has_mode)
            out->base_color[3] = opacity;
    } else if (picture_alpha) {
        out->alpha = HOST_ALPHA_MASK;
        out->cutoff = 0.5f;
    }
}

/* A texture of its own with the joints of a material whose texture has no alpha. Without memory it has no joints. An
 * occlusion texture is mostly what its name says, so the file has to say that it shows joints. */
static void read_joints(host_mesh_build *build, const struct aiMaterial *in, host_material *out)
{
    if (out->base_texture < 0 || out->alpha != HOST_ALPHA_OPAQUE || build->pictures[out->base_texture].alpha ||
        !host_gltf_has_joints(build->gltf, out->name))
        return;
    const int32_t occlusion = find_texture(build, in, aiTextureType_LIGHTMAP); /* Assimp's name for glTF's occlusion */
    if (occlusion < 0)
        return;
    char key[4096];
    snprintf(key, sizeof key, "%s with the joints of %s", build->picture_keys[out->base_texture],
             build->picture_keys[occlusion]);
    bool is_new;
    const int32_t both = add_picture(build, key, &is_new);
    if (both < 0 || (is_new && !host_picture_add_joints(&build->pictures[out->base_texture],
                                                        &build->pictures[occlusion], &build->pictures[both])))
        return;
    out->joints = build->pictures[both].texels != NULL;
    out->base_texture = out->joints ? both : out->base_texture;
    out->base_color[3] = out->joints ? 1 : out->base_color[3]; /* which an opaque material does not use */
}

static void read_material(host_mesh_build *build, const struct aiMaterial *in, host_material *out)
{
    struct aiString name = {0};
    memset(out, 0, sizeof *out);
    aiGetMaterialString(in, AI_MATKEY_NAME, &name);
    snprintf(out->name, sizeof out->name, "%.*s", (int)sizeof out->name - 1, name.data);
    read_surface(in, out);
    read_emission(build, in, out);
    out->passes = host_gltf_transmission(build->gltf, out->name);

    out->base_texture = find_texture(build, in, aiTextureType_BASE_COLOR);
    if (out->base_texture < 0)
        out->base_texture = find_texture(build, in, aiTextureType_DIFFUSE);
    out->sky_passes = out->passes * (out->base_color[0] + out->base_color[1] + out->base_color[2]) / 3;
    if (out->passes > 0 && out->base_texture >= 0)
        out->sky_passes *= host_picture_light(&build->pictures[out->base_texture]);
    out->emissive_texture = find_texture(build, in, aiTextureType_EMISSIVE);
    /* Roughness and metallic from a texture are its mean. Assimp has glTF's texture as "unknown". */
    int32_t packed = find_texture(build, in, aiTextureType_UNKNOWN);
    if (packed >= 0) {
        float mean[4];
        host_picture_mean(&build->pictures[packed], mean);
        out->roughness *= mean[1];
        out->metallic *= mean[2];
    }
    read_alpha(build, in, out);
    read_joints(build, in, out);
}

bool host_mesh_build_materials(host_mesh_build *build)
{
    host_mesh *mesh = build->mesh;
    uint32_t count = build->scene->mNumMaterials;
    mesh->materials = calloc(count + 1, sizeof *mesh->materials);
    if (!mesh->materials)
        return host_fail(build->error, build->error_size, "%s: out of memory", build->path);
    build->gltf = host_gltf_read(build->device, build->path);
    for (uint32_t i = 0; i < count; i++)
        read_material(build, build->scene->mMaterials[i], &mesh->materials[i]);
    host_gltf_free(build->gltf);
    build->gltf = NULL;
    if (count == 0) {
        mesh->materials[0] = (host_material){
            .name = "default",
            .base_color = {0.8f, 0.8f, 0.8f, 1.0f},
            .roughness = 0.9f,
            .base_texture = -1,
            .emissive_texture = -1,
        };
        count = 1;
    }
    mesh->material_count = count;
    return true;
}
