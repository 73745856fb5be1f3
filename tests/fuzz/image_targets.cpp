#include "formats/gltf/decode_image8.h"
#include "formats/image/exr.h"
#include "formats/image/hdr.h"
#include "formats/image/load_environment.h"
#include "formats/image/png.h"
#include "tests/fuzz/targets.h"

namespace opaline::fuzz {
namespace {

using formats::Result;

void expect_environment(std::span<const std::byte> bytes) {
    const Result<formats::LoadedEnvironment> loaded = formats::decode_environment(bytes, "x");
    if (!loaded) return expect_message(loaded.error());
    const formats::Environment& map = loaded->environment;
    hold(map.pixel.size() == std::size_t{map.width} * map.height && !map.pixel.empty(),
         "a map has as many pixels as its size says");
    for (const formats::Rgb& c : map.pixel) {
        for (const float v : {c.r, c.g, c.b}) {
            hold(v >= 0 && v <= formats::kMaxRadiance, "radiance is finite and not negative");
        }
    }
}

template <class Pixel>
bool is_whole(std::uint32_t width, std::uint32_t height, const std::vector<Pixel>& pixel,
              std::size_t per_pixel = 1) {
    return !pixel.empty() && pixel.size() == std::size_t{width} * height * per_pixel;
}

}  // namespace

void run_exr(std::span<const std::byte> bytes) {
    const auto image = formats::decode_exr(bytes, "x.exr");
    if (!image) expect_message(image.error());
    if (image) hold(is_whole(image->image.width, image->image.height, image->image.pixel), "size");
    const auto channel = formats::decode_exr_channel(bytes, "x.exr", {"Y", "Z", "R"}, 64);
    if (!channel) return expect_message(channel.error());
    hold(channel->width <= 64 && channel->height <= 64 &&
             is_whole(channel->width, channel->height, channel->value),
         "a channel is as large as it may be at most");
    expect_environment(bytes);
}

void run_hdr(std::span<const std::byte> bytes) {
    const auto image = formats::decode_hdr(bytes, "x.hdr");
    if (!image) return expect_message(image.error());
    hold(is_whole(image->image.width, image->image.height, image->image.pixel), "size");
    expect_environment(bytes);
}

void run_png(std::span<const std::byte> bytes) {
    const auto image = formats::decode_png(bytes, "x.png");
    if (!image) return expect_message(image.error());
    hold(is_whole(image->width, image->height, image->rgba, 4), "size");
}

void run_texture(std::span<const std::byte> bytes) {
    const auto decoded = formats::gltf::decode_image8(bytes);
    if (!decoded.fault.empty()) return;
    hold(is_whole(decoded.image.width, decoded.image.height, decoded.image.rgba, 4), "size");
}

}  // namespace opaline::fuzz
