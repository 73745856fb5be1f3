#include "bake/volumes/node_worth.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <glm/glm.hpp>

#include "formats/opal/cubemap.h"

namespace opaline::bake {

std::vector<float> node_densities(const formats::SparseGrid<float>& density,
                                  const NodeLattice& lattice) {
    const int reach = static_cast<int>(lattice.spacing);
    float most = 0;
    std::vector<float> means;
    means.reserve(lattice.node.size());
    for (const glm::ivec3 node : lattice.node) {
        float sum = 0;
        glm::ivec3 d;
        for (d.z = 1 - reach; d.z < reach; ++d.z) {
            for (d.y = 1 - reach; d.y < reach; ++d.y) {
                for (d.x = 1 - reach; d.x < reach; ++d.x) {
                    const glm::ivec3 left = reach - glm::abs(d);
                    sum += static_cast<float>(left.x * left.y * left.z) * density.at(node + d);
                }
            }
        }
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
