// make_exr.cpp - OpenEXR files for the tests of reading.
#include "make_exr.h"

#include <ImfChannelList.h>
#include <ImfDeepFrameBuffer.h>
#include <ImfDeepScanLineOutputPart.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfMultiPartOutputFile.h>
#include <ImfOutputFile.h>
#include <ImfOutputPart.h>
#include <ImfPartType.h>
#include <ImfTiledOutputFile.h>
#include <half.h>

#include <cstdio>
#include <exception>
#include <string>
#include <vector>

using namespace OPENEXR_IMF_NAMESPACE;

template <typename action> static bool without_exceptions(action act)
{
    try {
        act();
        return true;
    } catch (const std::exception &problem) {
        std::fprintf(stderr, "make_exr: %s\n", problem.what());
        return false;
    }
}

static Header header_of(const exr_recipe &recipe)
{
    Imath::Box2i window(Imath::V2i(recipe.left, recipe.top),
                        Imath::V2i(recipe.left + recipe.width - 1, recipe.top + recipe.height - 1));
    int sampling = recipe.sampling ? recipe.sampling : 1;
    Header header(window, window);
    header.compression() = static_cast<Compression>(recipe.compression);
    header.setName("picture");
    for (const char *name = recipe.channels; *name; name++)
        header.channels().insert(std::string(1, *name), Channel(recipe.half ? HALF : FLOAT, sampling, sampling));
    if (recipe.tile)
        header.setTileDescription(
            TileDescription(unsigned(recipe.tile), unsigned(recipe.tile), recipe.mip ? MIPMAP_LEVELS : ONE_LEVEL));
    return header;
}

bool make_exr(const char *path, const exr_recipe *recipe)
{
    return without_exceptions([&] {
        Header header = header_of(*recipe);
        size_t count = std::string(recipe->channels).size();
        size_t total = size_t(recipe->width) * size_t(recipe->height) * count;
        int sampling = recipe->sampling ? recipe->sampling : 1;
        std::vector<half> halves;
        for (size_t i = 0; i < total && recipe->half; i++)
            halves.push_back(half(recipe->samples[i]));
        FrameBuffer frame;
        for (size_t c = 0; c < count; c++) {
            const void *base = recipe->half ? (const void *)(halves.data() + c) : (const void *)(recipe->samples + c);
            size_t stride = count * (recipe->half ? 2 : 4);
            frame.insert(std::string(1, recipe->channels[c]),
                         Slice::Make(recipe->half ? HALF : FLOAT, base, header.dataWindow(), stride,
                                     stride * size_t(recipe->width), sampling, sampling));
        }
        if (!recipe->tile) {
            OutputFile file(path, header);
            file.setFrameBuffer(frame);
            file.writePixels(recipe->rows ? recipe->rows : recipe->height);
            return;
        }
        TiledOutputFile file(path, header);
        file.setFrameBuffer(frame);
        file.writeTiles(0, file.numXTiles(0) - 1, 0, file.numYTiles(0) - 1, 0);
        for (int level = 1; recipe->mip && level < file.numLevels(); level++)
            file.writeTiles(0, file.numXTiles(level) - 1, 0, file.numYTiles(level) - 1, level);
    });
}

bool make_exr_parts(const char *path)
{
    return without_exceptions([&] {
        exr_recipe recipe = {};
        recipe.width = 4;
        recipe.height = 2;
        recipe.channels = "RGB";
        std::vector<float> samples(4 * 2 * 3, 0.5f);
        std::vector<Header> headers(2, header_of(recipe));
        headers[1].setName("other");
        for (Header &header : headers)
            header.setType(SCANLINEIMAGE);
        MultiPartOutputFile file(path, headers.data(), 2);
        for (int part = 0; part < 2; part++) {
            FrameBuffer frame;
            for (int c = 0; c < 3; c++)
                frame.insert(std::string(1, "RGB"[c]),
                             Slice::Make(FLOAT, samples.data() + c, headers[0].dataWindow(), 12, 48));
            OutputPart output(file, part);
            output.setFrameBuffer(frame);
            output.writePixels(2);
        }
    });
}

bool make_exr_deep(const char *path)
{
    return without_exceptions([&] {
        Header header(2, 2);
        header.setName("deep");
        header.setType(DEEPSCANLINE);
        header.compression() = ZIPS_COMPRESSION;
        header.channels().insert("Z", Channel(FLOAT));
        unsigned counts[4] = {1, 1, 1, 1};
        float values[4] = {1, 2, 3, 4};
        float *pointers[4] = {values, values + 1, values + 2, values + 3};
        MultiPartOutputFile file(path, &header, 1);
        DeepScanLineOutputPart part(file, 0);
        DeepFrameBuffer frame;
        frame.insertSampleCountSlice(Slice(UINT, (char *)counts, sizeof(unsigned), 2 * sizeof(unsigned)));
        frame.insert("Z", DeepSlice(FLOAT, (char *)pointers, sizeof(float *), 2 * sizeof(float *), sizeof(float)));
        part.setFrameBuffer(frame);
        part.writePixels(2);
    });
}
