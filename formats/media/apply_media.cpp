#include "formats/media/apply_media.h"

#include <algorithm>
#include <map>
#include <span>
#include <string>
#include <string_view>

#include "formats/gltf/report.h"
#include "formats/gltf/sha256.h"
#include "formats/media/fields.h"

namespace opaline::formats {

namespace {

std::string names_of(const std::vector<Material>& materials) {
    constexpr std::size_t kShown = 6;
    std::string list;
    for (std::size_t i = 0; i < std::min(materials.size(), kShown); ++i) {
        list += (i == 0 ? "" : ", ") + gltf::in_quotes(materials[i].name);
    }
    return materials.size() > kShown ? list + ", ..." : list;
}

void add_to_hash(const std::string& sha256, Scene& scene) {
    const std::string both = scene.sha256 + sha256;
    gltf::Sha256 hash;
    hash.add(std::as_bytes(std::span(both)));
    scene.sha256 = hash.finish();
}

}  // namespace

std::vector<Diagnostic> apply_media(const MediaFile& media, Scene& scene) {
    std::map<std::string_view, const MaterialMedium*> by_name;
    for (const MaterialMedium& entry : media.materials) {
        by_name.emplace(entry.name, &entry);
    }
    const auto others = by_name.find("*");
    for (Material& material : scene.materials) {
        auto found = by_name.find(material.name);
        found = found == by_name.end() ? others : found;
        if (found != by_name.end()) {
            material.medium = found->second->medium;
            // The medium has its own colour; the factor was for the surface it replaces.
            material.base_color = found->second->base_color.value_or(
                material.medium ? Rgb{1, 1, 1} : material.base_color);
        }
    }
    std::vector<Diagnostic> warnings;
    for (const MaterialMedium& entry : media.materials) {
        const auto is_named = [&](const Material& material) { return material.name == entry.name; };
        if (entry.name != "*" &&
            std::none_of(scene.materials.begin(), scene.materials.end(), is_named)) {
            warnings.push_back(make_warning(media.file, media::place("materials", entry.name),
                                            "the scene has no material of this name",
                                            "it has: " + names_of(scene.materials)));
        }
    }
    if (!media.inputs.empty()) {
        scene.inputs.insert(scene.inputs.end(), media.inputs.begin(), media.inputs.end());
        add_to_hash(media.sha256, scene);
    }
    return warnings;
}

}  // namespace opaline::formats
