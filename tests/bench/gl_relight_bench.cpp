// Relights receivers in compute shaders, as Opaline::gl does, the light's upload included:
// milliseconds of the GPU's own clock. Needs EGL alone, no asset:
//     gl_relight_bench [RECEIVERS [COEFFICIENTS [CUBEMAP]]]
// Indices are random, which is hard on caches: those of baked rows favour coarse coefficients.
#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <dlfcn.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include "runtime/embed_gl/relight.h"
#include "runtime/embed_gl/saved_state.h"

namespace {

using namespace opaline;
using runtime::GlFunctions;

constexpr int kRuns = 31;

PFNEGLGETPROCADDRESSPROC egl_loader = nullptr;

void* load(const char* name) {
    return reinterpret_cast<void*>(egl_loader(name));
}

template <class Function>
Function egl(const char* name) {
    return reinterpret_cast<Function>(egl_loader(name));
}

// A context without a surface on the first device that has one; opened by hand, so that the program
// starts wherever there is a driver.
bool make_context() {
    void* const library = dlopen("libEGL.so.1", RTLD_NOW | RTLD_GLOBAL);
    if (library == nullptr) return false;
    egl_loader = reinterpret_cast<PFNEGLGETPROCADDRESSPROC>(dlsym(library, "eglGetProcAddress"));
    std::array<EGLDeviceEXT, 16> devices{};
    std::vector<EGLDisplay> displays;
    EGLint count = 0;
    const auto query = egl<PFNEGLQUERYDEVICESEXTPROC>("eglQueryDevicesEXT");
    const auto platform = egl<PFNEGLGETPLATFORMDISPLAYEXTPROC>("eglGetPlatformDisplayEXT");
    if (query != nullptr && platform != nullptr && query(16, devices.data(), &count) == EGL_TRUE) {
        for (EGLint d = 0; d < count; ++d) {
            displays.push_back(
                platform(EGL_PLATFORM_DEVICE_EXT, devices[static_cast<std::size_t>(d)], nullptr));
        }
    }
    const auto function = [&](const char* name) { return dlsym(library, name); };
    const auto get = reinterpret_cast<PFNEGLGETDISPLAYPROC>(function("eglGetDisplay"));
    const auto start = reinterpret_cast<PFNEGLINITIALIZEPROC>(function("eglInitialize"));
    const auto bind = reinterpret_cast<PFNEGLBINDAPIPROC>(function("eglBindAPI"));
    const auto create = reinterpret_cast<PFNEGLCREATECONTEXTPROC>(function("eglCreateContext"));
    const auto make_current = reinterpret_cast<PFNEGLMAKECURRENTPROC>(function("eglMakeCurrent"));
    displays.push_back(get(EGL_DEFAULT_DISPLAY));
    const EGLint wanted[] = {EGL_CONTEXT_MAJOR_VERSION, 4, EGL_CONTEXT_MINOR_VERSION, 3, EGL_NONE};
    for (EGLDisplay display : displays) {
        if (start(display, nullptr, nullptr) != EGL_TRUE) continue;
        bind(EGL_OPENGL_API);
        const EGLContext context = create(display, nullptr, EGL_NO_CONTEXT, wanted);
        if (context != EGL_NO_CONTEXT &&
            make_current(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context) == EGL_TRUE) {
            return true;
        }
    }
    return false;
}

struct Random {
    std::uint64_t state = 1;
    std::uint32_t below(std::uint32_t n) {
        state = state * 6364136223846793005u + 1442695040888963407u;
        return static_cast<std::uint32_t>((state >> 32) * n >> 32);
    }
};

formats::Asset make_rows(std::uint32_t receivers, std::uint32_t coefficients, std::uint32_t n,
                         std::uint32_t bands) {
    formats::Asset asset;
    asset.transport = formats::make_sparse_rows(n, 8);
    formats::PrimitiveRecord primitive;
    primitive.vertex_count = receivers;
    primitive.bands = bands;
    asset.primitives = {primitive};
    asset.position.resize(receivers);
    asset.normal.resize(receivers, {0, 1, 0});
    asset.base_color.resize(receivers, {1, 1, 1});
    formats::SparseRows& rows = asset.transport;
    Random random;
    std::vector<std::uint32_t> index(coefficients);
    for (std::uint32_t r = 0; r < receivers; ++r) {
        for (std::uint32_t& i : index)
            i = random.below(6 * n * n);
        std::sort(index.begin(), index.end());
        for (const std::uint32_t i : index) {
            if (rows.index_bytes == 2) {
                rows.index16.push_back(static_cast<std::uint16_t>(i));
            } else {
                rows.index32.push_back(i);
            }
            for (std::uint32_t b = 0; b < bands; ++b) {
                rows.code8.push_back(static_cast<std::int8_t>(random.below(255)));
            }
        }
        rows.row_offset.push_back((r + 1) * coefficients);
        for (std::uint32_t b = 0; b < bands; ++b) {
            rows.average_scale.push_back(1e-6f);
            rows.detail_scale.push_back(1e-6f);
            rows.average_code.insert(rows.average_code.end(), 6, 1000);
        }
    }
    return asset;
}

struct Queries {
    PFNGLGENQUERIESPROC gen;
    PFNGLBEGINQUERYPROC begin;
    PFNGLENDQUERYPROC end;
    PFNGLGETQUERYOBJECTUI64VPROC get;
    PFNGLFINISHPROC finish;
};

// Median milliseconds by the GPU's clock and by the wall's; software renderers have no clock for
// compute shaders.
struct Times {
    double gpu = 0, wall = 0;
};

template <class Work>
Times measure(const Queries& q, const Work& work) {
    GLuint query = 0;
    q.gen(1, &query);
    std::vector<double> gpu, wall;
    for (int i = 0; i < kRuns + 3; ++i) {
        q.finish();
        const auto start = std::chrono::steady_clock::now();
        q.begin(GL_TIME_ELAPSED, query);
        work();
        q.end(GL_TIME_ELAPSED);
        q.finish();
        const std::chrono::duration<double, std::milli> took =
            std::chrono::steady_clock::now() - start;
        GLuint64 nanoseconds = 0;
        q.get(query, GL_QUERY_RESULT, &nanoseconds);
        if (i < 3) continue;  // drivers finish shaders at their first runs
        gpu.push_back(1e-6 * static_cast<double>(nanoseconds));
        wall.push_back(took.count());
    }
    std::sort(gpu.begin(), gpu.end());
    std::sort(wall.begin(), wall.end());
    return {gpu[gpu.size() / 2], wall[wall.size() / 2]};
}

int run(std::uint32_t receivers, std::uint32_t coefficients, std::uint32_t n) {
    GlFunctions gl;
    if (!make_context() || runtime::load_gl_functions(load, gl) != OPALINE_OK) {
        std::fprintf(stderr, "no OpenGL: %s\n", opaline_last_error());
        return 1;
    }
    const Queries queries{egl<PFNGLGENQUERIESPROC>("glGenQueries"),
                          egl<PFNGLBEGINQUERYPROC>("glBeginQuery"),
                          egl<PFNGLENDQUERYPROC>("glEndQuery"),
                          egl<PFNGLGETQUERYOBJECTUI64VPROC>("glGetQueryObjectui64v"),
                          egl<PFNGLFINISHPROC>("glFinish")};
    std::printf("%s, OpenGL %s\n%u receivers x %u coefficients, cube map of %u\n",
                reinterpret_cast<const char*>(gl.GetString(GL_RENDERER)),
                reinterpret_cast<const char*>(gl.GetString(GL_VERSION)), receivers, coefficients,
                n);
    runtime::LightVector light;
    light.n = n;
    light.rgba.assign(std::size_t{24} * n * n, 0.5f);
    for (const std::uint32_t bands : {1u, 3u}) {
        const formats::Asset asset = make_rows(receivers, coefficients, n, bands);
        runtime::GlNames names(gl);
        runtime::Relight relight(gl);
        const runtime::SavedState saved(gl);
        if (relight.upload(asset.view(), {0, 0}, names) != OPALINE_OK) {
            std::fprintf(stderr, "%s\n", opaline_last_error());
            return 1;
        }
        const Times relit = measure(queries, [&] {
            relight.light(light, names);
            relight.dot(runtime::dark_emitters());
        });
        std::printf("%u band%s: %.4f ms (wall %.4f ms)\n", bands, bands == 1 ? "" : "s", relit.gpu,
                    relit.wall);
        names.release();
    }
    return runtime::check_errors(gl, "relighting") == OPALINE_OK ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
    const auto argument = [&](int i, std::uint32_t otherwise) {
        return argc > i ? static_cast<std::uint32_t>(std::strtoul(argv[i], nullptr, 10))
                        : otherwise;
    };
    return run(argument(1, 100'000), argument(2, 128), argument(3, 64));
}
