// Lamps through the program: baked once, switched and dimmed.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>
#include <string>

#include "tests/cli/small_scene.h"
#include "tests/formats/opal/emitter_fixture.h"

namespace opaline::tests {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

std::string write_emitter_file(const SmallScene& small) {
    return small.write(make_emitter_asset(), "lamps.opal");
}

// What `relight --json` prints.
nlohmann::json relit(const SmallScene& small, Arguments more) {
    const Outcome outcome = run_well(join({"relight", write_emitter_file(small), "--light", "black",
                                           "-o", small.path("o.csv"), "--json"},
                                          more));
    return nlohmann::json::parse(outcome.out);
}

TEST(EmitterFiles, AreListedAndVerified) {
    SmallScene small;
    const std::string file = write_emitter_file(small);
    const Outcome info = run_well({"info", file, "--json"});
    const auto emitters = nlohmann::json::parse(info.out)["emitters"];
    ASSERT_EQ(emitters.size(), 2u);
    EXPECT_EQ(emitters[0]["name"], "Lamp");
    EXPECT_EQ(emitters[1]["glowing_primitives"], 1);
    EXPECT_THAT(run_opaline({"info", file}).out,
                AllOf(HasSubstr("'Lamp': "), HasSubstr(" times the light of a sky of radiance 1")));
    run_well({"verify", file});
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
    expect_refused({"relight", small.baked(), "--light", "white", "--emitter", "Lamp=1", "-o",
                    small.path("o.csv")},
                   2, "it has none at all");
}

}  // namespace
}  // namespace opaline::tests
