#include "formats/gltf/decode_image8.h"

// jpeglib.h needs FILE and size_t declared first.
#include <cstdio>
// clang-format off
#include <jpeglib.h>
#include <jerror.h>
// clang-format on
#include <png.h>

#include <array>
#include <csetjmp>
#include <cstring>
#include <vector>

#include "formats/gltf/limits.h"

namespace opaline::formats::gltf {

namespace {

/// Empty if an image of this size may be allocated for a file of `bytes` bytes.
std::string size_fault(std::uint64_t width, std::uint64_t height, std::size_t bytes) {
    const std::string size = std::to_string(width) + " x " + std::to_string(height);
    if (width == 0 || height == 0) return "the image has no pixels";
    if (width > kMaxImageSide || height > kMaxImageSide || width * height > kMaxImagePixels) {
        return "the image has " + size + " pixels, the limit is " + std::to_string(kMaxImageSide) +
               " on a side and " + std::to_string(kMaxImagePixels) + " in all";
    }
    // Neither format stores more than about 8000 pixels a byte (one-bit PNG of one colour).
    if (width * height > 1'000'000 && width * height / 10'000 > bytes) {
        return "the image claims " + size + " pixels in " + std::to_string(bytes) + " bytes";
    }
    return {};
}

/// The part of a decoder's state that its C callbacks reach. No destructor may be skipped by a
/// jump, so everything that owns memory lives in the caller of the function with setjmp.
struct Source {
    std::span<const std::byte> bytes;
    std::size_t at = 0;
    std::array<char, 256> message{};
    std::jmp_buf escape;
};

void remember(Source& source, const char* text) {
    std::snprintf(source.message.data(), source.message.size(), "%s", text);
}

// ---- PNG

[[noreturn]] void png_fail(png_structp png, png_const_charp text) {
    auto& source = *static_cast<Source*>(png_get_error_ptr(png));
    remember(source, text);
    std::longjmp(source.escape, 1);
}

void png_ignore(png_structp, png_const_charp) {}

void png_pull(png_structp png, png_bytep out, std::size_t count) {
    auto& source = *static_cast<Source*>(png_get_io_ptr(png));
    if (count > source.bytes.size() - source.at) {
        png_error(png, "the data ends early");
    }
    std::memcpy(out, source.bytes.data() + source.at, count);
    source.at += count;
}

/// Size and conversions; false when libpng gave up.
bool png_begin(Source& source, png_structp png, png_infop info) {
    if (setjmp(source.escape)) return false;
    png_set_read_fn(png, &source, png_pull);
    png_set_user_limits(png, kMaxImageSide, kMaxImageSide);
    png_set_chunk_malloc_max(png, 1u << 24);
    png_read_info(png, info);
    png_set_expand(png);  // palette, few-bit grey, tRNS
    png_set_scale_16(png);
    png_set_gray_to_rgb(png);
    png_set_add_alpha(png, 255, PNG_FILLER_AFTER);
    png_set_interlace_handling(png);
    png_read_update_info(png, info);
    return true;
}

bool png_rows(Source& source, png_structp png, png_bytepp rows) {
    if (setjmp(source.escape)) return false;
    png_read_image(png, rows);
    png_read_end(png, nullptr);
    return true;
}

DecodedImage8 decode_png(Source& source) {
    DecodedImage8 out;
    png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &source, png_fail, png_ignore);
    png_infop info = png ? png_create_info_struct(png) : nullptr;
    const auto fail = [&](std::string fault) {
        png_destroy_read_struct(&png, &info, nullptr);
        return DecodedImage8{{}, std::move(fault)};
    };
    if (!info) return fail("the PNG decoder ran out of memory");
    if (!png_begin(source, png, info)) {
        return fail(std::string("the PNG cannot be decoded: ") + source.message.data());
    }
    const std::uint32_t width = png_get_image_width(png, info);
    const std::uint32_t height = png_get_image_height(png, info);
    if (std::string fault = size_fault(width, height, source.bytes.size()); !fault.empty()) {
        return fail(std::move(fault));
    }
    if (png_get_rowbytes(png, info) != std::size_t{4} * width) {
        return fail("the PNG has an unexpected pixel format");
    }
    out.image = {width, height, std::vector<std::uint8_t>(std::size_t{4} * width * height)};
    std::vector<png_bytep> rows(height);
    for (std::size_t y = 0; y < height; ++y) {
        rows[y] = out.image.rgba.data() + y * 4 * width;
    }
    if (!png_rows(source, png, rows.data())) {
        return fail(std::string("the PNG cannot be decoded: ") + source.message.data());
    }
    png_destroy_read_struct(&png, &info, nullptr);
    return out;
}

// ---- JPEG

[[noreturn]] void jpeg_fail(j_common_ptr jpeg) {
    auto& source = *static_cast<Source*>(jpeg->client_data);
    std::array<char, JMSG_LENGTH_MAX> text{};
    jpeg->err->format_message(jpeg, text.data());
    remember(source, text.data());
    std::longjmp(source.escape, 1);
}

/// libjpeg only warns about missing or damaged data and paints grey; a texture must be whole.
void jpeg_message(j_common_ptr jpeg, int level) {
    if (level >= 0) return;
    const int code = jpeg->err->msg_code;
    if (code == JWRN_JPEG_EOF || code == JWRN_HIT_MARKER || code == JWRN_HUFF_BAD_CODE ||
        code == JWRN_MUST_RESYNC) {
        jpeg_fail(jpeg);
    }
}

/// A small progressive file can ask for thousands of passes over a large image.
void jpeg_progress(j_common_ptr jpeg) {
    constexpr int kMaxScans = 200;
    const auto decoder = reinterpret_cast<j_decompress_ptr>(jpeg);
    if (decoder->input_scan_number > kMaxScans) {
        remember(*static_cast<Source*>(jpeg->client_data), "it has too many scans");
        std::longjmp(static_cast<Source*>(jpeg->client_data)->escape, 1);
    }
}

bool jpeg_begin(Source& source, jpeg_decompress_struct& jpeg) {
    if (setjmp(source.escape)) return false;
    jpeg_create_decompress(&jpeg);
    jpeg_mem_src(&jpeg, reinterpret_cast<const unsigned char*>(source.bytes.data()),
                 source.bytes.size());
    jpeg_read_header(&jpeg, TRUE);
    jpeg.out_color_space = JCS_EXT_RGBA;
    return true;
}

bool jpeg_rows(Source& source, jpeg_decompress_struct& jpeg, std::uint8_t* rgba) {
    if (setjmp(source.escape)) return false;
    jpeg_start_decompress(&jpeg);
    while (jpeg.output_scanline < jpeg.output_height) {
        JSAMPROW row = rgba + std::size_t{4} * jpeg.output_width * jpeg.output_scanline;
        jpeg_read_scanlines(&jpeg, &row, 1);
    }
    jpeg_finish_decompress(&jpeg);
    return true;
}

DecodedImage8 decode_jpeg(Source& source) {
    DecodedImage8 out;
    jpeg_error_mgr errors{};
    jpeg_progress_mgr progress{};
    jpeg_decompress_struct jpeg{};
    jpeg.err = jpeg_std_error(&errors);
    jpeg.client_data = &source;
    errors.error_exit = jpeg_fail;
    errors.emit_message = jpeg_message;
    const auto fail = [&](std::string fault) {
        jpeg_destroy_decompress(&jpeg);
        return DecodedImage8{{}, std::move(fault)};
    };
    if (!jpeg_begin(source, jpeg)) {
        return fail(std::string("the JPEG cannot be decoded: ") + source.message.data());
    }
    if (std::string fault = size_fault(jpeg.image_width, jpeg.image_height, source.bytes.size());
        !fault.empty()) {
        return fail(std::move(fault));
    }
    progress.progress_monitor = jpeg_progress;
    jpeg.progress = &progress;
    out.image = {jpeg.image_width, jpeg.image_height,
                 std::vector<std::uint8_t>(std::size_t{4} * jpeg.image_width * jpeg.image_height)};
    if (!jpeg_rows(source, jpeg, out.image.rgba.data())) {
        return fail(std::string("the JPEG cannot be decoded: ") + source.message.data());
    }
    jpeg_destroy_decompress(&jpeg);
    return out;
}

}  // namespace

DecodedImage8 decode_image8(std::span<const std::byte> bytes) {
    Source source;
    source.bytes = bytes;
    const auto starts_with = [&](std::string_view magic) {
        return bytes.size() >= magic.size() &&
               std::memcmp(bytes.data(), magic.data(), magic.size()) == 0;
    };
    if (starts_with("\x89PNG\r\n\x1a\n")) return decode_png(source);
    if (starts_with("\xff\xd8\xff")) return decode_jpeg(source);
    return {{}, "its " + std::to_string(bytes.size()) + " bytes are neither PNG nor JPEG"};
}

}  // namespace opaline::formats::gltf
