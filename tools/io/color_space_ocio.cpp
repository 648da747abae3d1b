// color_space_ocio.cpp - color spaces through OpenColorIO: the module that color_space.c loads. No exception leaves
// this file.
#include "color_space_table.h"

#include <OpenColorIO/OpenColorIO.h>

#include <cmath>
#include <cstdio>
#include <exception>
#include <memory>
#include <string>

namespace ocio = OCIO_NAMESPACE;

struct color_space {
    ocio::ConstCPUProcessorRcPtr to_light, to_code;
};

namespace
{

// On one line.
color_space *refuse(char *reason, size_t size, const std::string &text)
{
    std::snprintf(reason, size, "%s", text.c_str());
    for (char *c = reason; *c; c++)
        if (*c == '\n' || *c == '\r')
            *c = *(c + 1) ? ' ' : '\0';
    return nullptr;
}

// Steps that the config gives are never left out or approximated: a code has to come back.
ocio::ConstCPUProcessorRcPtr processor(const ocio::ConstConfigRcPtr &config, const char *from, const char *to)
{
    return config->getProcessor(from, to)->getOptimizedCPUProcessor(ocio::BIT_DEPTH_F32, ocio::BIT_DEPTH_F32,
                                                                    ocio::OPTIMIZATION_LOSSLESS);
}

color_space *open_space(const char *file, const char *name, char *reason, size_t size)
{
    try {
        ocio::SetLoggingLevel(ocio::LOGGING_LEVEL_NONE);
        const ocio::ConstConfigRcPtr config = file ? ocio::Config::CreateFromFile(file) : ocio::Config::CreateFromEnv();
        const ocio::ConstColorSpaceRcPtr found = config->getColorSpace(name);
        if (!config->hasRole(ocio::ROLE_SCENE_LINEAR))
            return refuse(reason, size, "expected a config with the role scene_linear");
        if (!found)
            return refuse(reason, size, std::string("expected a color space of the config, got '") + name + "'");
        std::unique_ptr<color_space> space(new color_space);
        space->to_light = processor(config, name, ocio::ROLE_SCENE_LINEAR);
        space->to_code = processor(config, ocio::ROLE_SCENE_LINEAR, name);
        return space.release();
    } catch (const std::exception &problem) {
        return refuse(reason, size, std::string("OpenColorIO: ") + problem.what());
    }
}

void close_space(color_space *space)
{
    delete space;
}

// Rows of a million pixels: OpenColorIO counts in ints of bytes.
void apply(const color_space *space, bool to_light, float *values, size_t pixels, uint32_t channels)
{
    const size_t most = 1u << 20;
    try {
        for (size_t begin = 0; begin < pixels; begin += most) {
            const size_t count = pixels - begin < most ? pixels - begin : most;
            ocio::PackedImageDesc image(values + begin * channels, static_cast<long>(count), 1,
                                        static_cast<long>(channels));
            (to_light ? space->to_light : space->to_code)->apply(image);
        }
    } catch (const std::exception &) {
        // Only for pictures that are no pictures: there are none.
    }
    for (size_t i = 0; i < pixels * channels; i++)
        if (!std::isfinite(values[i]))
            values[i] = 0;
}

} // namespace

const color_space_table COLOR_SPACE_TABLE = {open_space, close_space, apply};
