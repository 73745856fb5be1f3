#include "runtime/clouds/layer_march.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "runtime/clouds/single_scattering.h"

namespace opaline::runtime {
namespace {

struct Part {
    double begin = 0, end = 0;
};

// Cuts [begin, end] down to where low <= position + t direction <= high.
void cut_to(Part& part, double position, double direction, double low, double high) {
    if (direction == 0) {
        if (position < low || position > high) part.end = part.begin;
        return;
    }
    double in = (low - position) / direction, out = (high - position) / direction;
    if (in > out) std::swap(in, out);
    part.begin = std::max(part.begin, in);
    part.end = std::min(part.end, out);
}

// Where the ray may be inside; empty if end <= begin.
Part part_within(const LayerField& field, const LayerRay& ray) {
    Part part{ray.begin, std::min(ray.end, kFarthest)};
    const double base = static_cast<double>(field.base);
    cut_to(part, static_cast<double>(ray.origin.y), static_cast<double>(ray.direction.y), base,
           base + static_cast<double>(field.highest));
    if (field.repeats()) return part;
    // Coarse levels reach beyond the edge by half a texel.
    const double margin_x = field.size_x / 8, margin_z = field.size_z / 8;
    cut_to(part, static_cast<double>(ray.origin.x), static_cast<double>(ray.direction.x),
           field.low_x - margin_x, field.low_x + field.size_x + margin_x);
    cut_to(part, static_cast<double>(ray.origin.z), static_cast<double>(ray.direction.z),
           field.low_z - margin_z, field.low_z + field.size_z + margin_z);
    return part;
}

// The part of a step that is inside, as shares of it, where the height below the top goes linearly
// from `first` to `last`.
struct Inside {
    float begin = 0, end = 0;
};
Inside inside_of(float first, float last) {
    if (first <= 0 && last <= 0) return {};
    if (first > 0 && last > 0) return {0, 1};
    const float crossing = first / (first - last);
    return first > 0 ? Inside{0, crossing} : Inside{crossing, 1};
}

}  // namespace

LayerMarch march_layer(const LayerField& field, const LayerRay& ray, float kappa) {
    LayerMarch march;
    const Part part = part_within(field, ray);
    if (!(part.end > part.begin) || !(field.highest > 0)) return march;
    // Distances (begin + offset) ratio^i - offset.
    const double offset = static_cast<double>(field.highest) / 2;
    const double ratio = std::pow((part.end + offset) / (part.begin + offset), 1.0 / kLayerSteps);
    const double level_scale =
        std::hypot(static_cast<double>(ray.direction.x), static_cast<double>(ray.direction.z)) *
        (ratio - 1);
    const double height = static_cast<double>(ray.origin.y) - static_cast<double>(field.base);
    const double climb = static_cast<double>(ray.direction.y);
    const auto level_at = [&](double t) {
        return field.level_of(
            std::max(level_scale * (t + offset), static_cast<double>(ray.spread) * t));
    };
    constexpr float kOpaque = 20;  // optical depth

    double t = part.begin;
    float level = level_at(t);
    float thickness = sample_thickness(field, ray.x(t), ray.z(t), level);
    float below_top = thickness - static_cast<float>(height + climb * t);
    float weights = 0, thickness_sum = 0, level_sum = 0;
    double distance_sum = 0, growth = 1;
    for (int i = 0; i < kLayerSteps && kappa * march.length < kOpaque; ++i) {
        growth *= ratio;
        const double next =
            i + 1 < kLayerSteps ? (part.begin + offset) * growth - offset : part.end;
        const float next_level = level_at(next);
        const float next_thickness = sample_thickness(field, ray.x(next), ray.z(next), next_level);
        const float next_below = next_thickness - static_cast<float>(height + climb * next);
        const Inside inside = inside_of(below_top, next_below);
        if (inside.end > inside.begin) {
            const float length = (inside.end - inside.begin) * static_cast<float>(next - t);
            const float weight = std::exp(-kappa * march.length) * taken_share(kappa * length);
            const float middle = (inside.begin + inside.end) / 2;
            march.length += length;
            weights += weight;
            thickness_sum += weight * (thickness + middle * (next_thickness - thickness));
            level_sum += weight * (level + middle * (next_level - level));
            distance_sum +=
                static_cast<double>(weight) * (t + static_cast<double>(middle) * (next - t));
        }
        t = next;
        level = next_level;
        thickness = next_thickness;
        below_top = next_below;
    }
    if (!(weights > 0)) {
        march.length = 0;
        return march;
    }
    march.distance = distance_sum / static_cast<double>(weights);
    march.thickness = thickness_sum / weights;
    march.level = level_sum / weights;
    return march;
}

}  // namespace opaline::runtime
