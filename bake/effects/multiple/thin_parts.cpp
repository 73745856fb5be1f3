#include "bake/effects/multiple/thin_parts.h"

#include <algorithm>
#include <array>
#include <string>

#include "bake/transport/body.h"
#include "bake/truth/draw_receivers.h"

namespace opaline::bake {

double estimate_thin_excess(const MediumProfile& profile, const RayScene& rays,
                            std::span<const BodyPoint> points) {
    constexpr float kNoLimit = 1e30f;  // past a hole nothing is near
    std::array<double, 3> sum{};
    std::size_t count = 0;
    for (const BodyPoint& point : points) {
        if (point.normal == glm::vec3(0)) {
            continue;
        }
        const InwardPath path = trace_inward_path(rays, point, kNoLimit);
        ++count;
        for (std::size_t b = 0; b < 3; ++b) {
            const double total = profile.total(b);
            sum[b] += total > 0 ? profile.tail(b, static_cast<double>(path.length)) / total : 0;
        }
    }
    return count == 0 ? 0 : *std::max_element(sum.begin(), sum.end()) / static_cast<double>(count);
}

void warn_of_thin_parts(const EffectInputs& inputs, const MediumProfile& profile,
                        std::vector<formats::Diagnostic>& warnings) {
    if (inputs.layout.local) {
        return;
    }
    constexpr double kWorthSaying = 0.1;
    std::vector<BodyPoint> points;
    const auto& sets = inputs.bake.receivers;
    for (const std::uint32_t v : draw_receivers(count_receivers(sets), inputs.knobs.seed)) {
        const ReceiverSet& set = set_of(sets, v);
        if (set.material == inputs.material) {
            points.push_back(set.inside[v - set.first]);
        }
    }
    const double excess = estimate_thin_excess(profile, inputs.bake.rays, points);
    if (excess > kWorthSaying) {
        warnings.push_back(formats::make_warning(
            "", "material '" + inputs.bake.scene.materials[inputs.material].name + "'",
            "light crosses the body: diffusion takes it for a half space and makes it up to " +
                std::to_string(static_cast<int>(100 * excess + 0.5)) +
                " % too bright under even light",
            "compare with `opaline reference`; denser media and thicker bodies err less"));
    }
}

}  // namespace opaline::bake
