// The folder that `export-web` writes; tests/runtime/web looks at the page.
#include <gmock/gmock.h>

#include <cstdint>
#include <filesystem>
#include <fstream>

#include "tests/cli/small_scene.h"

namespace opaline::tests {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;

TEST(ExportWeb, FolderHasEachLightAndReplacesAnEarlierOne) {
    SmallScene small;
    const std::string page = small.path("page");
    const Arguments command = {"export-web", small.baked(), "-o", page};
    const Outcome before = run_well(join(command, {"--light", "studio", "--light", "white"}));
    EXPECT_THAT(before.err, HasSubstr("with 2 lights; open"));
    EXPECT_THAT(list_folder(page), Contains("light-1.js"));
    EXPECT_THAT(read_text(page + "/contents.js"),
                HasSubstr(R"(opaline.lights = ["studio","white"])"));
    EXPECT_THAT(read_text(page + "/contents.js"), HasSubstr(R"(opaline.title = "scene")"));
    run_well(join(command, {"--light", "sun:10,20"}));
    EXPECT_THAT(list_folder(page), Not(Contains("light-1.js")));
    EXPECT_EQ(list_folder(small.folder()), (Arguments{"page", "scene.glb", "scene.opal"}));
}

TEST(ExportWeb, APageWithTheLightsByDefaultIsSmall) {
    SmallScene small;
    const std::string page = small.path("page");
    run_well({"export-web", small.baked(), "-o", page});
    std::uintmax_t bytes = 0;
    for (const std::string& name : list_folder(page)) {
        bytes += std::filesystem::file_size(page + "/" + name);
    }
    EXPECT_LT(bytes, 2'000'000u);
}

TEST(ExportWeb, FolderThatHoldsOtherThingsStaysAsItIs) {
    SmallScene small;
    const std::string folder = small.path("mine"), file = small.path("note");
    std::filesystem::create_directory(folder);
    std::ofstream(folder + "/letter.txt") << "dear";
    std::ofstream(file) << "note";
    for (const std::string& output : {folder, file}) {
        expect_refused({"export-web", small.baked(), "-o", output}, 2, "");
    }
    EXPECT_EQ(list_folder(folder), Arguments{"letter.txt"});
    EXPECT_EQ(read_text(file), "note");
}

TEST(ExportWeb, NothingIsWrittenOfWhatCannotBeShown) {
    SmallScene small;
    const std::string page = small.path("page");
    expect_refused({"export-web", small.path("none.opal"), "-o", page}, 3, "");
    expect_refused({"export-web", small.baked(), "-o", page, "--light", "sky:99,10"}, 2, "");
    expect_refused({"export-web", small.scene(), "-o", page}, 3, "");
    EXPECT_EQ(list_folder(small.folder()), (Arguments{"scene.glb", "scene.opal"}));
}

}  // namespace
}  // namespace opaline::tests
