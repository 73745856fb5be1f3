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

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::StartsWith;

using std::numbers::pi;

/// Droplets whose mean takes a tenth of a second.
const Arguments kSmallDroplets = {"--effective-radius", "0.5", "--size-step", "0.2"};

TEST(Mie, RadiusAndWavelengthAreASizeParameterInAnyUnit) {
    const Json x = print_json(
        "mie", {"--size-parameter", std::to_string(2 * pi * 0.525 / 0.6328), "--index", "1.55"});
    // As [BohrenHuffman1983], appendix A, prints.
    EXPECT_NEAR(x.at("q_ext").get<double>(), 3.10543, 1e-5);
    EXPECT_NEAR(x.at("q_back").get<double>(), 2.92534, 2e-5);
    EXPECT_NEAR(x.at("g").get<double>(), 0.63314, 1e-5);
    for (const auto& [radius, wavelength] : {std::pair{"0.525", "0.6328"},
                                             {"525nm", "632.8nm"},
                                             {"0.000525mm", "6.328e-7m"},
                                             {"0.525um", "0.6328um"}}) {
        const Json r =
            print_json("mie", {"--radius", radius, "--wavelength", wavelength, "--index", "1.55"});
        EXPECT_NEAR(r.at("q_ext").get<double>(), x.at("q_ext").get<double>(), 1e-5) << radius;
        EXPECT_NEAR(r.at("radius_m").get<double>(), 5.25e-7, 1e-18) << radius;
        EXPECT_NEAR(r.at("wavelength_m").get<double>(), 6.328e-7, 1e-18) << wavelength;
    }
    // The index of water and of ice at the wavelength.
    const Json water = print_json("mie", {"--radius", "1", "--wavelength", "550nm"});
    EXPECT_EQ(water.at("index"), (Json{1.333, 1.96e-9}));
    const Json ice =
        print_json("mie", {"--radius", "1", "--wavelength", "0.55", "--substance", "ice"});
    EXPECT_EQ(ice.at("index").at(0), 1.311);
}

TEST(Mie, DropletsHaveTheirExtinctionFromTheirWater) {
    const Json all = print_json("mie", join({"--density", "1e9"}, kSmallDroplets));
    const Json& droplets = all.at("droplets");
    ASSERT_EQ(all.at("wavelengths").size(), 3u);
    for (const Json& one : all.at("wavelengths")) {
        const double kappa = 0.75 * one.at("q_ext").get<double>() *
                             droplets.at("liquid_water_kg_per_m3").get<double>() / (1000 * 0.5e-6);
        EXPECT_NEAR(one.at("extinction_per_m").get<double>() / kappa, 1, 1e-9);
        EXPECT_NEAR(one.at("albedo").get<double>() + one.at("absorbed_share").get<double>(), 1,
                    1e-12);
        EXPECT_GT(one.at("error").at("phase_rms"), 0);
        const double weight = one.at("forward_weight");
        EXPECT_NEAR(one.at("rest_extinction_per_m").get<double>(), (1 - weight) * kappa,
                    1e-9 * kappa);
    }
    EXPECT_EQ(all.at("wavelengths").at(0).at("wavelength_m"), 6.5e-7);
    EXPECT_EQ(droplets.at("gamma"), 2);
}

TEST(Mie, ForwardAngleIsTheOneThatIsAskedFor) {
    const Json none =
        print_json("mie", join({"--forward-angle", "0", "--wavelength", "550nm"}, kSmallDroplets));
    EXPECT_EQ(none.at("forward_angle_deg"), 0);
    EXPECT_EQ(none.at("wavelengths").at(0).at("forward_weight"), 0);
    EXPECT_EQ(none.at("wavelengths").at(0).at("rest_extinction_per_m"),
              none.at("wavelengths").at(0).at("extinction_per_m"));
    const Json wide =
        print_json("mie", join({"--forward-angle", "30", "--wavelength", "550nm"}, kSmallDroplets));
    EXPECT_NEAR(wide.at("forward_angle_deg").get<double>(), 30, 1e-9);
    EXPECT_GT(wide.at("wavelengths").at(0).at("forward_weight"), 0.3);
}

