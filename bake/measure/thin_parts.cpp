#include "bake/measure/thin_parts.h"

#include <algorithm>
#include <array>

namespace opaline::bake {

double estimate_thin_excess(const MediumProfile& profile, const RayScene& rays,
                            std::uint32_t material, std::span<const BodyPoint> points,
                            std::span<const std::uint32_t> drawn) {
    constexpr float kNoLimit = 1e30f;  // past a hole nothing is near
    std::array<double, 3> sum{};
    std::size_t count = 0;
    for (const std::uint32_t v : drawn) {
        if (points[v].material != material || points[v].normal == glm::vec3(0)) {
            continue;
        }
        const InwardPath path = trace_inward_path(rays, points[v], kNoLimit);
        ++count;
        for (std::size_t b = 0; b < 3; ++b) {
            const double total = profile.total(b);
            sum[b] += total > 0 ? profile.tail(b, static_cast<double>(path.length)) / total : 0;
        }
    }
    return count == 0 ? 0 : *std::max_element(sum.begin(), sum.end()) / static_cast<double>(count);
}

}  // namespace opaline::bake
