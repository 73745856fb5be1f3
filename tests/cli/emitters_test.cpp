// Lamps through the program: baked once, switched and dimmed.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>
#include <string>

#include "formats/opal/write_opal.h"
#include "tests/cli/small_scene.h"
#include "tests/formats/opal/emitter_fixture.h"

namespace opaline::tests {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

std::string write_emitter_file(const SmallScene& small) {
    auto file = formats::AtomicFile::create(small.path("lamps.opal"));
    EXPECT_TRUE(file && formats::write_opal(make_emitter_asset().view(), std::move(*file)));
    return small.path("lamps.opal");
}

// What `relight --json` prints.
nlohmann::json relit(const SmallScene& small, Arguments more) {
    Arguments arguments{"relight", write_emitter_file(small), "--light", "black",
                        "-o",      small.path("o.csv"),       "--json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Outcome outcome = run_opaline(arguments);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    return nlohmann::json::parse(outcome.out);
}

TEST(EmitterFiles, AreListedAndVerified) {
    SmallScene small;
    const std::string file = write_emitter_file(small);
    const Outcome info = run_opaline({"info", file, "--json"});
    ASSERT_EQ(info.exit_code, 0) << info.err;
    const auto emitters = nlohmann::json::parse(info.out)["emitters"];
    ASSERT_EQ(emitters.size(), 2u);
    EXPECT_EQ(emitters[0]["name"], "Lamp");
    EXPECT_EQ(emitters[1]["glowing_primitives"], 1);
    EXPECT_THAT(run_opaline({"info", file}).out,
                AllOf(HasSubstr("'Lamp': "), HasSubstr(" times the light of a sky of radiance 1")));
    EXPECT_EQ(run_opaline({"verify", file}).exit_code, 0);
}

TEST(EmitterFiles, AreSwitchedAndDimmed) {
    SmallScene small;
    const double on = relit(small, {})["mean"][0];
    EXPECT_GT(on, 1);
    EXPECT_EQ(relit(small, {"--emitter", "Lamp=0,0,0", "--emitter", "Panel=0"})["maximum"], 0);
    const double lamp = relit(small, {"--emitter", "Panel=0"})["mean"][0];
    const double panel = relit(small, {"--emitter", "Lamp=0,0,0"})["mean"][0];
    EXPECT_NEAR(lamp + panel, on, 1e-4 * on);
    EXPECT_NEAR(
        double(relit(small, {"--emitter", "Panel=0", "--emitter", "Lamp=0.5,1,1"})["mean"][0]),
        lamp / 2, 1e-4 * on);
}

TEST(EmitterFiles, NamesAndFactorsThatAreNoneAreRefused) {
    SmallScene small;
    const std::string file = write_emitter_file(small);
    const auto refuse = [&](const std::string& text) {
        const Outcome outcome = run_opaline(
            {"render", file, "--light", "black", "--emitter", text, "-o", small.path("o.png")});
        EXPECT_EQ(outcome.exit_code, 2) << text;
        return outcome.err;
    };
    EXPECT_THAT(refuse("Bulb=1,1,1"),
                AllOf(HasSubstr("no emitter of that name"), HasSubstr("it has 'Lamp', 'Panel'")));
    EXPECT_THAT(refuse("Lamp"), HasSubstr("expected NAME=R,G,B"));
    for (const char* text : {"Lamp=-1,0,0", "Lamp=1,2", "Lamp=nan,1,1", "Lamp=1,2,3,4", "Lamp="}) {
        EXPECT_THAT(refuse(text), HasSubstr("expected three numbers"));
    }
}

TEST(EmitterFiles, OfAFileWithoutAnyThereIsNoneToName) {
    SmallScene small;
    const Outcome outcome = run_opaline({"relight", small.baked(), "--light", "white", "--emitter",
                                         "Lamp=1", "-o", small.path("o.csv")});
    EXPECT_EQ(outcome.exit_code, 2);
    EXPECT_THAT(outcome.err, HasSubstr("it has none at all"));
}

}  // namespace
}  // namespace opaline::tests
