#include "formats/gltf/named_object.h"

#include <algorithm>
#include <functional>
#include <nlohmann/json.hpp>

namespace opaline::formats::gltf {

namespace {

using Json = nlohmann::json;

template <int kSize>
void read_numbers(const NamedObject& from, const char* key, glm::vec<kSize, double>& value) {
    const Json* found = find_member(from.object, key);
    if (!found) {
        return;
    }
    if (!is_array_of(*found, &Json::is_number, kSize)) {
        from.report.error(from.where, std::string(key) + " is not an array of " +
                                          (kSize == 3 ? "three" : "four") + " numbers");
        return;
    }
    for (int i = 0; i < kSize; ++i) {
        value[i] = (*found)[static_cast<std::size_t>(i)].get<double>();
    }
}

}  // namespace

const Json* find_member(const Json& object, const char* key) {
    const auto found = object.find(key);
    return found == object.end() ? nullptr : &*found;
}

const Json* find_extension(const Json& object, const char* name) {
    const Json* extensions = find_member(object, "extensions");
    return extensions ? find_member(*extensions, name) : nullptr;
}

std::string name_in(const Json& object, const char* key) {
    const Json* name = find_member(object, key);
    return name && name->is_string() ? name->get<std::string>() : std::string();
}

std::optional<std::uint64_t> whole_in(const Json& object, const char* key, std::uint64_t most) {
    const Json* found = find_member(object, key);
    const bool is_right =
        found && found->is_number_unsigned() && found->get<std::uint64_t>() <= most;
    return is_right ? std::optional(found->get<std::uint64_t>()) : std::nullopt;
}

bool is_array_of(const Json& value, bool (Json::*is_kind)() const noexcept, std::size_t size) {
    return value.is_array() && (size == 0 || value.size() == size) &&
           std::all_of(value.begin(), value.end(), std::mem_fn(is_kind));
}

std::optional<NamedObject> NamedObject::member(const char* key) const {
    const Json* found = find_member(object, key);
    if (found && !found->is_object()) {
        report.error(where, std::string(key) + " is not an object");
        found = nullptr;
    }
    const std::string within = where.empty() ? key : where + " > " + key;
    return found ? std::optional(NamedObject{*found, within, report}) : std::nullopt;
}

NamedObject NamedObject::extensions() const {
    static const Json kNothing = Json::object();
    const auto found = member("extensions");
    return {found ? found->object : kNothing, where, report};
}

std::vector<std::string> NamedObject::keys() const {
    std::vector<std::string> keys;
    for (const auto& [key, value] : object.items()) {
        keys.push_back(key);
    }
    return keys;
}

void NamedObject::number(const char* key, double& value) const {
    const Json* found = find_member(object, key);
    if (found && !found->is_number()) {
        report.error(where, std::string(key) + " is not a number");
    } else if (found) {
        value = found->get<double>();
    }
}

void NamedObject::color(const char* key, glm::dvec3& value) const {
    read_numbers<3>(*this, key, value);
}

void NamedObject::color(const char* key, glm::dvec4& value) const {
    read_numbers<4>(*this, key, value);
}

}  // namespace opaline::formats::gltf
