/* gltf.c - reads the JSON part of glTF files for what Assimp 5.2.5 leaves out. */
#include "gltf.h"

#include <jansson.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#define GLB_JSON_AT 20 /* bytes: the header of the file and that of its first chunk, which is JSON */

struct host_gltf {
    char *path;
    json_t *root;
};

/* Moves to where the JSON begins. False if the file is no glTF. */
static bool find_json(FILE *file, const char *path)
{
    char magic[4] = {0};
    const char *dot = strrchr(path, '.');
    if (fread(magic, 1, sizeof magic, file) == sizeof magic && memcmp(magic, "glTF", 4) == 0)
        return fseek(file, GLB_JSON_AT, SEEK_SET) == 0;
    return dot && strcasecmp(dot, ".gltf") == 0 && fseek(file, 0, SEEK_SET) == 0;
}

host_gltf *host_gltf_read(const host_device *device, const char *path)
{
    FILE *file = fopen(path, "rb");
    host_gltf *gltf = NULL;
    json_error_t error = {0};
    json_t *root = NULL;
    if (file && find_json(file, path)) {
        root = json_loadf(file, JSON_DISABLE_EOF_CHECK, &error); /* binary chunks follow in a .glb */
        if (!root)
            host_warn(device, "%s: line %d of its JSON: %s; the strength of emitted light is taken as 1", path,
                      error.line, error.text);
    }
    if (file)
        fclose(file);
    if (root)
        gltf = calloc(1, sizeof *gltf);
    if (!gltf) {
        json_decref(root);
        return NULL;
    }
    gltf->root = root;
    gltf->path = strdup(path);
    return gltf;
}

/* Compares with a tolerance, as Assimp rounds numbers in a way of its own. Without a factor it is black. */
static bool has_factor(const json_t *material, const float factor[3])
{
    const json_t *written = json_object_get(material, "emissiveFactor");
    for (size_t c = 0; c < 3; c++) {
        const double value = json_number_value(json_array_get(written, c)); /* 0 if it is none */
        if (fabs(value - factor[c]) > 1e-5 * fabs(value))
            return false;
    }
    return true;
}

static float strength_of(const json_t *material)
{
    const json_t *extension =
        json_object_get(json_object_get(material, "extensions"), "KHR_materials_emissive_strength");
    const json_t *strength = json_object_get(extension, "emissiveStrength");
    const float value = (float)json_number_value(strength);
    return json_is_number(strength) && isfinite(value) && value >= 0.0f ? value : 1.0f;
}

static bool is_called(const json_t *material, const char *name)
{
    const char *written = json_string_value(json_object_get(material, "name"));
    return strcmp(written ? written : "", name) == 0;
}

float host_gltf_strength(const host_gltf *gltf, const host_device *device, const char *name, const float factor[3])
{
    float strength = -1.0f;
    size_t i;
    const json_t *material;
    if (!gltf)
        return 1.0f;
    json_array_foreach(json_object_get(gltf->root, "materials"), i, material)
    {
        if (!is_called(material, name) || !has_factor(material, factor))
            continue;
        const float value = strength_of(material);
        if (strength >= 0.0f && value != strength) {
            host_warn(device, "%s: several materials are called \"%s\" and differ in emissiveStrength: %g is used",
                      gltf->path ? gltf->path : "", name, (double)strength);
            break;
        }
        strength = value;
    }
    return strength >= 0.0f ? strength : 1.0f;
}

/* The first material with this name; NULL: none, or no file. */
static const json_t *find_material(const host_gltf *gltf, const char *name)
{
    size_t i;
    const json_t *material;
    if (!gltf)
        return NULL;
    json_array_foreach(json_object_get(gltf->root, "materials"), i, material)
    {
        if (is_called(material, name))
            return material;
    }
    return NULL;
}

bool host_gltf_has_joints(const host_gltf *gltf, const char *name)
{
    return json_is_true(json_object_get(json_object_get(find_material(gltf, name), "extras"), "virga_joints"));
}

float host_gltf_transmission(const host_gltf *gltf, const char *name)
{
    const json_t *extension =
        json_object_get(json_object_get(find_material(gltf, name), "extensions"), "KHR_materials_diffuse_transmission");
    const double value = json_number_value(json_object_get(extension, "diffuseTransmissionFactor")); /* NULL: 0 */
    return isfinite(value) ? (float)fmin(fmax(value, 0), 1) : 0.0f;
}

void host_gltf_free(host_gltf *gltf)
{
    if (!gltf)
        return;
    json_decref(gltf->root);
    free(gltf->path);
    free(gltf);
}
