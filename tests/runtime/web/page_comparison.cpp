#include "tests/runtime/web/page_comparison.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "runtime/shade.h"
#include "runtime/volumes/relight_volumes.h"

namespace opaline::test {
namespace {

using namespace runtime;

struct PixelRange {
    int low = 255, high = 0;
};

// Of a pixel and its eight neighbours.
PixelRange around(const DisplayPicture& picture, std::uint32_t x, std::uint32_t y,
                  std::size_t band) {
    PixelRange range;
    for (std::uint32_t j = y == 0 ? 0 : y - 1; j <= std::min(y + 1, picture.height - 1); ++j) {
        for (std::uint32_t i = x == 0 ? 0 : x - 1; i <= std::min(x + 1, picture.width - 1); ++i) {
            const int value = picture.rgba[4 * (std::size_t{j} * picture.width + i) + band];
            range = {std::min(range.low, value), std::max(range.high, value)};
        }
    }
    return range;
}

}  // namespace

DisplayPicture render_on_cpu(const formats::AssetView& view, const formats::Environment& sky,
                             const Camera& camera, const PageView& wanted) {
    const Rotation rotation = rotation_about_y(wanted.turn * std::numbers::pi_v<float> / 180);
    const LightVector light = project_environment(sky, view.cubemap_size, rotation);
    const SpecularLight specular = make_specular_light(sky, specular_needs(view), rotation, 0);
    const EmitterLight emitters{wanted.emitters, true};
    SoftwareOptions options;
    options.specular = &specular;
    options.emitters = emitters;
    options.lights = light;
    const VolumeLight volumes = relight_volumes(view.volumes, light, {.emitters = emitters});
    options.volumes = &volumes;
    const auto picture = render_software(
        view, shade_for_picture(view, light, camera.eye, formats::TermSet::all, 0, emitters), sky,
        rotation, camera, options);
    EXPECT_TRUE(picture);
    return tone_map(*picture, wanted.exposure);
}

void expect_same_pixels(const DisplayPicture& cpu, const std::vector<std::uint8_t>& page) {
    constexpr int kNear = 2;
    ASSERT_EQ(cpu.rgba.size(), page.size());
    const std::size_t pixels = page.size() / 4, allowed = pixels / 1000;
    std::size_t at_edges = 0, wrong = 0;
    for (std::uint32_t y = 0; y < cpu.height; ++y) {
        for (std::uint32_t x = 0; x < cpu.width; ++x) {
            const std::size_t at = 4 * (std::size_t{y} * cpu.width + x);
            bool is_near = true, is_between = true;
            for (std::size_t band = 0; band < 3; ++band) {
                const int value = page[at + band];
                const PixelRange range = around(cpu, x, y, band);
                is_near = is_near && std::abs(value - cpu.rgba[at + band]) <= kNear;
                is_between =
                    is_between && value >= range.low - kNear && value <= range.high + kNear;
            }
            at_edges += is_near ? 0 : 1;
            if (is_between) continue;
            ++wrong;
            EXPECT_LE(wrong, allowed)
                << x << ", " << y << ": " << int{page[at]} << ' ' << int{page[at + 1]} << ' '
                << int{page[at + 2]} << ", not " << int{cpu.rgba[at]} << ' '
                << int{cpu.rgba[at + 1]} << ' ' << int{cpu.rgba[at + 2]};
        }
    }
    EXPECT_LE(at_edges, pixels / 50);
    EXPECT_LE(wrong, allowed);
}

}  // namespace opaline::test
