#include <gmock/gmock.h>

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

Json phase(const Arguments& arguments) {
    return print_json("phase", arguments);
}

/// 2 pi int p over the cosine, by trapezia.
double integral(const Json& function) {
    const Json &cosine = function.at("cosine"), &value = function.at("value");
    double sum = 0;
    for (std::size_t i = 1; i < value.size(); ++i) {
        sum += (cosine.at(i).get<double>() - cosine.at(i - 1).get<double>()) *
               (value.at(i).get<double>() + value.at(i - 1).get<double>()) / 2;
    }
    return 2 * pi * sum;
}

TEST(Phase, EveryTypeIsADensityWithItsMeanCosine) {
    const TemporaryFolder folder;
    write_file(folder / "ramp.csv", std::string("cosine,value\n-1,0\n1,4\n"));
    for (const auto& [arguments, mean] :
         {std::pair{Arguments{"--type", "hg", "--g", "-0.3"}, -0.3},
          {{"--type", "isotropic"}, 0.0},
          {{"--type", "rayleigh"}, 0.0},
          {{"--type", "table", "--table", folder / "ramp.csv"}, 1.0 / 3}}) {
        Arguments more = arguments;
        more.insert(more.end(), {"--samples", "2001"});
        const Json all = phase(more);
        EXPECT_EQ(all.at("function").at("value").size(), 2001u);
        EXPECT_NEAR(integral(all.at("function")), 1, 1e-5);  // trapezia of 0.09 degrees
        EXPECT_NEAR(all.at("mean_cosine").get<double>(), mean, 1e-9);
        EXPECT_NEAR(all.at("lambda").at(0).get<double>(), 1, 1e-12);
        EXPECT_EQ(all.at("lambda").at(1), all.at("mean_cosine"));
    }
    const Json narrow = phase({"--type", "gaussian", "--rms-angle", "0.5"});
    EXPECT_NEAR(integral(narrow.at("function")), 1, 1e-3);
    EXPECT_GT(narrow.at("mean_cosine"), 0.8);
}

// With equally spaced rows g = 0.99 came back as 0.993, which the reader refuses.
TEST(Phase, NarrowLobesComeBackFromTheirTable) {
    const TemporaryFolder folder;
    const std::string path = folder / "table.txt";
    for (const Arguments& type : {Arguments{"--g", "0.99"},
                                  {"--g", "-0.95"},
                                  {"--type", "gaussian", "--rms-angle", "0.15"},
                                  {"--type", "isotropic"}}) {
        const std::string copy = folder / "copy.txt";
        // Their peaks are too narrow for the cube map, which is a warning.
        const Outcome made = run_opaline(join({"phase", "--table-output", path}, type));
        const Outcome read =
            run_opaline({"phase", "--type", "table", "--table", path, "--table-output", copy});
        ASSERT_EQ(made.exit_code, 0) << made.err;
        ASSERT_EQ(read.exit_code, 0) << read.err;
        const Json first = Json::parse(made.out), second = Json::parse(read.out);
        for (std::size_t l = 0; l < 32; ++l) {
            EXPECT_NEAR(second.at("lambda").at(l).get<double>(),
                        first.at("lambda").at(l).get<double>(), 1e-3)
                << type.back() << ' ' << l;
        }
        // A table keeps its rows: values are normalised, cosines stay.
        EXPECT_EQ(count_lines(copy), count_lines(path));
        EXPECT_LT(count_lines(path), 2000u);
    }
}

TEST(Phase, AnyFileNameCanBePrinted) {
    const TemporaryFolder folder;
    const std::string path = folder / "not\xffutf8";
    write_file(path, std::string("-1 1\n1 1\n"));
    EXPECT_NEAR(phase({"--type", "table", "--table", path}).at("mean_cosine").get<double>(), 0,
                1e-12);
}

TEST(Phase, CsvHoldsTheNumbersOfTheJson) {
    const Json json = phase({"--g", "0.25"});
    const Outcome csv = run_well({"phase", "--g", "0.25", "--format", "csv"});
    std::map<std::string, std::map<double, double>> value;
    std::istringstream lines(csv.out);
    std::string line;
    std::getline(lines, line);
    EXPECT_EQ(line, "quantity,at,value");
    while (std::getline(lines, line)) {
        const std::size_t first = line.find(','), second = line.find(',', first + 1);
        value[line.substr(0, first)][std::stod(line.substr(first + 1))] =
            std::stod(line.substr(second + 1));
    }
    EXPECT_EQ(value["p"].size(), 181u);
    EXPECT_NEAR(value["p"][1], 1.25 / (4 * pi * 0.75 * 0.75), 1e-12);
    EXPECT_EQ(value["lambda"][2], 0.0625);
    EXPECT_EQ(value["rms_harmonics"][4], json.at("rms").at("harmonics").at(3));
    EXPECT_EQ(value["rms_harmonics_absolute"].size(), 25u);
    EXPECT_EQ(value["rms_svd"][25], json.at("rms").at("svd").at(24));
    EXPECT_EQ(value["singular_value"][0], json.at("singular_values").at(0));
    EXPECT_EQ(value["singular_value"].size(), 100u);
}

TEST(Phase, LobesTooNarrowForTheCubeMapAreAWarning) {
    const Outcome outcome = run_well({"phase", "--g", "0.95"});
    EXPECT_THAT(outcome.err, AllOf(StartsWith("opaline: warning: "), HasSubstr("too narrow")));
    EXPECT_EQ(Json::parse(outcome.out).at("lambda").at(1), 0.95);
}

TEST(Phase, FaultyTablesAreRefusedWithTheirLine) {
    const TemporaryFolder folder;
    const std::string path = folder / "table.txt";
    const auto refuse = [&](const std::string& text) {
        write_file(path, text);
        const Outcome outcome = run_opaline({"phase", "--type", "table", "--table", path});
        EXPECT_EQ(outcome.exit_code, 3) << text;
        EXPECT_EQ(outcome.out, "");
        EXPECT_THAT(outcome.err, StartsWith("opaline: error: " + path));
        return outcome.err;
    };
    EXPECT_THAT(refuse("-1 1\n0 -1\n1 1\n"), HasSubstr("line 2"));
    EXPECT_THAT(refuse("-1 1\n0 1\n0 1\n1 1\n"), HasSubstr("line 3"));
    EXPECT_THAT(refuse("0 1\n1 1\n"), HasSubstr("do not reach from -1 to 1"));
    EXPECT_THAT(refuse("-1 0\n1 0\n"), HasSubstr("all zero"));
    refuse("");
    const std::string nowhere = folder / "none";
    const Outcome missing = run_opaline({"phase", "--type", "table", "--table", nowhere});
    EXPECT_EQ(missing.exit_code, 3);
    EXPECT_THAT(missing.err, StartsWith("opaline: error: " + nowhere));
}

}  // namespace
}  // namespace opaline::tests
