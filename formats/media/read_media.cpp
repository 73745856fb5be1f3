#include "formats/media/read_media.h"

#include <exception>
#include <new>
#include <nlohmann/json.hpp>
#include <set>
#include <utility>

#include "formats/gltf/check_json.h"
#include "formats/gltf/container.h"
#include "formats/gltf/resources.h"
#include "formats/media/fields.h"
#include "formats/media/read_material.h"
#include "formats/media/read_volume.h"

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
    if (!gltf::within_json_bounds(text, report)) {
        return std::nullopt;
    }
    std::vector<std::set<std::string>> open;
    try {
        Json root = Json::parse(text, refuse_twice(open, report));
        return report.failed() ? std::nullopt : std::optional(std::move(root));
    } catch (const Json::exception& problem) {
        report.error("JSON", "it cannot be parsed " + gltf::json_fault(problem.what()),
                     "correct it where the message says");
        return std::nullopt;
    }
}

void read_volumes(const Json& root, const std::string& where, Resources& resources,
                  MediaFile& media, Report& report) {
    const auto volumes = root.find("volumes");
    if (volumes == root.end()) {
        return;
    }
    const std::string at = media::place(where, "volumes");
    if (!volumes->is_array()) {
        report.error(at, "it is not an array", "give {\"volumes\": [{\"file\": \"NAME.vdb\"}]}");
        return;
    }
    if (volumes->size() > kMaxVolumes) {
        report.error(at, "there are more than " + std::to_string(kMaxVolumes),
                     "join grids that lie beside each other in one file");
        return;
    }
    for (std::size_t i = 0; i < volumes->size(); ++i) {
        auto volume = media::read_volume((*volumes)[i], media::place(at, std::to_string(i)),
                                         resources, report);
        if (volume) {
            media.volumes.push_back(std::move(*volume));
        }
    }
}

void read_root(const Json& root, const std::string& where, Resources& resources, MediaFile& media,
               Report& report) {
    if (!root.is_object()) {
        report.error(where, "the outermost value is not an object", "give {\"materials\": {...}}");
        return;
    }
    media::refuse_unknown_keys({root, where, report}, {"materials", "volumes", "clouds"});
    if (root.contains("clouds")) {
        report.error(media::place(where, "clouds"), "they are not supported yet", "leave them out");
    }
    read_volumes(root, where, resources, media, report);
    const std::string at = media::place(where, "materials");
    const auto materials = root.find("materials");
    if (materials == root.end() && root.contains("volumes")) {
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
Result<MediaFile> guarded(const std::filesystem::path& path, const Read& read) {
    Report report;
    report.file = path.string();
    try {
        MediaFile media;
        media.file = report.file;
        Resources resources;
        resources.folder = path.parent_path();
        read(resources, media, report);
        if (report.failed()) {
            return report.take_error();
        }
        media.inputs = std::move(resources.inputs);
        media.sha256 = resources.hash.finish();
        return media;
    } catch (const std::bad_alloc&) {
        return make_error(ErrorKind::resource, report.file, "", "it does not fit into memory",
                          "make it smaller");
    } catch (const std::exception& problem) {
        return make_error(ErrorKind::bad_input, report.file, "",
                          "it cannot be read: " + gltf::json_fault(problem.what()),
                          "correct the file");
    }
}

}  // namespace

Result<MediaFile> read_media(const std::filesystem::path& path) {
    return guarded(path, [&](Resources& resources, MediaFile& media, Report& report) {
        auto bytes = gltf::read_whole_file(path, "", report);
        if (!bytes) {
            return;
        }
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
                              const std::string& where) {
    return guarded(file, [&](Resources& resources, MediaFile& media, Report& report) {
        if (const auto root = parse_strict(json, report)) {
            read_root(*root, where, resources, media, report);
        }
    });
}

}  // namespace opaline::formats
