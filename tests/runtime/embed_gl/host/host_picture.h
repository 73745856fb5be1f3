#pragma once

#include <string>
#include <utility>
#include <vector>

#include "tests/runtime/embed_gl/host/host_context.h"

namespace opaline::test {

/// A ray for a host's fragment shader, four floats a texel: from, begin; direction, end.
struct HostRay {
    float from[3], begin, direction[3], end;
};

/// The text of an installed file of functions.
std::string read_functions(const std::string& file);

/// Compiles `parts` for a stage of a program. Throws what the driver says of them as `require`.
void attach_shader(unsigned program, unsigned stage, const std::vector<std::string>& parts);

/// A texture of four floats a texel that a framebuffer draws to, nearest filter; bound.
unsigned make_float_target(int width, int height);

/// A host that draws one texel a ray with its own fragment shader, from installed functions. All
/// throw as `require`.
class HostPicture {
  public:
    /// `files`: of the installed functions; `defines` stand before them. The shader's text ends
    /// with `void see(vec3 from, float begin, vec3 direction, float end, out vec4 a, out vec4 b)`.
    HostPicture(HostApi api, const std::vector<std::string>& files, const std::string& defines,
                const std::string& see);
    ~HostPicture();
    HostPicture(HostPicture&& other) noexcept;
    HostPicture(const HostPicture&) = delete;
    HostPicture& operator=(const HostPicture&) = delete;

    void bind_texture(const char* uniform, unsigned texture);
    void bind_block(const char* name, unsigned buffer);
    void set_flag(const char* uniform, bool value);
    void set_number(const char* uniform, float value);
    void set_numbers(const char* uniform, float first, float second);
    void set_pair(const char* uniform, int first, int second);

    /// `a` and `b` of each ray, eight floats.
    std::vector<float> draw(const std::vector<HostRay>& rays);

  private:
    int use(const char* uniform) const;
    unsigned program_ = 0, array_ = 0, framebuffer_ = 0;
    std::vector<std::pair<int, unsigned>> textures_;  // by unit from 1 on
    unsigned blocks_ = 0;
};

}  // namespace opaline::test
