#include "bake/effects/multiple/walks/exit_cells.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cstring>

#include "bake/base/vector8.h"
#include "bake/physics/fresnel.h"
#include "formats/opal/cubemap.h"
#include "formats/opal/haar.h"

namespace opaline::bake {
namespace {

constexpr std::uint32_t kPerFace = ExitCells::kSide * ExitCells::kSide;
constexpr std::uint32_t kParts = 8;        // of a cell's side
constexpr std::uint32_t kNormalSide = 33;  // of a cube map of normals that share a table: 3 degrees
constexpr std::uint32_t kCosines = 1024;
constexpr std::uint8_t kCoarseCell = ExitCells::kCount;

ExitCells::Functions functions_of(const ExitDirection& direction) {
    const glm::vec3 w = direction.mean;
    const glm::mat3& s = direction.square;
    // Those of one degree have the same mean square over the sphere, whatever the axes.
    constexpr float kAxis = 0.86602540f;  // sqrt 3 / 2
    return {w.x,
            w.y,
            w.z,
            s[0][1],
            s[1][2],
            s[2][0],
            0.5f * (s[0][0] - s[1][1]),
            kAxis * (s[2][2] - 1 / 3.0f)};
}

ExitDirection one_direction(glm::vec3 w) {
    return {w, glm::outerProduct(w, w)};
}

// Which cell each Haar function lies in.
std::vector<std::uint8_t> cells_of_functions(std::uint32_t n) {
    std::vector<std::uint8_t> cells(formats::cubemap_texels(n), kCoarseCell);
    for (std::uint32_t k = 0; k < cells.size(); ++k) {
        const std::uint32_t face = k / (n * n), row = k / n % n, column = k % n;
        // The details of a level with `many` squares along an edge are the part of the 2 many x 2
        // many block outside its first many x many block.
        std::uint32_t many = ExitCells::kSide;
        while (row >= 2 * many || column >= 2 * many) {
            many *= 2;
        }
        if (row >= many || column >= many) {
            const std::uint32_t across = many / ExitCells::kSide;
            cells[k] = static_cast<std::uint8_t>((face * ExitCells::kSide + row % many / across) *
                                                     ExitCells::kSide +
                                                 column % many / across);
        }
    }
    return cells;
}

}  // namespace

ExitCells::ExitCells(std::span<const SurfaceSample> samples, std::uint32_t cubemap_size,
                     const ExitLobe& lobe)
    : lobe_(lobe), size_(cubemap_size), cell_(cells_of_functions(cubemap_size)) {
    for (std::uint32_t i = 0; i <= kCosines; ++i) {
        transmittance_.push_back(
            static_cast<float>(fresnel_transmittance(static_cast<double>(i) / kCosines, lobe.eta)));
    }
    // Cell by cell.
    std::vector<Part> parts(std::size_t{kCount} * kParts * kParts);
    const std::vector<formats::Vec3> moments = formats::texel_moments(kParts * kSide);
    for (std::uint32_t k = 0; k < moments.size(); ++k) {
        const std::uint32_t side = kParts * kSide, face = k / (side * side), row = k / side % side,
                            column = k % side;
        const std::uint32_t cell = (face * kSide + row / kParts) * kSide + column / kParts;
        const glm::vec3 moment(moments[k].x, moments[k].y, moments[k].z);
        const float length = glm::length(moment);
        parts[(cell * kParts + row % kParts) * kParts + column % kParts] = {
            moment / length, length, functions_of(one_direction(moment / length))};
    }
    std::vector<std::uint32_t> number(formats::cubemap_texels(kNormalSide), formats::kNone);
    table_.reserve(samples.size());
    for (const SurfaceSample& s : samples) {
        std::uint32_t& own =
            number[formats::texel_index(kNormalSide, {s.normal.x, s.normal.y, s.normal.z})];
        if (own == formats::kNone) {
            own = static_cast<std::uint32_t>(tables_.size());
            tables_.push_back(make_table(s.normal, parts));
        }
        table_.push_back(own);
    }
}

float ExitCells::transmittance(float cosine) const {
    const float place = static_cast<float>(kCosines) * std::min(1.0f, cosine);
    const auto below = std::min(kCosines - 1, static_cast<std::uint32_t>(place));
    const float share = place - static_cast<float>(below);
    return (1 - share) * transmittance_[below] + share * transmittance_[below + 1];
}

ExitCells::Table ExitCells::make_table(glm::vec3 normal, std::span<const Part> parts) const {
    constexpr auto kSize = static_cast<Eigen::Index>(kFunctions);
    using Vector = Eigen::Matrix<double, kSize, 1>;
    std::array<Vector, kCount> value;  // times p, over each cell
    std::array<double, kCount> p{};
    double all = 0;
    Vector mean = Vector::Zero();
    for (std::uint32_t cell = 0; cell < kCount; ++cell) {
        Functions sum{};
        float weights = 0;
        for (const Part& part :
             parts.subspan(std::size_t{cell} * kParts * kParts, kParts * kParts)) {
            const float cosine = glm::dot(part.direction, normal);
            if (cosine > 0) {
                const float weight = part.solid_angle * cosine * transmittance(cosine);
                weights += weight;
                for (std::size_t i = 0; i < kFunctions; ++i) {
                    sum[i] += weight * part.value[i];
                }
            }
        }
        p[cell] = static_cast<double>(weights);
        value[cell] = Eigen::Map<const Eigen::Matrix<float, kSize, 1>>(sum.data()).cast<double>();
        all += p[cell];
        mean += value[cell];
    }
    Table table{};
    if (!(all > 0)) return table;
    mean /= all;
    // Leave out cells that share only an edge with the cone of entering light.
    constexpr double kLeast = 1e-5;
    Eigen::Matrix<double, kSize, kSize> variance = decltype(variance)::Zero();
    for (std::uint32_t cell = 0; cell < kCount; ++cell) {
        if (p[cell] > kLeast * all) {
            value[cell] = value[cell] / p[cell] - mean;
            variance += p[cell] / all * value[cell] * value[cell].transpose();
        }
    }
    // Below index 1 the entering light fills a cone of few cells: too few to separate all
    // functions, and the cells' shares of the cone are inaccurate. A larger ridge keeps the fit
    // stable.
    constexpr double kRidge = 5e-5, kRidgeOfCone = 0.02;
    variance.diagonal().array() += kRidge + kRidgeOfCone * std::max(0.0, 1 - lobe_.eta);
    const auto solver = variance.ldlt();
    for (std::uint32_t cell = 0; cell < kCount; ++cell) {
        const Vector own =
            p[cell] > kLeast * all ? Vector(solver.solve(value[cell])) : Vector::Zero();
        for (std::size_t i = 0; i < kFunctions; ++i) {
            table.reproduces[i][cell] = static_cast<float>(own[static_cast<Eigen::Index>(i)]);
        }
    }
    for (std::size_t i = 0; i < kFunctions; ++i) {
        table.mean[i] = static_cast<float>(mean[static_cast<Eigen::Index>(i)]);
    }
    return table;
}

void ExitCells::add_exit(std::uint32_t sample, const ExitDirection& direction, glm::vec4 weight,
                         Sums& sums) const {
    const Table& table = tables_[table_[sample]];
    const Functions value = functions_of(direction);
    sums[0] += weight;
    for (std::size_t i = 0; i < kFunctions; ++i) {
        sums[1 + i] += (value[i] - table.mean[i]) * weight;
    }
}

namespace {

using Float4 = float __attribute__((vector_size(16)));

// weight[cell] = sums[0] + sum over functions of reproduces[function][cell] * sums[1 + function]
OPALINE_VECTOR_CLONES
void weigh_cells(const float* reproduces, const float* sums, float* weight) {
    for (std::size_t cell = 0; cell < ExitCells::kCount; ++cell) {
        weight[cell] = sums[0];
    }
    for (std::size_t i = 0; i < ExitCells::kFunctions; ++i) {
        for (std::size_t cell = 0; cell < ExitCells::kCount; ++cell) {
            weight[cell] += reproduces[i * ExitCells::kCount + cell] * sums[1 + i];
        }
    }
}

// sum[cell] += weight[cell] * average[cell]
OPALINE_VECTOR_CLONES
void add_averages(const float* weight, const float* average, float* sum) {
    for (std::size_t cell = 0; cell < ExitCells::kCount; ++cell) {
        sum[cell] += weight[cell] * average[cell];
    }
}

}  // namespace

ExitCells::Averages ExitCells::averages_of(const SparseVector& vector) const {
    Averages averages{};
    for (std::size_t i = 0; i < vector.index.size(); ++i) {
        const std::uint32_t k = vector.index[i];
        if (cell_[k] == kCoarseCell) {
            const std::uint32_t face = k / (size_ * size_);
            averages[(face * kSide + k / size_ % size_) * kSide + k % size_] = vector.value[i];
        }
    }
    std::array<float, kPerFace> scratch;
    for (std::uint32_t face = 0; face < formats::kCubeFaces; ++face) {
        formats::haar_inverse(std::span(averages).subspan(face * kPerFace, kPerFace), kSide,
                              scratch);
    }
    return averages;
}

void ExitCells::add(std::uint32_t sample, const SparseVector& vector, const Averages& averages,
                    const Sums& sums, const TexelRow& row, Cells& cells) const {
    const Table& table = tables_[table_[sample]];
    const std::size_t bands = row.step == 1 ? 1 : 3;
    std::array<std::array<float, kCount + 1>, 3> plane;  // the last, of averages: 0
    for (std::size_t b = 0; b < bands; ++b) {
        std::array<float, 1 + kFunctions> own;
        for (std::size_t i = 0; i < own.size(); ++i) {
            own[i] = sums[i][static_cast<glm::length_t>(b)];
        }
        weigh_cells(table.reproduces.front().data(), own.data(), plane[b].data());
        plane[b][kCoarseCell] = 0;
        add_averages(plane[b].data(), averages.data(), cells[b].data());
    }
    float* const to = row.values.data();
    const std::size_t count = vector.index.size();
    if (bands == 1) {
        for (std::size_t i = 0; i < count; ++i) {
            const std::uint32_t k = vector.index[i];
            to[k] += vector.value[i] * plane[0][cell_[k]];
        }
        return;
    }
    std::array<Float4, kCount + 1> weight;
    for (std::size_t cell = 0; cell < weight.size(); ++cell) {
        weight[cell] = Float4{plane[0][cell], plane[1][cell], plane[2][cell], 0};
    }
    for (std::size_t i = 0; i < count; ++i) {
        const std::uint32_t k = vector.index[i];
        float* const place = to + 4 * std::size_t{k};
        Float4 sum;
        std::memcpy(&sum, place, sizeof sum);
        sum += vector.value[i] * weight[cell_[k]];
        std::memcpy(place, &sum, sizeof sum);
    }
}

void ExitCells::add_cells(const Cells& cells, const TexelRow& row) const {
    std::array<float, kPerFace> own, scratch;
    const std::size_t bands = row.step == 1 ? 1 : 3;
    for (std::uint32_t face = 0; face < formats::kCubeFaces; ++face) {
        for (std::size_t b = 0; b < bands; ++b) {
            for (std::uint32_t c = 0; c < kPerFace; ++c) {
                own[c] = cells[b][face * kPerFace + c];
            }
            formats::haar_forward(std::span(own), kSide, scratch);
            for (std::uint32_t c = 0; c < kPerFace; ++c) {
                const std::uint32_t in_row = c / kSide, in_column = c % kSide;
                if (std::max(in_row, in_column) >= size_) continue;  // too fine for the row
                const std::size_t k = (face * std::size_t{size_} + in_row) * size_ + in_column;
                row.values[row.step * k + b] += own[c];
            }
        }
    }
}

}  // namespace opaline::bake
