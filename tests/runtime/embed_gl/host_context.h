#pragma once

#include <gtest/gtest.h>

#include <optional>
#include <string>
#include <vector>

#include "runtime/opaline_gl.h"

namespace opaline::test {

/// The oldest contexts that Opaline::gl takes.
enum class HostApi { desktop_43, es_31 };

/// A host's context without a surface, on Mesa's software renderer or whatever EGL offers.
class HostContext {
  public:
    /// Nothing where EGL offers none. `shared`: its objects are this one's too.
    static std::optional<HostContext> create(HostApi api, const HostContext* shared = nullptr);

    HostContext(HostContext&& other) noexcept;
    HostContext& operator=(HostContext&& other) noexcept;
    HostContext(const HostContext&) = delete;
    HostContext& operator=(const HostContext&) = delete;
    ~HostContext();

    void make_current() const;
    static void make_none_current();

  private:
    HostContext() = default;
    void *display_ = nullptr, *context_ = nullptr;
};

/// The host's loader.
void* load_gl(const char* name);

/// Skips only where no context can be made.
class EmbedGl : public testing::TestWithParam<HostApi> {
  protected:
    void SetUp() override;
    std::optional<HostContext> context_;
};

std::string api_name(const testing::TestParamInfo<HostApi>& info);

/// The floats of a buffer of the current context.
std::vector<float> read_floats(unsigned buffer, std::size_t count);

}  // namespace opaline::test
