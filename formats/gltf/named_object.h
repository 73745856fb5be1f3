#pragma once

#include <glm/glm.hpp>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "formats/gltf/report.h"

namespace opaline::formats::gltf {

/// An object of the file and how messages name it. Members that are missing leave the value as it
/// is; of another type, they leave an error in the report too.
struct NamedObject {
    const nlohmann::json& object;
    std::string where;  ///< "material 'Wax' > KHR_materials_volume"
    Report& report;

    void number(const char* key, double& value) const;
    void color(const char* key, glm::dvec3& value) const;  ///< an array of three numbers
};

}  // namespace opaline::formats::gltf
