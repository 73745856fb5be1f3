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
    if (!object.contains(key)) return otherwise;
    const auto found = whole_in(object, key, most);
    return found ? std::optional(static_cast<std::uint32_t>(*found)) : std::nullopt;
}

std::optional<double> number(const Json& object, const char* key) {
    const Json* found = find_member(object, key);
    if (!found) return 0.0;
    return found->is_number() ? std::optional(found->get<double>()) : std::nullopt;
}

std::optional<glm::dvec2> pair(const Json& object, const char* key, glm::dvec2 otherwise) {
    const Json* found = find_member(object, key);
    if (!found) return otherwise;
    return is_array_of(*found, &Json::is_number, 2)
               ? std::optional(glm::dvec2((*found)[0].get<double>(), (*found)[1].get<double>()))
               : std::nullopt;
}

/// KHR_texture_transform: translation * rotation * scale. Its example (offset 0 1, rotation pi/2,
/// scale 1/2 is the lower left quadrant) holds for a rotation that is counter-clockwise with v
/// pointing down, so sin enters with the opposite sign of a v-up plane.
glm::mat3 texture_transform(glm::dvec2 offset, double rotation, glm::dvec2 scale) {
    const double cosine = std::cos(rotation), sine = std::sin(rotation);
    return glm::mat3(glm::dmat3(cosine * scale.x, -sine * scale.x, 0.0,  //
                                sine * scale.y, cosine * scale.y, 0.0,   //
                                offset.x, offset.y, 1.0));
}

TextureUse read_texture_use(const Json& info, const std::string& where, Report& report) {
    if (!info.is_object()) {
        report.error(where, "it is not an object");
        return {};
    }
    const auto index = whole(info, "index", kMostTextures, kNone);
    const auto texcoord = whole(info, "texCoord", kMostTexcoords, 0);
    if (!index || *index == kNone || !texcoord) {
        report.error(where, "index or texCoord is not a small whole number");
        return {};
    }
    TextureUse use{*index, *texcoord};
    const Json* transform = find_extension(info, "KHR_texture_transform");
    if (!transform) return use;
    if (!transform->is_object()) {
        report.error(where, "its KHR_texture_transform is not an object");
        return {};
    }
    const auto offset = pair(*transform, "offset", glm::dvec2(0.0));
    const auto scale = pair(*transform, "scale", glm::dvec2(1.0));
    const auto rotation = number(*transform, "rotation");
    const auto own = whole(*transform, "texCoord", kMostTexcoords, use.texcoord);
    if (!offset || !scale || !rotation || !own) {
        report.error(where, "its KHR_texture_transform has a member of the wrong type");
        return {};
    }
    use.texcoord = *own;
    use.transform = texture_transform(*offset, *rotation, *scale);
    return use;
}

}  // namespace

void read_texture(const NamedObject& object, const char* key, TextureUse& use) {
    if (const Json* found = find_member(object.object, key)) {
        use = read_texture_use(*found, object.where + " > " + key, object.report);
    }
}

}  // namespace opaline::formats::gltf
