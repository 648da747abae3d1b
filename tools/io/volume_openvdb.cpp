// volume_openvdb.cpp - volumes through OpenVDB, to memory: the module that volume.c loads. No exception leaves this
// file.
#include "volume_grids.h"
#include "volume_module.h"

#include <openvdb/io/Archive.h>

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <memory>
#include <sstream>
#include <string>

namespace
{

static_assert(float_grid::TreeType::LeafNodeType::DIM == VOLUME_SIDE, "a block is a leaf");

// Archive::write is not public. With offsets of the grids, as in all files that OpenVDB writes by name.
struct archive : openvdb::io::Archive {
    Ptr copy() const override
    {
        return Ptr(new archive(*this));
    }
    void put(std::ostream &to, const openvdb::GridCPtrVec &grids, const openvdb::MetaMap &about)
    {
        write(to, grids, true, about);
    }
};

openvdb::math::Transform::Ptr transform_of(const volume &v)
{
    const auto transform = openvdb::math::Transform::createLinearTransform(v.voxel_m);
    transform->postTranslate(openvdb::Vec3d(v.origin_m));
    return transform;
}

void add_block(const int32_t cell[3], const volume_voxel *voxels, float_grid &density, vector_grid &velocity)
{
    const openvdb::Coord first(cell[0] * VOLUME_SIDE, cell[1] * VOLUME_SIDE, cell[2] * VOLUME_SIDE);
    float_grid::TreeType::LeafNodeType *of_density = nullptr;
    vector_grid::TreeType::LeafNodeType *of_velocity = nullptr;
    for (int i = 0; i < VOLUME_VOXELS; i++) {
        const volume_voxel &from = voxels[i];
        if (!(from.density > 0))
            continue;
        const openvdb::Coord at =
            first.offsetBy(i % VOLUME_SIDE, i / VOLUME_SIDE % VOLUME_SIDE, i / VOLUME_SIDE / VOLUME_SIDE);
        if (!of_density) {
            of_density = density.tree().touchLeaf(first);
            of_velocity = velocity.tree().touchLeaf(first);
        }
        of_density->setValueOn(at, from.density);
        of_velocity->setValueOn(at, openvdb::Vec3f(from.velocity));
    }
}

void describe(openvdb::MetaMap &grid, const char *unit, const char *text)
{
    grid.insertMeta("unit", openvdb::StringMetadata(unit));
    grid.insertMeta("unit_length", openvdb::StringMetadata("m"));
    grid.insertMeta("description", openvdb::StringMetadata(text));
}

openvdb::GridCPtrVec grids_of(const volume &v)
{
    const auto density = float_grid::create(0.0f);
    const auto velocity = vector_grid::create(openvdb::Vec3f(0.0f));
    const auto voxels = std::make_unique<volume_voxel[]>(VOLUME_VOXELS);
    for (uint32_t i = 0; i < v.block_count; i++) {
        int32_t cell[3];
        v.fill(v.from, i, cell, voxels.get());
        add_block(cell, voxels.get(), *density, *velocity);
    }
    density->setName("density");
    density->setGridClass(openvdb::GRID_FOG_VOLUME);
    density->setTransform(transform_of(v));
    describe(*density, "1", "water in the air: 0 outside, about 1 inside; 'surface' is the value at the surface");
    density->insertMeta("surface", openvdb::FloatMetadata(static_cast<float>(v.surface)));
    velocity->setName("velocity");
    velocity->setVectorType(openvdb::VEC_CONTRAVARIANT_RELATIVE);
    velocity->setTransform(transform_of(v));
    velocity->setSaveFloatAsHalf(true); // a thousandth is enough, and it is three quarters of the data
    describe(*velocity, "m/s", "mean velocity of the water");
    return {density, velocity};
}

// OpenVDB marks each file with a random number, as text. One that depends on the contents keeps equal files equal.
void replace_mark(std::string &file)
{
    const size_t at = 21, length = 36; // behind magic number, three versions, and a byte
    if (file.size() < at + length)
        return;
    uint64_t hash[2] = {0xcbf29ce484222325u, 0x9ae16a3b2f90404fu};
    for (size_t i = at + length; i < file.size(); i++)
        for (uint64_t &h : hash) {
            h = (h ^ static_cast<unsigned char>(file[i])) * 0x100000001b3u;
            h ^= h >> 29;
        }
    char text[64];
    std::snprintf(text, sizeof text, "%08x-%04x-8%03x-%04x-%012llx", static_cast<unsigned>(hash[0] >> 32),
                  static_cast<unsigned>(hash[0] >> 16 & 0xffff), static_cast<unsigned>(hash[0] & 0xfff),
                  static_cast<unsigned>(0x8000 | (hash[1] >> 48 & 0x3fff)),
                  static_cast<unsigned long long>(hash[1] & 0xffffffffffffu));
    file.replace(at, length, text);
}

std::string encode(const volume &v)
{
    openvdb::initialize();
    openvdb::MetaMap about;
    about.insertMeta("creator", openvdb::StringMetadata("virga"));
    std::ostringstream to(std::ios_base::binary);
    archive().put(to, grids_of(v), about);
    std::string file = to.str();
    replace_mark(file);
    return file;
}

} // namespace

bool VOLUME_ENCODE(const volume *v, void **data, size_t *size, char *reason, size_t reason_size)
{
    try {
        const std::string file = encode(*v);
        *size = file.size();
        *data = std::malloc(file.size() + 1);
        if (*data)
            std::memcpy(*data, file.data(), file.size());
        else
            std::snprintf(reason, reason_size, "no memory");
        return *data;
    } catch (const std::exception &problem) {
        std::snprintf(reason, reason_size, "OpenVDB: %s", problem.what());
        return false;
    }
}
