#pragma once

#include <cstdint>
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

/// Within 2/255; where a sample lies beside an edge for one of the two, within its neighbours'
/// range.
void expect_same_pixels(const runtime::DisplayPicture& cpu, const std::vector<std::uint8_t>& page);

}  // namespace opaline::test
