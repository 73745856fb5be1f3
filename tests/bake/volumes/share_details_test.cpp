#include "bake/volumes/share_details.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "bake/volumes/node_lattice.h"
#include "bake/volumes/volume_knobs.h"
#include "tests/bake/volumes/volume_support.h"

namespace opaline::bake {
namespace {

constexpr std::uint32_t kEdge = 8;

formats::SparseRow random_row(std::mt19937& engine, float size) {
    std::uniform_real_distribution<float> uniform(-size, size);
    formats::SparseRow row;
    for (std::uint32_t k = 1; k < kEdge * kEdge; ++k) {
        row.index.push_back(k);
        row.value.push_back(uniform(engine));
    }
    row.average.assign(formats::kCubeFaces, size);
    return row;
}

formats::SparseRows rows_of(const std::vector<formats::SparseRow>& each,
                            std::uint32_t code_bits = 16) {
    formats::SparseRows rows = formats::make_sparse_rows(kEdge, code_bits);
    for (const formats::SparseRow& row : each) {
        formats::append_row(rows, row);
    }
    return rows;
}

float size_of(const formats::SparseRows& rows, std::size_t row, std::size_t detail) {
    return rows.detail_scale[row] * static_cast<float>(std::abs(rows.code16[detail]));
}

// The row seen half as well keeps what is twice as large.
TEST(ShareDetails, NoneThatIsLeftOutIsWorthMoreThanOneThatIsKept) {
    std::mt19937 engine(1);
    const formats::SparseRows all =
        rows_of({random_row(engine, 1), random_row(engine, 1), random_row(engine, 0.3f)});
    const std::vector<float> weight{1, 0.5f, 1};
    const formats::SparseRows kept =
        share_details(all, 1, make_selector(kEdge, 0, 0), {{0, 0, 0}, weight, {80}});
    ASSERT_EQ(kept.index16.size(), 80u);
    std::vector<float> scores, of_kept;
    for (std::size_t row = 0; row < 3; ++row) {
        for (std::size_t i = all.row_offset[row]; i < all.row_offset[row + 1]; ++i) {
            scores.push_back(weight[row] * size_of(all, row, i));
        }
        for (std::size_t i = kept.row_offset[row]; i < kept.row_offset[row + 1]; ++i) {
            of_kept.push_back(weight[row] * size_of(kept, row, i));
        }
    }
    std::ranges::sort(scores, std::greater<>());
    scores.resize(80);
    std::ranges::sort(of_kept, std::greater<>());
    EXPECT_EQ(of_kept, scores);
    EXPECT_GT(kept.row_offset[1], 2 * (kept.row_offset[3] - kept.row_offset[2]));
    EXPECT_EQ(kept.average_code, all.average_code);
    EXPECT_EQ(kept.average_scale, all.average_scale);
}

// Each pool by itself, of equal details the first ones; where all may stay, all do.
TEST(ShareDetails, PoolsKeepTheirNumbers) {
    std::mt19937 engine(2);
    formats::SparseRow even = random_row(engine, 1);
    std::ranges::fill(even.value, 0.5f);
    const formats::SparseRows all = rows_of({even, even, random_row(engine, 1)}, 8);
    const formats::SparseRows kept =
        share_details(all, 1, make_selector(kEdge, 0, 0), {{0, 0, 1}, {1, 1, 1e-9f}, {70, 1000}});
    EXPECT_EQ(kept.row_offset[1], 63u);
    EXPECT_EQ(kept.row_offset[2], 70u);
    EXPECT_TRUE(std::equal(kept.index16.begin(), kept.index16.begin() + 70, all.index16.begin()));
    EXPECT_GE(kept.row_offset[3], 70 + 62u) << "but for details that have rounded to 0";
    const formats::SparseRows none =
        share_details(all, 1, make_selector(kEdge, 0, 0), {{0, 0, 0}, {1, 1, 1}, {0}});
    EXPECT_TRUE(none.index16.empty());
}

TEST(ShareDetails, ARowThatIsNotANumberStaysSo) {
    std::mt19937 engine(3);
    formats::SparseRow faulty = random_row(engine, 1);
    faulty.value[3] = NAN;
    const formats::SparseRows kept =
        share_details(rows_of({faulty, random_row(engine, 1)}), 1, make_selector(kEdge, 0, 0),
                      {{0, 0}, {1, 1}, {9}});
    EXPECT_EQ(formats::find_faulty_row(kept, 1), 0u);
    EXPECT_EQ(kept.row_offset[2], 9u);
}

// Where there is little density, or little light comes out, errors are not seen.
TEST(ShareDetails, NodesThatAreSeenKeepMoreThanThoseAtTheEdge) {
    formats::Scene scene =
        tests::scene_of(tests::make_volume(tests::make_blob(0.5, 1.0 / 6), 4, 0.9f, 0.5f));
    Knobs knobs = tests::small_knobs(Quality::preview, 2);
    knobs.set(kVolumeWalks, 32);
    knobs.set(kVolumeCoefficients, 96);
    knobs.set(kVolumeTerms, 4);
    const formats::Volumes volumes = tests::bake_volumes_of(scene, knobs);
    const formats::VolumeRecord& record = volumes.records[0];
    const NodeLattice lattice = make_node_lattice(scene.volumes[0].density, 2);
    const std::vector<float> density = node_densities(scene.volumes[0].density, lattice);
    std::array<double, 2> details{}, nodes{};
    for (std::uint32_t i = 0; i < record.node_count; ++i) {
        const std::size_t dense = density[i] > 0.2f ? 1 : 0;
        details[dense] += volumes.rows.row_offset[(i + 1) * record.terms()] -
                          volumes.rows.row_offset[i * record.terms()];
        ++nodes[dense];
    }
    ASSERT_GT(nodes[0], 20);
    ASSERT_GT(nodes[1], 20);
    EXPECT_GT(details[1] / nodes[1], 3 * details[0] / nodes[0]);
    EXPECT_LE(details[0] + details[1], (nodes[0] + nodes[1]) * (96 - 6 * record.terms()));
    EXPECT_GT(details[0] + details[1], 0.9 * (nodes[0] + nodes[1]) * (96 - 6 * record.terms()));
}

}  // namespace
}  // namespace opaline::bake
