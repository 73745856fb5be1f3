#include "tests/fuzz/targets.h"

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <cstdlib>

#include "formats/vdb/limits.h"

extern "C" void __sanitizer_malloc_hook(const volatile void* memory, std::size_t size);

namespace opaline::fuzz {
namespace {

std::size_t most_of_any(std::size_t file_bytes) {
    return (std::size_t{64} << 20) + 8 * file_bytes;
}

// Images have limits of their own, in pixels: is_plausible_size, kMaxImagePixels of formats/gltf.
std::size_t most_of_float_images(std::size_t file_bytes) {
    return 12 * std::max(std::size_t{1} << 24, 16 * file_bytes);
}
std::size_t most_of_images(std::size_t file_bytes) {
    return 4 * std::min(std::size_t{1} << 27, 8256 * file_bytes) + most_of_any(file_bytes);
}

// Address space for the bricks that a reply announces; memory comes with them.
std::size_t most_of_bricks(std::size_t) {
    return std::size_t{formats::vdb::kMaxBricks} * 512 * sizeof(float[3]);
}

constexpr Target kTargets[] = {{"opal", run_opal_abi, most_of_any},
                               {"opal_picture", run_opal_picture, most_of_any},
                               {"gltf", run_gltf, most_of_any},
                               {"texture", run_texture, most_of_images},
                               {"media", run_media, most_of_any},
                               {"phase_table", run_phase_table, most_of_any},
                               {"exr", run_exr, most_of_float_images},
                               {"hdr", run_hdr, most_of_float_images},
                               {"png", run_png, most_of_images},
                               {"vdb", run_vdb, most_of_bricks},
                               {"vdb_reply", run_vdb_reply, most_of_bricks},
                               {"view_script", run_view_script, most_of_any},
                               {"relight_table", run_relight_table, most_of_any},
                               {"command_line", run_command_line, most_of_any}};

std::atomic<std::size_t> most_allocated = 0;  // 0: between inputs

}  // namespace

std::span<const Target> all_targets() {
    return kTargets;
}

void run(const Target& target, std::span<const std::byte> bytes) {
    most_allocated = target.most_allocated(bytes.size());
    target.run(bytes);
    most_allocated = 0;
}

void hold(bool holds, const char* promise) {
    if (holds) return;
    std::fprintf(stderr, "broken promise: %s\n", promise);
    std::abort();
}

void expect_message(const formats::Error& error) {
    hold(!error.diagnostics.empty() && error.diagnostics.size() < 70, "a few errors are named");
    for (const formats::Diagnostic& diagnostic : error.diagnostics) {
        hold(!diagnostic.fault.empty(), "an error says what is wrong");
    }
}

}  // namespace opaline::fuzz

// Sanitizers call it after each allocation.
extern "C" void __sanitizer_malloc_hook(const volatile void*, std::size_t size) {
    const std::size_t most = opaline::fuzz::most_allocated;
    if (most == 0 || size <= most) return;
    opaline::fuzz::most_allocated = 0;  // what reports it allocates, too
    std::fprintf(stderr, "%zu bytes at once, where %zu are the most\n", size, most);
    std::abort();
}
