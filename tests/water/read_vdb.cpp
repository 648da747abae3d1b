// read_vdb.cpp - what is in a volume, as OpenVDB sees it.
#include "read_vdb.h"
#include "volume_grids.h"

#include <openvdb/io/File.h>

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string>

namespace
{

void copy_text(const openvdb::MetaMap &from, const char *name, char to[32])
{
    std::snprintf(to, 32, "%s", from.metaValue<std::string>(name).c_str());
}

void read_voxels(const float_grid &density, const vector_grid &velocity, vdb_contents &to)
{
    const auto velocities = velocity.getConstAccessor();
    to.voxels = static_cast<vdb_voxel *>(std::calloc(density.activeVoxelCount() + 1, sizeof(vdb_voxel)));
    for (auto at = density.cbeginValueOn(); at && to.voxels; ++at) {
        const openvdb::Vec3d world = density.indexToWorld(at.getCoord());
        const openvdb::Vec3f v = velocities.getValue(at.getCoord());
        vdb_voxel &voxel = to.voxels[to.count++];
        voxel.density = *at;
        for (int axis = 0; axis < 3; axis++) {
            voxel.position_m[axis] = world[axis];
            voxel.velocity[axis] = v[axis];
        }
    }
    to.velocities = velocity.activeVoxelCount();
}

void read_file(const char *path, vdb_contents &to)
{
    openvdb::initialize();
    openvdb::io::File file(path);
    file.open(false);
    const auto grids = file.getGrids();
    const auto density = openvdb::gridPtrCast<float_grid>(file.readGrid("density"));
    const auto velocity = openvdb::gridPtrCast<vector_grid>(file.readGrid("velocity"));
    to.grids = static_cast<uint32_t>(grids->size());
    for (int axis = 0; axis < 3; axis++)
        to.voxel_m[axis] = density->voxelSize()[axis];
    to.background = density->background();
    to.surface = density->metaValue<float>("surface");
    std::snprintf(to.density_class, sizeof to.density_class, "%s",
                  openvdb::GridBase::gridClassToString(density->getGridClass()).c_str());
    copy_text(*density, "unit", to.density_unit);
    copy_text(*density, "unit_length", to.length_unit);
    copy_text(*velocity, "unit", to.velocity_unit);
    copy_text(*file.getMetadata(), "creator", to.creator);
    read_voxels(*density, *velocity, to);
}

} // namespace

bool read_vdb(const char *path, vdb_contents *to, char *reason)
{
    *to = vdb_contents();
    try {
        read_file(path, *to);
        return true;
    } catch (const std::exception &problem) {
        std::snprintf(reason, 256, "%s", problem.what());
        return false;
    }
}
