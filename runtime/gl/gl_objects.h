#pragma once

#include <cstddef>
#include <string>

#include "formats/opal/result.h"
#include "runtime/embed_gl/gl_names.h"
#include "runtime/gl/gl_handle.h"

namespace opaline::runtime {

/// What errors of OpenGL advise.
inline constexpr const char* kRenderOnCpu = "render on the CPU: `opaline render --backend cpu`";

/// Everything below needs a current OpenGL 4.5 context.

/// ok, or resource: the device, and what opaline_last_error says.
formats::Status as_status(opaline_status status);

/// check_errors: the GL errors since the last check.
formats::Status check_gl(const GlFunctions& gl, const char* doing);

/// A vertex and a fragment shader, after `defines`. Errors: resource with the driver's log.
formats::Result<GLuint> make_program(GlNames& names, const char* name, const std::string& defines,
                                     const char* vertex, const char* fragment);

/// In buffers and textures [bytes].
std::size_t resident_bytes(const GlNames& names);

}  // namespace opaline::runtime