TEST(Mie, CsvHoldsTheNumbersOfTheJson) {
    const auto check = [](const Arguments& arguments, const Json& expected, std::size_t lines) {
        const Outcome csv = run_well(join(join({"mie"}, arguments), {"--format", "csv"}));
        std::istringstream text(csv.out);
        std::vector<std::vector<std::string>> table;
        for (std::string line; std::getline(text, line);) {
            std::stringstream cells(line);
            table.emplace_back();
            for (std::string cell; std::getline(cells, cell, ',');) {
                table.back().push_back(cell);
            }
        }
        ASSERT_EQ(table.size(), lines + 1);
        for (const char* key : {"q_ext", "q_sca", "q_abs", "q_back", "g"}) {
            const auto column = std::find(table[0].begin(), table[0].end(), key);
            ASSERT_NE(column, table[0].end()) << key;
            const auto at = static_cast<std::size_t>(column - table[0].begin());
            EXPECT_EQ(table[1].size(), table[0].size());
            EXPECT_EQ(std::stod(table[1].at(at)), expected.at(key)) << key;
        }
    };
    const Arguments sphere = {"--size-parameter", "3", "--index", "1.5,0.1"};
    check(sphere, print_json("mie", sphere), 1);
    const Arguments droplets = join({"--wavelength", "650nm,450nm"}, kSmallDroplets);
    check(droplets, print_json("mie", droplets).at("wavelengths").at(0), 2);
}

TEST(Mie, EqualDropletsAreAWarning) {
    const Outcome outcome =
        run_well({"mie", "--effective-radius", "0.5", "--gamma", "1000", "--size-step", "1"});
    EXPECT_THAT(outcome.err, AllOf(StartsWith("opaline: warning: "), HasSubstr("ripples")));
}

TEST(Mie, BadCommandLinesExitWithTwoAndSayWhatIsWrong) {
    const std::vector<std::pair<Arguments, std::string>> bad = {
        {{}, "give one of"},
        {{"--size-parameter", "1", "--radius", "1", "--index", "1.5"}, "not several"},
        {{"--size-parameter", "1"}, "--index"},
        {{"--size-parameter", "0", "--index", "1.5"}, "number from"},
        {{"--size-parameter", "1e7", "--index", "1.5"}, "number from"},
        {{"--size-parameter", "nan", "--index", "1.5"}, "number from"},
        {{"--size-parameter", "1", "--index", "0"}, "real part"},
        {{"--size-parameter", "1", "--index", "1.5,-0.1"}, "imaginary part"},
        {{"--size-parameter", "1", "--index", "1.5,0,2"}, "not one number or two"},
        {{"--size-parameter", "1", "--index", "glass"}, "not one number or two"},
        {{"--size-parameter", "1", "--index", "1.5", "--wavelength", "550nm"}, "--wavelength"},
        {{"--size-parameter", "1", "--index", "1.5", "--gamma", "2"}, "--gamma"},
        {{"--size-parameter", "1", "--index", "1.5", "--density", "2"}, "--density"},
        {{"--radius", "1", "--threads", "2"}, "--threads"},
        {{"--radius", "1", "--wavelength", "550"}, "table of water"},
        {{"--radius", "1", "--wavelength", "550e-9"}, "micrometres"},
        {{"--radius", "1", "--wavelength", "550km"}, "nm, um, mm, m"},
        {{"--radius", "1", "--wavelength", "550nm,650nm"}, "--wavelength"},
        {{"--radius", "1km"}, "nm, um, mm, m"},
        {{"--radius", "1", "--index", "1.5", "--substance", "ice"}, "--"},
        {{"--effective-radius", "0"}, "micrometres"},
        {{"--effective-radius", "1", "--gamma", "0"}, "number from"},
        {{"--effective-radius", "1", "--density", "0"}, "number above"},
        {{"--effective-radius", "1", "--index", "1"}, "index 1"},
        {{"--effective-radius", "10mm"}, "geometric optics"},
        {{"--effective-radius", "1", "--wavelength", "100nm"}, "table of water"},
        {{"--effective-radius", "1", "--forward-angle", "91", "--size-step", "9"},
         "--forward-angle"},
        {{"--effective-radius", "1", "--format", "xml"}, "json, csv"},
        {{"--effective-radius", "1", "--json", "--format", "csv"}, "--"},
        {{"--effective-radius", "1", "--substance", "mercury"}, "water, ice"},
    };
    for (const auto& [arguments, part] : bad) {
        expect_refused(join({"mie"}, arguments), 2, part);
    }
}

