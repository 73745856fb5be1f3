#include "bake/effects/emitters/cross_media.h"

#include <algorithm>
#include <numbers>

#include "bake/effects/emitters/lit_media.h"
#include "bake/exchange/other_light.h"
#include "bake/physics/fresnel.h"
#include "formats/opal/cubemap.h"

namespace opaline::bake {

void add_crossing_light(const FinishedMedia& media, const ReceiverSet& set,
                        const LampBounces& light, std::vector<std::vector<formats::Rgb>>& rows,
                        const Context& context, std::uint64_t& rays) {
    const OtherLight lamps{.lamps = &light, .environment = false};
    const std::size_t count = light.lamps.sources.size();
    const std::uint32_t n = lamp_basis(count);
    const std::vector<std::vector<float>> crossing = light_through_medium(
        media, {set.material, set.outside, set.inside, lamps, n}, context, rays);
    if (crossing.size() != set.size() || crossing.empty()) return;
    const std::size_t columns = formats::cubemap_texels(n);
    const std::size_t terms = crossing.front().size() / (3 * columns);
    if (rows.empty()) rows.assign(count, std::vector<formats::Rgb>(set.size() * terms));
    for (std::size_t e = 0; e < count; ++e) {
        for (std::size_t v = 0; v < set.size(); ++v) {
            for (std::size_t k = 0; k < terms; ++k) {
                const auto band = [&](std::size_t b) {
                    return crossing[v][(3 * k + b) * columns + e];
                };
                formats::Rgb& to = rows[e][v * terms + k];
                to = to + formats::Rgb{band(0), band(1), band(2)};
            }
        }
    }
}

void add_leaving_light(const LampLight& lamps, const ReceiverSet& set, const RowLayout& layout,
                       std::vector<std::vector<formats::Rgb>>& rows, std::uint64_t& rays) {
    if (std::ranges::all_of(lamps.leaving, &ElementLight::empty)) return;
    const std::size_t terms = layout.terms();
    if (rows.empty()) {
        rows.assign(lamps.sources.size(), std::vector<formats::Rgb>(set.size() * terms));
    }
    const double eta{lamps.scene.materials[set.material].medium->eta};
    const double scale =
        std::numbers::inv_pi / (1 - fresnel_moments(eta).external) / layout.view_of_constant();
    for (std::size_t v = 0; v < set.size(); ++v) {
        const std::vector<glm::dvec3> leaving = leaving_exitance(lamps, set.outside[v], rays);
        for (std::size_t e = 0; e < leaving.size(); ++e) {
            const glm::vec3 own(scale * leaving[e]);
            formats::Rgb& to = rows[e][v * terms];
            to = to + formats::Rgb{own.x, own.y, own.z};
        }
    }
}

}  // namespace opaline::bake
