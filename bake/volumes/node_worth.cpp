#include "bake/volumes/node_worth.h"

#include <algorithm>
#include <cmath>

#include "bake/volumes/grid_loops.h"
#include "formats/opal/cubemap.h"

namespace opaline::bake {

std::vector<float> node_densities(const formats::SparseGrid<float>& density,
                                  const NodeLattice& lattice) {
    float most = 0;
    std::vector<float> means;
    means.reserve(lattice.node.size());
    for (const glm::ivec3 node : lattice.node) {
        float sum = 0;
        for_each_voxel_around(
            node, static_cast<int>(lattice.spacing),
            [&](glm::ivec3 voxel, float weight) { sum += weight * density.at(voxel); });
        means.push_back(sum);
        most = std::max(most, sum);
    }
    for (float& mean : means) {
        mean = most > 0 ? mean / most : 0.0f;
    }
    return means;
}

float mean_visibility(const formats::SparseRow& attenuated, std::uint32_t n) {
    double sum = 0;
    for (const auto* values : {&attenuated.value, &attenuated.average}) {
        for (const float v : *values) {
            sum += static_cast<double>(v) * static_cast<double>(v);
        }
    }
    // Haar's functions are orthonormal over texels.
    return static_cast<float>(std::sqrt(sum / (formats::cubemap_texels(n) * attenuated.bands)));
}

}  // namespace opaline::bake