TEST(PhaseOfDroplets, IntegratesTo1OnRowsThatCrowdAhead) {
    const Json all = print_json("phase", join({"--type", "mie"}, kSmallDroplets));
    const Json &cosine = all.at("function").at("cosine"), &value = all.at("function").at("value");
    double sum = 0, ahead = 0;
    for (std::size_t i = 1; i < value.size(); ++i) {
        const double width = cosine.at(i).get<double>() - cosine.at(i - 1).get<double>();
        EXPECT_GT(width, 0);
        sum += pi * width * (value.at(i).get<double>() + value.at(i - 1).get<double>());
        ahead += cosine.at(i).get<double>() > 0.9 ? 1 : 0;
    }
    EXPECT_EQ(cosine.front(), -1);
    EXPECT_EQ(cosine.back(), 1);
    EXPECT_NEAR(sum, 1, 2e-3);  // rows left out are within 0.2 % of the line
    EXPECT_GT(ahead, 0.1 * static_cast<double>(value.size()));
    EXPECT_EQ(all.at("phase").at("type"), "mie");
    EXPECT_EQ(all.at("phase").at("wavelength_m"), 5.5e-7);
    EXPECT_NEAR(all.at("lambda").at(0).get<double>(), 1, 1e-9);
    EXPECT_EQ(all.at("lambda").at(1), all.at("mean_cosine"));
    EXPECT_GT(all.at("error").at("phase_rms"), 0);
}

// By scattered power, which is alike in wavelengths so close.
TEST(PhaseOfDroplets, SeveralWavelengthsAreOneChannelByTheirWeights) {
    const auto mean_cosine = [](const Arguments& more) {
        const Json all = print_json("phase", join(join({"--type", "mie"}, kSmallDroplets), more));
        return all.at("mean_cosine").get<double>();
    };
    const double green = mean_cosine({"--wavelength", "550nm"});
    const double red = mean_cosine({"--wavelength", "600nm"});
    EXPECT_GT(std::abs(green - red), 1e-3);
    EXPECT_NEAR(mean_cosine({"--wavelength", "550nm,600nm", "--weights", "1,0"}), green, 1e-5);
    EXPECT_NEAR(mean_cosine({"--wavelength", "550nm,600nm"}), (green + red) / 2,
                0.1 * std::abs(green - red));
    EXPECT_NEAR(mean_cosine({"--wavelength", "550nm,600nm", "--weights", "1,3"}),
                (green + 3 * red) / 4, 0.1 * std::abs(green - red));
    const Json all = print_json(
        "phase", join(join({"--type", "mie"}, kSmallDroplets), {"--wavelength", "550nm,600nm"}));
    EXPECT_EQ(all.at("phase").at("weights"), (std::vector<double>{1, 1}));
}

TEST(PhaseOfDroplets, TableIsOneThatMediaFilesCanName) {
    const TemporaryFolder folder;
    const std::string path = folder / "droplets.txt";
    // Its peak is too narrow for the cube map, which is a warning, not an error.
    const Outcome made = run_well({"phase", "--type", "mie", "--effective-radius", "5um",
                                   "--size-step", "0.5", "--table-output", path});
    const Json first = Json::parse(made.out);
    const Outcome read = run_well({"phase", "--type", "table", "--table", path});
    const Json second = Json::parse(read.out);
    for (std::size_t l = 0; l < 32; ++l) {
        EXPECT_NEAR(second.at("lambda").at(l).get<double>(), first.at("lambda").at(l).get<double>(),
                    2e-3)
            << l;
    }
    // Any other function too; and never over the table that it is made from.
    const std::string other = folder / "other.txt";
    run_well({"phase", "--g", "0.5", "--table-output", other});
    EXPECT_EQ(run_opaline({"phase", "--type", "table", "--table", other, "--table-output", other})
                  .exit_code,
              2);
}

TEST(PhaseOfDroplets, OptionsOfOtherTypesAreRefused) {
    for (const Arguments& arguments :
         {Arguments{"--type", "mie"},
          {"--type", "mie", "--effective-radius", "1", "--g", "0.5"},
          {"--type", "mie", "--effective-radius", "1", "--samples", "10"},
          {"--type", "mie", "--effective-radius", "1", "--weights", "1,2"},
          {"--type", "mie", "--effective-radius", "1", "--wavelength", "550nm,650nm", "--weights",
           "0,0"},
          {"--type", "mie", "--effective-radius", "1", "--wavelength", "550nm,650nm", "--weights",
           "1,-1"},
          {"--g", "0.5", "--weights", "1"},
          {"--g", "0.5", "--effective-radius", "1"},
          {"--g", "0.5", "--gamma", "2"},
          {"--type", "rayleigh", "--wavelength", "550nm"},
          {"--type", "rayleigh", "--threads", "2"}}) {
        expect_refused(join({"phase"}, arguments), 2, "");
    }
}

}  // namespace
}  // namespace opaline::tests
