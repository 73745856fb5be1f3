#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "formats/opal/result.h"
#include "runtime/gl/gl_handle.h"
#include "runtime/gl/render_on_cpu.h"

namespace opaline::runtime {

/// Everything here needs a current OpenGL 4.5 context.

/// ok, or resource naming the GL errors since the last check and what was being done.
formats::Status check_gl(const std::string& doing);

/// A buffer with these bytes, padded to a multiple of 16 and never empty, so that a shader may
/// read whole words and bind it in any case. `resident` is increased by its size.
GlBuffer make_buffer(std::span<const std::byte> bytes, std::size_t& resident);

template <class T>
GlBuffer make_buffer_of(std::span<const T> values, std::size_t& resident) {
    return make_buffer(std::as_bytes(values), resident);
}

/// One shader stage: "#version 450 core", `defines`, then the text.
struct StageSource {
    GLenum stage = 0;
    const char* text = nullptr;
};

/// Compiles and links. Errors: resource with the driver's log.
formats::Result<GlProgram> make_program(const std::string& name, const std::string& defines,
                                        std::span<const StageSource> stages);

}  // namespace opaline::runtime
