#include "runtime/volumes/texel_integrals.h"

#include <cstddef>
#include <cstdint>
#include <span>

#include "formats/opal/cubemap.h"
#include "formats/opal/haar.h"

namespace opaline::runtime {

std::vector<double> texel_integrals(const LightVector& light) {
    const std::uint32_t n = light.n;
    const std::size_t face_size = std::size_t{n} * n, texels = formats::cubemap_texels(n);
    std::vector<double> integral(3 * texels), face(face_size), scratch(face_size);
    for (std::size_t b = 0; b < 3; ++b) {
        for (std::size_t first = 0; first < texels; first += face_size) {
            for (std::size_t i = 0; i < face_size; ++i) {
                face[i] = static_cast<double>(light.rgba[4 * (first + i) + b]);
            }
            formats::haar_inverse(std::span<double>(face), n, scratch);
            for (std::size_t i = 0; i < face_size; ++i) {
                integral[3 * (first + i) + b] = face[i];
            }
        }
    }
    return integral;
}

}  // namespace opaline::runtime
