#include "bake/effects/emitters/lit_media.h"

#include "bake/exchange/other_light.h"
#include "formats/opal/cubemap.h"

namespace opaline::bake {
namespace {

// The primitives of one medium that have rows, and all their receivers.
struct LitMedium {
    std::vector<std::uint32_t> primitives;
    std::vector<Receiver> outside;
    std::vector<BodyPoint> inside;
};

LitMedium find_medium(std::uint32_t material, std::span<const ReceiverSet> receivers,
                      std::span<const formats::PrimitiveRecord> primitives) {
    LitMedium medium;
    for (std::uint32_t p = 0; p < receivers.size(); ++p) {
        const ReceiverSet& set = receivers[p];
        if (set.size() == 0 || set.material != material ||
            primitives[p].shading != formats::Shading::translucent) {
            continue;
        }
        medium.primitives.push_back(p);
        medium.outside.insert(medium.outside.end(), set.outside.begin(), set.outside.end());
        medium.inside.insert(medium.inside.end(), set.inside.begin(), set.inside.end());
    }
    return medium;
}

}  // namespace

std::uint32_t lamp_basis(std::size_t lamps) {
    std::uint32_t n = 1;
    while (formats::cubemap_texels(n) < lamps)
        n *= 2;
    return n;
}

LampRowsOfMedia light_media(const LitMedia& media, const LampBounces& light,
                            std::span<const ReceiverSet> receivers,
                            std::span<const formats::PrimitiveRecord> primitives,
                            const Context& context, std::uint64_t& rays) {
    const std::size_t lamps = light.lamps.sources.size();
    const std::uint32_t n = lamp_basis(lamps);
    const std::size_t columns = formats::cubemap_texels(n);
    const OtherLight of_lamps{.lamps = &light, .environment = false};
    LampRowsOfMedia result(primitives.size());
    for (std::uint32_t m = 0; m < media.layouts.size() && !context.cancelled(); ++m) {
        const LitMedium medium = find_medium(m, receivers, primitives);
        if (medium.primitives.empty()) continue;
        const std::vector<std::vector<float>> rows = light_medium(
            *media.finished, {m, medium.outside, medium.inside, of_lamps, n}, context, rays);
        if (rows.size() != medium.outside.size()) continue;
        const std::size_t terms = media.layouts[m].terms();
        std::size_t next = 0;
        for (const std::uint32_t p : medium.primitives) {
            const std::size_t count = receivers[p].size();
            result[p].assign(lamps, std::vector<formats::Rgb>(count * terms));
            for (std::size_t v = 0; v < count; ++v, ++next) {
                for (std::size_t e = 0; e < lamps; ++e) {
                    for (std::size_t k = 0; k < terms; ++k) {
                        const auto band = [&](std::size_t b) {
                            return rows[next][(3 * k + b) * columns + e];
                        };
                        result[p][e][v * terms + k] = {band(0), band(1), band(2)};
                    }
                }
            }
        }
    }
    return result;
}

}  // namespace opaline::bake
