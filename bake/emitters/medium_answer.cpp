#include "bake/emitters/medium_answer.h"

#include <utility>

#include "bake/plan/medium_exitance.h"

namespace opaline::bake {

std::vector<LitMedium> list_lit_media(const LitMedia& media, std::span<const ReceiverSet> receivers,
                                      std::span<const formats::PrimitiveRecord> primitives) {
    std::vector<LitMedium> lit;
    if (!media.light_medium) return lit;
    for (std::uint32_t m = 0; m < media.layouts.size(); ++m) {
        LitMedium medium;
        medium.material = m;
        for (std::uint32_t p = 0; p < receivers.size(); ++p) {
            const ReceiverSet& set = receivers[p];
            if (set.size() == 0 || set.material != m ||
                primitives[p].shading != formats::Shading::translucent) {
                continue;
            }
            medium.primitives.push_back(p);
            medium.first.push_back(static_cast<std::uint32_t>(medium.outside.size()));
            medium.outside.insert(medium.outside.end(), set.outside.begin(), set.outside.end());
            medium.inside.insert(medium.inside.end(), set.inside.begin(), set.inside.end());
            const auto color = media.color.subspan(primitives[p].first_vertex, set.size());
            medium.color.insert(medium.color.end(), color.begin(), color.end());
        }
        if (!medium.primitives.empty()) lit.push_back(std::move(medium));
    }
    return lit;
}

std::vector<glm::vec3> exitance_of_row(std::span<const float> weights, formats::Rgb color,
                                       std::span<const float> row, std::size_t columns) {
    std::vector<glm::vec3> exitance(columns, glm::vec3(0));
    for (std::size_t k = 0; k < weights.size(); ++k) {
        for (int b = 0; b < 3; ++b) {
            const float* const plane = &row[(3 * k + static_cast<std::size_t>(b)) * columns];
            for (std::size_t i = 0; i < columns; ++i) {
                exitance[i][b] += weights[k] * plane[i];
            }
        }
    }
    for (glm::vec3& value : exitance) {
        value = glm::max(value, glm::vec3(0)) * glm::vec3(color.r, color.g, color.b);
    }
    return exitance;
}

std::vector<float> weigh_rows_at(const LitMedia& media, const formats::Scene& scene,
                                 const LitMedium& medium, std::size_t receiver) {
    return weigh_rows_of_medium(media.layouts[medium.material],
                                scene.materials[medium.material].medium->eta,
                                medium.inside[receiver].normal);
}

}  // namespace opaline::bake
