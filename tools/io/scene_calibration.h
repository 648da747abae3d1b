/* scene_calibration.h - camera.calibration from a file. Internal; for scene_file.c. */
#ifndef VIRGA_IO_SCENE_CALIBRATION_H
#define VIRGA_IO_SCENE_CALIBRATION_H

#include "scene_document.h"
#include "scene_file.h"

/* Whether the document, without defaults, has either a file or numbers. */
bool scene_calibration_check_keys(scene_document *document);

/* Reads the file, if one is named, into the numbers of the calibration, and checks these. */
bool scene_calibration_read(scene_file *scene, char *error, size_t error_size);

#endif
