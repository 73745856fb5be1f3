#include <gtest/gtest.h>

#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "tests/bake/reference/reference_support.h"
#include "tests/support/reference_table.h"

namespace opaline::tests {
namespace {

/// A row of the table of volumes: what a plane slab reflects and transmits.
struct SlabRow {
    std::string id, quantity, method;
    float g = 0, albedo = 0, sigma_t = 0, size = 0;
    double value = 0, error = 0;
};

std::vector<SlabRow> read_slab_rows() {
    std::ifstream file(reference_folder() / "volumes.csv");
    std::vector<SlabRow> rows;
    for (std::string line; std::getline(file, line);) {
        std::vector<std::string> cell;
        std::stringstream cells(line);
        for (std::string part; std::getline(cells, part, ',');) {
            cell.push_back(part);
        }
        constexpr std::size_t kValue = 19, kError = 20;
        if (cell.size() <= kValue || cell[1] != "slab_total") continue;
        SlabRow row{cell[0],
                    cell[3],
                    cell[4],
                    std::stof(cell[5]),
                    std::stof(cell[6]),
                    std::stof(cell[7]),
                    std::stof(cell[8]),
                    std::stod(cell[kValue]),
                    0};
        row.error = cell.size() > kError && !cell[kError].empty() ? std::stod(cell[kError]) : 0;
        rows.push_back(row);
    }
    return rows;
}

// What a slab reflects of light from a direction is what it sends there under uniform light from
// that side, by reciprocity; the same for what it transmits, with light from the other side.
bake::Moments measure(const SlabRow& row, std::uint32_t samples) {
    const auto slab =
        make_fixture(make_slab(make_medium(row.sigma_t, row.albedo, row.g, 1), row.size),
                     make_half_sky(row.quantity[0] == 'R'));
    const float cosine = row.quantity.ends_with("normal") ? 1.0f : 0.0f;
    return look_down(slab->space(), 0.5f * row.size, cosine, samples);
}

TEST(ReferenceSlab, ReflectsAndTransmitsWhatIsPublished) {
    if (!std::filesystem::exists(reference_folder() / "volumes.csv")) {
        GTEST_SKIP() << "no reference table " << reference_folder() / "volumes.csv";
    }
    const std::vector<SlabRow> rows = read_slab_rows();
    ASSERT_FALSE(rows.empty());
    double squares = 0;
    for (const SlabRow& row : rows) {
        const bool published = row.method == "published";
        const bake::Moments m = measure(row, published ? 160000 : 16000);
        const double error = std::hypot(standard_error(m), row.error);
        const double z = (m.mean.x - row.value) / error;
        squares += z * z;
        // A single row in 370 is more than 3 standard errors off by chance, one of many in 16000
        // more than 4.
        EXPECT_LT(std::abs(z), published ? 3 : 4)
            << row.id << " " << row.quantity << " g " << row.g << " albedo " << row.albedo
            << " sigma_t " << row.sigma_t << ": " << m.mean.x << " +- " << error << ", expected "
            << row.value;
        EXPECT_LT(error, 0.02) << row.id << ": the test says little";
    }
    // The mean of many squares is 1 where errors are as large as stated: neither a bias that hides
    // below each limit nor a variance that flatters.
    const double count = static_cast<double>(rows.size());
    EXPECT_NEAR(squares / count, 1, 4 * std::sqrt(2 / count));
}

TEST(ReferenceSlab, ForwardScatteringBrightensABackLitSheet) {
    double brightness[2] = {};
    for (const int i : {0, 1}) {
        const auto sheet = make_fixture(
            make_slab(make_medium(0.5f, 1, i == 0 ? -0.7f : 0.7f, 1.3f), 1), make_half_sky(false));
        bake::PathOptions options;
        options.terms = bake::term::kSingle | bake::term::kMultiple;
        brightness[i] = look_down(sheet->space(options), 0.5f, 1, 8000).mean.x;
    }
    EXPECT_GT(brightness[1], 2 * brightness[0]);
}

TEST(ReferenceSlab, WithoutScatteringObeysBeersLaw) {
    formats::Medium medium = make_medium(0.7f, 0, 0, 1);
    medium.sigma_a = {0.1f, 0.7f, 2.0f};
    const auto slab = make_fixture(make_slab(medium, 1.5f), make_half_sky(false));
    const bake::Moments m = look_down(slab->space(), 0.75f, 0.6f, 160);
    // Nothing is left to chance but the channel: any one flies through with the same weight sum.
    const glm::dvec3 error = glm::sqrt(m.variance_of_mean());
    for (const int c : {0, 1, 2}) {
        const double sigma = glm::dvec3(0.1, 0.7, 2.0)[c];
        EXPECT_NEAR(m.mean[c], std::exp(-sigma * 1.5 / 0.6), 4 * error[c] + 1e-5);
    }
}

}  // namespace
}  // namespace opaline::tests
