#include "formats/gltf/unlit_materials.h"

#include <algorithm>

#include "formats/image/png.h"
#include "formats/opal/thin_glass.h"

namespace opaline::formats {
namespace {

// Values fixed by the glTF 2.0 specification.
constexpr int kRepeat = 10497, kClamp = 33071, kMirror = 33648;
constexpr int kNearest = 9728, kLinear = 9729, kMipmaps = 9987;

int gltf_wrap(Wrap wrap) {
    const Wrap edge = edge_of(wrap);
    return edge == Wrap::clamp ? kClamp : edge == Wrap::mirror ? kMirror : kRepeat;
}

GltfJson make_sampler(Wrap u, Wrap v) {
    const bool texels = is_nearest(u) || is_nearest(v);
    return {{"magFilter", texels ? kNearest : kLinear},
            {"minFilter", texels ? kNearest : kMipmaps},
            {"wrapS", gltf_wrap(u)},
            {"wrapT", gltf_wrap(v)}};
}

// One image of both, of the colour's size where there is one; white where there is no colour.
Image8 join_images(const PreviewImage* color, const PreviewImage* alpha) {
    const PreviewImage& size = color != nullptr ? *color : *alpha;
    Image8 image{size.width, size.height, {}};
    image.rgba.reserve(std::size_t{4} * size.width * size.height);
    const auto texel = [&](const PreviewImage& from, std::uint64_t column, std::uint64_t row) {
        column = (2 * column + 1) * from.width / (2 * std::uint64_t{size.width});
        row = (2 * row + 1) * from.height / (2 * std::uint64_t{size.height});
        return from.rgb.data() + 3 * (row * from.width + column);
    };
    for (std::uint32_t row = 0; row < size.height; ++row) {
        for (std::uint32_t column = 0; column < size.width; ++column) {
            constexpr std::uint8_t kWhite[] = {255, 255, 255};
            const std::uint8_t* c = color != nullptr ? texel(*color, column, row) : kWhite;
            const std::uint8_t* a = alpha != nullptr ? texel(*alpha, column, row) : kWhite;
            image.rgba.insert(image.rgba.end(), {c[0], c[1], c[2], a[0]});
        }
    }
    return image;
}

}  // namespace

float unlit_cover(const HoleRecord& hole) {
    if (hole.clear == 0) return 1;
    const ClearShare clear = clear_share_of(hole);
    return std::clamp(1 - clear.share * thin_glass_transmittance(1, clear.eta), 0.0f, 1.0f);
}

std::size_t UnlitMaterials::Distinct::add(const GltfJson& entry) {
    const auto [at, is_new] = index_of.try_emplace(entry.dump(), array.size());
    if (is_new) array.push_back(entry);
    return at->second;
}

bool UnlitMaterials::has_image(std::size_t material) const {
    return materials_.array[material]["pbrMetallicRoughness"].contains("baseColorTexture");
}

Result<std::size_t> UnlitMaterials::add_image(std::uint32_t color, std::uint32_t alpha,
                                              GltfBuffer& buffer) {
    const auto known = image_of_.find({color, alpha});
    if (known != image_of_.end()) return known->second;
    const auto find = [&](std::uint32_t image) {
        return image == kNoImage ? nullptr : &asset_->images[image];
    };
    auto png = encode_png(join_images(find(color), find(alpha)),
                          "image " + std::to_string(color != kNoImage ? color : alpha));
    if (!png) return std::move(png).error();
    images_.push_back({{"mimeType", "image/png"}, {"bufferView", buffer.add_file(*png)}});
    return image_of_[{color, alpha}] = images_.size() - 1;
}

Result<std::size_t> UnlitMaterials::add(std::uint32_t primitive, const std::string& name,
                                        GltfBuffer& buffer) {
    const PrimitiveRecord& record = asset_->primitives[primitive];
    const HoleRecord* const hole = asset_->holes.of(primitive);
    // Metallic and roughness are what the extension advises for renderers that do not know it.
    GltfJson pbr = {{"metallicFactor", 0}, {"roughnessFactor", 0.9}};
    if (hole != nullptr) pbr["baseColorFactor"] = {1, 1, 1, hole->alpha * unlit_cover(*hole)};
    const std::uint32_t color = record.base_color_image,
                        alpha = hole != nullptr ? hole->image : kNoImage;
    if (color != kNoImage || alpha != kNoImage) {
        const auto image = add_image(color, alpha, buffer);
        if (!image) return image.error();
        const bool of_color = color != kNoImage;
        const std::size_t sampler =
            samplers_.add(of_color ? make_sampler(record.wrap_u, record.wrap_v)
                                   : make_sampler(hole->wrap_u, hole->wrap_v));
        pbr["baseColorTexture"] = {
            {"index", textures_.add({{"sampler", sampler}, {"source", *image}})}};
    }
    GltfJson material;
    if (!name.empty()) material["name"] = name;
    material["pbrMetallicRoughness"] = pbr;
    if (hole != nullptr) {
        const bool blends = hole->mode == HoleMode::blend || unlit_cover(*hole) < 1;
        material["alphaMode"] = blends ? "BLEND" : "MASK";
        if (!blends) material["alphaCutoff"] = hole->cutoff;
    }
    if (record.shows_back()) material["doubleSided"] = true;
    material["extensions"] = {{"KHR_materials_unlit", GltfJson::object()}};
    return materials_.add(material);
}

void UnlitMaterials::put_into(GltfJson& document) const {
    document["materials"] = materials_.array;
    if (images_.empty()) return;
    document["textures"] = textures_.array;
    document["samplers"] = samplers_.array;
    document["images"] = images_;
}

}  // namespace opaline::formats
