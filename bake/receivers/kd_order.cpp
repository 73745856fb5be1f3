#include "bake/receivers/kd_order.h"

#include <algorithm>
#include <numeric>

namespace opaline::bake {
namespace {

void split(std::span<const SurfaceSample> samples, std::span<std::uint32_t> order) {
    if (order.size() <= kSamplesPerLeaf) return;
    glm::vec3 low = samples[order[0]].position, high = low;
    for (const std::uint32_t i : order) {
        low = glm::min(low, samples[i].position);
        high = glm::max(high, samples[i].position);
    }
    const glm::vec3 size = high - low;
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const std::size_t half = first_child_count(static_cast<std::uint32_t>(order.size()));
    const auto middle = order.begin() + static_cast<std::ptrdiff_t>(half);
    std::nth_element(order.begin(), middle, order.end(), [&](std::uint32_t a, std::uint32_t b) {
        const float x = samples[a].position[axis], y = samples[b].position[axis];
        return x != y ? x < y : a < b;
    });
    split(samples, order.first(half));
    split(samples, order.subspan(half));
}

}  // namespace

std::uint32_t first_child_count(std::uint32_t count) {
    const std::uint32_t unit = count > kSamplesPerGroup ? kSamplesPerGroup : kSamplesPerLeaf;
    return (count + unit - 1) / unit / 2 * unit;
}

std::vector<std::uint32_t> kd_order(std::span<const SurfaceSample> samples) {
    std::vector<std::uint32_t> order(samples.size());
    std::iota(order.begin(), order.end(), 0u);
    split(samples, order);
    return order;
}

void sort_into_groups(std::vector<SurfaceSample>& samples) {
    std::vector<SurfaceSample> sorted;
    sorted.reserve(samples.size());
    for (const std::uint32_t i : kd_order(samples)) {
        sorted.push_back(samples[i]);
    }
    samples = std::move(sorted);
}

}  // namespace opaline::bake
