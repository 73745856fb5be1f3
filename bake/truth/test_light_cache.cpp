#include "bake/truth/test_light_cache.h"

#include <cstddef>
#include <cstring>
#include <fstream>
#include <iterator>
#include <span>
#include <string>
#include <system_error>
#include <type_traits>

#include "formats/opal/atomic_file.h"
#include "formats/opal/cubemap.h"
#include "formats/opal/file_bytes.h"
#include "formats/opal/section.h"

namespace opaline::bake {
namespace {

// A file is: XXH3-64 of the rest; that of the program; and for each light the number of its discs,
// the discs and the integrals, all as in memory. The program's checksum stands for versions, for
// the machine's byte order and for the layout of structs.
static_assert(std::is_trivially_copyable_v<TestDisc>);

// 0: not known.
std::uint64_t program_checksum() {
    const auto program = formats::FileBytes::open("/proc/self/exe");
    return program ? formats::checksum(program->bytes()) : 0;
}

template <class T>
void append(std::string& bytes, const T* values, std::size_t count) {
    if (count > 0) {
        bytes.append(reinterpret_cast<const char*>(values), count * sizeof(T));
    }
}

// False at the end.
template <class T>
bool take(std::string_view& bytes, T* values, std::size_t count) {
    if (bytes.size() / sizeof(T) < count) {
        return false;
    }
    if (count > 0) {  // of no values, the pointer may be null
        std::memcpy(static_cast<void*>(values), bytes.data(), count * sizeof(T));
    }
    bytes.remove_prefix(count * sizeof(T));
    return true;
}

std::uint64_t checksum(std::string_view bytes) {
    return formats::checksum(std::as_bytes(std::span(bytes.data(), bytes.size())));
}

}  // namespace

std::vector<TestLight> read_test_lights(const std::filesystem::path& file) {
    constexpr std::uint32_t kMostDiscs = 16;
    std::ifstream stream(file, std::ios::binary);
    const std::string content{std::istreambuf_iterator<char>(stream), {}};
    std::string_view bytes = content;
    std::uint64_t sum = 0, program = 0;
    const std::uint64_t own = program_checksum();
    if (own == 0 || !take(bytes, &sum, 1) || sum != checksum(bytes) || !take(bytes, &program, 1) ||
        program != own) {
        return {};
    }
    std::vector<TestLight> lights;
    for (const char* name : published_lights()) {
        std::uint32_t discs = 0;
        if (!take(bytes, &discs, 1) || discs > kMostDiscs) {
            return {};
        }
        TestLight light;
        light.name = name;
        light.discs.resize(discs);
        light.smooth.resize(formats::cubemap_texels(kTruthCubemap));
        if (!take(bytes, light.discs.data(), discs) ||
            !take(bytes, light.smooth.data(), light.smooth.size())) {
            return {};
        }
        lights.push_back(std::move(light));
    }
    return bytes.empty() ? lights : std::vector<TestLight>{};
}

void write_test_lights(const std::filesystem::path& file, const std::vector<TestLight>& lights) {
    const std::uint64_t program = program_checksum();
    if (program == 0) {
        return;
    }
    std::string bytes;
    append(bytes, &program, 1);
    for (const TestLight& light : lights) {
        const auto discs = static_cast<std::uint32_t>(light.discs.size());
        append(bytes, &discs, 1);
        append(bytes, light.discs.data(), discs);
        append(bytes, light.smooth.data(), light.smooth.size());
    }
    const std::uint64_t sum = checksum(bytes);
    std::string head;
    append(head, &sum, 1);
    std::error_code ignored;
    std::filesystem::create_directories(file.parent_path(), ignored);
    const formats::Status kept = formats::write_file_atomically(file, head + bytes);
    static_cast<void>(kept);
}

}  // namespace opaline::bake
