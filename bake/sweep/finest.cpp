#include "bake/sweep/finest.h"

#include <algorithm>
#include <string>
#include <utility>

namespace opaline::bake {
namespace {

std::string medium_effect(const SweepSubject& subject) {
    return subject.multiple && subject.single ? "multiple+single"
           : subject.multiple                 ? "multiple"
                                              : "single";
}

}  // namespace

std::size_t find_finest(std::span<const PointRecord> points) {
    const auto finest = std::min_element(points.begin(), points.end(),
                                         [](const PointRecord& a, const PointRecord& b) {
                                             return std::pair{a.error.rms_relative, -a.seconds} <
                                                    std::pair{b.error.rms_relative, -b.seconds};
                                         });
    return static_cast<std::size_t>(finest - points.begin());
}

void compare_with_finest(SweepResult& result, const formats::Scene& scene,
                         std::span<const std::uint32_t> probes) {
    std::vector<bool> is_medium;
    for (const formats::Primitive& p : scene.primitives) {
        is_medium.insert(is_medium.end(), p.position.size(),
                         scene.materials[p.material].medium.has_value());
    }
    std::vector<bool> of_medium;
    for (const std::uint32_t probe : probes) {
        of_medium.push_back(is_medium[probe]);
    }
    result.truth = find_finest(result.points);
    const PointRecord& finest = result.points[result.truth];
    for (PointRecord& record : result.points) {
        record.against_finest = compare_probes(record.luminance, finest.luminance, of_medium,
                                               result.lights, medium_effect(result.subject));
        add_error_of_truth(record.against_finest, finest.error);
    }
}

}  // namespace opaline::bake
