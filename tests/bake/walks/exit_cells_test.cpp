#include "bake/effects/multiple/walks/exit_cells.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "bake/physics/fresnel.h"
#include "formats/opal/cubemap.h"
#include "formats/opal/haar.h"

namespace opaline::bake {
namespace {

SurfaceSample facing(glm::vec3 normal) {
    SurfaceSample sample{};
    sample.normal = sample.geometric_normal = glm::normalize(normal);
    sample.area = 1;
    return sample;
}

// A whole Haar vector and its indices.
struct HaarVector {
    std::vector<std::uint32_t> index;
    std::vector<float> value;
    double all = 0;  // its sum before the transform
};

// F_t c L(w) over a sphere without obstacles, of the given light L.
template <class Light>
HaarVector entering(std::uint32_t size, double eta, glm::vec3 normal, Light&& light) {
    const std::vector<double> solid_angle = formats::texel_solid_angles(size);
    HaarVector haar;
    haar.index.resize(formats::cubemap_texels(size));
    std::iota(haar.index.begin(), haar.index.end(), 0u);
    for (std::uint32_t k = 0; k < haar.index.size(); ++k) {
        const std::uint32_t face = k / (size * size), texel = k % (size * size);
        const formats::Vec3 d = formats::texel_direction(size, face, texel / size, texel % size);
        const glm::vec3 w(d.x, d.y, d.z);
        const auto c = static_cast<double>(glm::dot(w, normal));
        haar.value.push_back(c > 0 ? static_cast<float>(c * fresnel_transmittance(c, eta) *
                                                        light(w) * solid_angle[texel])
                                   : 0.0f);
    }
    haar.all = std::accumulate(haar.value.begin(), haar.value.end(), 0.0);
    formats::haar_forward_cube(std::span(haar.value), size);
    return haar;
}

// What an exit sees of it, integrated over the sphere.
double seen(const ExitCells& cells, const HaarVector& light, const ExitDirection& direction,
            std::uint32_t size) {
    std::vector<float> row(4 * light.value.size());
    ExitCells::Sums sums{};
    ExitCells::Cells own{};
    cells.add_exit(0, direction, {1, 0.5f, 0, 0}, sums);
    const SparseVector vector{light.index, light.value};
    cells.add(0, vector, cells.averages_of(vector), sums, {row, 4}, own);
    cells.add_cells(own, {row, 4});
    double sum = 0;
    for (std::uint32_t face = 0; face < formats::kCubeFaces; ++face) {
        // A face's first coefficient is its average times its side.
        const float* average = &row[4 * std::size_t{face} * size * size];
        EXPECT_NEAR(average[1], 0.5f * average[0], 1e-5f * std::abs(average[0]) + 1e-6f);
        EXPECT_EQ(average[2], 0);
        sum += static_cast<double>(average[0]) * size;
    }
    return sum;
}

ExitDirection one(glm::vec3 towards) {
    const glm::vec3 w = glm::normalize(towards);
    return {w, glm::outerProduct(w, w)};
}

constexpr std::uint32_t kSize = 64;  // fine enough to integrate over

// Whatever an exit's direction, even light is as bright there as elsewhere, also where light leaves
// along the surface, or along the cone outside of which none leaves.
TEST(ExitCells, SeeEvenLightAsBrightFromEveryExit) {
    for (const double eta : {0.5, 0.8, 1.0, 1.3, 1.8}) {
        for (const glm::vec3 up : {glm::vec3(0, 1, 0), glm::vec3(-1, 0.3f, 0.6f)}) {
            const std::vector<SurfaceSample> samples{facing(up)};
            const glm::vec3 n = samples[0].normal;
            const ExitCells cells(samples, kSize, make_exit_lobe(eta));
            const HaarVector light = entering(kSize, eta, n, [](glm::vec3) { return 1.0; });
            const glm::vec3 across = glm::normalize(glm::cross(n, glm::vec3(0.2f, 0.1f, 0.7f)));
            const auto widest = eta < 1 ? static_cast<float>(std::asin(eta)) : 1.56f;
            for (const float part : {0.0f, 0.5f, 0.9f, 1.0f}) {
                const ExitDirection direction =
                    one(std::cos(part * widest) * n - std::sin(part * widest) * across);
                EXPECT_NEAR(seen(cells, light, direction, kSize) / light.all, 1,
                            eta < 1 ? 0.08 : 0.01)
                    << eta << " " << part;
            }
        }
    }
}

// Lamps light media of few vertices through cube maps of 1, 2 or 4 texels: coarser than the cells.
TEST(ExitCells, RowsOfCoarseCubeMapsHaveTheCoarseCoefficientsOfFineOnes) {
    const std::vector<SurfaceSample> samples{facing({0.3f, 1, 0.2f})};
    const ExitLobe lobe = make_exit_lobe(1.4);
    const HaarVector light = entering(kSize, 1.4, samples[0].normal, [](glm::vec3) { return 1.0; });
    for (const std::uint32_t size : {1u, 2u, 4u}) {
        std::vector<std::uint32_t> coarse, fine;
        std::vector<float> value;
        for (std::uint32_t k = 0; k < formats::cubemap_texels(size); ++k) {
            const std::uint32_t line = k / (size * size) * kSize + k / size % size;
            coarse.push_back(k);
            fine.push_back(line * kSize + k % size);
            value.push_back(light.value[fine.back()]);
        }
        const auto row_of = [&](std::uint32_t n, const std::vector<std::uint32_t>& index) {
            const ExitCells cells(samples, n, lobe);
            std::vector<float> row(4 * formats::cubemap_texels(n));
            ExitCells::Sums sums{};
            ExitCells::Cells own{};
            cells.add_exit(0, one({-0.5f, 1, 0.4f}), {1, 0.5f, 0.2f, 0}, sums);
            const SparseVector vector{index, value};
            cells.add(0, vector, cells.averages_of(vector), sums, {row, 4}, own);
            cells.add_cells(own, {row, 4});
            return row;
        };
        const std::vector<float> few = row_of(size, coarse), many = row_of(kSize, fine);
        for (std::size_t k = 0; k < 4 * coarse.size(); ++k) {
            EXPECT_EQ(few[k], many[4 * fine[k / 4] + k % 4]) << size << " " << k;
        }
    }
}

// Light that is a quadratic function of the direction is seen as it is where it comes from, at any
// angle, but for what cells 22 degrees wide smooth of it.
TEST(ExitCells, SeeLightOfDegreeTwoAsItIsTowardsTheExit) {
    const auto of_degree_two = [](glm::vec3 w) {
        const glm::dvec3 d(w);
        return 2 + 0.3 * d.x - 0.7 * d.y + 0.5 * d.z + 0.8 * d.x * d.y - 0.6 * d.z * d.z +
               0.4 * d.x * d.z + 0.9 * d.y * d.y;
    };
    for (const double eta : {1.0, 1.5}) {
        const std::vector<SurfaceSample> samples{facing({-1, 0.3f, 0.6f})};
        const glm::vec3 n = samples[0].normal;
        const ExitCells cells(samples, kSize, make_exit_lobe(eta));
        const double all = entering(kSize, eta, n, [](glm::vec3) { return 1.0; }).all;
        const HaarVector light = entering(kSize, eta, n, of_degree_two);
        const glm::vec3 across = glm::normalize(glm::cross(n, glm::vec3(0.2f, 0.1f, 0.7f)));
        for (const float slope : {0.0f, 0.5f, -1.0f, 8.0f, -30.0f}) {
            const ExitDirection direction = one(n + slope * across);
            EXPECT_NEAR(seen(cells, light, direction, kSize) / all, of_degree_two(direction.mean),
                        0.02)
                << eta << " " << slope;
        }
    }
}

}  // namespace
}  // namespace opaline::bake
