#include <gmock/gmock.h>

#include <chrono>

#include "tests/cli/small_scene.h"

namespace opaline::tests {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

// A sanitizer reserves more address space than these tests leave.
constexpr bool kSanitized = OPALINE_SANITIZED;

/// A sheet of n x n vertices, `count` times.
void write_instances(const std::string& path, unsigned n, unsigned count) {
    AssetBuilder asset = wavy_sheet(n);
    for (unsigned i = 1; i < count; ++i) {
        asset.add_node(0);
    }
    write_file(path, asset.glb());
}

TEST(Memory, BakesThatDoNotFitAreRefusedAtOnce) {
    SmallScene small;
    for (const char* command : {"bake", "plan", "sweep"}) {
        Arguments arguments = {command, small.scene(), "--memory-limit", "1000000"};
        if (command != std::string("plan")) {
            arguments.insert(arguments.end(), {"-o", small.path("out")});
        }
        const Outcome outcome = run_opaline(arguments);
        EXPECT_EQ(outcome.exit_code, 4) << outcome.err;
        EXPECT_THAT(outcome.err,
                    StartsWith("opaline: error: " + small.scene() + ": the bake needs about "));
        EXPECT_THAT(outcome.err, HasSubstr("and may take 1.0 MB"));
        EXPECT_THAT(outcome.err, HasSubstr("raise --memory-limit"));
    }
    EXPECT_EQ(list_folder(small.folder()), Arguments{"scene.glb"});
    run_well({"plan", small.scene(), "--memory-limit", "1000000000"});
}

// 10 000 instances of 2916 vertices took 8.7 GB in `plan`. Here the refusal must fit into 600 MB.
TEST(Memory, InstancesAreCountedBeforeTheyAreMade) {
    if (kSanitized) {
        GTEST_SKIP() << "a sanitizer's memory is not the program's";
    }
    SmallScene small;
    for (const auto& [side, count] : {std::pair{54u, 10000u}, {2u, 200000u}}) {
        write_instances(small.path("many.glb"), side, count);
        const auto start = std::chrono::steady_clock::now();
        const Outcome plan =
            run_any({"sh", "-c",
                     "ulimit -v 1500000; exec " OPALINE_PROGRAM " plan '" + small.path("many.glb") +
                         "' --simplify off --memory-limit 1000000000"});
        const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
        EXPECT_EQ(plan.exit_code, 4) << plan.err;
        EXPECT_THAT(plan.err, HasSubstr("many.glb: the bake needs about "));
        EXPECT_LT(seconds.count(), 30);
    }
}

TEST(Memory, PredictionIsNearWhatABakeTakes) {
    if (kSanitized) {
        GTEST_SKIP() << "a sanitizer's memory is not the program's";
    }
    SmallScene small;
    write_file(small.path("sheet.glb"), wavy_sheet(200).glb());
    const Outcome plan = run_opaline({"plan", small.path("sheet.glb"), "--json"});
    const Outcome bake = start_opaline({"bake", small.path("sheet.glb"), "-o", small.path("a.opal"),
                                        "--report", small.path("r.json")});
    ASSERT_EQ(bake.exit_code, 0) << bake.err;
    const double predicted = Json::parse(plan.out).at("predicted_memory_bytes");
    const double peak =
        Json::parse(read_text(small.path("r.json"))).at("stages").back().at("peak_rss_bytes");
    EXPECT_GT(predicted, peak / 2);
    EXPECT_LT(predicted, peak * 3);
}

// Little address space: TBB slept for ever where it could not start a thread.
TEST(Memory, LittleAddressSpaceIsRefusedAndNotWaitedFor) {
    if (kSanitized) {
        GTEST_SKIP() << "a sanitizer's memory is not the program's";
    }
    SmallScene small;
    for (unsigned kilobytes = 190000; kilobytes <= 260000; kilobytes += 10000) {
        const Outcome bake =
            run_any({"sh", "-c",
                     "ulimit -v " + std::to_string(kilobytes) + "; exec timeout -s KILL 60 " +
                         OPALINE_PROGRAM " bake '" + small.scene() + "' --threads 2 -o '" +
                         small.path("a.opal") + "'"});
        EXPECT_TRUE(bake.exit_code == 4 || bake.exit_code == 0) << kilobytes << bake.err;
    }
}

TEST(Memory, ThreadsThatCannotBeStartedAreAnError) {
    if (kSanitized) {
        GTEST_SKIP() << "a sanitizer's memory is not the program's";
    }
    SmallScene small;
    const Outcome bake =
        run_any({"sh", "-c",
                 "ulimit -v 1000000; exec timeout -s KILL 60 " OPALINE_PROGRAM " bake '" +
                     small.scene() + "' --threads 1000 -o '" + small.path("a.opal") + "'"});
    EXPECT_EQ(bake.exit_code, 4) << bake.err;
}

}  // namespace
}  // namespace opaline::tests
