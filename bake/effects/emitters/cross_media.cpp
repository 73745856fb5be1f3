#include "bake/effects/emitters/cross_media.h"

#include "bake/effects/emitters/lit_media.h"
#include "bake/exchange/other_light.h"
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

}  // namespace opaline::bake
