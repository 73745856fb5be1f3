#include "tests/formats/gltf/encode_test_image.h"

#include <png.h>
#include <stdio.h>
// jpeglib.h needs FILE declared first.
#include <jpeglib.h>

#include <cstdlib>

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

Blob encode_jpeg(std::uint8_t grey, std::uint32_t side) {
    jpeg_compress_struct jpeg{};
    jpeg_error_mgr errors{};
    jpeg.err = jpeg_std_error(&errors);
    jpeg_create_compress(&jpeg);
    unsigned char* data = nullptr;
    unsigned long size = 0;
    jpeg_mem_dest(&jpeg, &data, &size);
    jpeg.image_width = jpeg.image_height = side;
    jpeg.input_components = 1;
    jpeg.in_color_space = JCS_GRAYSCALE;
    jpeg_set_defaults(&jpeg);
    jpeg_start_compress(&jpeg, TRUE);
    Blob row(side, grey);
    while (jpeg.next_scanline < side) {
        JSAMPROW pointer = row.data();
        jpeg_write_scanlines(&jpeg, &pointer, 1);
    }
    jpeg_finish_compress(&jpeg);
    jpeg_destroy_compress(&jpeg);
    Blob out(data, data + size);
    std::free(data);
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
