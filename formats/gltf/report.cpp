#include "formats/gltf/report.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <functional>
#include <new>
#include <stdexcept>
#include <utility>

namespace opaline::formats::gltf {
namespace {

using Json = nlohmann::json;

template <int kSize>
void read_numbers(const NamedObject& from, const char* key, glm::vec<kSize, double>& value) {
    const Json* found = find_member(from.object, key);
    if (!found) return;
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

void Report::error(std::string where, std::string fault, std::string remedy) {
    if (errors.size() >= kMaxDiagnostics) {
        ++errors_left_out;
        return;
    }
    errors.push_back(
        {Diagnostic::Severity::error, file, std::move(where), std::move(fault), std::move(remedy)});
}

std::nullopt_t Report::fail(std::string where, std::string fault, std::string remedy) {
    error(std::move(where), std::move(fault), std::move(remedy));
    return std::nullopt;
}

void Report::warn(std::string where, std::string fault, std::string remedy) {
    if (warnings.size() >= kMaxDiagnostics) {
        ++warnings_left_out;
        return;
    }
    warnings.push_back(make_warning(file, std::move(where), std::move(fault), std::move(remedy)));
}

void Report::over_limit(std::string where, std::string fault, std::string remedy) {
    if (errors.empty()) {
        kind = ErrorKind::resource;  // the first fault decides the exit code
    }
    error(std::move(where), std::move(fault), std::move(remedy));
}

Error Report::take_error() {
    if (errors_left_out > 0) {
        errors.push_back({Diagnostic::Severity::error, file, "",
                          std::to_string(errors_left_out) + " more errors are left out", ""});
    }
    return {kind, std::move(errors)};
}

Error Report::take_exception(const char* if_large, const char* otherwise) const {
    std::string what;
    try {
        throw;
    } catch (const std::bad_alloc&) {
    } catch (const std::length_error&) {
    } catch (const std::exception& problem) {
        what = "it cannot be read: " + json_fault(problem.what());
    }
    return what.empty()
               ? make_error(ErrorKind::resource, file, "", "it does not fit into memory", if_large)
               : make_error(ErrorKind::bad_input, file, "", what, otherwise);
}

std::vector<Diagnostic> Report::take_warnings() {
    if (warnings_left_out > 0) {
        warnings.push_back(make_warning(
            file, "", std::to_string(warnings_left_out) + " more warnings are left out"));
    }
    return std::move(warnings);
}

std::string in_quotes(std::string_view name) {
    constexpr std::size_t kLongest = 80;
    std::string text = "'";
    for (const char c : name.substr(0, kLongest)) {
        const auto byte = static_cast<unsigned char>(c);
        text += byte < 0x20 || byte == 0x7f ? '?' : c;
    }
    return text + (name.size() > kLongest ? "...'" : "'");
}

std::string json_fault(std::string_view what) {
    if (what.starts_with("[json.exception.")) {
        what.remove_prefix(std::min(what.find("] "), what.size() - 2) + 2);
    }
    constexpr std::string_view kParse = "parse error ";
    if (what.starts_with(kParse)) {
        what.remove_prefix(kParse.size());
    }
    constexpr std::size_t kLongest = 200;
    std::string text;
    for (const char c : what.substr(0, kLongest)) {
        const auto byte = static_cast<unsigned char>(c);
        text += byte < 0x20 || byte == 0x7f ? '?' : c;
    }
    return text + (what.size() > kLongest ? "..." : "");
}

std::string label(std::string_view kind, std::size_t index, std::string_view name) {
    std::string text(kind);
    text += ' ';
    return text + (name.empty() ? std::to_string(index) : in_quotes(name));
}

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
