// Compares what OpenGL contexts make of baked files with the CPU's functions of opaline.h, by the
// measures of tests/runtime/embed_gl: a table of the largest differences.
//     opaline_gl_parity FILE.opal...
//     opaline_gl_parity --pictures CPU.exr GL.exr
// Every context has a process of its own, as Mesa makes all contexts of one of the same version.
// All receivers, hosts' functions at a few hundred places of each kind, under two lights; pictures
// by the measure of tests/runtime/gl. Exits with 1 where something is beyond its tolerance, with 77
// where no context can be made.
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <cstring>
#include <exception>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "formats/image/exr.h"
#include "tests/bench/gl_parity/comparisons.h"
#include "tests/runtime/gl/picture_difference.h"

namespace {

using namespace opaline;
using parity::Report;
using test::HostApi;

constexpr int kBeyond = 1, kFailed = 2, kNoContext = 77;
constexpr std::array<std::pair<HostApi, const char*>, 3> kContexts{
    {{HostApi::desktop_45, "OpenGL 4.5"},
     {HostApi::desktop_43, "OpenGL 4.3"},
     {HostApi::es_31, "ES 3.1"}}};

struct ReleaseGl {
    void operator()(opaline_gl* gl) const { opaline_gl_release(gl); }
};
using OwnedGl = std::unique_ptr<opaline_gl, ReleaseGl>;

OwnedGl make_gl(const test::LoadedFile& file, Report& report) {
    opaline_gl* gl = nullptr;
    std::uint32_t flags = OPALINE_GL_WITH_MESH | OPALINE_GL_WITH_VOLUMES | OPALINE_GL_WITH_IMAGES;
    if (opaline_gl_create(file.asset(), test::load_gl, flags, &gl) == OPALINE_OK)
        return OwnedGl(gl);
    report.note(std::string("volumes, which are refused: ") + opaline_last_error());
    flags &= ~std::uint32_t{OPALINE_GL_WITH_VOLUMES};
    test::require(opaline_gl_create(file.asset(), test::load_gl, flags, &gl) == OPALINE_OK,
                  opaline_last_error());
    return OwnedGl(gl);
}

int compare_file(const std::filesystem::path& path, HostApi api, const char* context_name) {
    const std::optional<test::HostContext> context = test::HostContext::create(api);
    if (!context) {
        std::printf("NOT COMPARED: %s: EGL makes no such context\n", context_name);
        return kNoContext;
    }
    const test::LoadedFile file(path);
    Report report;
    const OwnedGl gl = make_gl(file, report);
    const parity::Case in{file, api, gl.get(), report};
    for (const parity::Sky& sky : {parity::even_sky(), parity::varied_sky()}) {
        sky.light(file.light());
        test::require(opaline_gl_relight(gl.get(), file.light()) == OPALINE_OK,
                      opaline_last_error());
        parity::compare_surfaces(in);
        parity::compare_normal_maps(in);
        parity::compare_volumes(in);
        parity::compare_layers(in, sky);
    }
    parity::compare_images(in);
    std::printf("%s", report.text(path.stem().string(), context->version()).c_str());
    return report.holds() ? 0 : kBeyond;
}

// In a process of its own.
int compare_apart(const std::filesystem::path& path, HostApi api, const char* context_name) {
    std::fflush(stdout);
    const pid_t child = fork();
    if (child == 0) {
        int status = kFailed;
        try {
            status = compare_file(path, api, context_name);
        } catch (const std::exception& fault) {
            std::printf("FAILED: %s, %s: %s\n", path.c_str(), context_name, fault.what());
        }
        std::fflush(stdout);
        _exit(status);
    }
    int status = 0;
    if (child < 0 || waitpid(child, &status, 0) != child || !WIFEXITED(status)) {
        std::printf("FAILED: %s, %s: its process ended early\n", path.c_str(), context_name);
        return kFailed;
    }
    return WEXITSTATUS(status);
}

int compare_pictures(const char* cpu_path, const char* gl_path) {
    const auto cpu = formats::read_exr(cpu_path), gl = formats::read_exr(gl_path);
    if (!cpu || !gl || cpu->width != gl->width || cpu->height != gl->height) {
        std::printf("FAILED: %s and %s are no pictures of one size\n", cpu_path, gl_path);
        return kFailed;
    }
    const test::PictureDifference found = test::picture_difference(cpu->pixel, gl->pixel);
    std::printf("mean difference %.2g of the mean, %zu of %zu pixels off%s\n", found.mean,
                found.off, cpu->pixel.size(), found.is_small() ? "" : ": BEYOND TOLERANCE");
    return found.is_small() ? 0 : kBeyond;
}

}  // namespace

int main(int count, char** arguments) {
    if (count == 4 && std::strcmp(arguments[1], "--pictures") == 0) {
        return compare_pictures(arguments[2], arguments[3]);
    }
    if (count < 2 || arguments[1][0] == '-') {
        std::fprintf(stderr, "usage: %s FILE.opal... | --pictures CPU.exr GL.exr\n", arguments[0]);
        return kFailed;
    }
    std::printf("| file | context |");
    for (const char* const kind : parity::kKindNames)
        std::printf(" %s |", kind);
    std::printf("\n|---|---|---:|---:|---:|---:|---:|---:|---:|\n");
    int worst = 0;
    for (int i = 1; i < count; ++i) {
        for (const auto& [api, name] : kContexts) {
            const int status = compare_apart(arguments[i], api, name);
            if (status != 0 && (worst == 0 || worst == kNoContext)) worst = status;
        }
    }
    return worst;
}
