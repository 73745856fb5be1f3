#include "formats/media/load_volumes.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <new>
#include <optional>
#include <utility>

#include "formats/gltf/container.h"
#include "formats/gltf/report.h"
#include "formats/gltf/sha256.h"
#include "formats/media/fill_body.h"
#include "formats/media/limits.h"
#include "formats/media/load_emission.h"
#include "formats/media/resampler.h"
#include "formats/media/split_absorption.h"
#include "formats/vdb/read_vdb.h"

namespace opaline::formats {
namespace {

using gltf::in_quotes;

struct Bounds {
    glm::dvec3 low{std::numeric_limits<double>::max()}, high{std::numeric_limits<double>::lowest()};
};

void include(Bounds& bounds, const SparseGrid<float>& grid) {
    for (const glm::dvec3& corner : grid.corners()) {
        bounds.low = glm::min(bounds.low, corner);
        bounds.high = glm::max(bounds.high, corner);
    }
}

// What is said of a file that is read: warnings, and lines that call for nothing.
struct Findings {
    std::vector<Diagnostic> warnings;
    std::vector<std::string> notes;
};

// One line that says which grids of the file the entry does not use.
void note_unused(const VolumeEntry& entry, const std::filesystem::path& file,
                 std::vector<std::string> unread, std::vector<std::string>& notes) {
    std::erase_if(unread, [&](const std::string& name) {
        return name == entry.albedo_grid || name == entry.emission || name == entry.temperature;
    });
    std::string list;
    for (const std::string& name : unread) {
        list += (list.empty() ? "" : ", ") + in_quotes(name);
    }
    if (!list.empty()) {
        notes.push_back(
            "grids of " + in_quotes(file.filename().string()) + " that are not used: " + list +
            " (a media file can name one as density, albedo, emission or " + "temperature)");
    }
}

// The grid that holds an entry's density.
Result<VdbGrid> read_density(const VolumeEntry& entry, const std::filesystem::path& file,
                             const VdbReadOptions& reader, std::vector<std::string>& notes) {
    std::vector<std::string> names, unread;
    if (!entry.density.empty()) {
        names.push_back(entry.density);
    }
    auto grids = read_vdb(file, names, reader, &unread);
    if (!grids) return std::move(grids).error();
    if (grids->front().is_color) {
        return make_error(ErrorKind::bad_input, file.string(), in_quotes(entry.density),
                          "it holds colours, not a density", "name a grid of one float a voxel");
    }
    if (grids->size() > 1) {
        std::string list;
        for (const VdbGrid& g : *grids) {
            list += (list.empty() ? "" : ", ") + in_quotes(g.name);
        }
        return make_error(ErrorKind::bad_input, file.string(), "",
                          "it is not said which of its grids is the density: " + list,
                          "name one in a media file: {\"volumes\": [{\"density\": \"NAME\"}]}");
    }
    if (names.empty()) note_unused(entry, file, std::move(unread), notes);
    return std::move(grids->front());
}

Result<Volume> load_volume(const VolumeEntry& entry, const std::filesystem::path& file,
                           double metres_per_unit, const VdbReadOptions& reader,
                           Findings& findings) {
    std::vector<Diagnostic>& warnings = findings.warnings;
    auto read = read_density(entry, file, reader, findings.notes);
    if (!read) return std::move(read).error();
    warn_of_repairs(file, *read, warnings);
    Volume volume;
    volume.name = "volume " + in_quotes(file.filename().string());
    volume.density = std::move(read->scalar);
    SparseGrid<float>& grid = volume.density;
    const glm::dmat4 density_space = grid.to_scene;
    const glm::dmat4 placed = entry.transform * grid.to_scene;
    for (int column = 0; column < 4; ++column) {
        grid.to_scene[column] =
            glm::dvec4(metres_per_unit * glm::dvec3(placed[column]), column == 3 ? 1 : 0);
    }
    float densest = 0;
    for (float& value : grid.value) {
        value = static_cast<float>(static_cast<double>(value) * entry.scale);
        densest = std::max(densest, value);
    }
    volume.sigma_t = entry.sigma_t;
    volume.albedo = entry.albedo;
    volume.phase = entry.phase;
    volume.paper = entry.paper;
    Bounds bounds;
    include(bounds, grid);
    const glm::dvec3 farthest = glm::max(glm::abs(bounds.low), glm::abs(bounds.high));
    if (!(std::max({farthest.x, farthest.y, farthest.z}) <= media::kMaxVolumeCoordinate)) {
        return make_error(ErrorKind::bad_input, file.string(), "",
                          "it reaches beyond 1e9 m from the origin",
                          "check its transform and --metres-per-unit");
    }
    const double edge = std::max({glm::length(grid.to_scene[0]), glm::length(grid.to_scene[1]),
                                  glm::length(grid.to_scene[2])});
    const double extinction =
        static_cast<double>(std::max({entry.sigma_t.r, entry.sigma_t.g, entry.sigma_t.b})) *
        static_cast<double>(densest);
    if (!(extinction * edge <= media::kMaxVoxelDepth)) {
        return make_error(ErrorKind::bad_input, file.string(), "",
                          "a voxel of it holds more than a million mean free paths",
                          "lower sigma_t or scale, check the unit, or model it as a mesh");
    }
    if (Status status = load_albedo(entry, file, density_space, reader, volume, warnings);
        !status) {
        return std::move(status).error();
    }
    if (Status status = load_emission(entry, file, density_space, reader, volume, warnings);
        !status) {
        return std::move(status).error();
    }
    return volume;
}

// The middle where that is far from the world's origin, so that floats are precise there.
glm::dvec3 choose_origin(const std::vector<Volume>& volumes) {
    Bounds all;
    for (const Volume& volume : volumes) {
        include(all, volume.density);
    }
    constexpr double kNear = 16;  // radii: four bits of precision
    const glm::dvec3 middle = 0.5 * all.low + 0.5 * all.high;
    const double radius = 0.5 * glm::length(all.high - all.low);
    glm::dvec3 origin(0);
    for (int a = 0; a < 3; ++a) {
        origin[a] = std::abs(middle[a]) > kNear * radius ? middle[a] : 0;
    }
    return origin;
}

void move(std::vector<Volume>& volumes, glm::dvec3 origin) {
    for (Volume& volume : volumes) {
        volume.density.to_scene[3] -= glm::dvec4(origin, 0);
    }
}

struct LoadedVolumes {
    std::vector<Volume> volumes;
    Findings findings;
};

// The inside of meshes of the scene.
Result<Volume> load_body(const MediaFile& media, const VolumeEntry& entry, const Scene& scene,
                         std::vector<Diagnostic>& warnings) {
    const auto named_before = [&](const VolumeEntry& e) { return e.material == entry.material; };
    const auto first = std::ranges::find_if(media.volumes, named_before);
    if (first != media.volumes.end() && first->where != entry.where) {
        return make_error(ErrorKind::bad_input, media.file, entry.where,
                          "it names the same material as " + first->where, "keep one of them");
    }
    auto filled = fill_body(scene, entry.material, entry.voxels, media.file, entry.where);
    if (!filled) return std::move(filled).error();
    std::ranges::move(filled->warnings, std::back_inserter(warnings));
    Volume volume = std::move(filled->volume);
    volume.paper = entry.paper;
    volume.density.to_scene[3] += glm::dvec4(scene.origin, 0);
    return volume;
}

// In world space. `own`: the file of entries that name none.
Result<LoadedVolumes> load_all(const MediaFile& media, const std::vector<VolumeEntry>& entries,
                               const std::filesystem::path& own, double metres_per_unit,
                               const Scene& scene, const VdbReadOptions& reader) {
    LoadedVolumes loaded;
    for (const VolumeEntry& entry : entries) {
        auto volume = entry.material.empty()
                          ? load_volume(entry, entry.file.empty() ? own : entry.file,
                                        metres_per_unit, reader, loaded.findings)
                          : load_body(media, entry, scene, loaded.findings.warnings);
        if (!volume) return std::move(volume).error();
        std::optional<Volume> absorber = split_absorption(*volume);
        loaded.volumes.push_back(std::move(*volume));
        if (absorber) {
            loaded.volumes.push_back(std::move(*absorber));
        }
    }
    return loaded;
}

Error too_many(const std::string& file) {
    return make_error(ErrorKind::resource, file, "volumes",
                      "the scene has more than " + std::to_string(kMaxVolumes) +
                          " in all, of which an entry whose albedo is a grid counts as two",
                      "join grids that lie beside each other in one file");
}

}  // namespace

Result<std::vector<Diagnostic>> load_volumes(const MediaFile& media, double metres_per_unit,
                                             Scene& scene, const VdbReadOptions& reader,
                                             std::vector<std::string>* notes) {
    if (scene.volumes.size() + media.volumes.size() > kMaxVolumes) return too_many(media.file);
    for (const VolumeEntry& entry : media.volumes) {
        if (entry.file.empty() && entry.material.empty()) {
            return make_error(ErrorKind::bad_input, media.file, entry.where, "it names no file",
                              "give file, the OpenVDB file that holds the volume");
        }
    }
    auto loaded = load_all(media, media.volumes, {}, metres_per_unit, scene, reader);
    if (!loaded) return std::move(loaded).error();
    if (scene.volumes.size() + loaded->volumes.size() > kMaxVolumes) return too_many(media.file);
    const bool is_bare = scene.primitives.empty() && scene.volumes.empty();
    if (is_bare && !loaded->volumes.empty()) {
        scene.origin = choose_origin(loaded->volumes);
    }
    move(loaded->volumes, scene.origin);
    for (const VolumeEntry& entry : media.volumes) {
        if (!entry.material.empty()) remove_surface(scene, entry.material);
    }
    for (Volume& volume : loaded->volumes) {
        scene.volumes.push_back(std::move(volume));
    }
    Findings& findings = loaded->findings;
    if (notes != nullptr) std::ranges::move(findings.notes, std::back_inserter(*notes));
    return std::move(findings.warnings);
}

Result<ImportedScene> import_vdb(const std::filesystem::path& path, const MediaFile& media,
                                 double metres_per_unit, const VdbReadOptions& reader) {
    gltf::Report report;
    report.file = path.string();
    std::vector<VolumeEntry> entries = media.volumes;
    const bool is_described =
        std::any_of(entries.begin(), entries.end(), [&](const VolumeEntry& e) {
            std::error_code none;
            return e.material.empty() &&
                   (e.file.empty() || std::filesystem::equivalent(e.file, path, none));
        });
    ImportedScene imported;
    if (!is_described) {
        entries.insert(entries.begin(), VolumeEntry{});
        imported.warnings.push_back(make_warning(
            path.string(), "",
            "nothing says what it is made of: its density counts as extinction in 1/m, with an "
            "albedo of 0.99 and an isotropic phase function",
            "give --media with {\"volumes\": [{\"sigma_t\": [...], \"unit\": \"1/m\"}]}"));
    }
    if (entries.size() > kMaxVolumes) return too_many(media.file);
    Scene& scene = imported.scene;
    try {
        auto bytes = gltf::read_whole_file(path, "", report);
        if (!bytes) return report.take_error();
        gltf::Sha256 hash;
        hash.add(*bytes);
        scene.sha256 = hash.finish();
    } catch (const std::bad_alloc&) {
        return report.take_exception("make it smaller", "");
    }
    auto loaded = load_all(media, entries, path, metres_per_unit, scene, reader);
    if (!loaded) return std::move(loaded).error();
    if (loaded->volumes.size() > kMaxVolumes) return too_many(media.file);
    scene.source = path.string();
    scene.inputs = {path};
    scene.materials.resize(1);
    scene.origin = choose_origin(loaded->volumes);
    scene.volumes = std::move(loaded->volumes);
    move(scene.volumes, scene.origin);
    std::ranges::move(loaded->findings.warnings, std::back_inserter(imported.warnings));
    imported.notes = std::move(loaded->findings.notes);
    return imported;
}

}  // namespace opaline::formats
