#include "formats/media/fields.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <type_traits>

#include "formats/gltf/report.h"

namespace opaline::formats::media {

namespace {

using Json = nlohmann::json;
using gltf::in_quotes;

// As in the file, bounded.
std::string shown(const Json& value) {
    return in_quotes(value.dump(-1, ' ', true, Json::error_handler_t::replace));
}

std::string plain(double value) {
    return Json(value).dump();
}

const Json* find(const Fields& fields, const char* key) {
    const auto found = fields.object.find(key);
    return found == fields.object.end() ? nullptr : &*found;
}

// The member as convert() makes it, if it is there and right; else an error says what is expected.
template <class IsRight, class Convert>
auto take(const Fields& fields, const char* key, const std::string& expected,
          const IsRight& is_right, const Convert& convert)
    -> std::optional<std::decay_t<decltype(convert(Json()))>> {
    const Json* value = find(fields, key);
    if (!value) return std::nullopt;
    if (!is_right(*value)) {
        return fields.report.fail(place(fields.where, key),
                                  "it is " + shown(*value) + ", expected " + expected,
                                  "correct it or leave it out");
    }
    return convert(*value);
}

template <class T>
T value_of(const Json& value) {
    return value.get<T>();
}

// NaN fails both comparisons.
bool is_within(const Json& value, double least, double greatest) {
    return value.is_number() && value.get<double>() >= least && value.get<double>() <= greatest;
}

std::string range(double least, double greatest) {
    return "from " + plain(least) + " to " + plain(greatest);
}

bool are_within(const Json& value, std::size_t size, double least, double greatest) {
    return value.is_array() && value.size() == size &&
           std::all_of(value.begin(), value.end(),
                       [&](const Json& one) { return is_within(one, least, greatest); });
}

Rgb to_rgb(const Json& value, double scale) {
    const auto band = [&](std::size_t i) {
        return static_cast<float>(scale * value[i].get<double>());
    };
    return {band(0), band(1), band(2)};
}

}  // namespace

std::string listed(std::span<const std::string_view> names) {
    std::string list;
    for (const std::string_view name : names) {
        list += (list.empty() ? "" : ", ") + std::string(name);
    }
    return list;
}

std::string place(const std::string& where, std::string_view key) {
    const std::string quoted = in_quotes(key);
    const std::string name = quoted.substr(1, quoted.size() - 2);
    return where.empty() ? name : where + " > " + name;
}

bool has(const Fields& fields, const char* key) {
    return find(fields, key) != nullptr;
}

void refuse_both(const Fields& fields, const char* key, const char* other) {
    if (has(fields, key) && has(fields, other)) {
        fields.report.error(place(fields.where, key),
                            std::string("it contradicts ") + other + ", which is given too",
                            "keep one of them");
    }
}

void refuse_unknown_keys(const Fields& fields, std::initializer_list<std::string_view> known) {
    for (const auto& [key, value] : fields.object.items()) {
        if (std::find(known.begin(), known.end(), key) == known.end()) {
            fields.report.error(place(fields.where, key), "there is no such key here",
                                "known are: " + listed({known.begin(), known.size()}));
        }
    }
}

std::optional<double> number(const Fields& fields, const char* key, double least, double greatest) {
    return take(
        fields, key, "a number " + range(least, greatest),
        [&](const Json& value) { return is_within(value, least, greatest); }, value_of<double>);
}

void number(const Fields& fields, const char* key, double least, double greatest, float& value) {
    if (const auto found = number(fields, key, least, greatest)) {
        value = static_cast<float>(*found);
    }
}

std::optional<std::uint32_t> count(const Fields& fields, const char* key, std::uint32_t least,
                                   std::uint32_t greatest) {
    return take(
        fields, key,
        "a whole number from " + std::to_string(least) + " to " + std::to_string(greatest),
        [&](const Json& value) {
            return is_within(value, least, greatest) &&
                   value.get<double>() == std::floor(value.get<double>());
        },
        [](const Json& value) { return static_cast<std::uint32_t>(value.get<double>()); });
}

std::optional<std::array<double, 2>> pair(const Fields& fields, const char* key, double least,
                                          double greatest) {
    return take(
        fields, key, "two numbers [x, z], each " + range(least, greatest),
        [&](const Json& value) { return are_within(value, 2, least, greatest); },
        value_of<std::array<double, 2>>);
}

std::optional<Rgb> rgb(const Fields& fields, const char* key, double least, double greatest,
                       double scale) {
    return take(
        fields, key, "three numbers [red, green, blue], each " + range(least, greatest),
        [&](const Json& value) { return are_within(value, 3, least, greatest); },
        [&](const Json& value) { return to_rgb(value, scale); });
}

std::optional<std::vector<Rgb>> rgb_list(const Fields& fields, const char* key, std::size_t fewest,
                                         std::size_t most, double least, double greatest) {
    const auto is_color = [&](const Json& color) { return are_within(color, 3, least, greatest); };
    return take(
        fields, key,
        std::to_string(fewest) + " to " + std::to_string(most) +
            " colours [red, green, blue], each number " + range(least, greatest),
        [&](const Json& value) {
            return value.is_array() && value.size() >= fewest && value.size() <= most &&
                   std::all_of(value.begin(), value.end(), is_color);
        },
        [](const Json& value) {
            std::vector<Rgb> colors;
            for (const Json& color : value) {
                colors.push_back(to_rgb(color, 1));
            }
            return colors;
        });
}

std::optional<std::string> text(const Fields& fields, const char* key) {
    return take(
        fields, key, "a text", [](const Json& value) { return value.is_string(); },
        value_of<std::string>);
}

std::optional<std::vector<std::string>> texts(const Fields& fields, const char* key,
                                              std::size_t most) {
    return take(
        fields, key, "a text or a list of 1 to " + std::to_string(most) + " texts",
        [&](const Json& value) {
            return value.is_string() || (gltf::is_array_of(value, &Json::is_string) &&
                                         !value.empty() && value.size() <= most);
        },
        [](const Json& value) {
            return value.is_string() ? std::vector{value.get<std::string>()}
                                     : value.get<std::vector<std::string>>();
        });
}

std::optional<bool> truth(const Fields& fields, const char* key) {
    return take(
        fields, key, "true or false", [](const Json& value) { return value.is_boolean(); },
        value_of<bool>);
}

std::optional<Fields> object_in(const Fields& fields, const char* key, const char* example) {
    const Json* value = find(fields, key);
    if (value && !value->is_object()) {
        fields.report.error(place(fields.where, key), "it is not an object", example);
    }
    return value && value->is_object()
               ? std::optional<Fields>({*value, place(fields.where, key), fields.report})
               : std::nullopt;
}

std::optional<gltf::Bytes> read_named_file(const Fields& fields, const char* key,
                                           gltf::Resources& resources) {
    const auto name = text(fields, key);
    return name ? gltf::read_inside(resources, *name, place(fields.where, key), fields.report)
                : std::nullopt;
}

std::optional<std::size_t> choice(const Fields& fields, const char* key,
                                  std::initializer_list<std::string_view> names) {
    const auto position_of = [&](const Json& value) {
        const auto* const found = value.is_string() ? std::find(names.begin(), names.end(),
                                                                value.get_ref<const std::string&>())
                                                    : names.end();
        return static_cast<std::size_t>(found - names.begin());
    };
    return take(
        fields, key, "one of " + listed({names.begin(), names.size()}),
        [&](const Json& value) { return position_of(value) < names.size(); }, position_of);
}

bool is_paper(const Fields& fields) {
    return choice(fields, "fidelity", {"physical", "paper"}).value_or(0) == 1;
}

double per_metre(const Fields& fields) {
    return choice(fields, "unit", {"1/mm", "1/m"}).value_or(0) == 0 ? 1000 : 1;
}

}  // namespace opaline::formats::media
