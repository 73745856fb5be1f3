// What encoding costs each vertex: baked, said, verified and shown.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "formats/image/png.h"
#include "formats/opal/cubemap.h"
#include "formats/opal/file_bytes.h"
#include "formats/opal/receiver_errors.h"
#include "tests/cli/small_scene.h"

namespace opaline::tests {
namespace {

using ::testing::HasSubstr;

struct ErrorBake {
    explicit ErrorBake(const std::string& path)
        : file(std::move(*formats::FileBytes::open(path))),
          loaded(std::move(*formats::read_opal(file.bytes(), path))),
          errors(*formats::read_receiver_errors(file.bytes(), loaded, path)) {}

    // The first term's row, all bands.
    std::vector<double> row_of(std::uint32_t vertex) const {
        const formats::AssetView& view = loaded.view;
        const auto primitive =
            static_cast<std::size_t>(&formats::primitive_of(view, vertex) - view.primitives.data());
        std::vector<float> dense(formats::cubemap_texels(view.cubemap_size));
        formats::decode_row(view.transport, view.rows_of(primitive),
                            view.slot_of(primitive, vertex), 0, dense);
        return {dense.begin(), dense.end()};
    }

    formats::FileBytes file;
    formats::LoadedAsset loaded;
    std::vector<float> errors;
};

std::string bake_direct(const SmallScene& small, const std::string& name, Arguments more) {
    run_well(join({"bake", small.scene(), "-o", small.path(name), "--cubemap", "16", "--effects",
                   "direct", "--refine", "off"},
                  more));
    return small.path(name);
}

double norm(const std::vector<double>& a) {
    double sum = 0;
    for (const double v : a)
        sum += v * v;
    return std::sqrt(sum);
}

// With T the row before it is encoded, A all of its coefficients and B some, both rounded:
// | |T - B| - |A - B| | <= |T - A|.
TEST(ReceiverErrors, AreTheDistancesOfRowsToThoseWithAllCoefficients) {
    const SmallScene small;
    const ErrorBake all(
        bake_direct(small, "all.opal", {"--coefficients", "all", "--receiver-errors"}));
    const ErrorBake few(
        bake_direct(small, "few.opal", {"--coefficients", "24", "--receiver-errors"}));
    ASSERT_EQ(few.errors.size(), 8u);
    float largest = 0;
    for (std::uint32_t v = 0; v < 8; ++v) {
        const std::vector<double> a = all.row_of(v), b = few.row_of(v);
        std::vector<double> apart(a.size());
        for (std::size_t j = 0; j < a.size(); ++j)
            apart[j] = a[j] - b[j];
        const double rounding = static_cast<double>(all.errors[v]);
        EXPECT_LT(rounding, 0.01);
        EXPECT_NEAR(few.errors[v], norm(apart) / norm(a), 1.05 * rounding + 1e-6) << v;
        largest = std::max(largest, few.errors[v]);
    }
    EXPECT_GT(largest, 0.05);
}

TEST(ReceiverErrors, AreAsOtherBakesForTheRestAndForAnyNumberOfThreads) {
    const SmallScene small;
    const auto bytes = [&](const std::string& name, Arguments more) {
        more.insert(more.end(), {"--coefficients", "24"});
        const auto file = formats::FileBytes::open(bake_direct(small, name, more));
        return std::vector<std::byte>(file->bytes().begin(), file->bytes().end());
    };
    const auto one = bytes("1.opal", {"--receiver-errors", "--threads", "1"});
    EXPECT_EQ(one, bytes("3.opal", {"--receiver-errors", "--threads", "3"}));
    bytes("plain.opal", {});
    const ErrorBake with(small.path("1.opal")), without(small.path("plain.opal"));
    EXPECT_TRUE(without.errors.empty());
    // All sections as they are without, and one more.
    ASSERT_EQ(with.loaded.sections.size(), without.loaded.sections.size() + 1);
    for (std::size_t i = 0; i < without.loaded.sections.size(); ++i) {
        EXPECT_EQ(with.loaded.sections[i].id, without.loaded.sections[i].id);
        EXPECT_EQ(with.loaded.sections[i].checksum, without.loaded.sections[i].checksum);
    }
    EXPECT_EQ(with.loaded.sections.back().id, formats::kRerrSection);
}

TEST(ReceiverErrors, AreSaidAndVerified) {
    const SmallScene small;
    const std::string file =
        bake_direct(small, "a.opal", {"--coefficients", "24", "--receiver-errors"});
    const ErrorBake baked(file);
    const auto info = nlohmann::json::parse(run_opaline({"info", file, "--json"}).out);
    double mean = 0;
    for (const float e : baked.errors)
        mean += static_cast<double>(e) / 8;
    EXPECT_NEAR(info["receiver_errors"]["mean"].get<double>(), mean, 1e-9);
    EXPECT_GE(info["receiver_errors"]["max"].get<double>(),
              info["receiver_errors"]["p95"].get<double>());
    EXPECT_THAT(run_opaline({"info", file}).out, HasSubstr("row errors"));
    run_well({"verify", file});
}

TEST(ReceiverErrors, AreShownInPlaceOfLight) {
    const SmallScene small;
    const std::string file =
        bake_direct(small, "a.opal", {"--coefficients", "24", "--receiver-errors"});
    const auto draw = [&](const std::string& name, Arguments more) {
        run_well(join({"render", file, "--backend", "cpu", "--size", "96x72", "--eye", "0,3,0.1",
                       "--target", "0,0,0", "-o", small.path(name)},
                      more));
        return formats::read_png(small.path(name))->rgba;
    };
    const auto map = draw("a.png", {"--receiver-errors", "0.000001"});
    // The middle: the upper square, all of whose errors are above one in a million.
    const std::size_t middle = 4 * (36 * 96 + 48);
    EXPECT_EQ(map[middle] + map[middle + 1] + map[middle + 2], 3 * 255);
    EXPECT_NEAR(map[0], 63, 1);  // the background's 0.05 as sRGB
    // A third of the scale is red.
    const ErrorBake baked(file);
    float largest = 0;
    for (const float e : baked.errors)
        largest = std::max(largest, e);
    const auto red =
        draw("r.png", {"--light", "white", "--receiver-errors", std::to_string(3 * largest)});
    EXPECT_GT(red[middle], 100);
    EXPECT_EQ(red[middle + 1] + red[middle + 2], 0);
    EXPECT_EQ(draw("b.png", {"--light", "sun:10,50", "--exposure", "2", "--receiver-errors",
                             std::to_string(3 * largest)}),
              red);
    expect_refused({"render", bake_direct(small, "b.opal", {}), "--light", "white",
                    "--receiver-errors", "0.1", "-o", small.path("n.png")},
                   3, "bake it with --receiver-errors");
}

}  // namespace
}  // namespace opaline::tests
