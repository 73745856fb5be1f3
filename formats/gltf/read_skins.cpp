#include "formats/gltf/read_skins.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>

#include "formats/gltf/report.h"

namespace opaline::formats::gltf {

namespace {

bool is_index(const nlohmann::json& value) {
    return value.is_number_unsigned() && value.get<std::uint64_t>() < kNone;
}

}  // namespace

std::vector<Skin> read_skins(const nlohmann::json& root, Report& report) {
    std::vector<Skin> skins;
    const nlohmann::json* found = find_member(root, "skins");
    if (!found) return skins;
    for (const nlohmann::json& entry : *found) {
        const std::string where = "skin " + std::to_string(skins.size());
        Skin& skin = skins.emplace_back();
        const nlohmann::json* joints = find_member(entry, "joints");
        if (!joints || !joints->is_array() || joints->empty() ||
            !std::all_of(joints->begin(), joints->end(), is_index)) {
            report.error(where, "joints is not a list of nodes");
            continue;
        }
        skin.joints = joints->get<std::vector<std::uint32_t>>();
        if (const nlohmann::json* bind = find_member(entry, "inverseBindMatrices")) {
            if (is_index(*bind)) {
                skin.inverse_bind_matrices = bind->get<std::uint32_t>();
            } else {
                report.error(where, "inverseBindMatrices is not an accessor");
            }
        }
    }
    return skins;
}

}  // namespace opaline::formats::gltf
