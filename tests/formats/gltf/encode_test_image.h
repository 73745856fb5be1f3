#pragma once

#include <cstdint>

#include "tests/formats/gltf/asset_builder.h"

namespace opaline::tests {

enum class TestImage { rgba, grey };

/// A PNG file of 8-bit samples, rows from the top.
Blob encode_png(const Blob& samples, std::uint32_t width, std::uint32_t height,
                TestImage kind = TestImage::rgba);

/// A square JPEG file of one grey.
Blob encode_jpeg(std::uint8_t grey, std::uint32_t side);

/// Adds a file as an image, with these members, and a texture of it; the texture's index.
std::size_t add_texture(AssetBuilder& asset, const Blob& file, Json image = Json::object(),
                        Json texture = Json::object());

}  // namespace opaline::tests
