#include "tests/bench/gl_parity/conditioning.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>

#include "tests/runtime/embed_gl/host/host_context.h"

namespace opaline::parity {
namespace {

using formats::Vec3;

// The largest change of each value.
std::vector<float> changes_of(const std::vector<float>& values, const SeenFrom& cpu, float moved) {
    std::vector<float> largest(values.size());
    for (const Vec3 axis : {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}}) {
        for (const float by : {moved, -moved}) {
            const std::vector<float> beside = cpu(by * axis);
            for (std::size_t i = 0; i < values.size(); ++i)
                largest[i] = std::max(largest[i], std::abs(beside[i] - values[i]));
        }
    }
    return largest;
}

}  // namespace

void compare_values(Report& report, const Measure& measure, const SeenFrom& cpu,
                    const std::vector<float>& gl) {
    const std::vector<float> values = cpu({});
    test::require(values.size() == gl.size(), "numbers of values differ");
    std::optional<std::vector<float>> changes;
    for (std::size_t i = 0; i < values.size(); ++i) {
        const float difference = std::abs(gl[i] - values[i]);
        const float scale = measure.scale[measure.scale.size() == 1 ? 0 : i];
        const float tolerated = static_cast<float>(measure.tolerance) * scale;
        const auto share = static_cast<double>(difference / scale);
        const std::size_t element = i / measure.per_element;
        if (!(difference <= tolerated)) {
            if (!changes) changes = changes_of(values, cpu, measure.moved);
            if (difference <= tolerated + 2 * (*changes)[i]) {
                report.compare_step(measure.kind, share, measure.of, element);
                continue;
            }
        }
        report.compare(measure.kind, share, measure.of, element, measure.tolerance);
    }
}

float largest_of(const std::vector<float>& values, float least) {
    return values.empty() ? least
                          : std::max(*std::max_element(values.begin(), values.end()), least);
}

}  // namespace opaline::parity
