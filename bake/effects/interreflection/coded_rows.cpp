#include "bake/effects/interreflection/coded_rows.h"

#include <algorithm>
#include <cmath>

#include "bake/base/vector8.h"

namespace opaline::bake {
namespace {

constexpr float kLargest = 32767;

OPALINE_VECTOR_CLONES
void add_codes(const std::int16_t* code, std::size_t count, float factor, float* to) {
    for (std::size_t k = 0; k < count; ++k) {
        to[k] += factor * static_cast<float>(code[k]);
    }
}

}  // namespace

void CodedRows::set(std::size_t i, std::span<const float> row) {
    float largest = 0;
    for (const float value : row) {
        largest = std::max(largest, std::abs(value));
    }
    const float scale = largest / kLargest;
    scale_[i] = scale;
    // 0 where the row is so dark that its scale is not a normal number.
    const float inverse = std::isnormal(scale) ? 1 / scale : 0;
    std::int16_t* const code = &code_[i * size_];
    for (std::size_t k = 0; k < size_; ++k) {
        code[k] = static_cast<std::int16_t>(std::lrint(row[k] * inverse));
    }
}

void CodedRows::add(std::size_t i, float weight, std::span<float> to) const {
    add_codes(&code_[i * size_], size_, weight * scale_[i], to.data());
}

std::vector<float> CodedRows::row(std::size_t i) const {
    std::vector<float> values(size_);
    add(i, 1, values);
    return values;
}

}  // namespace opaline::bake
