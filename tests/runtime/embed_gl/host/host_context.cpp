#include "tests/runtime/embed_gl/host/host_context.h"

#include <EGL/egl.h>
#include <EGL/eglext.h>
#define GL_GLEXT_PROTOTYPES
#include <GL/glcorearb.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <stdexcept>
#include <utility>

namespace opaline::test {
namespace {

// Mesa's surfaceless platform, else EGL's default display.
EGLDisplay host_display() {
    const auto get = reinterpret_cast<PFNEGLGETPLATFORMDISPLAYEXTPROC>(
        eglGetProcAddress("eglGetPlatformDisplayEXT"));
    const char* const extensions = eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
    EGLDisplay display = EGL_NO_DISPLAY;
    if (get != nullptr && extensions != nullptr &&
        std::strstr(extensions, "EGL_MESA_platform_surfaceless") != nullptr) {
        display = get(EGL_PLATFORM_SURFACELESS_MESA, nullptr, nullptr);
    }
    return display != EGL_NO_DISPLAY ? display : eglGetDisplay(EGL_DEFAULT_DISPLAY);
}

}  // namespace

void require(bool holds, const std::string& text) {
    if (!holds) throw std::runtime_error(text);
}

std::optional<HostContext> HostContext::create(HostApi api, const HostContext* shared) {
    // Mesa gives the newest compatible context whatever older one is asked for; not with these.
    const EGLint minor = api == HostApi::desktop_45 ? 5 : 3;
    setenv("MESA_GL_VERSION_OVERRIDE", minor == 5 ? "4.5" : "4.3", 1);
    setenv("MESA_GLES_VERSION_OVERRIDE", "3.1", 1);
    HostContext made;
    made.display_ = host_display();
    if (made.display_ == EGL_NO_DISPLAY ||
        eglInitialize(made.display_, nullptr, nullptr) != EGL_TRUE) {
        return std::nullopt;
    }
    const bool is_es = api == HostApi::es_31;
    eglBindAPI(is_es ? EGL_OPENGL_ES_API : EGL_OPENGL_API);
    const EGLint desktop[] = {EGL_CONTEXT_MAJOR_VERSION, 4, EGL_CONTEXT_MINOR_VERSION, minor,
                              EGL_NONE};
    const EGLint es[] = {EGL_CONTEXT_MAJOR_VERSION, 3, EGL_CONTEXT_MINOR_VERSION, 1, EGL_NONE};
    made.context_ = eglCreateContext(made.display_, nullptr,
                                     shared != nullptr ? shared->context_ : EGL_NO_CONTEXT,
                                     is_es ? es : desktop);
    if (made.context_ == EGL_NO_CONTEXT) return std::nullopt;
    made.make_current();
    return made;
}

HostContext::HostContext(HostContext&& other) noexcept
    : display_(other.display_), context_(std::exchange(other.context_, nullptr)) {}

HostContext& HostContext::operator=(HostContext&& other) noexcept {
    std::swap(display_, other.display_);
    std::swap(context_, other.context_);
    return *this;
}

HostContext::~HostContext() {
    if (context_ == nullptr) return;
    make_none_current();
    eglDestroyContext(display_, context_);
}

void HostContext::make_current() const {
    eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_);
}

void HostContext::make_none_current() {
    eglMakeCurrent(eglGetCurrentDisplay(), EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
}

std::string HostContext::version() const {
    make_current();
    const std::string all = reinterpret_cast<const char*>(glGetString(GL_VERSION));
    return all.substr(0, std::min(all.find(" ("), all.find(" Mesa")));
}

void* load_gl(const char* name) {
    return reinterpret_cast<void*>(eglGetProcAddress(name));
}

std::vector<float> read_floats(unsigned buffer, std::size_t count) {
    std::vector<float> values(count);
    GLint previous = 0;
    glGetIntegerv(GL_COPY_READ_BUFFER_BINDING, &previous);
    glBindBuffer(GL_COPY_READ_BUFFER, buffer);
    const auto size = static_cast<GLsizeiptr>(count * sizeof(float));
    const void* const mapped = glMapBufferRange(GL_COPY_READ_BUFFER, 0, size, GL_MAP_READ_BIT);
    require(mapped != nullptr, "the buffer cannot be read");
    std::memcpy(values.data(), mapped, count * sizeof(float));
    glUnmapBuffer(GL_COPY_READ_BUFFER);
    glBindBuffer(GL_COPY_READ_BUFFER, static_cast<GLuint>(previous));
    return values;
}

}  // namespace opaline::test
