// exr_read.cpp - reads OpenEXR pictures of all compressions, scan lines or tiles, with the C++ library. This is C++
// because OpenEXR's C core does not support DWA. No exception leaves this file.
#include "exr.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfIntAttribute.h>
#include <ImfPartType.h>
#include <ImfStringAttribute.h>

#include <cerrno>
#include <cmath>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <memory>
#include <new>
#include <string>

namespace
{

struct release {
    void operator()(void *data) const
    {
        std::free(data);
    }
};
using bytes = std::unique_ptr<unsigned char, release>; // to be freed by free() in C

struct reader {
    const char *path;
    char *error;
    size_t error_size;

    // "cannot read PATH: ..." on one line.
    __attribute__((format(printf, 2, 3))) bool refuse(const char *format, ...) const
    {
        if (!error || !error_size)
            return false;
        int start = std::snprintf(error, error_size, "cannot read %s: ", path);
        va_list arguments;
        va_start(arguments, format);
        if (start >= 0 && static_cast<size_t>(start) < error_size)
            std::vsnprintf(error + start, error_size - static_cast<size_t>(start), format, arguments);
        va_end(arguments);
        for (char *c = error; *c; c++)
            if (*c == '\n' || *c == '\r')
                *c = ' ';
        return false;
    }
};

// OpenEXR's reasons often begin with the path, which our line already has.
std::string reason_of(const std::exception &problem, const char *path)
{
    std::string text = problem.what();
    std::string quoted = std::string("\"") + path + "\". ";
    size_t at = text.find(quoted);
    return at == std::string::npos ? text : text.substr(at + quoted.size());
}

// OpenEXR's reasons hardly distinguish a missing file, an empty file and a file of another format.
bool check_start(const reader &reader)
{
    std::unique_ptr<std::FILE, int (*)(std::FILE *)> file(std::fopen(reader.path, "rb"), std::fclose);
    if (!file)
        return reader.refuse("%s", std::strerror(errno));
    unsigned char start[4];
    errno = 0;
    size_t size = std::fread(start, 1, sizeof start, file.get());
    if (std::ferror(file.get()))
        return reader.refuse("%s", std::strerror(errno));
    if (size == 0)
        return reader.refuse("the file is empty");
    if (size < sizeof start || std::memcmp(start, "\x76\x2f\x31\x01", sizeof start) != 0)
        return reader.refuse("not an OpenEXR file");
    return true;
}

struct picture {
    Imf::InputFile file;
    uint32_t width = 0, height = 0;

    explicit picture(const char *path) : file(path)
    {
    }

    bool measure(const reader &reader)
    {
        const Imath::Box2i &window = file.header().dataWindow();
        int64_t across = int64_t(window.max.x) - window.min.x + 1;
        int64_t down = int64_t(window.max.y) - window.min.y + 1;
        if (across < 1 || down < 1 || across > EXR_MAX_SIDE || down > EXR_MAX_SIDE)
            return reader.refuse("%lld x %lld pixels, expected 1 to %d on each side", (long long)across,
                                 (long long)down, EXR_MAX_SIDE);
        if (file.header().hasType() && Imf::isDeepData(file.header().type()))
            return reader.refuse("a deep picture, expected a flat one");
        if (!file.isComplete())
            return reader.refuse("the file is incomplete");
        width = static_cast<uint32_t>(across);
        height = static_cast<uint32_t>(down);
        return true;
    }

    const Imf::Channel *find(const char *name) const
    {
        return file.header().channels().findChannel(name);
    }

    // The channels of the file, "R, A, Z", for the error about a missing one.
    std::string channel_names() const
    {
        std::string names;
        const Imf::ChannelList &channels = file.header().channels();
        for (auto i = channels.begin(); i != channels.end(); ++i)
            names += (names.empty() ? "" : ", ") + std::string(i.name());
        return names.empty() ? "none" : names;
    }

    // All the channels must have one sample per pixel.
    bool check_channels(const reader &reader, const char *const *wanted, uint32_t count) const
    {
        std::string missing;
        for (uint32_t i = 0; i < count; i++) {
            const Imf::Channel *channel = find(wanted[i]);
            if (!channel)
                missing += (missing.empty() ? "" : ", ") + std::string(wanted[i]);
            else if (channel->xSampling != 1 || channel->ySampling != 1)
                return reader.refuse("channel %s is subsampled, expected one sample per pixel", wanted[i]);
        }
        if (missing.empty())
            return true;
        return reader.refuse("missing channel%s %s (the file has %s)",
                             missing.find(',') == std::string::npos ? "" : "s", missing.c_str(),
                             channel_names().c_str());
    }

    void attach(Imf::FrameBuffer &frame, const char *name, Imf::PixelType type, void *data, size_t stride) const
    {
        frame.insert(name, Imf::Slice::Make(type, data, file.header().dataWindow(), stride, stride * width));
    }

