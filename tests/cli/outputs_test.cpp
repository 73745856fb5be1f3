#include <gmock/gmock.h>

#include "tests/cli/small_scene.h"

namespace opaline::tests {
namespace {

using ::testing::StartsWith;

Arguments draft(const SmallScene& small, const Arguments& more) {
    return join({"bake", small.scene(), "--quality", "draft"}, more);
}

TEST(Outputs, EmptyNameIsRefusedBeforeAnyWork) {
    SmallScene small;
    const std::string out = small.path("a.opal");
    for (const Arguments& more :
         {Arguments{"-o", ""}, {"-o", out, "--report", ""}, {"-o", out, "--depfile", ""}}) {
        expect_refused(draft(small, more), 2, "the name is empty");
    }
    EXPECT_EQ(list_folder(small.folder()), Arguments{"scene.glb"});
}

TEST(Outputs, TwoOutputsInOneFileAreRefused) {
    SmallScene small;
    const std::string out = small.path("q.opal");
    std::filesystem::create_symlink("q.opal", small.path("link"));  // to what does not exist yet
    std::filesystem::create_directory_symlink(".", small.path("here"));
    const std::vector<Arguments> same = {
        {"-o", out, "--report", out},
        {"-o", out, "--depfile", out},
        {"-o", out, "--report", small.path("r"), "--depfile", small.path("r")},
        {"-o", out, "--report", small.path("link")},
        {"-o", out, "--report", small.path("here/q.opal")},
        {"-o", out, "--report", small.path("./here/./q.opal")}};
    for (const Arguments& more : same) {
        expect_refused(draft(small, more), 2, " name the same file");
    }
    EXPECT_EQ(list_folder(small.folder()), (Arguments{"here", "link", "scene.glb"}));
    write_file(out, std::string("former"));
    std::filesystem::create_hard_link(out, small.path("hard"));
    EXPECT_EQ(run_opaline(draft(small, {"-o", out, "--report", small.path("hard")})).exit_code, 2);
    EXPECT_EQ(read_text(out), "former");
}

TEST(Outputs, OutputsThatTakeEverythingMayBeNamedTwice) {
    SmallScene small;
    run_well(draft(
        small, {"-o", small.path("a.opal"), "--report", "/dev/null", "--depfile", "/dev/null"}));
}

TEST(Outputs, InputsAreNotOverwrittenThroughLinks) {
    SmallScene small;
    const std::string before = read_text(small.scene());
    std::filesystem::create_symlink("scene.glb", small.path("link.opal"));
    for (const char* option : {"-o", "--report", "--depfile"}) {
        Arguments more = {option, small.path("link.opal")};
        if (option != std::string("-o")) {
            more.insert(more.end(), {"-o", small.path("a.opal")});
        }
        expect_refused(draft(small, more), 2, "is an input and would be overwritten");
    }
    EXPECT_EQ(read_text(small.scene()), before);
}

TEST(Outputs, OneFrameOfATurntableMayNotBeTheLight) {
    SmallScene small;
    write_file(small.path("t-0002.exr"), std::string("a light"));
    expect_refused({"render", small.baked(), "--light", small.path("t-0002.exr"), "-o",
                    small.path("t.exr"), "--frames", "3", "--backend", "cpu"},
                   2, "t-0002.exr: is an input");
}

TEST(Outputs, LinkIsFollowed) {
    SmallScene small;
    std::filesystem::create_symlink("real.opal", small.path("link.opal"));
    run_well(draft(small, {"-o", small.path("link.opal")}));
    EXPECT_TRUE(std::filesystem::is_symlink(small.path("link.opal")));
    EXPECT_TRUE(std::filesystem::is_regular_file(small.path("real.opal")));
}

TEST(Outputs, FailureOfAReportOrDepfileLeavesNoBake) {
    SmallScene small;
    for (const char* option : {"--report", "--depfile"}) {
        expect_refused(draft(small, {"-o", small.path("a.opal"), option, "/dev/full"}), 4,
                       "No space left on device");
        EXPECT_EQ(list_folder(small.folder()), Arguments{"scene.glb"});
    }
}

TEST(Outputs, EndingsMayBeInCapitals) {
    SmallScene small;
    const std::string png = small.path("x.PNG"), csv = small.path("x.CSV");
    run_well({"render", small.baked(), "--light", "white", "--backend", "cpu", "--size", "32x32",
              "-o", png});
    EXPECT_THAT(read_text(png), StartsWith("\x89PNG"));
    run_well({"relight", small.baked(), "--light", "white", "-o", csv});
    EXPECT_THAT(read_text(csv), StartsWith("primitive,vertex,"));
}

TEST(Outputs, SignalsIgnoredAsByNohupStayIgnored) {
    SmallScene small;
    const Outcome bake = run_any({"sh", "-c",
                                  "trap '' HUP; " OPALINE_PROGRAM " bake '" + small.scene() +
                                      "' --quality draft -o '" + small.path("a.opal") +
                                      "' & sleep 0.3; kill -HUP $!; wait $!"});
    EXPECT_EQ(bake.exit_code, 0) << bake.err;
}

}  // namespace
}  // namespace opaline::tests
