#include "bake/reference/reference_scene.h"

#include <utility>

namespace opaline::bake {

formats::Result<ReferenceScene> make_reference_scene(const formats::Scene& scene,
                                                     unsigned threads) {
    auto surfaces = HitScene::build(scene, threads);
    if (!surfaces) {
        return std::move(surfaces).error();
    }
    ReferenceScene result{std::move(*surfaces), {}, {}, false};
    for (const formats::Material& material : scene.materials) {
        result.medium_of.push_back(formats::kNone);
        if (material.medium) {
            result.medium_of.back() = static_cast<std::uint32_t>(result.media.size());
            const formats::Medium& m = *material.medium;
            ReferenceMedium medium;
            medium.sigma_s = {m.sigma_s.r, m.sigma_s.g, m.sigma_s.b};
            medium.sigma_t = medium.sigma_s + glm::vec3(m.sigma_a.r, m.sigma_a.g, m.sigma_a.b);
            medium.eta = m.eta;
            medium.phase = make_phase_sampler(m.phase);
            result.has_matched_boundary = result.has_matched_boundary || is_matched(m.eta);
            result.media.push_back(std::move(medium));
        }
    }
    return result;
}

void MediumStack::enter(std::uint32_t m) {
    if (size < kCapacity) {
        medium[size++] = m;
    }
}

void MediumStack::leave(std::uint32_t m) {
    for (std::uint32_t i = size; i-- > 0;) {
        if (medium[i] == m) {
            for (std::uint32_t j = i + 1; j < size; ++j) {
                medium[j - 1] = medium[j];
            }
            --size;
            return;
        }
    }
}

}  // namespace opaline::bake
