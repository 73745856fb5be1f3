#include "bake/lights/test_lights.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstring>
#include <fstream>
#include <iterator>
#include <span>
#include <string>
#include <system_error>
#include <type_traits>
#include <utility>

#include "bake/lights/builtin_environment.h"
#include "formats/opal/atomic_file.h"
#include "formats/opal/cubemap.h"
#include "formats/opal/file_bytes.h"
#include "formats/opal/rgb.h"
#include "formats/opal/section.h"
#include "runtime/integrate_discs.h"
#include "runtime/integrate_map.h"
#include "runtime/light_vector.h"
#include "runtime/reduce_map.h"

namespace opaline::bake {
namespace {

constexpr std::array<const char*, 6> kPublishedLights{"white",      "sun:30,60", "sun:150,35",
                                                      "sun:270,15", "studio",    "sky:3,35"};

// The same integrals over the texels of n x n, by sums, or shared out by solid angle.
std::vector<double> change_size(std::span<const float> smooth, std::uint32_t n) {
    const std::vector<double> from = formats::texel_solid_angles(kTruthCubemap);
    const std::vector<double> to = formats::texel_solid_angles(n);
    const std::uint32_t size = std::max(n, kTruthCubemap);
    const std::uint32_t down = size / kTruthCubemap, up = size / n;
    std::vector<double> integral(formats::cubemap_texels(n));
    for (std::uint32_t face = 0; face < formats::kCubeFaces; ++face) {
        for (std::uint32_t row = 0; row < size; ++row) {
            for (std::uint32_t column = 0; column < size; ++column) {
                const std::size_t source = row / down * kTruthCubemap + column / down;
                const std::size_t target = row / up * n + column / up;
                const double share = down > 1 ? to[target] / from[source] : 1.0;
                integral[face * to.size() + target] +=
                    share * static_cast<double>(smooth[face * from.size() + source]);
            }
        }
    }
    return integral;
}

std::vector<float> integrate_smooth(const formats::Environment& environment, unsigned threads) {
    const std::size_t texels = formats::cubemap_texels(kTruthCubemap);
    std::vector<double> integral(3 * texels);
    runtime::integrate_map(environment, kTruthCubemap, {}, threads, integral);
    std::vector<float> smooth(texels);
    for (std::size_t j = 0; j < texels; ++j) {
        smooth[j] = formats::luminance({static_cast<float>(integral[3 * j]),
                                        static_cast<float>(integral[3 * j + 1]),
                                        static_cast<float>(integral[3 * j + 2])});
    }
    return smooth;
}

std::vector<TestDisc> exact_discs(std::span<const formats::DistantDisc> given) {
    std::vector<TestDisc> discs;
    for (const formats::DistantDisc& d : given) {
        discs.push_back({{d.direction.x, d.direction.y, d.direction.z},
                         d.angular_radius,
                         static_cast<double>(formats::luminance(d.radiance)) *
                             formats::disc_solid_angle(d.angular_radius)});
    }
    return discs;
}

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
    if (bytes.size() / sizeof(T) < count) return false;
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

std::span<const char* const> published_lights() {
    return kPublishedLights;
}

double relit(std::span<const float> row, std::span<const float> light) {
    double sum = 0;
    for (std::size_t k = 0; k < row.size(); ++k) {
        sum += static_cast<double>(row[k]) * static_cast<double>(light[k]);
    }
    return sum;
}

namespace {

formats::Result<std::vector<TestLight>> integrate_test_lights(unsigned threads) {
    std::vector<TestLight> lights;
    for (const char* name : kPublishedLights) {
        formats::Result<formats::Environment> environment = make_environment(name);
        if (!environment) return std::move(environment).error();
        // Two to three pixels per texel suffice for these smooth maps.
        std::vector<formats::DistantDisc> discs = std::move(environment->discs);
        if (!environment->pixel.empty()) {
            environment = runtime::reduce_lat_long(*environment, 4 * kTruthCubemap,
                                                   2 * kTruthCubemap, threads);
        }
        lights.push_back({name, {}, exact_discs(discs), integrate_smooth(*environment, threads)});
    }
    return lights;
}

}  // namespace

formats::Result<std::vector<TestLight>> make_test_lights(std::uint32_t cubemap_size,
                                                         unsigned threads,
                                                         const std::filesystem::path& cache) {
    std::vector<TestLight> lights;
    if (!cache.empty()) {
        lights = read_test_lights(cache);
    }
    if (lights.empty()) {
        auto integrated = integrate_test_lights(threads);
        if (!integrated) return integrated;
        lights = std::move(*integrated);
        if (!cache.empty()) {
            write_test_lights(cache, lights);
        }
    }
    project_test_lights(lights, cubemap_size);
    return lights;
}

void project_test_lights(std::span<TestLight> lights, std::uint32_t cubemap_size) {
    for (TestLight& light : lights) {
        const std::vector<double> smooth = change_size(light.smooth, cubemap_size);
        std::vector<double> integral(3 * smooth.size());
        for (std::size_t j = 0; j < smooth.size(); ++j) {
            integral[3 * j] = smooth[j];
        }
        std::vector<formats::DistantDisc> discs;
        for (const TestDisc& d : light.discs) {
            const auto radiance =
                static_cast<float>(d.flux / formats::disc_solid_angle(d.angular_radius));
            discs.push_back({{d.direction.x, d.direction.y, d.direction.z},
                             d.angular_radius,
                             {radiance, radiance, radiance}});
        }
        runtime::integrate_discs(discs, cubemap_size, {}, integral);
        const runtime::LightVector projected = runtime::make_light_vector(integral, cubemap_size);
        light.coarse.resize(smooth.size());
        for (std::size_t k = 0; k < smooth.size(); ++k) {
            light.coarse[k] = projected.rgba[4 * k];
        }
    }
}

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
    if (program == 0) return;
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

std::vector<std::uint32_t> draw_evenly(std::size_t count, std::size_t wanted, RandomStage stage,
                                       std::uint64_t seed) {
    wanted = std::min(count, wanted);
    std::vector<std::uint32_t> drawn;
    for (std::size_t i = 0; i < wanted; ++i) {
        const std::size_t begin = count * i / wanted, end = count * (i + 1) / wanted;
        const auto u = static_cast<double>(random_uniform(seed, stage, i)[0]);
        drawn.push_back(static_cast<std::uint32_t>(
            begin + static_cast<std::size_t>(u * static_cast<double>(end - begin))));
    }
    return drawn;
}

}  // namespace opaline::bake
