
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstring>
#include <limits>
#include <random>

#include "formats/vdb/limits.h"
#include "formats/vdb/reply.h"
#include "tests/formats/vdb/vdb_files.h"
#include "tests/support/temporary_folder.h"

namespace opaline::formats::vdb {
namespace {

std::optional<Reply> parse(const std::string& bytes) {
    std::size_t used = 0;
    return parse_reply([&](std::span<std::byte> out) {
        if (bytes.size() - used < out.size()) return false;
        std::memcpy(out.data(), bytes.data() + used, out.size());
        used += out.size();
        return true;
    });
}

GridHead head_of(std::int32_t extent, std::uint32_t bricks) {
    GridHead head;
    for (const int i : {0, 5, 10, 15}) {
        head.to_scene[i] = 1;
    }
    for (std::int32_t& e : head.extent) {
        e = extent;
    }
    head.bricks = bricks;
    return head;
}

// What a function sends through a writer.
template <class F>
std::string sent(const F& send) {
    const tests::TemporaryFolder folder;
    FILE* const file = std::fopen((folder / "reply").c_str(), "wb");
    ReplyWriter writer(::fileno(file));
    send(writer);
    std::fclose(file);
    return tests::read_bytes(folder / "reply");
}

std::string sent_grid(const GridHead& head, std::vector<std::uint32_t> places, float value = 1) {
    return sent([&](ReplyWriter& writer) {
        writer.write_grid("density", head);
        for (const std::uint32_t place : places) {
            writer.write_brick(place, std::vector<float>(head.is_color ? 1536 : 512, value));
        }
        writer.write_end();
    });
}

TEST(ParseReply, GridsAndFaultsArrive) {
    GridHead head = head_of(2, 2);
    head.first_brick[1] = -7;
    head.negative = 3;
    const auto reply = parse(sent_grid(head, {1, 6}));
    ASSERT_TRUE(reply.has_value());
    ASSERT_EQ(reply->grids.size(), 1u);
    EXPECT_EQ(reply->grids[0].name, "density");
    EXPECT_EQ(reply->grids[0].negative, 3u);
    EXPECT_EQ(reply->grids[0].scalar.at({8, -56, 0}), 1.0f);
    EXPECT_EQ(reply->grids[0].scalar.at({0, -48, 8}), 1.0f);
    EXPECT_EQ(reply->grids[0].scalar.at({0, -56, 0}), 0.0f);
    const auto fault = parse(sent([](ReplyWriter& writer) {
        writer.write_fault({"a", "b", "c"});
    }));
    ASSERT_TRUE(fault.has_value() && fault->fault.has_value());
    EXPECT_EQ(fault->fault->where + fault->fault->fault + fault->fault->remedy, "abc");
}

TEST(ParseReply, NamesOfUnreadGridsArriveAndAreFew) {
    const auto reply_of = [](std::size_t names) {
        return sent([&](ReplyWriter& writer) {
            writer.write_grid("density", head_of(1, 1));
            writer.write_brick(0, std::vector<float>(512, 1));
            writer.write_end(std::vector<std::string>(names, "vel.x"));
        });
    };
    const auto reply = parse(reply_of(2));
    ASSERT_TRUE(reply.has_value());
    EXPECT_EQ(reply->unread, (std::vector<std::string>{"vel.x", "vel.x"}));
    EXPECT_EQ(parse(reply_of(1000)).value_or(Reply{}).unread.size(), kMaxGrids);
    std::string bytes = reply_of(0);
    bytes[bytes.size() - 1] = '\x7f';  // two thousand million names
    EXPECT_FALSE(parse(bytes).has_value());
}

TEST(ParseReply, LongTextsAreCut) {
    const auto reply = parse(sent([](ReplyWriter& writer) {
        writer.write_fault({"", std::string(100000, 'x'), ""});
    }));
    ASSERT_TRUE(reply.has_value() && reply->fault.has_value());
    EXPECT_EQ(reply->fault->fault.size(), kMaxTextBytes);
}

TEST(ParseReply, WrongHeadsAreRefusedBeforeMemoryIsTaken) {
    ASSERT_TRUE(parse(sent_grid(head_of(2, 1), {0})).has_value());
    std::vector<GridHead> wrong;
    for (const std::int32_t extent :
         {0, -1, 257, 1 << 20, std::numeric_limits<std::int32_t>::max()}) {
        wrong.push_back(head_of(extent, 1));
    }
    for (const std::uint32_t bricks : {0u, 9u, 0xffffffffu}) {
        wrong.push_back(head_of(2, bricks));
    }
    wrong.push_back(head_of(100, kMaxBricks + 1));
    wrong.push_back(head_of(2, 1));
    wrong.back().is_color = 2;
    for (const std::int32_t first : {std::numeric_limits<std::int32_t>::min(), 1 << 21,
                                     std::numeric_limits<std::int32_t>::max()}) {
        wrong.push_back(head_of(2, 1));
        wrong.back().first_brick[2] = first;
    }
    for (const double entry :
         {0.0, std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN()}) {
        wrong.push_back(head_of(2, 1));
        wrong.back().to_scene[5] = entry;
    }
    wrong.push_back(head_of(2, 1));
    wrong.back().to_scene[3] = 0.5;  // not affine
    for (const GridHead& head : wrong) {
        EXPECT_FALSE(parse(sent_grid(head, {0})).has_value());
    }
}

TEST(ParseReply, WrongBricksAreRefused) {
    EXPECT_FALSE(parse(sent_grid(head_of(2, 1), {8})).has_value());
    EXPECT_FALSE(parse(sent_grid(head_of(2, 2), {3, 3})).has_value());
    EXPECT_FALSE(parse(sent_grid(head_of(2, 2), {3, 2})).has_value());
    EXPECT_FALSE(parse(sent_grid(head_of(2, 1), {0xffffffffu})).has_value());
    EXPECT_FALSE(parse(sent_grid(head_of(2, 1), {})).has_value());
    for (const float value : {0.0f, -1.0f, std::numeric_limits<float>::infinity(),
                              std::numeric_limits<float>::quiet_NaN()}) {
        EXPECT_FALSE(parse(sent_grid(head_of(2, 1), {0}, value)).has_value());
    }
}

TEST(ParseReply, GridsTogetherStayWithinTheLimits) {
    const auto many = [](std::size_t grids, std::int32_t extent) {
        return parse(sent([&](ReplyWriter& writer) {
            for (std::size_t i = 0; i < grids; ++i) {
                writer.write_grid("density", head_of(extent, 1));
                writer.write_brick(0, std::vector<float>(512, 1.0f));
            }
            writer.write_end();
        }));
    };
    EXPECT_TRUE(many(64, 1).has_value());
    EXPECT_FALSE(many(65, 1).has_value());
    EXPECT_TRUE(many(8, 128).has_value());
    EXPECT_FALSE(many(9, 128).has_value());
    EXPECT_FALSE(many(0, 1).has_value());
}

TEST(ParseReply, NoPrefixIsAReply) {
    const std::string whole = sent_grid(head_of(2, 2), {1, 6});
    for (std::size_t length = 0; length < whole.size(); ++length) {
        EXPECT_FALSE(parse(whole.substr(0, length)).has_value()) << length;
    }
}

TEST(ParseReply, GarbageIsRefusedOrSound) {
    std::mt19937 random(1);
    GridHead colored = head_of(2, 2);
    colored.is_color = 1;
    for (const std::string& whole :
         {sent_grid(head_of(2, 2), {1, 6}), sent_grid(colored, {1, 6})}) {
        for (int i = 0; i < 3000; ++i) {
            std::string bytes = whole;
            // Mostly in the head.
            bytes[random() % (i % 4 == 0 ? bytes.size() : 230)] = static_cast<char>(random());
            if (const auto reply = parse(bytes)) {
                for (const VdbGrid& grid : reply->grids) {
                    ASSERT_TRUE(tests::is_sound(grid));
                }
            }
        }
    }
}

}  // namespace
}  // namespace opaline::formats::vdb
