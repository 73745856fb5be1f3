#pragma once

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "formats/opal/asset.h"
#include "formats/opal/environment.h"
#include "runtime/picture/software_renderer.h"
#include "runtime/picture/tone_map.h"
#include "runtime/web/web_page.h"

namespace opaline::test {

/// Whether the tests were configured where there is a Chromium.
bool has_browser();

/// What a headless browser made of a page.
struct BrowserOutcome {
    std::string console;  ///< what the page's scripts complained of
    std::string title;    ///< of the document, at the end
    std::string message;  ///< what the page tells its viewer
    std::vector<std::uint8_t> rgba;
};

/// Opens the page from the disk, without a network, and takes a picture of that size. `address`:
/// what stands behind '#'.
BrowserOutcome take_page_picture(std::span<const runtime::PageFile> page,
                                 const std::string& address, std::uint32_t width,
                                 std::uint32_t height);

/// The same, but runs a script on the page; rgba is empty.
BrowserOutcome run_on_page(std::span<const runtime::PageFile> page, const std::string& script);

/// The same, without graphics: rgba is empty.
BrowserOutcome open_page_without_webgl(std::span<const runtime::PageFile> page);

/// Skips where the tests were configured without a Chromium.
class PagePicture : public testing::Test {
  protected:
    void SetUp() override {
        if (!has_browser()) GTEST_SKIP() << "no Chromium was found: the page was not looked at";
    }
};

std::vector<runtime::PageFile> page_of(const formats::Asset& asset,
                                       std::span<const runtime::PageLight> lights,
                                       const std::string& title = "a");

/// A view of the page, and what it is on the CPU.
struct PageView {
    std::string address;
    float turn = 0;      ///< of the light [degrees]
    float exposure = 0;  ///< [stops]
    std::vector<formats::Rgb> emitters{{1, 1, 1}, {1, 1, 1}};
};

/// What `render --backend cpu` shows.
runtime::DisplayPicture render_on_cpu(const formats::AssetView& view,
                                      const formats::Environment& sky,
                                      const runtime::Camera& camera, const PageView& wanted);

/// Takes a picture of the page at an address, without complaints of its scripts. Its pixels and
/// those that `render` has for the camera are the same within 2/255. Vertices
/// snap to the grid of the browser's graphics, 1/16 sample, which moves samples beside edges
/// across: pixels that change by more than 1/255 when the camera turns by one step of that grid lie
/// within 2/255 of the range of these pictures, but for one in 1000. `elsewhere`: how many others
/// may lie beyond 2/255.
BrowserOutcome expect_same_pixels(
    std::span<const runtime::PageFile> page, const std::string& address,
    const runtime::Camera& camera,
    const std::function<runtime::DisplayPicture(const runtime::Camera&)>& render,
    std::size_t elsewhere = 0);

}  // namespace opaline::test
