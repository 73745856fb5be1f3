#include "formats/media/fields.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

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

std::string listed(std::initializer_list<std::string_view> names) {
    std::string list;
    for (const std::string_view name : names) {
        list += (list.empty() ? "" : ", ") + std::string(name);
    }
    return list;
}

const Json* find(const Fields& fields, const char* key) {
    const auto found = fields.object.find(key);
    return found == fields.object.end() ? nullptr : &*found;
}

void wrong(const Fields& fields, const char* key, const Json& value, const std::string& expected) {
    fields.report.error(place(fields.where, key),
                        "it is " + shown(value) + ", expected " + expected,
                        "correct it or leave it out");
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

bool is_rgb(const Json& value, double least, double greatest) {
    return are_within(value, 3, least, greatest);
}

Rgb to_rgb(const Json& value, double scale) {
    const auto band = [&](std::size_t i) {
        return static_cast<float>(scale * value[i].get<double>());
    };
    return {band(0), band(1), band(2)};
}

}  // namespace

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
                                "known are: " + listed(known));
        }
    }
}

std::optional<double> number(const Fields& fields, const char* key, double least, double greatest) {
    const Json* value = find(fields, key);
    if (!value) {
        return std::nullopt;
    }
    if (!is_within(*value, least, greatest)) {
        wrong(fields, key, *value, "a number " + range(least, greatest));
        return std::nullopt;
    }
    return value->get<double>();
}

std::optional<std::uint32_t> count(const Fields& fields, const char* key, std::uint32_t least,
                                   std::uint32_t greatest) {
    const Json* value = find(fields, key);
    if (!value) {
        return std::nullopt;
    }
    if (!is_within(*value, least, greatest) ||
        value->get<double>() != std::floor(value->get<double>())) {
        wrong(fields, key, *value,
              "a whole number from " + std::to_string(least) + " to " + std::to_string(greatest));
        return std::nullopt;
    }
    return static_cast<std::uint32_t>(value->get<double>());
}

std::optional<std::array<double, 2>> pair(const Fields& fields, const char* key, double least,
                                          double greatest) {
    const Json* value = find(fields, key);
    if (!value) {
        return std::nullopt;
    }
    if (!are_within(*value, 2, least, greatest)) {
        wrong(fields, key, *value, "two numbers [x, z], each " + range(least, greatest));
        return std::nullopt;
    }
    return std::array{(*value)[0].get<double>(), (*value)[1].get<double>()};
}

std::optional<Rgb> rgb(const Fields& fields, const char* key, double least, double greatest,
                       double scale) {
    const Json* value = find(fields, key);
    if (!value) {
        return std::nullopt;
    }
    if (!is_rgb(*value, least, greatest)) {
        wrong(fields, key, *value,
              "three numbers [red, green, blue], each " + range(least, greatest));
        return std::nullopt;
    }
    return to_rgb(*value, scale);
}

std::optional<std::vector<Rgb>> rgb_list(const Fields& fields, const char* key, std::size_t fewest,
                                         std::size_t most, double least, double greatest) {
    const Json* value = find(fields, key);
    if (!value) {
        return std::nullopt;
    }
    const auto good = [&](const Json& color) { return is_rgb(color, least, greatest); };
    if (!value->is_array() || value->size() < fewest || value->size() > most ||
        !std::all_of(value->begin(), value->end(), good)) {
        wrong(fields, key, *value,
              std::to_string(fewest) + " to " + std::to_string(most) +
                  " colours [red, green, blue], each number " + range(least, greatest));
        return std::nullopt;
    }
    std::vector<Rgb> colors;
    for (const Json& color : *value) {
        colors.push_back(to_rgb(color, 1));
    }
    return colors;
}

std::optional<std::string> text(const Fields& fields, const char* key) {
    const Json* value = find(fields, key);
    if (!value) {
        return std::nullopt;
    }
    if (!value->is_string()) {
        wrong(fields, key, *value, "a text");
        return std::nullopt;
    }
    return value->get<std::string>();
}

std::optional<std::vector<std::string>> texts(const Fields& fields, const char* key,
                                              std::size_t most) {
    const Json* value = find(fields, key);
    if (!value) {
        return std::nullopt;
    }
    if (value->is_string()) {
        return std::vector{value->get<std::string>()};
    }
    const auto is_text = [](const Json& one) { return one.is_string(); };
    if (!value->is_array() || value->empty() || value->size() > most ||
        !std::all_of(value->begin(), value->end(), is_text)) {
        wrong(fields, key, *value, "a text or a list of 1 to " + std::to_string(most) + " texts");
        return std::nullopt;
    }
    return value->get<std::vector<std::string>>();
}

std::optional<bool> truth(const Fields& fields, const char* key) {
    const Json* value = find(fields, key);
    if (!value) {
        return std::nullopt;
    }
    if (!value->is_boolean()) {
        wrong(fields, key, *value, "true or false");
        return std::nullopt;
    }
    return value->get<bool>();
}

std::optional<gltf::Bytes> read_named_file(const Fields& fields, const char* key,
                                           gltf::Resources& resources) {
    const auto name = text(fields, key);
    return name ? gltf::read_inside(resources, *name, place(fields.where, key), fields.report)
                : std::nullopt;
}

std::optional<std::size_t> choice(const Fields& fields, const char* key,
                                  std::initializer_list<std::string_view> names) {
    const Json* value = find(fields, key);
    if (!value) {
        return std::nullopt;
    }
    const auto found = value->is_string() ? std::find(names.begin(), names.end(),
                                                      value->get_ref<const std::string&>())
                                          : names.end();
    if (found == names.end()) {
        wrong(fields, key, *value, "one of " + listed(names));
        return std::nullopt;
    }
    return static_cast<std::size_t>(found - names.begin());
}

}  // namespace opaline::formats::media
