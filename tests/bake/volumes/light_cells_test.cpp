#include "bake/trace/density/attenuation.h"

#include <gtest/gtest.h>

#include <random>
#include <span>

#include "formats/opal/cubemap.h"
#include "formats/opal/haar.h"

namespace opaline::bake {
namespace {

std::vector<float> random_cells(std::uint32_t n) {
    std::mt19937 engine(n);
    std::uniform_real_distribution<float> uniform(0, 1);
    std::vector<float> values(formats::cubemap_texels(n));
    for (float& value : values) {
        value = uniform(engine);
    }
    return values;
}

TEST(LightCells, CoarseCellsTransformLikeTheFineOnesTheyStandFor) {
    const std::vector<float> coarse = random_cells(8);
    std::vector<float> fine(formats::cubemap_texels(32));
    for (std::size_t i = 0; i < fine.size(); ++i) {
        const std::size_t column = i % 32, row = i / 32 % 32, face = i / 1024;
        fine[i] = coarse[(face * 8 + row / 4) * 8 + column / 4];
    }
    formats::haar_forward_cube(std::span<float>(fine), 32);
    const std::vector<float> transformed = transform_cells(coarse, 8, 32);
    ASSERT_EQ(transformed.size(), fine.size());
    for (std::size_t i = 0; i < fine.size(); ++i) {
        EXPECT_NEAR(transformed[i], fine[i], 2e-5);
    }
}

TEST(LightCells, ReducingKeepsTheMeanOfEachBlock) {
    const std::vector<float> fine = random_cells(16), coarse = reduce_cells(fine, 16, 8);
    EXPECT_NEAR(coarse[9], (fine[34] + fine[35] + fine[50] + fine[51]) / 4, 1e-6);
    EXPECT_EQ(reduce_cells(fine, 16, 16), fine);
}

TEST(LightCells, DirectionsAreThoseOfTheFile) {
    const LightCells cells = make_light_cells(8);
    ASSERT_EQ(cells.size(), 384u);
    for (std::size_t i = 0; i < cells.size(); i += 7) {
        const glm::vec3 d = cells.direction(i);
        EXPECT_EQ(formats::texel_index(8, {d.x, d.y, d.z}), i);
    }
}

}  // namespace
}  // namespace opaline::bake
