#include <gtest/gtest.h>

#include <cmath>

#include "bake/encode/pack_asset.h"
#include "bake/encode/select_coefficients.h"
#include "bake/receivers/vertex_receivers.h"
#include "bake/trace/irradiance_transport.h"
#include "formats/opal/cubemap.h"
#include "formats/opal/haar.h"
#include "tests/support/bake.h"

namespace opaline::bake {
namespace {

constexpr std::uint32_t kSize = 32;

double relative_error(const std::vector<formats::Rgb>& a, const std::vector<formats::Rgb>& b) {
    double error = 0, reference = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        error += std::pow(formats::luminance(a[i]) - formats::luminance(b[i]), 2);
        reference += std::pow(formats::luminance(b[i]), 2);
    }
    return std::sqrt(error / reference);
}

std::vector<std::vector<float>> dense_rows(const formats::Scene& scene) {
    const auto rays = RayScene::build(scene, 2);
    const DirectionSet directions = make_direction_set(kSize);
    std::vector<std::vector<float>> rows;
    for (const Receiver& receiver : make_vertex_receivers(scene)) {
        rows.emplace_back(formats::cubemap_texels(kSize));
        gather_irradiance(*rays, directions, receiver, rows.back());
        formats::haar_forward_cube(std::span<float>(rows.back()), kSize);
    }
    return rows;
}

formats::Asset pack(const formats::Scene& scene, const std::vector<std::vector<float>>& dense,
                    std::uint32_t kept, std::uint32_t bits) {
    const Selector selector = make_selector(kSize, kept);
    formats::SparseRows rows = formats::make_sparse_rows(kSize, bits);
    for (const std::vector<float>& row : dense) {
        EXPECT_TRUE(formats::append_row(rows, select_coefficients(selector, row, 1)));
    }
    const std::vector<RowLayout> layouts(scene.materials.size());
    return pack_asset(scene, layouts, std::move(rows), {});
}

// Keeping more of the N^2 terms brings the picture closer to the one with all of them.
TEST(Truncation, RelitErrorFallsMonotonicallyWithTheNumberOfCoefficients) {
    const auto scene = tests::make_dented_ball();
    const auto dense = dense_rows(scene);
    const formats::Asset all = pack(scene, dense, kAllCoefficients, 16);
    for (const char* name : {"studio", "sky:3,35", "sun:40,50"}) {
        const runtime::LightVector light = tests::make_light(name, kSize);
        const auto reference = tests::relight(all.view(), light);
        double previous = 1;
        for (const std::uint32_t kept : {16u, 64u, 128u, 256u, 512u, 1024u}) {
            const formats::Asset some = pack(scene, dense, kept, 16);
            const double error = relative_error(tests::relight(some.view(), light), reference);
            EXPECT_LT(error, previous) << name << ' ' << kept;
            previous = error;
        }
        EXPECT_LT(previous, 0.02) << name;
    }
}

// Rounding to 8 bits adds less than truncation to 128 coefficients has cost already.
TEST(Truncation, EightBitsCostLessThanTruncationDoes) {
    const auto scene = tests::make_dented_ball();
    const auto dense = dense_rows(scene);
    const runtime::LightVector light = tests::make_light("studio", kSize);
    const auto reference = tests::relight(pack(scene, dense, kAllCoefficients, 16).view(), light);
    const auto sixteen = tests::relight(pack(scene, dense, 128, 16).view(), light);
    const auto eight = tests::relight(pack(scene, dense, 128, 8).view(), light);
    EXPECT_LT(relative_error(eight, sixteen), relative_error(sixteen, reference));
}

}  // namespace
}  // namespace opaline::bake
