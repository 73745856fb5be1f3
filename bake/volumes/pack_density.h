#pragma once

#include <string>

#include "bake/volumes/node_lattice.h"
#include "formats/opal/result.h"
#include "formats/opal/volumes.h"
#include "formats/scene.h"

namespace opaline::bake {

/// Appends a volume's bricks and nodes to those of a file, its density in 16 bits a voxel; fills in
/// all of the record but what concerns rows. `name`: of the volume, for messages. `world` moves the
/// scene's frame to the world. Errors: resource (more than 2^32 - 2 bricks, nodes or corners).
formats::Status pack_density(const formats::SparseGrid<float>& density, const std::string& name,
                             const NodeLattice& lattice, glm::dvec3 world,
                             formats::VolumeRecord& record, formats::Volumes& volumes);

}  // namespace opaline::bake
