#include "bake/effects/multiple/walks/exit_light.h"

#include <cmath>
#include <cstring>
#include <limits>
#include <numbers>
#include <utility>

namespace opaline::bake {
namespace {

using Float4 = float __attribute__((vector_size(16)));

void add_to(float* to, Float4 value) {
    Float4 sum;
    std::memcpy(&sum, to, sizeof sum);
    sum += value;
    std::memcpy(to, &sum, sizeof sum);
}

std::vector<SurfacePoint> sample_points(std::span<const SurfaceSample> samples) {
    std::vector<SurfacePoint> points;
    points.reserve(samples.size());
    for (const SurfaceSample& s : samples) {
        points.push_back({.position = s.position, .normal = s.geometric_normal});
    }
    return points;
}

// Cells twice as wide as samples are apart: the nearest sample lies in one of the 27 around.
float cell_size(std::span<const SurfaceSample> samples) {
    double area = 0;
    for (const SurfaceSample& s : samples) {
        area += static_cast<double>(s.area);
    }
    const double each = samples.empty() ? 0 : area / static_cast<double>(samples.size());
    return each > 0 ? static_cast<float>(1.5 * std::sqrt(each)) : 1.0f;
}

}  // namespace

ExitLight::ExitLight(std::span<const SurfaceSample> samples, const SparseVectors& light,
                     std::optional<ExitCells> cells, double escape, const SparseVectors* other)
    : samples_(samples),
      light_(light),
      cells_(std::move(cells)),
      other_(other),
      scale_(static_cast<float>(1 / (std::numbers::pi * escape))),
      grid_(sample_points(samples), cell_size(samples)) {}

std::uint32_t ExitLight::nearest(const WalkExit& exit, std::vector<std::uint32_t>& around) const {
    constexpr float kFacing = 0.3f;
    const auto search = [&](auto&& candidates) {
        std::uint32_t best = formats::kNone, any = formats::kNone;
        float best_distance = std::numeric_limits<float>::max(), any_distance = best_distance;
        for (const std::uint32_t j : candidates) {
            const glm::vec3 d = samples_[j].position - exit.position;
            const float distance = glm::dot(d, d);
            if (distance < any_distance) {
                any = j, any_distance = distance;
            }
            if (distance < best_distance && glm::dot(samples_[j].normal, exit.normal) > kFacing) {
                best = j, best_distance = distance;
            }
        }
        return best != formats::kNone ? best : any;
    };
    grid_.collect_around(grid_.cell_of(exit.position), around);
    const std::uint32_t near = search(around);
    if (near != formats::kNone) {
        return near;
    }
    around.resize(samples_.size());
    for (std::uint32_t j = 0; j < samples_.size(); ++j) {
        around[j] = j;
    }
    return search(around);
}

glm::vec4 ExitLight::weigh(std::uint32_t sample, const WalkExit& exit, float scale) const {
    const float area = samples_[sample].area;
    const float factor = area > 0 ? scale * scale_ / area : 0;
    return {factor * exit.weight[0], factor * exit.weight[1], factor * exit.weight[2], 0};
}

void ExitLight::add_exit(std::uint32_t sample, const WalkExit& exit, float scale,
                         ExitCells::Sums& sums) const {
    const SurfaceSample& s = samples_[sample];
    if (!(s.area > 0)) {
        return;
    }
    const glm::vec4 weight = weigh(sample, exit, scale);
    if (cells_) {
        cells_->add_exit(sample, cells_->lobe().direction(s.normal, exit), weight, sums);
    } else {
        sums[0] += weight;
    }
}

void ExitLight::add(std::uint32_t sample, const ExitCells::Sums& sums, std::span<float> rgbx,
                    ExitCells::Cells& cells) const {
    const SparseVector entries = light_[sample];
    const glm::vec4& all = sums[0];
    if (cells_) {
        cells_->add(sample, entries, sums, rgbx, cells);
    } else {
        const Float4 factor{all.x, all.y, all.z, 0};
        for (std::size_t i = 0; i < entries.index.size(); ++i) {
            add_to(&rgbx[4 * std::size_t{entries.index[i]}], factor * entries.value[i]);
        }
    }
    add_diffuse(sample, all, rgbx);  // the mean of a lobe over such light is 1
}

void ExitLight::add_cells(const ExitCells::Cells& cells, std::span<float> rgbx) const {
    if (cells_) {
        cells_->add_cells(cells, rgbx);
    }
}

void ExitLight::add_diffuse(std::uint32_t sample, const glm::vec4& weight,
                            std::span<float> rgbx) const {
    if (other_ == nullptr) {
        return;
    }
    const SparseVector entries = (*other_)[sample];
    for (std::size_t i = 0; i < entries.index.size(); ++i) {
        float* const to = &rgbx[4 * std::size_t{entries.index[i]}];
        for (glm::length_t b = 0; b < 3; ++b) {
            const auto band = static_cast<std::size_t>(b);
            to[b] += weight[b] * entries.value[other_->bands == 1 ? i : 3 * i + band];
        }
    }
}

void ExitLight::add_views(std::uint32_t sample, std::span<const std::array<float, 3>> weight,
                          std::span<float> rows) const {
    const SurfaceSample& s = samples_[sample];
    const float scale = s.area > 0 ? scale_ / s.area : 0;
    const SparseVector entries = light_[sample];
    const std::size_t size = rows.size() / weight.size();
    for (std::size_t row = 0; row < weight.size(); ++row) {
        const Float4 factor{scale * weight[row][0], scale * weight[row][1], scale * weight[row][2],
                            0};
        float* const to = &rows[row * size];
        for (std::size_t i = 0; i < entries.index.size(); ++i) {
            add_to(&to[4 * std::size_t{entries.index[i]}], factor * entries.value[i]);
        }
        add_diffuse(sample, {factor[0], factor[1], factor[2], 0}, rows.subspan(row * size, size));
    }
}

}  // namespace opaline::bake
