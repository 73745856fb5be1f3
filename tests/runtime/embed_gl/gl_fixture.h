#pragma once

#include <gtest/gtest.h>

#include <iostream>
#include <optional>
#include <string>

#include "tests/runtime/embed_gl/host/host_context.h"

namespace opaline::test {

/// Skips only where no context can be made.
class EmbedGl : public testing::TestWithParam<HostApi> {
  protected:
    void SetUp() override {
        context_ = HostContext::create(GetParam());
        if (context_) return;
        std::cerr << "NO OPENGL ON THIS MACHINE: Opaline::gl is NOT tested\n";
        GTEST_SKIP() << "EGL offers no context of that version";
    }
    std::optional<HostContext> context_;
};

inline std::string api_name(const testing::TestParamInfo<HostApi>& info) {
    return info.param == HostApi::es_31 ? "Es31" : "Desktop43";
}

}  // namespace opaline::test
