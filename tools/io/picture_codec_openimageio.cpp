// picture_codec_openimageio.cpp - PNG, JPEG and TIFF through OpenImageIO, from and to memory: the module that
// picture_codec.c loads. No exception leaves this file.
#include "picture_codec_table.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <memory>
#include <string>
#include <vector>

namespace
{

const char *const names[PICTURE_KINDS] = {"openexr", "png", "jpeg", "tiff"};
const char *const people[PICTURE_KINDS] = {"EXR", "PNG", "JPEG", "TIFF"};

struct answer {
    char *reason;
    size_t size;

    // On one line.
    bool refuse(const std::string &text) const
    {
        std::snprintf(reason, size, "%s", text.empty() ? "the picture is damaged" : text.c_str());
        for (char *c = reason; *c; c++)
            if (*c == '\n' || *c == '\r')
                *c = *(c + 1) ? ' ' : '\0';
        return false;
    }
};

// OpenImageIO's reasons hardly distinguish a damaged file and a file of another format.
bool begins_as(picture_kind kind, const void *data, size_t size)
{
    const auto begins = [&](const char *with, size_t length) {
        return size >= length && std::memcmp(data, with, length) == 0;
    };
    switch (kind) {
    case PICTURE_PNG: return begins("\x89PNG\r\n\x1a\n", 8);
    case PICTURE_JPEG: return begins("\xff\xd8\xff", 3);
    default: return begins("II*\0", 4) || begins("MM\0*", 4) || begins("II+\0", 4) || begins("MM\0+", 4);
    }
}

// What is stored, in our three sizes of a sample.
uint32_t bits_of(OIIO::TypeDesc type)
{
    if (type == OIIO::TypeUInt8 || type == OIIO::TypeInt8)
        return 8;
    return type == OIIO::TypeUInt16 || type == OIIO::TypeInt16 ? 16 : 32;
}

// Keeps the first three channels of each pixel; of grey, the first three times. NaN becomes 0, infinity the largest
// half float.
void keep_rgb(const std::vector<float> &from, size_t channels, size_t pixels, float *rgb)
{
    const size_t step = channels >= 3 ? 1 : 0;
    for (size_t i = 0; i < pixels; i++)
        for (size_t c = 0; c < 3; c++) {
            const float value = from[i * channels + c * step];
            rgb[i * 3 + c] = value != value ? 0 : std::min(std::max(value, -65504.0f), 65504.0f);
        }
}

bool read_pixels(OIIO::ImageInput &input, picture *p, const answer &out)
{
    const OIIO::ImageSpec &spec = input.spec();
    if (spec.width < 1 || spec.height < 1 || spec.width > PICTURE_MAX_SIDE || spec.height > PICTURE_MAX_SIDE)
        return out.refuse(std::to_string(spec.width) + " x " + std::to_string(spec.height) +
                          " pixels, expected 1 to 16384 on each side");
    if (spec.nchannels < 1 || spec.depth > 1)
        return out.refuse("expected a flat picture");
    const size_t channels = static_cast<size_t>(std::min(spec.nchannels, 4));
    const size_t pixels = static_cast<size_t>(spec.width) * static_cast<size_t>(spec.height);
    std::vector<float> values(pixels * channels);
    if (!input.read_image(0, 0, 0, static_cast<int>(channels), OIIO::TypeFloat, values.data()))
        return out.refuse(input.geterror());
    p->rgb = static_cast<float *>(std::malloc(pixels * 3 * sizeof *p->rgb));
    if (!p->rgb)
        return out.refuse("no memory");
    keep_rgb(values, channels, pixels, p->rgb);
    p->width = static_cast<uint32_t>(spec.width);
    p->height = static_cast<uint32_t>(spec.height);
    p->channels = static_cast<uint32_t>(spec.nchannels);
    p->format.bits = bits_of(spec.format);
    return true;
}

OIIO::ImageSpec spec_of(picture_format format, uint32_t width, uint32_t height)
{
    const OIIO::TypeDesc type = format.bits == 8    ? OIIO::TypeUInt8
                                : format.bits == 16 ? OIIO::TypeUInt16
                                                    : OIIO::TypeFloat;
    OIIO::ImageSpec spec(static_cast<int>(width), static_cast<int>(height), 3, type);
    if (format.kind == PICTURE_JPEG) {
        spec.attribute("Compression", "jpeg:95");
        spec.attribute("jpeg:subsampling", "4:4:4");
    }
    if (format.kind == PICTURE_TIFF) {
        spec.attribute("compression", "zip");
        spec.attribute("DateTime", "1970:01:01 00:00:00"); // else the time of day, and no two files are the same
    }
    return spec;
}

bool write_pixels(OIIO::ImageOutput &output, const OIIO::ImageSpec &spec, const void *samples,
                  OIIO::Filesystem::IOVecOutput &memory, const answer &out)
{
    output.set_ioproxy(&memory);
    if (!output.open("picture", spec) || !output.write_image(spec.format, samples) || !output.close())
        return out.refuse(output.geterror());
    return true;
}

bool decode(const void *data, size_t size, picture *p, char *reason, size_t reason_size)
{
    const answer out = {reason, reason_size};
    const char *const name = names[p->format.kind];
    p->rgb = nullptr;
    try {
        OIIO::Filesystem::IOMemReader memory(const_cast<void *>(data), size);
        const std::unique_ptr<OIIO::ImageInput> input = OIIO::ImageInput::create(name);
        OIIO::ImageSpec config, spec;
        config.attribute("oiio:UnassociatedAlpha", 1);
        if (!begins_as(p->format.kind, data, size))
            return out.refuse(std::string("not a ") + people[p->format.kind] + " picture");
        if (!input)
            return out.refuse("OpenImageIO has no " + std::string(people[p->format.kind]));
        if (!input->set_ioproxy(&memory) || !input->open("picture", spec, config))
            return out.refuse(input->geterror());
        if (read_pixels(*input, p, out))
            return true;
    } catch (const std::exception &problem) {
        out.refuse(problem.what());
    }
    std::free(p->rgb);
    p->rgb = nullptr;
    return false;
}

bool encode(picture_format format, uint32_t width, uint32_t height, const void *samples, void **data, size_t *size,
            char *reason, size_t reason_size)
{
    const answer out = {reason, reason_size};
    *data = nullptr;
    try {
        OIIO::Filesystem::IOVecOutput memory;
        const std::unique_ptr<OIIO::ImageOutput> output = OIIO::ImageOutput::create(names[format.kind]);
        if (!output)
            return out.refuse("OpenImageIO has no " + std::string(people[format.kind]));
        if (!write_pixels(*output, spec_of(format, width, height), samples, memory, out))
            return false;
        *size = memory.buffer().size();
        *data = std::malloc(*size);
        if (!*data)
            return out.refuse("no memory");
        std::memcpy(*data, memory.buffer().data(), *size);
        return true;
    } catch (const std::exception &problem) {
        return out.refuse(problem.what());
    }
}

} // namespace

const picture_codec_table PICTURE_CODEC_TABLE = {decode, encode};
