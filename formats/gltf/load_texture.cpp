#include "formats/gltf/load_texture.h"

#include <algorithm>
#include <utility>

#include "formats/gltf/decode_image8.h"
#include "formats/image/srgb.h"

namespace opaline::formats::gltf {

namespace {

TextureWrap wrap_mode(std::uint32_t value, const std::string& where, Report& report) {
    switch (value) {
        case 10497:
            return TextureWrap::repeat;
        case 33071:
            return TextureWrap::clamp;
        case 33648:
            return TextureWrap::mirror;
        default:
            report.error(
                where, "wrap mode " + std::to_string(value) + " is none of 10497, 33071 and 33648");
            return TextureWrap::repeat;
    }
}

// Values at texel centres are the same either way: what is asked for when an image is magnified
// decides, and where the file leaves that open, what is asked for when it is not.
bool is_nearest_sampler(const Sampler& sampler) {
    constexpr std::uint32_t kNearest = 9728, kNearestMipmapNearest = 9984,
                            kNearestMipmapLinear = 9986;
    if (sampler.mag_filter != kNone) return sampler.mag_filter == kNearest;
    return sampler.min_filter == kNearest || sampler.min_filter == kNearestMipmapNearest ||
           sampler.min_filter == kNearestMipmapLinear;
}

}  // namespace

std::array<double, 256> decoded_codes() {
    std::array<double, 256> linear{};
    for (std::size_t code = 0; code < linear.size(); ++code) {
        linear[code] = static_cast<double>(linear_from_srgb(static_cast<float>(code) / 255.0f));
    }
    return linear;
}

glm::dvec4 mean_texel(const Image8& image) {
    const std::array<double, 256> linear = decoded_codes();
    glm::dvec4 sum(0.0);
    for (std::size_t i = 0; i + 3 < image.rgba.size(); i += 4) {
        sum += glm::dvec4(linear[image.rgba[i]], linear[image.rgba[i + 1]],
                          linear[image.rgba[i + 2]], image.rgba[i + 3] / 255.0);
    }
    return sum / static_cast<double>(std::max<std::size_t>(1, image.rgba.size() / 4));
}

std::optional<Image8> TextureLoader::decode_image(std::uint32_t index) {
    const ImageSource& source = document_.images[index];
    const std::string where = label("image", index, source.name);
    Bytes bytes;
    if (source.uri.empty()) {
        const BufferView& view = document_.views[source.view];
        bytes = resources_.buffers[view.buffer].subspan(view.offset, view.length);
    } else if (const auto read = read_uri(resources_, source.uri, where, report_)) {
        bytes = *read;
    } else {
        return std::nullopt;
    }
    DecodedImage8 decoded = decode_image8(bytes);
    if (!decoded.fault.empty()) {
        report_.error(where, decoded.fault, "save the texture again as 8-bit PNG or JPEG");
        return std::nullopt;
    }
    return std::move(decoded.image);
}

std::optional<Image8> TextureLoader::decode(std::uint32_t texture, const std::string& where) {
    const std::uint32_t image = document_.textures[texture].image;
    if (image == kNone) {
        report_.error(where, "texture " + std::to_string(texture) + " has no PNG or JPEG image",
                      "export the texture as PNG or JPEG");
        return std::nullopt;
    }
    if (const auto found = known_.find(image); found != known_.end()) {
        return found->second == kNone ? std::nullopt : std::optional(scene_.images[found->second]);
    }
    return decode_image(image);
}

LoadedTexture TextureLoader::load(std::uint32_t texture, const std::string& where) {
    return load_into(scene_.images, known_, texture, where);
}

LoadedTexture TextureLoader::load_inner(std::uint32_t texture, const std::string& where) {
    return load_into(scene_.inner_images, known_inner_, texture, where);
}

LoadedTexture TextureLoader::load_into(std::vector<Image8>& images, Known& known,
                                       std::uint32_t texture, const std::string& where) {
    LoadedTexture loaded = sampler_of(texture);
    const Texture& source = document_.textures[texture];
    if (const auto found = known.find(source.image); found != known.end()) {
        loaded.image = found->second;
    } else {
        auto image = decode(texture, where);
        if (image) {
            loaded.image = static_cast<std::uint32_t>(images.size());
            images.push_back(std::move(*image));
        }
        if (source.image != kNone) {
            known[source.image] = loaded.image;
        }
    }
    return loaded;
}

LoadedTexture TextureLoader::sampler_of(std::uint32_t texture) {
    LoadedTexture loaded;
    const Texture& source = document_.textures[texture];
    if (source.sampler != kNone) {
        const Sampler& sampler = document_.samplers[source.sampler];
        const std::string at = "sampler " + std::to_string(source.sampler);
        loaded.wrap_u = wrap_mode(sampler.wrap_s, at, report_);
        loaded.wrap_v = wrap_mode(sampler.wrap_t, at, report_);
        if (is_nearest_sampler(sampler)) {
            loaded.wrap_u = nearest(loaded.wrap_u);
            loaded.wrap_v = nearest(loaded.wrap_v);
        }
    }
    return loaded;
}

}  // namespace opaline::formats::gltf
