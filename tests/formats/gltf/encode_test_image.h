#pragma once

#include <cstdint>

#include "tests/formats/gltf/asset_builder.h"

namespace opaline::tests {

enum class TestImage { rgba, grey };

/// A PNG file of 8-bit samples, rows from the top.
Blob encode_png(const Blob& samples, std::uint32_t width, std::uint32_t height,
                TestImage kind = TestImage::rgba);

}  // namespace opaline::tests
