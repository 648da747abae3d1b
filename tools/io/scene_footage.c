/* scene_footage.c - keys of scene files that say what the pictures of a plate mean. */
#include "scene_footage.h"

#include "scene_rows.h"
#include "transfer.h"

static const scene_keyword curves[] = {
    {"auto", TRANSFER_AUTO},     {"linear", TRANSFER_LINEAR},   {"srgb", TRANSFER_SRGB},
    {"rec709", TRANSFER_REC709}, {"acescct", TRANSFER_ACESCCT}, {"cineon", TRANSFER_CINEON},
    {"logc3", TRANSFER_LOGC3},   {"slog3", TRANSFER_SLOG3},     {NULL, 0},
};

static const scene_row footage_rows[] = {
    CHOICE(scene_footage, curve, curves, "auto", RESTARTS,
           "transfer curve of the plate, undone before rain and done again after; auto: srgb, linear for floats"),
};
const scene_group scene_footage_group = SCENE_GROUP(scene_footage, footage_rows);
