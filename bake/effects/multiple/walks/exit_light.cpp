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
                     std::optional<ExitCells> cells, double escape, const SparseVectors* other) {
    Part& part =
        parts_.emplace_back(Part{.samples = samples,
                                 .light = &light,
                                 .cells = std::move(cells),
                                 .averages = {},
                                 .other = other,
                                 .scale = static_cast<float>(1 / (std::numbers::pi * escape)),
                                 .grid = {sample_points(samples), cell_size(samples)},
                                 .around = {}});
    std::vector<std::uint32_t> around;
    for (std::size_t cell = 0; cell < part.grid.cells(); ++cell) {
        part.grid.collect_around(part.grid.name_of(cell), around);
        part.around.insert(part.around.end(), around.begin(), around.end());
        part.first.push_back(static_cast<std::uint32_t>(part.around.size()));
    }
    part.averages.reserve(part.cells ? light.size() : 0);
    for (std::size_t j = 0; part.cells && j < light.size(); ++j) {
        part.averages.push_back(part.cells->averages_of(light[j]));
    }
}

void ExitLight::add_body(std::uint32_t material, ExitLight light) {
    for (Part& part : light.parts_) {
        part.material = material;
        part.begin = parts_.back().begin + static_cast<std::uint32_t>(parts_.back().samples.size());
        parts_.push_back(std::move(part));
    }
}

// Makes the number that of a sample of the part.
const ExitLight::Part& ExitLight::part_of(std::uint32_t& sample) const {
    std::size_t p = parts_.size() - 1;
    while (sample < parts_[p].begin) {
        --p;
    }
    sample -= parts_[p].begin;
    return parts_[p];
}

std::uint32_t ExitLight::nearest(const WalkExit& exit, std::vector<std::uint32_t>& around) const {
    const Part* of = &parts_.front();
    for (const Part& part : parts_) {
        if (part.material == exit.material) {
            of = &part;
        }
    }
    return of->begin + of->nearest(exit, around);
}

std::uint32_t ExitLight::Part::nearest(const WalkExit& exit,
                                       std::vector<std::uint32_t>& around_exit) const {
    constexpr float kFacing = 0.3f;
    const auto search = [&](std::span<const std::uint32_t> candidates) {
        std::uint32_t best = formats::kNone, any = formats::kNone;
        float best_distance = std::numeric_limits<float>::max(), any_distance = best_distance;
        for (const std::uint32_t j : candidates) {
            const glm::vec3 d = samples[j].position - exit.position;
            const float distance = glm::dot(d, d);
            if (distance < any_distance) {
                any = j, any_distance = distance;
            }
            if (distance < best_distance && glm::dot(samples[j].normal, exit.normal) > kFacing) {
                best = j, best_distance = distance;
            }
        }
        return best != formats::kNone ? best : any;
    };
    const std::uint64_t key = grid.cell_of(exit.position);
    const std::size_t cell = grid.cell_at(key);
    if (cell < grid.cells()) {
        return search(std::span(around).subspan(first[cell], first[cell + 1] - first[cell]));
    }
    grid.collect_around(key, around_exit);
    const std::uint32_t near = search(around_exit);
    if (near != formats::kNone) return near;
    around_exit.resize(samples.size());
    for (std::uint32_t j = 0; j < samples.size(); ++j) {
        around_exit[j] = j;
    }
    return search(around_exit);
}

glm::vec4 ExitLight::weigh(std::uint32_t sample, const WalkExit& exit, float scale) const {
    const Part& part = part_of(sample);
    const float area = part.samples[sample].area;
    const float factor = area > 0 ? scale * part.scale / area : 0;
    return {factor * exit.weight[0], factor * exit.weight[1], factor * exit.weight[2], 0};
}

void ExitLight::add_exit(std::uint32_t sample, const WalkExit& exit, float scale,
                         ExitCells::Sums& sums) const {
    const glm::vec4 weight = weigh(sample, exit, scale);
    const Part& part = part_of(sample);
    const SurfaceSample& s = part.samples[sample];
    if (!(s.area > 0)) return;
    if (part.cells) {
        part.cells->add_exit(sample, part.cells->lobe().direction(s.normal, exit), weight, sums);
    } else {
        sums[0] += weight;
    }
}

void ExitLight::add(std::uint32_t sample, const ExitCells::Sums& sums, const TexelRow& row,
                    ExitCells::Cells& cells) const {
    std::uint32_t own = sample;
    const Part& part = part_of(own);
    const SparseVector entries = (*part.light)[own];
    if (part.cells) {
        part.cells->add(own, entries, part.averages[own], sums, row, cells);
    } else {
        add_weighted(entries, sums[0], row);
    }
    add_diffuse(sample, sums[0], row);  // the mean of a lobe over such light is 1
}

void ExitLight::add_cells(const ExitCells::Cells& cells, const TexelRow& row) const {
    if (parts_.front().cells) {
        parts_.front().cells->add_cells(cells, row);
    }
}

void ExitLight::add_diffuse(std::uint32_t sample, const glm::vec4& weight,
                            const TexelRow& row) const {
    const Part& part = part_of(sample);
    if (part.other == nullptr) return;
    const SparseVector entries = (*part.other)[sample];
    const glm::length_t bands = row.step == 1 ? 1 : 3;
    for (std::size_t i = 0; i < entries.index.size(); ++i) {
        float* const to = &row.values[row.step * entries.index[i]];
        for (glm::length_t b = 0; b < bands; ++b) {
            const auto band = static_cast<std::size_t>(b);
            to[b] += weight[b] * entries.value[part.other->bands == 1 ? i : 3 * i + band];
        }
    }
}

void ExitLight::add_views(std::uint32_t sample, std::span<const std::array<float, 3>> weight,
                          const TexelRow& rows) const {
    std::uint32_t own = sample;
    const Part& part = part_of(own);
    const SurfaceSample& s = part.samples[own];
    const float scale = s.area > 0 ? part.scale / s.area : 0;
    const std::size_t size = rows.values.size() / weight.size();
    for (std::size_t r = 0; r < weight.size(); ++r) {
        const glm::vec4 factor{scale * weight[r][0], scale * weight[r][1], scale * weight[r][2], 0};
        const TexelRow row{rows.values.subspan(r * size, size), rows.step};
        add_weighted((*part.light)[own], factor, row);
        add_diffuse(sample, factor, row);
    }
}

}  // namespace opaline::bake
