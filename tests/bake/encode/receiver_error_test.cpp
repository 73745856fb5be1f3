#include "bake/encode/receiver_error.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <utility>
#include <vector>

#include "bake/encode/row_sink.h"
#include "bake/plan/knobs.h"
#include "formats/opal/cubemap.h"

namespace opaline::bake {
namespace {

constexpr std::uint32_t kSide = 8;

std::vector<float> random_row(std::uint32_t terms, std::uint32_t bands, unsigned seed) {
    std::mt19937 generator(seed);
    std::normal_distribution<float> normal;
    std::vector<float> values(std::size_t{terms} * bands * formats::cubemap_texels(kSide));
    for (float& value : values) {
        value = normal(generator) * normal(generator);
    }
    return values;
}

// Stored rows of two receivers, the one asked for last.
struct Encoded {
    std::vector<float> before, values;
    std::uint32_t terms, bands;
    formats::SparseRows rows;

    DenseRow row() { return {values, kSide, terms, bands}; }
    float error(TermsSeen seen) { return receiver_loss(row(), seen, rows, 1).error(); }
};

Encoded encode_row(std::vector<float> values, std::uint32_t terms, std::uint32_t bands,
                   std::uint32_t coefficients, std::uint32_t bits = 16) {
    const RowEncoder encoder = make_row_encoder(kSide, coefficients, bits);
    Encoded made{random_row(terms, bands, 9), std::move(values), terms, bands, empty_rows(encoder)};
    encode_receiver(encoder, {made.before, kSide, terms, bands}, made.rows);
    encode_receiver(encoder, made.row(), made.rows);
    return made;
}

// Parseval: what was dropped are all squares but the largest ones and the face averages.
TEST(ReceiverError, IsTheShareOfDroppedSquares) {
    constexpr std::uint32_t kKept = 40;
    Encoded made = encode_row(random_row(1, 1, 1), 1, 1, kKept);
    formats::SparseRow kept = select_coefficients(make_selector(kSide, kKept), made.values, 1);
    double all = 0, stored = 0;
    for (const float v : made.values)
        all += double(v) * double(v);
    for (const float v : kept.value)
        stored += double(v) * double(v);
    for (const float v : kept.average)
        stored += double(v) * double(v);
    // Codes of 16 bits add less than 1e-4 of the row, in quadrature.
    EXPECT_NEAR(made.error(TermsSeen::apart), std::sqrt((all - stored) / all), 1e-5);
}

TEST(ReceiverError, IsZeroWhereNothingIsLostOrThere) {
    std::vector<float> one(formats::cubemap_texels(kSide), 0.0f);
    Encoded dark = encode_row(one, 1, 1, 7);
    EXPECT_EQ(dark.error(TermsSeen::apart), 0);
    one[5] = 0.75f;
    Encoded single = encode_row(one, 1, 1, 7);
    EXPECT_LT(single.error(TermsSeen::apart), 1e-6);
}

// The mean over directions of view and lights, by sums over many of both.
TEST(ReceiverError, IsTheRmsOfWhiteLightInTheMeanOverViews) {
    std::mt19937 generator(5);
    std::normal_distribution<float> normal;
    for (const TermsSeen seen : {TermsSeen::apart, TermsSeen::together}) {
        const std::uint32_t terms = seen == TermsSeen::together ? 5 : 4;
        // The first row is bright and loses nothing, so that it matters what it counts for.
        std::vector<float> values = random_row(terms, 1, 3);
        for (std::size_t j = 0; j < formats::cubemap_texels(kSide); ++j) {
            values[j] *= j < 12 ? 4 : 0;
        }
        Encoded made = encode_row(std::move(values), terms, 1, 20);
        const formats::RowRange range{terms, terms, 1, terms, made.rows.row_offset[terms]};
        std::vector<std::vector<float>> stored(terms,
                                               std::vector<float>(formats::cubemap_texels(kSide)));
        for (std::uint32_t k = 0; k < terms; ++k) {
            formats::decode_row(made.rows.view(), range, k, 0, stored[k]);
        }
        double lost = 0, all = 0;
        for (int trial = 0; trial < 4000; ++trial) {
            // Lights of independent coefficients, and a direction of view each.
            double x = normal(generator), y = normal(generator), z = normal(generator);
            const double size = std::sqrt(x * x + y * y + z * z);
            const double y0 = std::sqrt(1 / (4 * std::numbers::pi)), y1 = std::sqrt(3.0) * y0;
            const std::array<double, 4> harmonic{y0, y1 * y / size, y1 * z / size, y1 * x / size};
            std::vector<double> dense_sum(terms), stored_sum(terms);
            for (std::size_t j = 0; j < made.row().size(); ++j) {
                const double light = normal(generator);
                for (std::uint32_t k = 0; k < terms; ++k) {
                    dense_sum[k] += light * double(made.row().plane(k, 0)[j]);
                    stored_sum[k] += light * double(stored[k][j]);
                }
            }
            double whole = 0, seen_stored = 0;
            for (std::uint32_t k = 0; k < terms; ++k) {
                const double h = seen == TermsSeen::apart ? harmonic[k]
                                 : k == 0                 ? 1
                                                          : harmonic[k - 1];
                whole += h * dense_sum[k];
                seen_stored += h * stored_sum[k];
            }
            lost += (whole - seen_stored) * (whole - seen_stored);
            all += whole * whole;
        }
        // The variance of a mean of 4000 squares of normal numbers: 2 / 4000, twice.
        const double expected = std::sqrt(lost / all);
        EXPECT_NEAR(made.error(seen), expected, 4 * 0.016 * expected);
    }
}

}  // namespace
}  // namespace opaline::bake
