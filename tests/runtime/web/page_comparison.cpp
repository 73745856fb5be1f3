#include "tests/runtime/web/page_comparison.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <numbers>
#include <set>
#include <sstream>

#include "runtime/shade.h"
#include "runtime/volumes/relight_volumes.h"
#include "tests/support/temporary_folder.h"

namespace opaline::test {
namespace {

// Graphics without a GPU.
constexpr const char* kSoftware = "--use-angle=swiftshader --enable-unsafe-swiftshader";

std::string read_whole(const std::filesystem::path& path) {
    std::ostringstream text;
    text << std::ifstream(path, std::ios::binary).rdbuf();
    return text.str();
}

// Between the first `before` and what follows it.
std::string part_of(const std::string& text, const std::string& before, const std::string& after) {
    const std::size_t found = text.find(before);
    if (found == std::string::npos) return {};
    const std::size_t first = found + before.size(), end = text.find(after, first);
    return end == std::string::npos ? std::string() : text.substr(first, end - first);
}

std::vector<std::uint8_t> decode_base64(const std::string& text) {
    std::vector<std::uint8_t> bytes;
    std::uint32_t group = 0;
    int bits = 0;
    for (const char c : text) {
        const std::string digits =
            "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
        const std::size_t digit = digits.find(c);
        if (digit == std::string::npos) continue;
        group = group << 6 | static_cast<std::uint32_t>(digit);
        bits += 6;
        if (bits < 8) continue;
        bits -= 8;
        bytes.push_back(static_cast<std::uint8_t>(group >> bits & 255u));
    }
    return bytes;
}

// The console's lines of the browser's log.
std::string console_lines(const std::string& log) {
    std::istringstream lines(log);
    std::string line, found;
    while (std::getline(lines, line)) {
        if (line.find("CONSOLE") != std::string::npos) found += line + "\n";
    }
    return found;
}

BrowserOutcome open(std::span<const runtime::PageFile> page, const std::string& script,
                    const std::string& address, const std::string& flags) {
    const tests::TemporaryFolder folder;
    for (const runtime::PageFile& file : page) {
        std::ofstream out(folder / file.name, std::ios::binary);
        // The window is not looked at: drawing it would take longer than the picture.
        if (file.name == "index.html") out << "<script>requestAnimationFrame = () => 0</script>\n";
        out << file.text;
        if (file.name == "index.html") out << "<script>" << script << "</script>\n";
    }
    const std::string at = folder.path().string();
    const std::string command =
        "HOME='" + at + "' timeout 100 '" + OPALINE_BROWSER +
        "' --headless --no-sandbox --disable-quic --no-first-run --disable-background-networking "
        "--disable-component-update --disable-sync --host-resolver-rules='MAP * ~NOTFOUND' "
        "--force-device-scale-factor=0.2 --enable-logging=stderr --v=0 "
        "--virtual-time-budget=100000 --user-data-dir='" +
        at + "/profile' " + flags + " --dump-dom 'file://" + at + "/index.html#" + address +
        "' >'" + at + "/dom' 2>'" + at + "/log'";
    EXPECT_EQ(std::system(command.c_str()), 0) << read_whole(folder / "log");
    const std::string dom = read_whole(folder / "dom");
    return {console_lines(read_whole(folder / "log")), part_of(dom, "<title>", "</title>"),
            part_of(dom, "<p id=\"message\" role=\"alert\">", "</p>"),
            decode_base64(part_of(dom, "<pre id=\"pixels\">", "</pre>"))};
}

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

bool has_browser() {
    return !std::string(OPALINE_BROWSER).empty();
}

BrowserOutcome take_page_picture(std::span<const runtime::PageFile> page,
                                 const std::string& address, std::uint32_t width,
                                 std::uint32_t height) {
    const std::string size = std::to_string(width) + ", " + std::to_string(height);
    const std::string script = R"js(
opaline.page.ready.then(() => opaline.page.takePicture()js" +
                               size + R"js()).then(({ pixels }) => {
  let text = "";
  for (const byte of pixels) text += String.fromCharCode(byte);
  const pre = document.createElement("pre");
  pre.id = "pixels";
  pre.textContent = btoa(text);
  document.body.append(pre);
  const fetched = performance.getEntriesByType("resource").filter(e => !e.name.startsWith("file:") && !e.name.startsWith("data:"));
  if (fetched.length > 0) console.error("asked the network for " + fetched[0].name);
});
)js";
    return open(page, script, address, kSoftware);
}

BrowserOutcome run_on_page(std::span<const runtime::PageFile> page, const std::string& script) {
    return open(page, script, "", kSoftware);
}

BrowserOutcome open_page_without_webgl(std::span<const runtime::PageFile> page) {
    return open(page, "", "", "--disable-gpu --disable-software-rasterizer --disable-3d-apis");
}

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
