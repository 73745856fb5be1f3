#include "formats/opal/normal_maps.h"

#include <algorithm>
#include <cmath>

#include "formats/opal/vec3.h"

namespace opaline::formats {
namespace {

constexpr float kSteps = 32767;

std::int16_t code_of(float x) {
    return static_cast<std::int16_t>(std::lround(std::clamp(x, -1.0f, 1.0f) * kSteps));
}

float value_of(std::int16_t code) {
    return std::max(static_cast<float>(code) / kSteps, -1.0f);
}

}  // namespace

Tangent encode_tangent(Vec3 direction, float sign) {
    const Octahedral at = to_octahedral(direction);
    return {code_of(at.p), code_of(at.q), code_of(sign), 0};
}

DecodedTangent decode_tangent(Tangent tangent) {
    const float sign = value_of(tangent.sign);
    return {std::abs(sign) * from_octahedral({value_of(tangent.p), value_of(tangent.q)}), sign};
}

const NormalMapRecord* NormalMapsView::of(std::uint32_t primitive) const {
    const auto found = std::ranges::lower_bound(record, primitive, {}, &NormalMapRecord::primitive);
    return found != record.end() && found->primitive == primitive ? &*found : nullptr;
}

}  // namespace opaline::formats