    void read(const Imf::FrameBuffer &frame)
    {
        const Imath::Box2i &window = file.header().dataWindow();
        file.setFrameBuffer(frame);
        file.readPixels(window.min.y, window.max.y);
    }
};

bytes allocate(const picture &picture, size_t pixel_bytes)
{
    bytes data(static_cast<unsigned char *>(std::calloc(size_t(picture.width) * picture.height, pixel_bytes)));
    if (!data)
        throw std::bad_alloc();
    return data;
}

uint64_t repair(float *samples, size_t count)
{
    uint64_t repaired = 0;
    for (size_t i = 0; i < count; i++) {
        if (samples[i] >= 0.0f && samples[i] <= 3.402823466e38f)
            continue;
        samples[i] = samples[i] > 0.0f ? 65504.0f : 0.0f;
        repaired++;
    }
    return repaired;
}

bool read_rgb(const reader &reader, uint32_t *width, uint32_t *height, float **rgb, uint64_t *repaired)
{
    static const char *const colors[] = {"R", "G", "B"}, *const grey[] = {"Y"};
    if (!check_start(reader))
        return false;
    picture picture(reader.path);
    if (!picture.measure(reader))
        return false;
    bool any_color = picture.find("R") || picture.find("G") || picture.find("B");
    bool is_grey = !any_color && picture.find("Y");
    if (is_grey && (picture.find("RY") || picture.find("BY")))
        return reader.refuse("stored as luminance and chroma (Y, RY, BY), expected R, G, B");
    if (!picture.check_channels(reader, is_grey ? grey : colors, is_grey ? 1 : 3))
        return false;
    bytes data = allocate(picture, 3 * sizeof(float));
    float *samples = reinterpret_cast<float *>(data.get());
    size_t pixels = size_t(picture.width) * picture.height;
    Imf::FrameBuffer frame;
    for (int i = 0; i < (is_grey ? 1 : 3); i++)
        picture.attach(frame, is_grey ? "Y" : colors[i], Imf::FLOAT, samples + i, 3 * sizeof(float));
    picture.read(frame);
    for (size_t i = 0; is_grey && i < pixels; i++)
        samples[i * 3 + 1] = samples[i * 3 + 2] = samples[i * 3];
    uint64_t bad = repair(samples, pixels * 3);
    if (repaired)
        *repaired = is_grey ? bad / 3 : bad;
    *width = picture.width;
    *height = picture.height;
    *rgb = reinterpret_cast<float *>(data.release());
    return true;
}

bool read_channels(const reader &reader, uint32_t *width, uint32_t *height, exr_request *requests, uint32_t count)
{
    if (!check_start(reader))
        return false;
    picture picture(reader.path);
    if (!picture.measure(reader))
        return false;
    std::unique_ptr<const char *[]> names(new const char *[count]);
    std::unique_ptr<bytes[]> data(new bytes[count]);
    for (uint32_t i = 0; i < count; i++)
        names[i] = requests[i].name;
    if (!picture.check_channels(reader, names.get(), count))
        return false;
    Imf::FrameBuffer frame;
    for (uint32_t i = 0; i < count; i++) {
        bool whole = requests[i].type == EXR_SAMPLE_UINT;
        if (whole != (picture.find(names[i])->type == Imf::UINT))
            return reader.refuse("channel %s holds %s", names[i], whole ? "no whole numbers" : "whole numbers");
        data[i] = allocate(picture, 4);
        picture.attach(frame, names[i], whole ? Imf::UINT : Imf::FLOAT, data[i].get(), 4);
    }
    picture.read(frame);
    for (uint32_t i = 0; i < count; i++)
        requests[i].data = data[i].release();
    *width = picture.width;
    *height = picture.height;
    return true;
}

void read_text(const Imf::Header &header, exr_text &wanted)
{
    const Imf::StringAttribute *string = header.findTypedAttribute<Imf::StringAttribute>(wanted.name);
    const Imf::IntAttribute *integer = header.findTypedAttribute<Imf::IntAttribute>(wanted.name);
    if (string)
        std::snprintf(wanted.text, sizeof wanted.text, "%s", string->value().c_str());
    else if (integer)
        std::snprintf(wanted.text, sizeof wanted.text, "%d", integer->value());
}

bool read_header(const reader &reader, exr_header *header, exr_text *texts, uint32_t count)
{
    if (!check_start(reader))
        return false;
    picture picture(reader.path);
    if (!picture.measure(reader))
        return false;
    header->width = picture.width;
    header->height = picture.height;
    std::string names = ",";
    const Imf::ChannelList &channels = picture.file.header().channels();
    for (auto i = channels.begin(); i != channels.end(); ++i)
        names += std::string(i.name()) + ",";
    std::snprintf(header->channels, sizeof header->channels, "%s", names.c_str());
    for (uint32_t i = 0; i < count; i++)
        read_text(picture.file.header(), texts[i]);
    return true;
}

// Runs `action`. An exception becomes an error line.
template <typename action> bool guarded(const reader &reader, action act)
{
    try {
        return act();
    } catch (const std::bad_alloc &) {
        return reader.refuse("no memory");
    } catch (const std::exception &problem) {
        return reader.refuse("the file is damaged: %s", reason_of(problem, reader.path).c_str());
    } catch (...) {
        return reader.refuse("the file is damaged");
    }
}

} // namespace

bool exr_read_rgb(const char *path, uint32_t *width, uint32_t *height, float **rgb, uint64_t *repaired, char *error,
                  size_t error_size)
{
    reader reader{path, error, error_size};
    *width = *height = 0;
    *rgb = nullptr;
    if (repaired)
        *repaired = 0;
    return guarded(reader, [&] { return read_rgb(reader, width, height, rgb, repaired); });
}

bool exr_read_channels(const char *path, uint32_t *width, uint32_t *height, exr_request *requests, uint32_t count,
                       char *error, size_t error_size)
{
    reader reader{path, error, error_size};
    *width = *height = 0;
    for (uint32_t i = 0; i < count; i++)
        requests[i].data = nullptr;
    return guarded(reader, [&] { return read_channels(reader, width, height, requests, count); });
}

bool exr_read_header(const char *path, exr_header *header, exr_text *texts, uint32_t count, char *error,
                     size_t error_size)
{
    reader reader{path, error, error_size};
    *header = exr_header{};
    for (uint32_t i = 0; i < count; i++)
        texts[i].text[0] = 0;
    return guarded(reader, [&] { return read_header(reader, header, texts, count); });
}
