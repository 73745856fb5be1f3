#include "bake/trace/coded_rows.h"

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

OPALINE_VECTOR_CLONES
float find_largest(const float* row, std::size_t count) {
    // Independent maxima, which the compiler keeps in one register.
    constexpr std::size_t kLanes = 16;
    float most[kLanes] = {};
    std::size_t k = 0;
    for (; k + kLanes <= count; k += kLanes) {
        for (std::size_t j = 0; j < kLanes; ++j) {
            const float value = row[k + j] < 0 ? -row[k + j] : row[k + j];
            most[j] = value > most[j] ? value : most[j];
        }
    }
    for (; k < count; ++k) {
        const float value = row[k] < 0 ? -row[k] : row[k];
        most[0] = value > most[0] ? value : most[0];
    }
    float all = 0;
    for (const float value : most) {
        all = value > all ? value : all;
    }
    return all;
}

OPALINE_VECTOR_CLONES
void encode(const float* row, std::size_t count, float inverse, std::int16_t* code) {
    for (std::size_t k = 0; k < count; ++k) {
        const float value = row[k] * inverse;
        code[k] = static_cast<std::int16_t>(
            static_cast<std::int32_t>(value + (value < 0 ? -0.5f : 0.5f)));
    }
}

}  // namespace

void CodedRows::set(std::size_t i, std::span<const float> row) {
    const float scale = find_largest(row.data(), size_) / kLargest;
    scale_[i] = scale;
    // 0 where the row is so dark that its scale is not a normal number.
    encode(row.data(), size_, std::isnormal(scale) ? 1 / scale : 0, &code_[i * size_]);
}

void CodedRows::add(std::size_t i, float weight, std::span<float> to) const {
    add_codes(&code_[i * size_], size_, weight * scale_[i], to.data());
}

void CodedRows::add_part(std::size_t i, std::size_t first, float weight,
                         std::span<float> to) const {
    add_codes(&code_[i * size_ + first], to.size(), weight * scale_[i], to.data());
}

std::vector<float> CodedRows::row(std::size_t i) const {
    std::vector<float> values(size_);
    add(i, 1, values);
    return values;
}

}  // namespace opaline::bake
