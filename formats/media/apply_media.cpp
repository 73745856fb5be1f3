#include "formats/media/apply_media.h"

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "formats/gltf/report.h"
#include "formats/gltf/sha256.h"
#include "formats/media/fields.h"

namespace opaline::formats {

namespace {

constexpr std::size_t kShown = 6;

std::string listed(const std::vector<std::string_view>& names) {
    std::string list;
    for (std::size_t i = 0; i < std::min(names.size(), kShown); ++i) {
        list += (i == 0 ? "" : ", ") + gltf::in_quotes(names[i]);
    }
    return names.size() > kShown ? list + ", ..." : list;
}

/// One warning for all entries that no material of the scene has the name of.
void warn_of_unmatched(const MediaFile& media, const Scene& scene,
                       std::vector<Diagnostic>& warnings) {
    std::vector<std::string_view> own;
    for (const Material& material : scene.materials) {
        own.push_back(material.name);
    }
    const std::set<std::string_view> known(own.begin(), own.end());
    std::vector<std::string_view> unmatched;
    for (const MaterialMedium& entry : media.materials) {
        if (entry.name != "*" && !known.contains(entry.name)) {
            unmatched.push_back(entry.name);
        }
    }
    const std::string remedy = "it has: " + listed(own);
    if (unmatched.size() == 1) {
        warnings.push_back(make_warning(media.file, media::place("materials", unmatched[0]),
                                        "the scene has no material of this name", remedy));
    } else if (!unmatched.empty()) {
        warnings.push_back(make_warning(media.file, "materials",
                                        "the scene has no materials of " +
                                            std::to_string(unmatched.size()) +
                                            " names: " + listed(unmatched),
                                        remedy));
    }
}

void add_to_hash(const std::string& sha256, Scene& scene) {
    const std::string both = scene.sha256 + sha256;
    gltf::Sha256 hash;
    hash.add(std::as_bytes(std::span(both)));
    scene.sha256 = hash.finish();
}

/// A texture that some of its triangles cannot show.
template <class EntryOf>
std::optional<Error> find_unmapped(const std::string& file, const Scene& scene,
                                   const EntryOf& entry_of) {
    for (const Primitive& primitive : scene.primitives) {
        const MaterialMedium* entry = entry_of(scene.materials[primitive.material]);
        const char* const key = entry == nullptr ? nullptr
                                : entry->albedo  ? "albedo_texture"
                                : entry->scatter ? "scatter_texture"
                                : entry->density ? "density_texture"
                                                 : nullptr;
        if (key != nullptr && primitive.texcoord.empty() && !primitive.index.empty()) {
            const Material& material = scene.materials[primitive.material];
            return make_error(ErrorKind::bad_input, file,
                              media::place(media::place("materials", entry->name), key),
                              primitive.name + " of material " + gltf::in_quotes(material.name) +
                                  " has no texture coordinates TEXCOORD_" +
                                  std::to_string(material.base_color_texcoord),
                              "unwrap the mesh before export, or use marble, which needs none");
        }
    }
    return std::nullopt;
}

// Where the images of entries are in a scene: each once, for all materials of an entry.
using KnownImages = std::map<const Image8*, std::uint32_t>;

std::uint32_t add_image(const Image8& image, std::vector<Image8>& images, KnownImages& known) {
    const auto [at, is_new] = known.try_emplace(&image, static_cast<std::uint32_t>(images.size()));
    if (is_new) {
        images.push_back(image);
    }
    return at->second;
}

void fill(const MaterialMedium& entry, Material& material, Scene& scene, KnownImages& known) {
    if (material.sheet) {
        material.base_color = material.sheet->opaque_color;
        material.double_sided = material.sheet->opaque_double_sided;
        material.gloss.metallic = material.sheet->opaque_metallic;
        if (material.sheet->clear > 0) {  // then the gloss is that of what does not pass
            material.gloss.ior = material.sheet->eta;
        }
    }
    material.medium = entry.medium;
    material.sheet = entry.sheet;
    if (material.sheet) {
        material.sheet->opaque_color = material.base_color;
        material.sheet->opaque_double_sided = material.double_sided;
        // glTF's default is a metal, whose diffuse parts are nothing.
        material.sheet->opaque_metallic = std::exchange(material.gloss.metallic, 0.f);
    }
    material.double_sided = material.double_sided || entry.sheet;  // it has two sides
    // Medium and sheet have their own colour; the factor was for the surface they replace.
    const bool has_color = material.medium || material.sheet;
    material.base_color = entry.base_color.value_or(has_color ? Rgb{1, 1, 1} : material.base_color);
    material.marble = entry.marble;
    if (entry.albedo) {
        material.base_color_image = add_image(*entry.albedo, scene.images, known);
    }
    const auto add_inner = [&](const std::optional<Image8>& image, InnerTexture& to) {
        if (image) {
            to = {add_image(*image, scene.inner_images, known), material.wrap_u, material.wrap_v};
        }
    };
    if (material.medium && material.medium->variation) {
        add_inner(entry.scatter, material.medium->variation->color);
        add_inner(entry.density, material.medium->variation->density);
    }
}

}  // namespace

Result<std::vector<Diagnostic>> apply_media(const MediaFile& media, Scene& scene) {
    std::map<std::string_view, const MaterialMedium*> by_name;
    for (const MaterialMedium& entry : media.materials) {
        by_name.emplace(entry.name, &entry);
    }
    const auto entry_of = [&](const Material& material) -> const MaterialMedium* {
        auto found = by_name.find(material.name);
        found = found == by_name.end() ? by_name.find("*") : found;
        return found == by_name.end() ? nullptr : found->second;
    };
    if (auto error = find_unmapped(media.file, scene, entry_of)) return std::move(*error);
    KnownImages known;
    for (Material& material : scene.materials) {
        if (const MaterialMedium* entry = entry_of(material)) {
            fill(*entry, material, scene, known);
        }
    }
    if (!media.emitter_groups.empty()) scene.emitter_groups = media.emitter_groups;
    std::vector<Diagnostic> warnings;
    warn_of_unmatched(media, scene, warnings);
    if (!media.inputs.empty()) {
        scene.inputs.insert(scene.inputs.end(), media.inputs.begin(), media.inputs.end());
        add_to_hash(media.sha256, scene);
    }
    return warnings;
}

}  // namespace opaline::formats
