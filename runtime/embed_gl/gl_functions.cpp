#include "runtime/embed_gl/gl_functions.h"

#include <dlfcn.h>

#include <cstdio>
#include <cstring>

#include "runtime/api_support.h"

namespace opaline::runtime {
namespace {

using api::fail;

// A library's function that the program has loaded, or nothing.
template <class Function>
Function loaded(const char* name) {
    return reinterpret_cast<Function>(dlsym(RTLD_DEFAULT, name));
}

opaline_gl_loader find_loader() {
    struct WindowSystem {
        const char *current, *loader;
    };
    for (const WindowSystem system :
         {WindowSystem{"eglGetCurrentContext", "eglGetProcAddress"},
          WindowSystem{"glXGetCurrentContext", "glXGetProcAddressARB"}}) {
        const auto current = loaded<void* (*)()>(system.current);
        if (current != nullptr && current() != nullptr) {
            return loaded<opaline_gl_loader>(system.loader);
        }
    }
    return nullptr;
}

// Bounded: a lost context reports errors for ever.
constexpr int kMostErrors = 16;

const char* gl_error_name(GLenum error) {
    switch (error) {
        case GL_INVALID_ENUM:
            return "invalid enumerator";
        case GL_INVALID_VALUE:
            return "invalid value";
        case GL_INVALID_OPERATION:
            return "invalid operation";
        case GL_INVALID_FRAMEBUFFER_OPERATION:
            return "incomplete framebuffer";
        case GL_OUT_OF_MEMORY:
            return "out of memory";
        case GL_CONTEXT_LOST:
            return "context lost";
        default:
            return "unknown error";
    }
}

}  // namespace

const char* GlFunctions::shader_head() const {
    return is_es ? "#version 310 es\nprecision highp float;\nprecision highp int;\n"
                 : "#version 430 core\n";
}

opaline_status load_gl_functions(opaline_gl_loader loader, GlFunctions& gl) {
    if (loader == nullptr) loader = find_loader();
    if (loader == nullptr) {
        return fail(OPALINE_GL_NO_CONTEXT,
                    "no context of EGL or GLX is current on this thread: make one current, or hand "
                    "in a loader");
    }
    gl.GetString = reinterpret_cast<PFNGLGETSTRINGPROC>(loader("glGetString"));
    const char* const version =
        gl.GetString == nullptr ? nullptr : reinterpret_cast<const char*>(gl.GetString(GL_VERSION));
    if (version == nullptr) {
        return fail(OPALINE_GL_NO_CONTEXT, "no OpenGL context is current on this thread");
    }
    constexpr char kEs[] = "OpenGL ES ";
    gl.is_es = std::strncmp(version, kEs, sizeof kEs - 1) == 0;
    int major = 0, minor = 0;
    const char* const numbers = gl.is_es ? version + sizeof kEs - 1 : version;
    char text[200];
    if (std::sscanf(numbers, "%d.%d", &major, &minor) != 2 ||
        10 * major + minor < (gl.is_es ? 31 : 43)) {
        std::snprintf(text, sizeof text, "found %.100s, needs OpenGL 4.3 or OpenGL ES 3.1",
                      version);
        return fail(OPALINE_GL_TOO_OLD, text);
    }
    const char* missing = nullptr;
#define OPALINE_GL_LOAD(name, type)                                    \
    gl.name = reinterpret_cast<PFNGL##type##PROC>(loader("gl" #name)); \
    if (gl.name == nullptr) missing = "gl" #name;
    OPALINE_GL_CALLS(OPALINE_GL_LOAD)
#undef OPALINE_GL_LOAD
    if (missing != nullptr) {
        std::snprintf(text, sizeof text, "the loader knows no %s", missing);
        return fail(OPALINE_GL_TOO_OLD, text);
    }
    // Core in OpenGL 4.5 and ES 3.2; a loader may hand out one that an older context does not have.
    if (10 * major + minor >= (gl.is_es ? 32 : 45)) {
        gl.GetGraphicsResetStatus =
            reinterpret_cast<PFNGLGETGRAPHICSRESETSTATUSPROC>(loader("glGetGraphicsResetStatus"));
    }
    return OPALINE_OK;
}

opaline_status check_errors(const GlFunctions& gl, const char* doing) {
    GLenum first = GL_NO_ERROR;
    bool is_out_of_memory = false, is_lost = false;
    for (int i = 0; i < kMostErrors; ++i) {
        const GLenum error = gl.GetError();
        if (error == GL_NO_ERROR) break;
        if (first == GL_NO_ERROR) first = error;
        is_out_of_memory |= error == GL_OUT_OF_MEMORY;
        is_lost |= error == GL_CONTEXT_LOST;
    }
    if (first == GL_NO_ERROR) return OPALINE_OK;
    char text[200];
    std::snprintf(text, sizeof text, "OpenGL: %s while %s", gl_error_name(first), doing);
    return fail(is_lost            ? OPALINE_GL_CONTEXT_LOST
                : is_out_of_memory ? OPALINE_OUT_OF_MEMORY
                                   : OPALINE_GL_REFUSED,
                text);
}

void drop_errors(const GlFunctions& gl) {
    for (int i = 0; i < kMostErrors && gl.GetError() != GL_NO_ERROR; ++i) {
    }
}

}  // namespace opaline::runtime
