/* picture.c - the beauty of a frame in the format and with the transfer curve of the plate that it was made over. */
#include "color_space.h"
#include "effect.h"
#include "frame/files.h"
#include "options.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const struct {
    const char *word;
    picture_format format;
} words[] = {
    {"png", {PICTURE_PNG, 8}},  {"png16", {PICTURE_PNG, 16}},  {"jpg", {PICTURE_JPEG, 8}},
    {"tif", {PICTURE_TIFF, 8}}, {"tif16", {PICTURE_TIFF, 16}}, {"tif32", {PICTURE_TIFF, 32}},
    {"none", {PICTURE_EXR, 0}},
};

bool frame_picture_parse(const char *word, const picture_format *plate, picture_format *to)
{
    *to = (picture_format){PICTURE_EXR, 0};
    const bool of_plate = plate && plate->kind != PICTURE_EXR;
    if (!word || !strcmp(word, "same")) {
        if (word && !of_plate)
            return options_complain("render", "--picture: 'same' needs a --plate of PNG, JPEG or TIFF");
        if (of_plate)
            *to = *plate;
        return true;
    }
    for (size_t i = 0; i < sizeof words / sizeof words[0]; i++)
        if (!strcmp(word, words[i].word)) {
            *to = words[i].format;
            return !to->bits || picture_has_codecs() ||
                   options_complain("render", "--picture: this program was built without OpenImageIO");
        }
    return options_complain("render", "--picture: expected same, png, png16, jpg, tif, tif16, tif32 or none, got '%s'",
                            word);
}

void frame_picture_path(const char *directory, picture_kind kind, uint32_t frame, char *path, size_t size)
{
    snprintf(path, size, "%s/picture.%04u.%s", directory, frame, picture_ending(kind));
}

bool frame_save_picture(const shot *s, const host_drawn *drawn, const char *path, uint64_t seed, picture_format format,
                        char *error, size_t error_size)
{
    const size_t pixels = (size_t)drawn->width * drawn->height;
    float *beauty = malloc(pixels * 4 * sizeof *beauty), *samples = malloc(pixels * 3 * sizeof *samples);
    uint8_t *changed = malloc(pixels);
    bool written = beauty && samples && changed;
    if (!written)
        host_fail(error, error_size, "no memory for a frame of %u x %u", drawn->width, drawn->height);
    if (written) {
        frame_compose(s, drawn, beauty);
        for (size_t i = 0; i < pixels; i++)
            changed[i] = memcmp(beauty + 4 * i, drawn->color + 4 * i, 3 * sizeof *beauty) != 0;
        if (s->color_space)
            color_space_to_code(s->color_space, beauty, pixels, 4);
        /* Wet ground and a lens change the plate itself. */
        picture_from_light(beauty, s->plate_ground || s->lens ? NULL : changed, pixels,
                           s->color_space ? TRANSFER_LINEAR : s->scene->footage.curve, format, seed, samples);
        written = picture_write(path, format, drawn->width, drawn->height, samples, error, error_size);
    }
    free(beauty);
    free(samples);
    free(changed);
    return written;
}

bool frame_write_picture(const shot *s, const host_drawn *drawn, const char *directory, uint32_t frame,
                         picture_format format, char *error, size_t error_size)
{
    char path[4096];
    frame_picture_path(directory, format.kind, frame, path, sizeof path);
    return frame_save_picture(s, drawn, path, (uint64_t)tool_seed(s->scene) << 32 | frame, format, error, error_size);
}
