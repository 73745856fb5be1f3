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
    Arguments first = command;
    first.insert(first.end(), {"--light", "studio", "--light", "white"});
    const Outcome before = run_opaline(first);
    ASSERT_EQ(before.exit_code, 0) << before.err;
    EXPECT_THAT(before.err, HasSubstr("with 2 lights; open"));
    EXPECT_THAT(list_folder(page), Contains("light-1.js"));
    EXPECT_THAT(read_text(page + "/contents.js"),
                HasSubstr(R"(opaline.lights = ["studio","white"])"));
    EXPECT_THAT(read_text(page + "/contents.js"), HasSubstr(R"(opaline.title = "scene")"));
    Arguments second = command;
    second.insert(second.end(), {"--light", "sun:10,20"});
    const Outcome after = run_opaline(second);
    ASSERT_EQ(after.exit_code, 0) << after.err;
    EXPECT_THAT(list_folder(page), Not(Contains("light-1.js")));
    EXPECT_EQ(list_folder(small.folder()), (Arguments{"page", "scene.glb", "scene.opal"}));
}

TEST(ExportWeb, APageWithTheLightsByDefaultIsSmall) {
    SmallScene small;
    const std::string page = small.path("page");
    ASSERT_EQ(run_opaline({"export-web", small.baked(), "-o", page}).exit_code, 0);
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
        const Outcome refused = run_opaline({"export-web", small.baked(), "-o", output});
        EXPECT_EQ(refused.exit_code, 2) << refused.err;
    }
    EXPECT_EQ(list_folder(folder), Arguments{"letter.txt"});
    EXPECT_EQ(read_text(file), "note");
}

TEST(ExportWeb, NothingIsWrittenOfWhatCannotBeShown) {
    SmallScene small;
    const std::string page = small.path("page");
    const Outcome missing = run_opaline({"export-web", small.path("none.opal"), "-o", page});
    EXPECT_EQ(missing.exit_code, 3) << missing.err;
    const Outcome light =
        run_opaline({"export-web", small.baked(), "-o", page, "--light", "sky:99,10"});
    EXPECT_EQ(light.exit_code, 2) << light.err;
    const Outcome file = run_opaline({"export-web", small.scene(), "-o", page});
    EXPECT_EQ(file.exit_code, 3) << file.err;
    EXPECT_EQ(list_folder(small.folder()), (Arguments{"scene.glb", "scene.opal"}));
}

}  // namespace
}  // namespace opaline::tests
