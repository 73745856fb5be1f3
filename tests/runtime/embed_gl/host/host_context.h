#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "runtime/opaline_gl.h"

namespace opaline::test {

/// The oldest contexts that Opaline::gl takes, and the one that `opaline render` makes.
enum class HostApi { desktop_43, es_31, desktop_45 };

/// Unless `holds`, throws std::runtime_error: what a host of tests cannot go on without.
void require(bool holds, const std::string& text);

/// A struct of the interface as the function fills it that takes `arguments` before it. Throws as
/// `require`.
template <class Struct, class Function, class... Arguments>
Struct filled(const Function& function, const Arguments&... arguments) {
    Struct found{};
    found.struct_size = sizeof found;
    require(function(arguments..., &found) == OPALINE_OK, opaline_last_error());
    return found;
}

/// A host's context without a surface, on Mesa's software renderer or whatever EGL offers.
class HostContext {
  public:
    /// Nothing where EGL offers none. `shared`: its objects are this one's too. Mesa makes all
    /// desktop contexts of a process of the version that is asked for first.
    static std::optional<HostContext> create(HostApi api, const HostContext* shared = nullptr);

    HostContext(HostContext&& other) noexcept;
    HostContext& operator=(HostContext&& other) noexcept;
    HostContext(const HostContext&) = delete;
    HostContext& operator=(const HostContext&) = delete;
    ~HostContext();

    void make_current() const;
    static void make_none_current();
    /// Of OpenGL, as the driver states it: a newer one than was asked for may be compatible.
    std::string version() const;

  private:
    HostContext() = default;
    void *display_ = nullptr, *context_ = nullptr;
};

/// The host's loader.
void* load_gl(const char* name);

/// The floats of a buffer of the current context. Throws as `require`.
std::vector<float> read_floats(unsigned buffer, std::size_t count);

}  // namespace opaline::test
