#include "bake/volumes/node_rows.h"

#include <gtest/gtest.h>

#include <random>

#include "bake/encode/select_coefficients.h"
#include "formats/opal/cubemap.h"

namespace opaline::bake {
namespace {

std::vector<float> random_cells() {
    std::mt19937 engine(1);
    std::uniform_real_distribution<float> uniform(0, 1);
    std::vector<float> values(formats::cubemap_texels(8));
    for (float& value : values) {
        value = uniform(engine);
    }
    return values;
}

double kept_energy(const formats::SparseRow& row) {
    double sum = 0;
    for (const auto* values : {&row.value, &row.average}) {
        for (const float v : *values) {
            sum += static_cast<double>(v) * static_cast<double>(v);
        }
    }
    return sum;
}

TEST(NodeRows, WhatIsLostStaysBelowTheTolerance) {
    const std::vector<float> values = random_cells();
    const double energy = row_energy(values, 8, 16);
    for (const double tolerance : {0.0, 0.01, 0.1}) {
        const NodeEncoder encoder{make_selector(16, 1536), tolerance};
        const formats::SparseRow row = encode_node_row(encoder, values, 8, 1, energy);
        EXPECT_GE(kept_energy(row), (1 - tolerance * tolerance) * energy * (1 - 1e-5));
        EXPECT_LE(kept_energy(row), energy * (1 + 1e-5));
        EXPECT_EQ(row.index.size() < 378, tolerance > 0);
    }
}

TEST(NodeRows, ARowThatAddsNothingToItsNodeKeepsItsAveragesAlone) {
    std::vector<float> values = random_cells();
    const double energy = row_energy(values, 8, 16);
    for (float& value : values) {
        value *= 1e-3f;
    }
    const NodeEncoder encoder{make_selector(16, 1536), 0.01};
    const formats::SparseRow row = encode_node_row(encoder, values, 8, 1, energy);
    EXPECT_TRUE(row.index.empty());
    EXPECT_GT(row.average.at(0), 0);
}

}  // namespace
}  // namespace opaline::bake
