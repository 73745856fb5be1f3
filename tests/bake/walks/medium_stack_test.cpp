#include "bake/trace/medium_stack.h"

#include <gtest/gtest.h>

namespace opaline::tests {
namespace {

using bake::MediumStack;

TEST(MediumStack, TheLastInTheirOrderFillsTheSpaceWhicheverWasEnteredFirst) {
    MediumStack stack(0, 1);
    EXPECT_TRUE(stack.enter(1));
    EXPECT_EQ(stack.top(), 1);
    stack.leave(0);  // overlapping bodies: left in another order than entered
    EXPECT_EQ(stack.top(), 1);
    EXPECT_TRUE(stack.enter(0));
    EXPECT_EQ(stack.top(), 1);
    EXPECT_TRUE(stack.contains(0));
    stack.leave(1);
    EXPECT_EQ(stack.top(), 0);
    stack.leave(0);
    EXPECT_TRUE(stack.empty());
}

TEST(MediumStack, BodiesOfOneMediumInEachOtherTakeNoRoom) {
    MediumStack stack(3, 1);
    for (int i = 0; i < 1000; ++i) {
        EXPECT_TRUE(stack.enter(3));
    }
    for (int i = 0; i < 1000; ++i) {
        stack.leave(3);
        EXPECT_EQ(stack.top(), 3);
    }
    stack.leave(3);
    EXPECT_TRUE(stack.empty());
}

TEST(MediumStack, WhatALeftBodyPartedIsOneAgain) {
    MediumStack stack(0, 1);
    EXPECT_TRUE(stack.enter(1));
    EXPECT_TRUE(stack.enter(0));
    stack.leave(1);
    EXPECT_EQ(stack.top(), 0);
    for (std::size_t i = 1; i < MediumStack::kCapacity; ++i) {
        EXPECT_TRUE(stack.enter(static_cast<std::uint8_t>(i))) << i;
    }
    EXPECT_FALSE(stack.enter(99)) << "full";
    for (std::size_t i = MediumStack::kCapacity; --i > 0;) {
        EXPECT_EQ(stack.top(), i);
        stack.leave(static_cast<std::uint8_t>(i));
    }
    stack.leave(0);
    EXPECT_EQ(stack.top(), 0) << "entered twice";
    stack.leave(0);
    EXPECT_TRUE(stack.empty());
}

TEST(MediumStack, LeavingABodyThatWasNeverEnteredChangesNothing) {
    MediumStack stack(0, 2);
    EXPECT_FALSE(stack.leave(5));
    EXPECT_EQ(stack.top(), 0);
    stack.leave(0);
    stack.leave(0);
    stack.leave(0);
    EXPECT_TRUE(stack.empty());
}

}  // namespace
}  // namespace opaline::tests
