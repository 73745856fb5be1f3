#include "bake/effects/emitters/lamp_rows.h"

#include <glm/glm.hpp>
#include <numbers>

#include "bake/base/ordered_parallel.h"
#include "bake/receivers/other_side.h"

namespace opaline::bake {
namespace {

constexpr std::size_t kReceiversPerBlock = 16;

glm::dvec3 band_colors(formats::Rgb c) {
    return {c.r, c.g, c.b};
}

formats::Rgb radiance_of(const glm::dvec3& exitance) {
    const glm::vec3 c(exitance * std::numbers::inv_pi);
    return {c.x, c.y, c.z};
}

}  // namespace

std::vector<std::vector<formats::Rgb>> make_lamp_rows(const LampBounces& light,
                                                      const ReceiverSet& set, std::uint32_t terms,
                                                      const Context& context, std::uint64_t& rays) {
    std::vector<std::vector<formats::Rgb>> rows(light.lamps.sources.size(),
                                                std::vector<formats::Rgb>(set.size() * terms));
    const auto& sheet = light.lamps.scene.materials[set.material].sheet;
    struct Part {
        std::vector<std::vector<glm::dvec3>> front, back;  // by receiver, by lamp
        std::uint64_t rays = 0;
    };
    for_each_block_in_order(
        set.size(), kReceiversPerBlock, context,
        [&](Range range) {
            Part part;
            for (std::size_t r = range.begin; r < range.end; ++r) {
                const std::uint64_t key = 2 * (std::uint64_t{set.first} + r);
                part.front.push_back(receive_light(light, {set.outside[r]}, key, part.rays));
                if (sheet) {
                    const Receiver back = other_side(set.outside[r], set.inside[r]);
                    part.back.push_back(receive_light(light, {back}, key + 1, part.rays));
                }
            }
            return part;
        },
        [&](Range range, Part&& part) {
            for (std::size_t r = range.begin; r < range.end; ++r) {
                for (std::size_t lamp = 0; lamp < rows.size(); ++lamp) {
                    const glm::dvec3& front = part.front[r - range.begin][lamp];
                    if (!sheet) {
                        rows[lamp][r * terms] = radiance_of(front);
                        continue;
                    }
                    const glm::dvec3& back = part.back[r - range.begin][lamp];
                    const glm::dvec3 reflect = band_colors(sheet->reflect),
                                     transmit = band_colors(sheet->transmit);
                    rows[lamp][r * terms] = radiance_of(reflect * front + transmit * back);
                    rows[lamp][r * terms + 1] = radiance_of(transmit * front + reflect * back);
                }
            }
            rays += part.rays;
        });
    return rows;
}

}  // namespace opaline::bake
