#include "bake/cli/option_values.h"

#include <fmt/core.h>

#include <charconv>
#include <cmath>
#include <optional>
#include <string_view>

#include "bake/cli/messages.h"

namespace opaline::cli {
namespace {

template <class T>
std::optional<T> parse_whole(std::string_view text) {
    T value{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    const bool is_whole = error == std::errc{} && end == text.data() + text.size();
    return is_whole ? std::optional(value) : std::nullopt;
}

CLI::Validator make_check(std::function<std::string(std::string&)> check) {
    return CLI::Validator(std::move(check), "");  // no text of its own in --help
}

}  // namespace

CLI::Validator real_number(double least, double most) {
    return make_check([=](std::string& text) {
        const auto value = parse_whole<double>(text);
        if (value && std::isfinite(*value) && *value >= least && *value <= most) {
            return std::string();
        }
        return fmt::format("'{}' is not a number from {:g} to {:g}", shorten(text), least, most);
    });
}

CLI::Validator number_above(double bound, double most) {
    return make_check([=](std::string& text) {
        const auto value = parse_whole<double>(text);
        if (value && std::isfinite(*value) && *value > bound && *value <= most) {
            return std::string();
        }
        return fmt::format("'{}' is not a number above {:g} and up to {:g}", shorten(text), bound,
                           most);
    });
}

CLI::Validator whole_number(std::uint64_t least, std::uint64_t most) {
    return make_check([=](std::string& text) {
        const auto value = parse_whole<std::uint64_t>(text);
        if (value && *value >= least && *value <= most) {
            text = std::to_string(*value);  // leading zeros would make it octal
            return std::string();
        }
        return fmt::format("'{}' is not a whole number from {} to {}", shorten(text), least, most);
    });
}

CLI::Validator file_name() {
    return make_check([](std::string& text) {
        return text.empty() ? std::string("the name is empty; give the path of a file") : "";
    });
}

namespace detail {

CLI::Validator one_of(std::vector<std::pair<std::string, std::string>> names) {
    return make_check([names = std::move(names)](std::string& text) {
        std::string list;
        for (const auto& [name, value] : names) {
            if (text == name) {
                text = value;
                return std::string();
            }
            list += (list.empty() ? "" : ", ") + name;
        }
        return fmt::format("'{}' is not one of {}", shorten(text), list);
    });
}

}  // namespace detail
}  // namespace opaline::cli
