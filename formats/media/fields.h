#pragma once

#include <array>
#include <cstdint>
#include <initializer_list>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "formats/gltf/report.h"
#include "formats/gltf/resources.h"
#include "formats/opal/rgb.h"

namespace opaline::formats::media {

/// Reads the members of one JSON object and reports every fault with the member's place.
struct Fields {
    const nlohmann::json& object;  ///< is_object()
    std::string where;             ///< "materials > Wax"
    gltf::Report& report;
};

/// "a, b, c".
std::string listed(std::span<const std::string_view> names);

/// The place of a member: "materials > Wax > sigma_a". Names lose their control characters.
std::string place(const std::string& where, std::string_view key);

bool has(const Fields& fields, const char* key);

/// An error at `key` if `other` is there too.
void refuse_both(const Fields& fields, const char* key, const char* other);

/// One error for each member whose name is not among `known`.
void refuse_unknown_keys(const Fields& fields, std::initializer_list<std::string_view> known);

/// Absent members give nothing; so do faulty ones, and then the report has an error. Bounds are
/// inclusive.
std::optional<double> number(const Fields& fields, const char* key, double least, double greatest);
void number(const Fields& fields, const char* key, double least, double greatest, float& value);
/// A whole number.
std::optional<std::uint32_t> count(const Fields& fields, const char* key, std::uint32_t least,
                                   std::uint32_t greatest);
/// Two numbers, as along x and z.
std::optional<std::array<double, 2>> pair(const Fields& fields, const char* key, double least,
                                          double greatest);
std::optional<Rgb> rgb(const Fields& fields, const char* key, double least, double greatest,
                       double scale = 1.0);
/// From `fewest` to `most` of them.
std::optional<std::vector<Rgb>> rgb_list(const Fields& fields, const char* key, std::size_t fewest,
                                         std::size_t most, double least, double greatest);
std::optional<std::string> text(const Fields& fields, const char* key);
/// A text, or a list of 1 to `most` of them.
std::optional<std::vector<std::string>> texts(const Fields& fields, const char* key,
                                              std::size_t most);
std::optional<bool> truth(const Fields& fields, const char* key);
/// A member that is an object; `example` is the remedy where it is something else.
std::optional<Fields> object_in(const Fields& fields, const char* key, const char* example);
/// The bytes of the file that a text names, see read_inside.
std::optional<gltf::Bytes> read_named_file(const Fields& fields, const char* key,
                                           gltf::Resources& resources);
/// The position of a text among `names`.
std::optional<std::size_t> choice(const Fields& fields, const char* key,
                                  std::initializer_list<std::string_view> names);
/// Whether `fidelity` is "paper".
bool is_paper(const Fields& fields);
/// What coefficients in the `unit` are multiplied with: 1000 for "1/mm", the default.
double per_metre(const Fields& fields);

}  // namespace opaline::formats::media
