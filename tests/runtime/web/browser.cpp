#include "tests/runtime/web/browser.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <sstream>

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

}  // namespace opaline::test
