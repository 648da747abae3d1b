/* scene_footage.c - keys of scene files that say what the pictures of a plate mean. */
#include "scene_footage.h"

#include "depth_map.h"
#include "scene_rows.h"
#include "transfer.h"

static const scene_keyword curves[] = {
    {"auto", TRANSFER_AUTO},     {"linear", TRANSFER_LINEAR},   {"srgb", TRANSFER_SRGB},
    {"rec709", TRANSFER_REC709}, {"acescct", TRANSFER_ACESCCT}, {"cineon", TRANSFER_CINEON},
    {"logc3", TRANSFER_LOGC3},   {"slog3", TRANSFER_SLOG3},     {NULL, 0},
};

static const scene_keyword depth_kinds[] = {
    {"axis", DEPTH_MAP_AXIS}, {"ray", DEPTH_MAP_RAY}, {"disparity", DEPTH_MAP_DISPARITY}, {NULL, 0}};

static const scene_keyword lights[] = {{"plate", SCENE_LIGHT_OF_PLATE}, {"scene", SCENE_LIGHT_OF_SCENE}, {NULL, 0}};

static const scene_keyword grounds[] = {{"none", SCENE_FOOTAGE_NO_GROUND},
                                        {"plane", SCENE_FOOTAGE_GROUND_PLANE},
                                        {"depth", SCENE_FOOTAGE_GROUND_DEPTH},
                                        {NULL, 0}};

static const scene_row footage_rows[] = {
    CHOICE(scene_footage, curve, curves, "auto", RESTARTS,
           "transfer curve of the plate, undone before rain and done again after; auto: srgb, linear for floats"),
    OPTIONAL_TEXT(scene_footage, color_space, 200, RESTARTS,
                  "in place of the curve: a color space of an OpenColorIO config, as the plate has it"),
    FILE_NAME(scene_footage, ocio_config, OPTIONAL, "that config; without it the one that OCIO names (environment)"),
    CHOICE(scene_footage, light, lights, "plate", RESTARTS,
           "what drops refract: plate (its first picture, mirrored all around, without environment.file) or scene"),
    NUMBER(scene_footage, depth_m, 0, MAX_METERS, "0", RESTARTS,
           "how far the plate is where --depth does not say it; 0: infinitely far"),
    CHOICE(scene_footage, depth_kind, depth_kinds, "axis", RESTARTS,
           "values of --depth: metres along the camera's axis, along each pixel's ray, or disparity in pixels"),
    NUMBER(scene_footage, depth_scale, 0, 1e6, "0", RESTARTS,
           "times the values of --depth; 0: 1 of floats, 1/256 of whole numbers as KITTI and Cityscapes have it"),
    CHOICE(scene_footage, ground, grounds, "none", RESTARTS,
           "where rain lands and wets the plate: plane (y = 0, see camera.height_m), depth (the points of --depth) or "
           "none; --ground-mask says what of the picture is ground"),
    NUMBER(scene_footage, disparity_base_m, 0, 1000, "0", RESTARTS,
           "distance of the two cameras (for depth_kind: disparity); Cityscapes: 0.2093"),
    NUMBER(scene_footage, disparity_focal_px, 0, 1e6, "0", RESTARTS,
           "focal length in pixels of the disparity's picture; Cityscapes: 2262.5"),
};
const scene_group scene_footage_group = SCENE_GROUP(scene_footage, footage_rows);

bool scene_footage_check(const scene_file *scene, char *error, size_t error_size)
{
    const scene_footage *footage = &scene->footage;
    if (footage->color_space && footage->curve != TRANSFER_AUTO)
        return scene_file_refuse(scene, "footage.curve", error, error_size,
                                 "expected auto, as footage.color_space is given");
    if (footage->ocio_config && !footage->color_space)
        return scene_file_refuse(scene, "footage.ocio_config", error, error_size,
                                 "expected footage.color_space with it");
    if (footage->depth_kind != DEPTH_MAP_DISPARITY)
        return true;
    if (!(footage->disparity_base_m > 0))
        return scene_file_refuse(scene, "footage.disparity_base_m", error, error_size,
                                 "expected more than 0, as footage.depth_kind is disparity");
    return footage->disparity_focal_px > 0 ||
           scene_file_refuse(scene, "footage.disparity_focal_px", error, error_size,
                             "expected more than 0, as footage.depth_kind is disparity");
}
