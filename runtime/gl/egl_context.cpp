#include "runtime/gl/egl_context.h"

#include <EGL/egl.h>
#include <EGL/eglext.h>

#include <array>
#include <string_view>
#include <utility>
#include <vector>

#include "runtime/gl/gl_objects.h"

namespace opaline::runtime {
namespace {

using formats::ErrorKind;
using formats::make_error;

// Extension strings are lists of words separated by blanks.
bool has_word(const char* words, std::string_view word) {
    if (words == nullptr) return false;
    std::string_view rest(words);
    while (!rest.empty()) {
        const std::size_t end = rest.find(' ');
        if (rest.substr(0, end) == word) return true;
        rest = end == std::string_view::npos ? std::string_view{} : rest.substr(end + 1);
    }
    return false;
}

template <class Function>
Function load(const char* name) {
    return reinterpret_cast<Function>(eglGetProcAddress(name));
}

struct Candidate {
    EGLDisplay display = EGL_NO_DISPLAY;
    std::string name;
};

// Displays to try, GPUs first.
std::vector<Candidate> list_displays() {
    const char* client = eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
    std::vector<Candidate> first, last;
    const auto get_display = load<PFNEGLGETPLATFORMDISPLAYEXTPROC>("eglGetPlatformDisplayEXT");
    if (has_word(client, "EGL_EXT_platform_base") && get_display != nullptr) {
        const auto query = load<PFNEGLQUERYDEVICESEXTPROC>("eglQueryDevicesEXT");
        const auto query_string = load<PFNEGLQUERYDEVICESTRINGEXTPROC>("eglQueryDeviceStringEXT");
        if (has_word(client, "EGL_EXT_platform_device") && query != nullptr &&
            query_string != nullptr) {
            std::array<EGLDeviceEXT, 64> devices{};
            EGLint count = 0;
            if (query(static_cast<EGLint>(devices.size()), devices.data(), &count) == EGL_TRUE) {
                for (EGLint d = 0; d < count; ++d) {
                    EGLDeviceEXT device = devices[static_cast<std::size_t>(d)];
                    const bool is_software =
                        has_word(query_string(device, EGL_EXTENSIONS), "EGL_MESA_device_software");
                    (is_software ? last : first)
                        .push_back(
                            {get_display(EGL_PLATFORM_DEVICE_EXT, device, nullptr),
                             (is_software ? "software device " : "device ") + std::to_string(d)});
                }
            }
        }
        if (has_word(client, "EGL_MESA_platform_surfaceless")) {
            first.push_back({get_display(EGL_PLATFORM_SURFACELESS_MESA,
                                         reinterpret_cast<void*>(EGL_DEFAULT_DISPLAY), nullptr),
                             "Mesa surfaceless"});
        }
    }
    first.insert(first.end(), last.begin(), last.end());
    first.push_back({eglGetDisplay(EGL_DEFAULT_DISPLAY), "default display"});
    return first;
}

// A 4.5 core context that needs no surface, or EGL_NO_CONTEXT and the reason.
EGLContext create_context(EGLDisplay display, std::string& reason) {
    EGLint major = 0, minor = 0;
    if (display == EGL_NO_DISPLAY || eglInitialize(display, &major, &minor) != EGL_TRUE) {
        reason = "cannot be initialised";
        return EGL_NO_CONTEXT;
    }
    const char* extensions = eglQueryString(display, EGL_EXTENSIONS);
    if (!has_word(extensions, "EGL_KHR_surfaceless_context")) {
        reason = "lacks EGL_KHR_surfaceless_context";
        return EGL_NO_CONTEXT;
    }
    const EGLint wanted[] = {EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_SURFACE_TYPE, 0, EGL_NONE};
    EGLConfig config = nullptr;  // EGL_NO_CONFIG_KHR
    EGLint configs = 0;
    if (eglBindAPI(EGL_OPENGL_API) != EGL_TRUE ||
        (!has_word(extensions, "EGL_KHR_no_config_context") &&
         (eglChooseConfig(display, wanted, &config, 1, &configs) != EGL_TRUE || configs < 1))) {
        reason = "offers no OpenGL";
        return EGL_NO_CONTEXT;
    }
    const EGLint attributes[] = {EGL_CONTEXT_MAJOR_VERSION,
                                 4,
                                 EGL_CONTEXT_MINOR_VERSION,
                                 5,
                                 EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                 EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                 EGL_NONE};
    const EGLContext context = eglCreateContext(display, config, EGL_NO_CONTEXT, attributes);
    if (context == EGL_NO_CONTEXT) reason = "offers no OpenGL 4.5 core context";
    return context;
}

std::string gl_text(GLenum name) {
    const auto* text = reinterpret_cast<const char*>(glGetString(name));
    return text != nullptr ? text : "unknown";
}

}  // namespace

formats::Result<EglContext> EglContext::create() {
    const EGLenum previous_api = eglQueryAPI();
    std::string tried;
    for (const Candidate& candidate : list_displays()) {
        std::string reason;
        EglContext made;
        made.context_ = create_context(candidate.display, reason);
        made.display_ = candidate.display;
        if (made.context_ != EGL_NO_CONTEXT) {
            const CurrentContext current(made);
            if (current.status()) {
                made.description_ = gl_text(GL_RENDERER) + ", OpenGL " + gl_text(GL_VERSION);
                eglBindAPI(previous_api);
                return made;
            }
            reason = "its context cannot be made current";
        }
        tried += (tried.empty() ? "" : "; ") + candidate.name + ": " + reason;
    }
    eglBindAPI(previous_api);
    return make_error(ErrorKind::resource, {}, "EGL", "no usable display (" + tried + ")",
                      "install a driver with OpenGL 4.5, such as Mesa's libegl1 and "
                      "libgl1-mesa-dri, or " +
                          std::string(kRenderOnCpu));
}

void* EglContext::load_function(const char* name) {
    return load<void*>(name);
}

EglContext::EglContext(EglContext&& other) noexcept
    : display_(other.display_),
      context_(std::exchange(other.context_, nullptr)),
      description_(std::move(other.description_)) {}

EglContext& EglContext::operator=(EglContext&& other) noexcept {
    std::swap(display_, other.display_);
    std::swap(context_, other.context_);
    std::swap(description_, other.description_);
    return *this;
}

EglContext::~EglContext() {
    // The display stays: it is the process's, and another renderer or the host may be using it.
    if (context_ != nullptr) eglDestroyContext(display_, context_);
}

CurrentContext::CurrentContext(const EglContext& context)
    : own_display_(context.display_),
      display_(eglGetCurrentDisplay()),
      context_(eglGetCurrentContext()),
      draw_(eglGetCurrentSurface(EGL_DRAW)),
      read_(eglGetCurrentSurface(EGL_READ)),
      api_(eglQueryAPI()) {
    eglBindAPI(EGL_OPENGL_API);
    is_current_ =
        context.context_ != nullptr && eglMakeCurrent(context.display_, EGL_NO_SURFACE,
                                                      EGL_NO_SURFACE, context.context_) == EGL_TRUE;
}

CurrentContext::~CurrentContext() {
    if (context_ != EGL_NO_CONTEXT) {
        eglMakeCurrent(display_, draw_, read_, context_);
    } else if (is_current_) {
        eglMakeCurrent(own_display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    }
    eglBindAPI(api_);
}

formats::Status CurrentContext::status() const {
    if (is_current_) return formats::ok_status();
    return make_error(ErrorKind::resource, {}, "EGL", "the OpenGL context cannot be made current",
                      "use a renderer on one thread at a time");
}

}  // namespace opaline::runtime
