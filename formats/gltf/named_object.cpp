#include "formats/gltf/named_object.h"

#include <algorithm>
#include <nlohmann/json.hpp>

namespace opaline::formats::gltf {

void NamedObject::number(const char* key, double& value) const {
    const auto found = object.find(key);
    if (found == object.end()) {
        return;
    }
    if (!found->is_number()) {
        report.error(where, std::string(key) + " is not a number", kExportAgain);
        return;
    }
    value = found->get<double>();
}

void NamedObject::color(const char* key, glm::dvec3& value) const {
    const auto found = object.find(key);
    if (found == object.end()) {
        return;
    }
    const bool good = found->is_array() && found->size() == 3 &&
                      std::all_of(found->begin(), found->end(),
                                  [](const nlohmann::json& band) { return band.is_number(); });
    if (!good) {
        report.error(where, std::string(key) + " is not an array of three numbers", kExportAgain);
        return;
    }
    value = {(*found)[0].get<double>(), (*found)[1].get<double>(), (*found)[2].get<double>()};
}

}  // namespace opaline::formats::gltf
