#include "bake/effects/volumes/node_rows.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
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
        const formats::SparseRow row = encode_node_rows(encoder, values, 1, 8, 1).front();
        EXPECT_GE(kept_energy(row), (1 - tolerance * tolerance) * energy * (1 - 1e-5));
        EXPECT_LE(kept_energy(row), energy * (1 + 1e-5));
        EXPECT_EQ(row.index.size() < 378, tolerance > 0);
    }
}

TEST(NodeRows, ARowThatAddsNothingToItsNodeKeepsItsAveragesAlone) {
    const std::vector<float> bright = random_cells();
    std::vector<float> values = bright;
    for (const float value : bright) {
        values.push_back(1e-3f * value);
    }
    const NodeEncoder encoder{make_selector(16, 1536), 0.01};
    const auto rows = encode_node_rows(encoder, values, 2, 8, 1);
    EXPECT_GT(rows.at(0).index.size(), 100u);
    EXPECT_TRUE(rows.at(1).index.empty());
    EXPECT_GT(rows[1].average.at(0), 0);
}

// What a row keeps is not an equal share: half as bright, it has fewer of the largest details.
TEST(NodeRows, TheLargestDetailsOfAllRowsTogetherAreKept) {
    const std::vector<float> bright = random_cells();
    std::vector<float> values = bright;
    for (const float value : bright) {
        values.push_back(0.5f * value);
    }
    const auto one = encode_node_rows({make_selector(16, 1536, 0), 0}, bright, 1, 8, 1).front();
    const auto rows = encode_node_rows({make_selector(16, 112, 0), 0}, values, 2, 8, 1);
    EXPECT_EQ(rows.at(0).index.size() + rows.at(1).index.size(), 100u);
    EXPECT_GT(rows[0].index.size(), 1.5 * static_cast<double>(rows[1].index.size()));
    float least = HUGE_VALF;
    for (const auto& row : rows) {
        for (const float v : row.value) {
            least = std::min(least, std::abs(v));
        }
    }
    std::size_t larger = 0;
    for (const float v : one.value) {
        larger += std::abs(v) > least ? 1 : 0;
        larger += 0.5f * std::abs(v) > least ? 1 : 0;
    }
    EXPECT_LT(larger, 100u) << "none that was left out is larger";
    EXPECT_GE(larger, 98u);
}

// Of equal details the first are kept: a node never takes more than it may.
TEST(NodeRows, EqualDetailsDoNotExceedTheirNumber) {
    std::vector<float> values = random_cells();
    values.insert(values.end(), values.begin(), values.begin() + 384);
    const auto rows = encode_node_rows({make_selector(16, 113, 0), 0}, values, 2, 8, 1);
    EXPECT_EQ(rows.at(0).index.size() + rows.at(1).index.size(), 101u);
}

}  // namespace
}  // namespace opaline::bake
