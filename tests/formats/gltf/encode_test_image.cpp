#include "tests/formats/gltf/encode_test_image.h"

#include <png.h>

namespace opaline::tests {

Blob encode_png(const Blob& samples, std::uint32_t width, std::uint32_t height, TestImage kind) {
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    image.width = width;
    image.height = height;
    image.format = kind == TestImage::grey ? PNG_FORMAT_GRAY : PNG_FORMAT_RGBA;
    png_alloc_size_t size = 0;
    png_image_write_to_memory(&image, nullptr, &size, 0, samples.data(), 0, nullptr);
    Blob out(size);
    png_image_write_to_memory(&image, out.data(), &size, 0, samples.data(), 0, nullptr);
    out.resize(size);
    return out;
}

std::size_t add_texture(AssetBuilder& asset, const Blob& file, Json image, Json texture) {
    image["bufferView"] = asset.add_view(file.data(), file.size());
    image["mimeType"] = "image/png";
    texture["source"] = asset.json["images"].size();
    asset.json["images"].push_back(std::move(image));
    asset.json["textures"].push_back(std::move(texture));
    return asset.json["textures"].size() - 1;
}

}  // namespace opaline::tests
