#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "formats/gltf/report.h"

namespace opaline::formats::gltf {

/// A member; null where it is missing, and where `object` is none.
const nlohmann::json* find_member(const nlohmann::json& object, const char* key);
/// The extension `name` of an object, of whatever type; null where it has none.
const nlohmann::json* find_extension(const nlohmann::json& object, const char* name);
/// The member `name` where it is a text, else nothing of it.
std::string name_in(const nlohmann::json& object, const char* key = "name");
/// A member that is a whole number, at most `most`; nothing where it is missing or something else.
std::optional<std::uint64_t> whole_in(const nlohmann::json& object, const char* key,
                                      std::uint64_t most = UINT64_MAX);
/// Whether it is an array whose elements all are of a kind, and `size` of them (0: any number).
bool is_array_of(const nlohmann::json& value, bool (nlohmann::json::*is_kind)() const noexcept,
                 std::size_t size = 0);

/// An object of the file and how messages name it. Members that are missing leave the value as it
/// is; of another type, they leave an error in the report too.
struct NamedObject {
    const nlohmann::json& object;
    std::string where;  ///< "material 'Wax' > KHR_materials_volume"
    Report& report;

    /// A member that is an object; nothing where it is missing, and, with an error, where it is
    /// none.
    std::optional<NamedObject> member(const char* key) const;
    /// The object of its extensions, which messages name as this object; empty where it has none.
    NamedObject extensions() const;
    std::vector<std::string> keys() const;
    void number(const char* key, double& value) const;
    void color(const char* key, glm::dvec3& value) const;  ///< an array of three numbers
    void color(const char* key, glm::dvec4& value) const;  ///< of four
};

}  // namespace opaline::formats::gltf
