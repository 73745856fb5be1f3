#include <array>

#include "runtime/api_support.h"
#include "runtime/embed_gl/api_gl_support.h"

namespace opaline::runtime::api {

opaline_status lost_context() {
    return fail(OPALINE_GL_CONTEXT_LOST,
                "the driver lost the context: make another, and the handle once more in it");
}

opaline_status check_context(const opaline_gl& handle) {
    const GlFunctions& gl = handle.gl;
    if (gl.GetString(GL_VERSION) == nullptr) {
        return fail(OPALINE_GL_NO_CONTEXT, "no OpenGL context is current on this thread");
    }
    if (gl.GetGraphicsResetStatus != nullptr && gl.GetGraphicsResetStatus() != GL_NO_ERROR) {
        return lost_context();
    }
    std::array<GLuint, 16> value{};  // as large as another program's uniform may be
    if (gl.IsProgram(handle.marker_program) == GL_TRUE) {
        gl.GetUniformuiv(handle.marker_program, 0, value.data());
    }
    drop_errors(gl);
    if (value[0] != handle.marker) {
        return fail(OPALINE_GL_WRONG_CONTEXT,
                    "another OpenGL context is current than the one of opaline_gl_create");
    }
    return OPALINE_OK;
}

}  // namespace opaline::runtime::api
