#pragma once

#include <functional>
#include <string_view>
#include <vector>

#include "formats/opal/vec3.h"
#include "tests/bench/gl_parity/report.h"

namespace opaline::parity {

/// Values of the CPU, some for each element, seen from an eye that is moved by so much [m].
using SeenFrom = std::function<std::vector<float>(formats::Vec3)>;

/// How values are compared.
struct Measure {
    Kind kind;
    std::string_view of;            ///< what the elements are
    std::size_t per_element = 3;    ///< values
    std::vector<float> scale;       ///< of all values, or of each
    float moved = 0;                ///< by how much rounding may move an eye [m]
    double tolerance = kTolerance;  ///< share of the scale
};

/// Reports gl - cpu by shares of the scale. What is beyond the tolerance counts as a step where it
/// is within it of twice what the CPU's own value changes by, as the eye is moved along an axis: a
/// formula's steps, and differences of nearly equal lengths, of which each rounds its own way.
void compare_values(Report& report, const Measure& measure, const SeenFrom& cpu,
                    const std::vector<float>& gl);

/// max(least, the largest value).
float largest_of(const std::vector<float>& values, float least = 1e-30f);

}  // namespace opaline::parity
