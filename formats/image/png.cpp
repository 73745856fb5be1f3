#include "formats/image/png.h"

#include <png.h>

#include <algorithm>
#include <new>

#include "formats/image/image_kind.h"
#include "formats/opal/atomic_file.h"
#include "formats/opal/file_bytes.h"

namespace opaline::formats {
namespace {

/// libpng's simplified interface reports errors as values: no long jumps over our objects.
struct PngImage {
    png_image control{};
    PngImage() { control.version = PNG_IMAGE_VERSION; }
    ~PngImage() { png_image_free(&control); }
    PngImage(const PngImage&) = delete;
    PngImage& operator=(const PngImage&) = delete;
};

}  // namespace

Result<Image8> decode_png(std::span<const std::byte> bytes, const std::string& name) {
    const auto fail = [&](const std::string& what) -> Error {
        return make_error(ErrorKind::bad_input, name, "", what, "export it again");
    };
    if (image_kind(bytes) != ImageKind::png) {
        return fail("is not a PNG image, whatever its name says");
    }
    PngImage png;
    if (png_image_begin_read_from_memory(&png.control, bytes.data(), bytes.size()) == 0) {
        return fail(std::string("is damaged: libpng says: ") + png.control.message);
    }
    const std::uint64_t width = png.control.width, height = png.control.height;
    // Deflate stores at least one byte per 1032, and a byte holds up to eight pixels.
    if (width == 0 || height == 0 || width > kMaxImagePixels || height > kMaxImagePixels ||
        width * height > std::min<std::uint64_t>(kMaxImagePixels, bytes.size() * 8256)) {
        return fail("claims " + std::to_string(width) + " x " + std::to_string(height) +
                    " pixels in " + std::to_string(bytes.size()) + " bytes");
    }
    try {
        png.control.format = PNG_FORMAT_RGBA;
        Image8 image{png.control.width, png.control.height, {}};
        image.rgba.resize(width * height * 4);
        if (png_image_finish_read(&png.control, nullptr, image.rgba.data(), 0, nullptr) == 0) {
            return fail(std::string("is damaged: libpng says: ") + png.control.message);
        }
        return image;
    } catch (const std::bad_alloc&) {
        return make_error(ErrorKind::resource, name, "", "does not fit in memory",
                          "use a smaller image");
    }
}

Result<Image8> read_png(const std::filesystem::path& path) {
    Result<FileBytes> file = FileBytes::open(path);
    if (!file) return std::move(file).error();
    return decode_png(file->bytes(), path.string());
}

Result<std::string> encode_png(const Image8& image, const std::string& name) {
    const std::size_t pixels = std::size_t{image.width} * image.height;
    if (pixels == 0 || image.rgba.size() != pixels * 4 || pixels > kMaxImagePixels) {
        return make_error(ErrorKind::usage, name, "",
                          "an image of " + std::to_string(image.width) + " x " +
                              std::to_string(image.height) + " pixels cannot be written",
                          "use a size from 1 x 1 to 16384 x 8192");
    }
    bool is_opaque = true;
    for (std::size_t i = 3; i < image.rgba.size(); i += 4) {
        is_opaque = is_opaque && image.rgba[i] == 255;
    }
    std::vector<std::uint8_t> rgb;
    if (is_opaque) {
        rgb.reserve(pixels * 3);
        for (std::size_t i = 0; i < image.rgba.size(); i += 4) {
            rgb.insert(rgb.end(), {image.rgba[i], image.rgba[i + 1], image.rgba[i + 2]});
        }
    }
    PngImage png;
    png.control.width = image.width;
    png.control.height = image.height;
    png.control.format = is_opaque ? PNG_FORMAT_RGB : PNG_FORMAT_RGBA;
    std::string bytes(PNG_IMAGE_PNG_SIZE_MAX(png.control), '\0');
    png_alloc_size_t size = bytes.size();
    const std::uint8_t* const source = is_opaque ? rgb.data() : image.rgba.data();
    if (png_image_write_to_memory(&png.control, bytes.data(), &size, 0, source, 0, nullptr) == 0) {
        return make_error(ErrorKind::resource, name, "",
                          std::string("cannot be encoded: libpng says: ") + png.control.message);
    }
    bytes.resize(size);
    return bytes;
}

Status write_png(const std::filesystem::path& path, const Image8& image) {
    const Result<std::string> bytes = encode_png(image, path.string());
    if (!bytes) return bytes.error();
    return write_file_atomically(path, *bytes);
}

}  // namespace opaline::formats
