#include "formats/gltf/read_skins.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>

namespace opaline::formats::gltf {

namespace {

bool is_index(const nlohmann::json& value) {
    return value.is_number_unsigned() && value.get<std::uint64_t>() < kNone;
}

}  // namespace

std::vector<Skin> read_skins(const nlohmann::json& root, Report& report) {
    std::vector<Skin> skins;
    const auto found = root.find("skins");
    if (found == root.end()) {
        return skins;
    }
    for (const nlohmann::json& entry : *found) {
        const std::string where = "skin " + std::to_string(skins.size());
        Skin& skin = skins.emplace_back();
        const auto joints = entry.find("joints");
        if (joints == entry.end() || !joints->is_array() || joints->empty() ||
            !std::all_of(joints->begin(), joints->end(), is_index)) {
            report.error(where, "joints is not a list of nodes", kExportAgain);
            continue;
        }
        for (const nlohmann::json& joint : *joints) {
            skin.joints.push_back(joint.get<std::uint32_t>());
        }
        if (const auto bind = entry.find("inverseBindMatrices"); bind != entry.end()) {
            if (is_index(*bind)) {
                skin.inverse_bind_matrices = bind->get<std::uint32_t>();
            } else {
                report.error(where, "inverseBindMatrices is not an accessor", kExportAgain);
            }
        }
    }
    return skins;
}

}  // namespace opaline::formats::gltf
