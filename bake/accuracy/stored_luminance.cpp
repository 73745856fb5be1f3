#include "bake/accuracy/stored_luminance.h"

#include <array>

#include "runtime/view_terms.h"

namespace opaline::bake {

std::vector<float> view_of_rows(const RowLayout& layout, glm::vec3 normal) {
    std::vector<float> h(layout.terms(), 1.0f);
    const std::size_t first = layout.first_harmonic();
    runtime::eval_view_terms({normal.x, normal.y, normal.z}, std::span(h).subspan(first));
    return h;
}

RowSource rows_of(const formats::AssetView& asset, std::uint32_t receiver) {
    const formats::PrimitiveRecord& primitive = formats::primitive_of(asset, receiver);
    return {asset.transport, primitive.rows(),
            (receiver - primitive.first_vertex) * primitive.terms};
}

Luminance relight_rows(const RowSource& source, std::span<const float> h,
                       std::span<const TestLight> lights) {
    const auto& [rows, range, first_row] = source;
    constexpr std::array<double, 3> kLuminance{0.2126, 0.7152, 0.0722};
    Luminance luminance(lights.size());
    std::vector<float> dense(lights.front().coarse.size());
    for (std::uint32_t k = 0; k < h.size(); ++k) {
        for (std::uint32_t band = 0; band < range.bands; ++band) {
            formats::decode_row(rows, range, first_row + k, band, dense);
            const double weight =
                static_cast<double>(h[k]) * (range.bands == 1 ? 1.0 : kLuminance[band]);
            for (std::size_t l = 0; l < lights.size(); ++l) {
                luminance[l] += weight * relit(dense, lights[l].coarse);
            }
        }
    }
    return luminance;
}

}  // namespace opaline::bake
