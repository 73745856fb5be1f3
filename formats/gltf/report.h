#pragma once

#include <glm/glm.hpp>
#include <nlohmann/json_fwd.hpp>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "formats/gltf/limits.h"
#include "formats/opal/result.h"

namespace opaline::formats::gltf {

/// The remedy for what no program should write.
inline constexpr const char* kExportAgain = "export the file again";

/// Collects the faults of one file, so that the user sees all at once. Beyond kMaxDiagnostics of
/// either kind it only counts.
struct Report {
    std::string file;
    ErrorKind kind = ErrorKind::bad_input;
    std::vector<Diagnostic> errors, warnings;
    std::vector<std::string> notes;  ///< what a conforming file leaves to the reader
    std::size_t errors_left_out = 0, warnings_left_out = 0;

    void error(std::string where, std::string fault, std::string remedy = kExportAgain);
    /// error(), for `return report.fail(...)` out of what returns an optional.
    std::nullopt_t fail(std::string where, std::string fault, std::string remedy = kExportAgain);
    void warn(std::string where, std::string fault, std::string remedy = {});
    /// An error that is about limits or memory, not about a damaged file.
    void over_limit(std::string where, std::string fault, std::string remedy = {});

    bool failed() const { return !errors.empty(); }
    std::size_t error_count() const { return errors.size() + errors_left_out; }
    /// Precondition: failed().
    Error take_error();
    /// The exception that is being handled: memory, or what a library says of malformed input.
    Error take_exception(const char* if_large, const char* otherwise) const;
    std::vector<Diagnostic> take_warnings();
};

/// A name from the file in quotes, made safe for a terminal: no control characters, bounded.
std::string in_quotes(std::string_view name);

/// What a JSON library's exception says, without the library's own numbering: "at line 3, column 7:
/// ...". Bounded, and as safe as in_quotes.
std::string json_fault(std::string_view what);

/// "node 'Vase'", or "node 7" where it has no name.
std::string label(std::string_view kind, std::size_t index, std::string_view name);

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
