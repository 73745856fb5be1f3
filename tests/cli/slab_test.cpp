#include <gmock/gmock.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <sstream>

#include "tests/cli/print_json.h"
#include "tests/cli/run_program.h"
#include "tests/formats/gltf/asset_builder.h"
#include "tests/support/temporary_folder.h"

namespace opaline::tests {
namespace {

using std::numbers::pi;
using ::testing::HasSubstr;
using ::testing::StartsWith;

Json slab(const Arguments& arguments) {
    return print_json("slab", arguments);
}

double number(const Json& object, const std::string& key) {
    return object.at(key).get<double>();
}

TEST(Slab, EveryMethodSplitsTheSameLightByOrder) {
    const Arguments layer = {"--optical-depth", "2", "--g", "0.7", "--cosine", "0.6"};
    const auto with = [&](const Arguments& more) { return slab(join(layer, more)); };
    const Json adding = with({"--orders", "3"});
    for (const auto& [arguments, tolerance] :
         {std::pair{Arguments{"--method", "model"}, 0.02},
          {Arguments{"--method", "monte-carlo", "--photons", "100000", "--orders", "3"}, 0.007}}) {
        const Json other = with(arguments);
        EXPECT_NEAR(number(other, "reflectance"), number(adding, "reflectance"), tolerance);
        EXPECT_NEAR(number(other, "reflectance") + number(other, "transmittance"), 1, 1e-9);
        ASSERT_EQ(other.at("by_order").size(), 4u);
        for (std::size_t n = 0; n < 4; ++n) {
            const Json &a = other.at("by_order").at(n), &b = adding.at("by_order").at(n);
            EXPECT_EQ(a.at("order"), b.at("order"));
            EXPECT_NEAR(number(a, "reflectance"), number(b, "reflectance"), tolerance) << n;
            EXPECT_NEAR(number(a, "transmittance"), number(b, "transmittance"), tolerance) << n;
        }
        EXPECT_EQ(other.at("by_order").back().at("order"), "3+");
    }
    EXPECT_GT(number(with({"--method", "model"}).at("fit_error"), "rms_transmittance"), 0);
}

double radiance(const Json& view, const char* side, const std::string& order) {
    for (const Json& each : view.at(side)) {
        if (each.at("order") == order) return number(each, "radiance");
    }
    ADD_FAILURE() << "no order " << order;
    return 0;
}

// Both against the solver, in the plane of the light, and single scattering by hand.
TEST(Slab, ViewsOfEveryMethodSeeTheSameLight) {
    const Arguments layer = {"--optical-depth", "1",   "--g",     "0.7",
                             "--cosine",        "0.6", "--views", "8"};
    const auto with = [&](const Arguments& method) {
        return slab(join(join(layer, {"--method"}), method)).at("views");
    };
    const Json solved = with({"adding", "--streams", "24"}), table = with({"table"}),
               model = with({"model"});
    ASSERT_EQ(solved.size(), 8u);
    for (std::size_t i = 0; i < 8; ++i) {
        const double degrees = -90 + 22.5 * (static_cast<double>(i) + 0.5);
        EXPECT_EQ(number(solved.at(i), "degrees"), degrees);
        for (const char* side : {"reflected", "transmitted"}) {
            const double all = radiance(solved.at(i), side, "all");
            EXPECT_NEAR(radiance(table.at(i), side, "all"), all, 0.03 * all) << degrees << side;
            // Orders 3 and more have one profile, which is farthest off near the horizon.
            const double coarse = std::abs(degrees) < 70 ? 0.5 : 1;
            EXPECT_NEAR(radiance(model.at(i), side, "all"), all, coarse * all) << degrees << side;
            EXPECT_EQ(radiance(model.at(i), side, "1"), radiance(solved.at(i), side, "1"));
        }
        // pi / mu_l p mu_l / (mu_l + mu_v) (1 - e^-x): the angle between -l and v.
        const double mu = std::cos(degrees * pi / 180);
        const double cosine = -std::cos(std::acos(0.6) + degrees * pi / 180), g = 0.7;
        const double phase = (1 - g * g) / (4 * pi * std::pow(1 + g * g - 2 * g * cosine, 1.5));
        const double once = pi * phase / (0.6 + mu) * -std::expm1(-1 / 0.6 - 1 / mu);
        EXPECT_NEAR(radiance(solved.at(i), "reflected", "1"), once, 1e-4 * once) << degrees;
    }
    EXPECT_THAT(run_opaline({"slab", "--optical-depth", "1", "--g", "0", "--views", "4", "--method",
                             "monte-carlo"})
                    .err,
                HasSubstr("--views"));
    const Outcome csv = run_opaline({"slab", "--optical-depth", "1", "--g", "0", "--views", "1",
                                     "--streams", "8", "--format", "csv"});
    EXPECT_THAT(csv.out, StartsWith("degrees,side,order,radiance\n0.0,reflected,1,"));
}

TEST(Slab, AbsorbedLightIsWhatDoesNotLeave) {
    const Json all = slab({"--optical-depth", "3", "--albedo", "0.8", "--g", "0"});
    EXPECT_NEAR(number(all, "absorptance"),
                1 - number(all, "reflectance") - number(all, "transmittance"), 1e-15);
    EXPECT_GT(number(all, "absorptance"), 0.3);
    const Json clear = slab({"--optical-depth", "0", "--g", "0"});
    EXPECT_EQ(number(clear, "transmittance"), 1);
    const Json black = slab({"--optical-depth", "1", "--albedo", "0", "--g", "0"});
    EXPECT_NEAR(number(black, "transmittance"), std::exp(-1.0), 1e-15);
}

// Index 1.5, albedo .9: [Giovanelli1955] states .2600, what the boundary reflects included.
TEST(Slab, RefractingBoundariesReflectAsPublished) {
    const Arguments layer = {"--optical-depth", "60", "--albedo", "0.9", "--g", "0",
                             "--eta",           "1.5"};
    EXPECT_NEAR(number(slab(layer), "reflectance"), 0.2600, 1.5e-4);
    const Json walk = slab(join(layer, {"--method", "monte-carlo", "--photons", "100000"}));
    EXPECT_NEAR(number(walk, "reflectance"), 0.26, 4 * number(walk, "reflectance_standard_error"));
    EXPECT_NEAR(number(walk.at("by_order").at(0), "reflectance"), 0.04,
                4 * number(walk.at("by_order").at(0), "reflectance_standard_error"));
}

TEST(Slab, TablesOfThePhaseFunctionAreAnInput) {
    const TemporaryFolder folder;
    const std::string path = folder / "even.txt";
    write_file(path, std::string("-1 3\n1 3\n"));
    const Json table = slab({"--optical-depth", "1", "--phase", path});
    const Json even = slab({"--optical-depth", "1", "--g", "0"});
    EXPECT_NEAR(number(table, "reflectance"), number(even, "reflectance"), 1e-9);
    EXPECT_NEAR(number(table, "reflectance"), 0.341329, 1e-5);
    const Json walk = slab(
        {"--optical-depth", "1", "--phase", path, "--method", "monte-carlo", "--photons", "50000"});
    EXPECT_NEAR(number(walk, "reflectance"), 0.341329,
                4 * number(walk, "reflectance_standard_error"));
    const std::string bad = folder / "bad.txt";
    write_file(bad, std::string("-1 1\n0 -1\n1 1\n"));
    const Outcome outcome = run_opaline({"slab", "--optical-depth", "1", "--phase", bad});
    EXPECT_EQ(outcome.exit_code, 3);
    EXPECT_EQ(outcome.out, "");
    EXPECT_THAT(outcome.err, StartsWith("opaline: error: " + bad));
    EXPECT_THAT(outcome.err, HasSubstr("line 2"));
}

TEST(Slab, CsvHoldsTheNumbersOfTheJson) {
    const Json json = slab({"--optical-depth", "1", "--g", "0.5", "--orders", "2", "--json"});
    const Outcome csv = run_well(
        {"slab", "--optical-depth", "1", "--g", "0.5", "--orders", "2", "--format", "csv"});
    std::map<std::string, double> value;
    std::istringstream lines(csv.out);
    std::string line;
    std::getline(lines, line);
    EXPECT_EQ(line, "quantity,order,value");
    while (std::getline(lines, line)) {
        const std::size_t last = line.rfind(',');
        value[line.substr(0, last)] = std::stod(line.substr(last + 1));
    }
    EXPECT_EQ(value.at("reflectance,all"), number(json, "reflectance"));
    EXPECT_EQ(value.at("numerical_error,all"), number(json, "numerical_error"));
    EXPECT_EQ(value.at("transmittance,0"), number(json.at("by_order").at(0), "transmittance"));
    EXPECT_EQ(value.at("reflectance,2+"), number(json.at("by_order").at(2), "reflectance"));
}

TEST(Slab, BadLayersExitWithTwoAndSayWhatIsAccepted) {
    const std::vector<std::pair<Arguments, std::string>> bad = {
        {{"--g", "0"}, "--optical-depth"},
        {{"--optical-depth", "1"}, "no phase function"},
        {{"--optical-depth", "1", "--g", "0", "--phase", "x"}, "two phase functions"},
        {{"--optical-depth", "-1", "--g", "0"}, "--optical-depth"},
        {{"--optical-depth", "nan", "--g", "0"}, "--optical-depth"},
        {{"--optical-depth", "1e7", "--g", "0"}, "--optical-depth"},
        {{"--optical-depth", "1", "--g", "1"}, "--g"},
        {{"--optical-depth", "1", "--g", "0", "--albedo", "1.1"}, "--albedo"},
        {{"--optical-depth", "1", "--g", "0", "--cosine", "0"}, "--cosine"},
        {{"--optical-depth", "1", "--g", "0", "--cosine", "1.5"}, "--cosine"},
        {{"--optical-depth", "1", "--g", "0", "--method", "guess"}, "--method"},
        {{"--optical-depth", "1", "--g", "0", "--eta", "0.1"}, "--eta"},
        {{"--optical-depth", "1", "--g", "0", "--eta", "1.5", "--method", "model"}, "--eta"},
        {{"--optical-depth", "1", "--g", "0", "--orders", "0"}, "--orders"},
        {{"--optical-depth", "1", "--g", "0", "--streams", "1000"}, "--streams"},
        {{"--optical-depth", "1", "--g", "0", "--photons", "9"}, "no photons"},
        {{"--optical-depth", "1", "--g", "0", "--method", "model", "--albedo", "0.5"}, "--albedo"},
        {{"--optical-depth", "1", "--g", "0", "--method", "model", "--orders", "2"}, "--orders"},
        {{"--optical-depth", "1", "--g", "0", "--method", "monte-carlo", "--streams", "8"},
         "--streams"},
        {{"--optical-depth", "1e4", "--g", "0", "--method", "monte-carlo"}, "too long"}};
    for (const auto& [arguments, says] : bad) {
        expect_refused(join({"slab"}, arguments), 2, says);
    }
}

TEST(Slab, ExtremeLayersGiveFiniteNumbers) {
    for (const char* depth : {"1e-300", "1e-9", "1e6"}) {
        for (const char* g : {"-0.99", "0.99"}) {
            for (const char* cosine : {"0.001", "1"}) {
                const Json all = slab({"--optical-depth", depth, "--g", g, "--cosine", cosine,
                                       "--streams", "8", "--orders", "2"});
                EXPECT_NEAR(number(all, "reflectance") + number(all, "transmittance"), 1, 1e-6)
                    << depth << " " << g << " " << cosine;  // null would have thrown
            }
        }
    }
}

}  // namespace
}  // namespace opaline::tests
