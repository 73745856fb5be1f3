#include "formats/media/read_media.h"

#include <exception>
#include <nlohmann/json.hpp>
#include <set>
#include <utility>

#include "formats/gltf/check_json.h"
#include "formats/gltf/container.h"
#include "formats/gltf/resources.h"
#include "formats/media/fields.h"
#include "formats/media/read_cloud.h"
#include "formats/media/read_emitter_groups.h"
#include "formats/media/read_material.h"
#include "formats/media/read_volume.h"
#include "formats/opal/clouds.h"

namespace opaline::formats {

namespace {

using Json = nlohmann::json;
using gltf::in_quotes;
using gltf::Report;
using gltf::Resources;

/// The parser keeps the last of two members with one name and says nothing: that would drop what
/// the user wrote.
Json::parser_callback_t refuse_twice(std::vector<std::set<std::string>>& open, Report& report) {
    return [&open, &report](int, Json::parse_event_t event, Json& parsed) {
        if (event == Json::parse_event_t::object_start) {
            open.emplace_back();
        } else if (event == Json::parse_event_t::object_end) {
            open.pop_back();
        } else if (event == Json::parse_event_t::key &&
                   !open.back().insert(parsed.get<std::string>()).second) {
            report.error("JSON",
                         "the key " + in_quotes(parsed.get_ref<const std::string&>()) +
                             " stands twice in one object",
                         "keep one of them");
        }
        return true;
    };
}

std::optional<Json> parse_strict(std::string_view text, Report& report) {
    if (!gltf::within_json_bounds(text, report)) return std::nullopt;
    std::vector<std::set<std::string>> open;
    try {
        Json root = Json::parse(text, refuse_twice(open, report));
        return report.failed() ? std::nullopt : std::optional(std::move(root));
    } catch (const Json::exception& problem) {
        return report.fail("JSON", "it cannot be parsed " + gltf::json_fault(problem.what()),
                           "correct it where the message says");
    }
}

/// What a root key that holds a list is like, for messages.
struct List {
    const char *key, *example;
    std::size_t most;
    const char *too_many, *remedy;
};

/// Calls read(entry, index, where) for each entry of a list of the root.
template <class Read>
void read_list(const Json& root, const std::string& where, const List& list, Report& report,
               const Read& read) {
    const auto found = root.find(list.key);
    if (found == root.end()) return;
    const std::string at = media::place(where, list.key);
    if (!found->is_array()) {
        report.error(at, "it is not an array", list.example);
        return;
    }
    if (found->size() > list.most) {
        report.error(at, list.too_many, list.remedy);
        return;
    }
    for (std::size_t i = 0; i < found->size(); ++i) {
        read((*found)[i], i, media::place(at, std::to_string(i)));
    }
}

void read_volumes(const Json& root, const std::string& where, Resources& resources,
                  MediaFile& media, Report& report) {
    static_assert(kMaxVolumes == 16);
    const List list{"volumes", "give {\"volumes\": [{\"file\": \"NAME.vdb\"}]}", kMaxVolumes,
                    "there are more than 16", "join grids that lie beside each other in one file"};
    read_list(root, where, list, report,
              [&](const Json& entry, std::size_t, const std::string& at) {
                  if (auto volume = media::read_volume(entry, at, resources, report)) {
                      media.volumes.push_back(std::move(*volume));
                  }
              });
}

void read_clouds(const Json& root, const std::string& where, Resources& resources, MediaFile& media,
                 Report& report) {
    static_assert(kMaxLayers == 1);
    const List list{"clouds", "give {\"clouds\": [{\"procedural\": {\"type\": \"cellular\"}}]}",
                    kMaxLayers, "there is more than one layer, and this version simulates one",
                    "keep one of them"};
    read_list(root, where, list, report,
              [&](const Json& entry, std::size_t index, const std::string& at) {
                  if (auto cloud = media::read_cloud(entry, index, at, resources, report)) {
                      media.clouds.push_back(std::move(*cloud));
                  }
              });
}

void read_root(const Json& root, const std::string& where, Resources& resources, MediaFile& media,
               Report& report) {
    if (!root.is_object()) {
        report.error(where, "the outermost value is not an object", "give {\"materials\": {...}}");
        return;
    }
    media::refuse_unknown_keys({root, where, report},
                               {"materials", "volumes", "clouds", "emitters"});
    read_volumes(root, where, resources, media, report);
    read_clouds(root, where, resources, media, report);
    media.emitter_groups = media::read_emitter_groups(root, where, report);
    const std::string at = media::place(where, "materials");
    const auto materials = root.find("materials");
    if (materials == root.end() &&
        (root.contains("volumes") || root.contains("clouds") || root.contains("emitters"))) {
        return;
    }
    if (materials == root.end() || !materials->is_object()) {
        report.error(at, materials == root.end() ? "it is missing" : "it is not an object",
                     "give {\"materials\": {\"NAME\": {...}}}");
        return;
    }
    for (const auto& [name, entry] : materials->items()) {
        media.materials.push_back(
            media::read_material(name, entry, media::place(at, name), resources, report));
    }
}

/// Turns what a library throws into a message.
template <class Read>
Result<MediaFile> guarded(const std::filesystem::path& path,
                          std::span<const std::filesystem::path> allowed_folders,
                          const Read& read) {
    Report report;
    report.file = path.string();
    try {
        MediaFile media;
        media.file = report.file;
        Resources resources;
        resources.folder = path.parent_path();
        resources.allowed.assign(allowed_folders.begin(), allowed_folders.end());
        read(resources, media, report);
        if (report.failed()) return report.take_error();
        media.inputs = std::move(resources.inputs);
        media.sha256 = resources.hash.finish();
        return media;
    } catch (const std::exception&) {
        return report.take_exception("make it smaller", "correct the file");
    }
}

}  // namespace

Result<MediaFile> read_media(const std::filesystem::path& path,
                             std::span<const std::filesystem::path> allowed_folders) {
    return guarded(
        path, allowed_folders, [&](Resources& resources, MediaFile& media, Report& report) {
            auto bytes = gltf::read_whole_file(path, "", report);
            if (!bytes) return;
            resources.inputs.push_back(path);
            const gltf::Bytes kept = resources.keep(std::move(*bytes));
            resources.hash.add(kept);
            const std::string_view text(reinterpret_cast<const char*>(kept.data()), kept.size());
            if (const auto root = parse_strict(text, report)) {
                read_root(*root, "", resources, media, report);
            }
        });
}

Result<MediaFile> parse_media(std::string_view json, const std::filesystem::path& file,
                              const std::string& where,
                              std::span<const std::filesystem::path> allowed_folders) {
    return guarded(file, allowed_folders,
                   [&](Resources& resources, MediaFile& media, Report& report) {
                       if (const auto root = parse_strict(json, report)) {
                           read_root(*root, where, resources, media, report);
                       }
                   });
}

}  // namespace opaline::formats
