#include "tests/runtime/web/page_comparison.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "runtime/shade.h"
#include "runtime/volumes/relight_volumes.h"

namespace opaline::test {
namespace {

using namespace runtime;

constexpr int kNear = 2, kSmooth = 1;     // [1/255]
constexpr float kSnap = 1.0f / (3 * 16);  // [pixels], at three samples a side of a pixel

struct ByteRange {
    int low = 255, high = 0;
};

// Shows the picture moved by so many pixels.
Camera turned(const Camera& camera, float x, float y) {
    const CameraFrame frame = camera_frame(camera);
    const float pixel = length(camera.target - camera.eye) * 2 *
                        static_cast<float>(frame.tan_half_y) / static_cast<float>(camera.height);
    Camera moved = camera;
    moved.target = camera.target + (x * pixel) * frame.right + (y * pixel) * frame.up;
    return moved;
}

// Of each byte, over pictures that are moved by one step of the grid or not at all.
std::vector<ByteRange> ranges_of(const std::function<DisplayPicture(const Camera&)>& render,
                                 const Camera& camera) {
    std::vector<ByteRange> ranges;
    for (int step = 0; step < 9; ++step) {
        const auto x = static_cast<float>(step % 3 - 1), y = static_cast<float>(step / 3 - 1);
        const DisplayPicture picture = render(turned(camera, x * kSnap, y * kSnap));
        ranges.resize(picture.rgba.size());
        for (std::size_t i = 0; i < ranges.size(); ++i) {
            ranges[i] = {std::min(ranges[i].low, int{picture.rgba[i]}),
                         std::max(ranges[i].high, int{picture.rgba[i]})};
        }
    }
    return ranges;
}

// As expect_same_pixels.
void expect_near(const std::function<DisplayPicture(const Camera&)>& render, const Camera& camera,
                 const std::vector<std::uint8_t>& page, std::size_t elsewhere) {
    const DisplayPicture cpu = render(camera);
    ASSERT_EQ(cpu.rgba.size(), page.size());
    std::vector<std::size_t> far;
    for (std::size_t i = 0; i < page.size(); ++i) {
        if (i % 4 < 3 && std::abs(page[i] - cpu.rgba[i]) > kNear) far.push_back(i);
    }
    if (far.empty()) return;
    const std::vector<ByteRange> ranges = ranges_of(render, camera);
    std::set<std::size_t> beyond_range, away_from_edges;  // pixels
    for (const std::size_t i : far) {
        const std::size_t pixel = i / 4;
        bool is_edge = false;
        for (std::size_t k = 4 * pixel; k < 4 * pixel + 3; ++k) {
            is_edge = is_edge || ranges[k].high - ranges[k].low > kSmooth;
        }
        if (!is_edge) away_from_edges.insert(pixel);
        EXPECT_LE(away_from_edges.size(), elsewhere)
            << pixel % cpu.width << ", " << pixel / cpu.width << ", band " << i % 4 << ": "
            << int{page[i]} << ", not " << int{cpu.rgba[i]};
        if (page[i] < ranges[i].low - kNear || page[i] > ranges[i].high + kNear) {
            beyond_range.insert(pixel);
        }
    }
    EXPECT_LE(beyond_range.size(), page.size() / 4000);
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

std::vector<PageFile> page_of(const formats::Asset& asset, std::span<const PageLight> lights,
                              const std::string& title) {
    auto page = make_web_page(asset.view(), lights, title, "a.opal", 0);
    EXPECT_TRUE(page);
    return std::move(page).value();
}

BrowserOutcome expect_same_pixels(std::span<const PageFile> page, const std::string& address,
                                  const Camera& camera,
                                  const std::function<DisplayPicture(const Camera&)>& render,
                                  std::size_t elsewhere) {
    const BrowserOutcome shown = take_page_picture(page, address, camera.width, camera.height);
    EXPECT_EQ(shown.console, "");
    expect_near(render, camera, shown.rgba, elsewhere);
    return shown;
}

}  // namespace opaline::test
