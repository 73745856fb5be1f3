#include "formats/gltf/read_texture_use.h"

#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

namespace opaline::formats::gltf {

namespace {

using Json = nlohmann::json;

constexpr std::uint32_t kMostTextures = 0x7fffffff, kMostTexcoords = 255;

/// A whole number up to `most`; absent: `otherwise`. Nothing where it is something else.
std::optional<std::uint32_t> whole(const Json& object, const char* key, std::uint32_t most,
                                   std::uint32_t otherwise) {
    const auto found = object.find(key);
    if (found == object.end()) {
        return otherwise;
    }
    if (!found->is_number_unsigned() || found->get<std::uint64_t>() > most) {
        return std::nullopt;
    }
    return found->get<std::uint32_t>();
}

std::optional<double> number(const Json& object, const char* key) {
    const auto found = object.find(key);
    if (found == object.end()) {
        return 0.0;
    }
    return found->is_number() ? std::optional(found->get<double>()) : std::nullopt;
}

std::optional<glm::dvec2> pair(const Json& object, const char* key, glm::dvec2 otherwise) {
    const auto found = object.find(key);
    if (found == object.end()) {
        return otherwise;
    }
    if (!found->is_array() || found->size() != 2 || !(*found)[0].is_number() ||
        !(*found)[1].is_number()) {
        return std::nullopt;
    }
    return glm::dvec2((*found)[0].get<double>(), (*found)[1].get<double>());
}

}  // namespace

glm::mat3 texture_transform(glm::dvec2 offset, double rotation, glm::dvec2 scale) {
    const double cosine = std::cos(rotation), sine = std::sin(rotation);
    return glm::mat3(glm::dmat3(cosine * scale.x, -sine * scale.x, 0.0,  //
                                sine * scale.y, cosine * scale.y, 0.0,   //
                                offset.x, offset.y, 1.0));
}

TextureUse read_texture_use(const Json& info, const std::string& where, Report& report) {
    if (!info.is_object()) {
        report.error(where, "it is not an object", kExportAgain);
        return {};
    }
    const auto index = whole(info, "index", kMostTextures, kNone);
    const auto texcoord = whole(info, "texCoord", kMostTexcoords, 0);
    if (!index || *index == kNone || !texcoord) {
        report.error(where, "index or texCoord is not a small whole number", kExportAgain);
        return {};
    }
    TextureUse use{*index, *texcoord};
    const auto extensions = info.find("extensions");
    if (extensions == info.end() || !extensions->is_object() ||
        !extensions->contains("KHR_texture_transform")) {
        return use;
    }
    const Json& transform = extensions->at("KHR_texture_transform");
    if (!transform.is_object()) {
        report.error(where, "its KHR_texture_transform is not an object", kExportAgain);
        return {};
    }
    const auto offset = pair(transform, "offset", glm::dvec2(0.0));
    const auto scale = pair(transform, "scale", glm::dvec2(1.0));
    const auto rotation = number(transform, "rotation");
    const auto own = whole(transform, "texCoord", kMostTexcoords, use.texcoord);
    if (!offset || !scale || !rotation || !own) {
        report.error(where, "its KHR_texture_transform has a member of the wrong type",
                     kExportAgain);
        return {};
    }
    use.texcoord = *own;
    use.transform = texture_transform(*offset, *rotation, *scale);
    return use;
}

}  // namespace opaline::formats::gltf
