#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

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

}  // namespace opaline::test
