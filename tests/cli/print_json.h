#pragma once

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "tests/cli/run_program.h"

namespace opaline::tests {

/// What a command prints as JSON; it must succeed without a message.
inline nlohmann::json print_json(const std::string& command, Arguments arguments) {
    arguments.insert(arguments.begin(), command);
    const Outcome outcome = run_well(arguments);
    EXPECT_EQ(outcome.err, "");
    return nlohmann::json::parse(outcome.out);
}

}  // namespace opaline::tests
