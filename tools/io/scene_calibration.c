/* scene_calibration.c - camera.calibration from a file, in place of numbers in the scene. */
#include "scene_calibration.h"

#include "camera_calibration.h"
#include "scene_camera.h"

#include <stdio.h>
#include <string.h>

bool scene_calibration_check_keys(scene_document *document)
{
    static const char *const keys[] = {"size_px", "focal_px", "center_px", "distortion"};
    char path[64];
    const int file = scene_document_find(document, "camera.calibration.file");
    const int camera = scene_document_find(document, "camera.calibration.camera");
    if (!file || scene_document_is_null(document, file))
        return !camera || scene_document_is_null(document, camera) ||
               scene_document_fail(document, camera, "camera.calibration.camera: expected it with a file");
    for (size_t i = 0; i < sizeof keys / sizeof *keys; i++) {
        snprintf(path, sizeof path, "camera.calibration.%s", keys[i]);
        const int node = scene_document_find(document, path);
        if (node)
            return scene_document_fail(document, node, "%s: expected it without camera.calibration.file, which has it",
                                       path);
    }
    return true;
}

bool scene_calibration_read(scene_file *scene, char *error, size_t error_size)
{
    scene_calibration *to = &scene->camera.calibration;
    camera_calibration from;
    char reason[512];
    if (!to->file)
        return true;
    if (!camera_calibration_read(to->file, to->camera, &from, reason, sizeof reason))
        return scene_file_refuse(scene, "camera.calibration.file", error, error_size, "%s", reason);
    memcpy(to->size_px, from.size_px, sizeof to->size_px);
    memcpy(to->focal_px, from.focal_px, sizeof to->focal_px);
    memcpy(to->center_px, from.center_px, sizeof to->center_px);
    memcpy(to->distortion, from.distortion, sizeof to->distortion);
    to->right_m = from.right_m;
    return scene_camera_check_lens(scene, error, error_size);
}
