// volume_grids.h - the grids of a volume, without openvdb.h, which compiles for half a minute.
#ifndef VIRGA_IO_VOLUME_GRIDS_H
#define VIRGA_IO_VOLUME_GRIDS_H

#include <openvdb/Grid.h>

namespace openvdb
{
OPENVDB_USE_VERSION_NAMESPACE
namespace OPENVDB_VERSION_NAME
{
void initialize();
}
} // namespace openvdb

using float_grid = openvdb::Grid<openvdb::tree::Tree4<float, 5, 4, 3>::Type>;
using vector_grid = openvdb::Grid<openvdb::tree::Tree4<openvdb::Vec3f, 5, 4, 3>::Type>;

#endif
