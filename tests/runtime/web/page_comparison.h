#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "formats/opal/asset.h"
#include "formats/opal/environment.h"
#include "runtime/picture/software_renderer.h"
#include "runtime/picture/tone_map.h"

namespace opaline::test {

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

/// The page's pixels and those that `render` has for the camera are the same within 2/255. Vertices
/// snap to the grid of the browser's graphics, 1/16 sample, which moves samples beside edges
/// across: pixels that change by more than 1/255 when the camera turns by one step of that grid lie
/// within 2/255 of the range of these pictures, but for one in 1000. `elsewhere`: how many others
/// may lie beyond 2/255.
void expect_same_pixels(
    const std::function<runtime::DisplayPicture(const runtime::Camera&)>& render,
    const runtime::Camera& camera, const std::vector<std::uint8_t>& page,
    std::size_t elsewhere = 0);

}  // namespace opaline::test
