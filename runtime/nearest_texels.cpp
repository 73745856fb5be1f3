#include "runtime/nearest_texels.h"

#include <cmath>

#include "formats/opal/cubemap.h"

namespace opaline::runtime {

std::array<TexelShare, 4> nearest_texels(std::uint32_t n, formats::Vec3 direction) {
    const formats::CubePoint point = formats::cube_point(direction);
    // Of the grid of centres: whole numbers are centres.
    const double half = 0.5 * n;
    const double x = (static_cast<double>(point.u) + 1) * half - 0.5;
    const double y = (static_cast<double>(point.v) + 1) * half - 0.5;
    const double left = std::floor(x), up = std::floor(y);
    std::array<TexelShare, 4> shares;
    for (int i = 0; i < 4; ++i) {
        const double column = left + (i & 1), row = up + (i >> 1);
        // A centre beyond the face's edge lies in the neighbouring face.
        const formats::Vec3 centre =
            formats::cube_position({point.face, static_cast<float>((column + 0.5) / half - 1),
                                    static_cast<float>((row + 0.5) / half - 1)});
        shares[static_cast<std::size_t>(i)] = {
            formats::texel_index(n, centre), (1 - std::abs(x - column)) * (1 - std::abs(y - row))};
    }
    return shares;
}

}  // namespace opaline::runtime
