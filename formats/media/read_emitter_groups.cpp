#include "formats/media/read_emitter_groups.h"

#include <map>
#include <nlohmann/json.hpp>
#include <utility>

#include "formats/media/fields.h"
#include "formats/opal/emitters.h"

namespace opaline::formats::media {
namespace {

using Json = nlohmann::json;
using gltf::in_quotes;

constexpr std::size_t kMostMembers = 4096;
constexpr const char* kExample = "give {\"emitters\": {\"GROUP\": [\"NAME\", \"NAME\"]}}";

// Names that no emitter of a file can have are faults here already.
bool is_name(const std::string& name) {
    for (const char c : name) {
        if (c >= 0 && c < ' ') return false;
    }
    return !name.empty() && name.size() <= kMaxEmitterName;
}

}  // namespace

std::vector<EmitterGroup> read_emitter_groups(const Json& root, const std::string& where,
                                              gltf::Report& report) {
    const auto found = root.find("emitters");
    if (found == root.end()) return {};
    const std::string at = place(where, "emitters");
    if (!found->is_object()) {
        report.error(at, "it is not an object", kExample);
        return {};
    }
    std::vector<EmitterGroup> groups;
    std::map<std::string, std::string> group_of;  // of each member
    const Fields fields{*found, at, report};
    for (const auto& entry : found->items()) {
        const std::string in_group = place(at, entry.key());
        if (!is_name(entry.key())) {
            report.error(in_group,
                         "a group's name is empty, has control characters or more than " +
                             std::to_string(kMaxEmitterName) + " bytes",
                         "give it another name");
            continue;
        }
        auto members = texts(fields, entry.key().c_str(), kMostMembers);
        if (!members) continue;
        for (const std::string& member : *members) {
            const auto [other, is_new] = group_of.try_emplace(member, entry.key());
            if (!is_new) {
                report.error(in_group,
                             "the emitter " + in_quotes(member) + " is in the group " +
                                 in_quotes(other->second) + " already",
                             "name it once");
            }
        }
        groups.push_back({entry.key(), std::move(*members)});
    }
    return groups;
}

}  // namespace opaline::formats::media
