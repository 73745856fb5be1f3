#include "bake/effects/multiple/walks/exit_light.h"

#include <cmath>
#include <cstring>
#include <limits>
#include <numbers>
#include <utility>

namespace opaline::bake {
namespace {

using Float4 = float __attribute__((vector_size(16)));

void add_weighted(const SparseVector& entries, const glm::vec4& weight, const TexelRow& row) {
    float* const to = row.values.data();
    if (row.step == 1) {
        for (std::size_t i = 0; i < entries.index.size(); ++i) {
            to[entries.index[i]] += weight.x * entries.value[i];
        }
        return;
    }
    const Float4 factor{weight.x, weight.y, weight.z, 0};
    for (std::size_t i = 0; i < entries.index.size(); ++i) {
        float* const place = to + 4 * std::size_t{entries.index[i]};
        Float4 sum;
        std::memcpy(&sum, place, sizeof sum);
        sum += factor * entries.value[i];
        std::memcpy(place, &sum, sizeof sum);
    }
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
      grid_(sample_points(samples), cell_size(samples)) {
    std::vector<std::uint32_t> around;
    for (std::size_t cell = 0; cell < grid_.cells(); ++cell) {
        grid_.collect_around(grid_.name_of(cell), around);
        around_.insert(around_.end(), around.begin(), around.end());
        first_.push_back(static_cast<std::uint32_t>(around_.size()));
    }
    averages_.reserve(cells_ ? light.size() : 0);
    for (std::size_t j = 0; cells_ && j < light.size(); ++j) {
        averages_.push_back(cells_->averages_of(light[j]));
    }
}

std::uint32_t ExitLight::nearest(const WalkExit& exit, std::vector<std::uint32_t>& around) const {
    constexpr float kFacing = 0.3f;
    const auto search = [&](std::span<const std::uint32_t> candidates) {
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
    const std::uint64_t key = grid_.cell_of(exit.position);
    const std::size_t cell = grid_.cell_at(key);
    if (cell < grid_.cells()) {
        return search(std::span(around_).subspan(first_[cell], first_[cell + 1] - first_[cell]));
    }
    grid_.collect_around(key, around);
    const std::uint32_t near = search(around);
    if (near != formats::kNone) return near;
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
    if (!(s.area > 0)) return;
    const glm::vec4 weight = weigh(sample, exit, scale);
    if (cells_) {
        cells_->add_exit(sample, cells_->lobe().direction(s.normal, exit), weight, sums);
    } else {
        sums[0] += weight;
    }
}

void ExitLight::add(std::uint32_t sample, const ExitCells::Sums& sums, const TexelRow& row,
                    ExitCells::Cells& cells) const {
    const SparseVector entries = light_[sample];
    if (cells_) {
        cells_->add(sample, entries, averages_[sample], sums, row, cells);
    } else {
        add_weighted(entries, sums[0], row);
    }
    add_diffuse(sample, sums[0], row);  // the mean of a lobe over such light is 1
}

void ExitLight::add_cells(const ExitCells::Cells& cells, const TexelRow& row) const {
    if (cells_) {
        cells_->add_cells(cells, row);
    }
}

void ExitLight::add_diffuse(std::uint32_t sample, const glm::vec4& weight,
                            const TexelRow& row) const {
    if (other_ == nullptr) return;
    const SparseVector entries = (*other_)[sample];
    const glm::length_t bands = row.step == 1 ? 1 : 3;
    for (std::size_t i = 0; i < entries.index.size(); ++i) {
        float* const to = &row.values[row.step * entries.index[i]];
        for (glm::length_t b = 0; b < bands; ++b) {
            const auto band = static_cast<std::size_t>(b);
            to[b] += weight[b] * entries.value[other_->bands == 1 ? i : 3 * i + band];
        }
    }
}

void ExitLight::add_views(std::uint32_t sample, std::span<const std::array<float, 3>> weight,
                          const TexelRow& rows) const {
    const SurfaceSample& s = samples_[sample];
    const float scale = s.area > 0 ? scale_ / s.area : 0;
    const std::size_t size = rows.values.size() / weight.size();
    for (std::size_t r = 0; r < weight.size(); ++r) {
        const glm::vec4 factor{scale * weight[r][0], scale * weight[r][1], scale * weight[r][2], 0};
        const TexelRow row{rows.values.subspan(r * size, size), rows.step};
        add_weighted(light_[sample], factor, row);
        add_diffuse(sample, factor, row);
    }
}

}  // namespace opaline::bake
