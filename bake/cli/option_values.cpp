#include "bake/cli/option_values.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <string_view>
#include <system_error>
#include <vector>

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

/// Units that a length may have, and how many of them a metre has.
struct LengthUnit {
    std::string_view name;
    double per_metre;
};
constexpr LengthUnit kLengthUnits[] = {{"nm", 1e9}, {"um", 1e6}, {"mm", 1e3}, {"m", 1}};
constexpr double kMicrometresPerMetre = 1e6;

/// In metres; nothing where it is no length.
std::optional<double> parse_length(std::string_view text) {
    double per_metre = kMicrometresPerMetre;
    for (const LengthUnit& unit : kLengthUnits) {
        if (text.size() > unit.name.size() && text.ends_with(unit.name)) {
            per_metre = unit.per_metre;
            text.remove_suffix(unit.name.size());
            break;
        }
    }
    const auto value = parse_number(text);
    // Divided, not multiplied by 1e-9, so that 550nm is the number nearest to 5.5e-7.
    return value ? std::optional(*value / per_metre) : std::nullopt;
}

// Takes texts that `parse` finds a value in; `describe` says what is wrong with others.
template <class Parse, class Put, class Describe>
OptionValue make_value(Parse parse, Put put, Describe describe) {
    return {[=](const std::string& text) {
        const auto value = parse(text);
        if (!value) return fmt::format("'{}' is not {}", shorten(text), describe());
        put(*value);
        return std::string();
    }};
}

constexpr const char* kEmptyName = "the name is empty; give the path of a file";

OptionValue make_text(std::string& to, const char* fault_of_none) {
    return {[&to, fault_of_none](const std::string& text) {
        to = text;
        return std::string(text.empty() ? fault_of_none : "");
    }};
}

// Of each value of several.
OptionValue append_to(std::vector<double>& to, OptionValue (*one)(double, double, detail::Put),
                      double least, double most) {
    OptionValue value = one(least, most, [&to](double number) { to.push_back(number); });
    value.count = OptionValue::Count::listed;
    return value;
}

OptionValue make_length(double least, double most, detail::Put put) {
    return make_value(
        [=](const std::string& text) {
            const auto metres = parse_length(text);
            return metres && *metres >= least && *metres <= most ? metres : std::nullopt;
        },
        std::move(put),
        [=] {
            return fmt::format(
                "a length from {:g} to {:g} micrometres (a number of micrometres, or one with a "
                "unit: nm, um, mm, m)",
                least * kMicrometresPerMetre, most * kMicrometresPerMetre);
        });
}

}  // namespace

std::optional<double> parse_number(std::string_view text) {
    const auto value = parse_whole<double>(text);
    return value && std::isfinite(*value) ? value : std::nullopt;
}

std::optional<std::uint64_t> parse_whole_number(std::string_view text, std::uint64_t least,
                                                std::uint64_t most) {
    const auto value = parse_whole<std::uint64_t>(text);
    return value && *value >= least && *value <= most ? value : std::nullopt;
}

namespace detail {

OptionValue real_number(double least, double most, Put put) {
    return make_value(
        [=](const std::string& text) {
            const auto value = parse_number(text);
            return value && *value >= least && *value <= most ? value : std::nullopt;
        },
        std::move(put), [=] { return fmt::format("a number from {:g} to {:g}", least, most); });
}

OptionValue number_above(double bound, double most, Put put) {
    return make_value(
        [=](const std::string& text) {
            const auto value = parse_number(text);
            return value && *value > bound && *value <= most ? value : std::nullopt;
        },
        std::move(put),
        [=] { return fmt::format("a number above {:g} and up to {:g}", bound, most); });
}

OptionValue whole_number(std::uint64_t least, std::uint64_t most,
                         std::function<void(std::uint64_t)> put) {
    return make_value(
        [=](const std::string& text) { return parse_whole_number(text, least, most); },
        std::move(put), [=] { return fmt::format("a whole number from {} to {}", least, most); });
}

OptionValue one_of(const std::vector<std::string>& names, std::function<void(std::size_t)> put) {
    return make_value(
        [names](const std::string& text) {
            const auto found = std::ranges::find(names, text);
            return found == names.end() ? std::nullopt : std::optional(found - names.begin());
        },
        [put = std::move(put)](std::ptrdiff_t i) { put(static_cast<std::size_t>(i)); },
        [names] { return fmt::format("one of {}", fmt::join(names, ", ")); });
}

}  // namespace detail

OptionValue length(double& to, double least, double most) {
    return make_length(least, most, detail::put_into(to));
}

OptionValue lengths(std::vector<double>& to, double least, double most) {
    return append_to(to, make_length, least, most);
}

OptionValue real_numbers(std::vector<double>& to, double least, double most) {
    return append_to(to, detail::real_number, least, most);
}

OptionValue text(std::string& to) {
    return make_text(to, "");
}

OptionValue texts(std::vector<std::string>& to) {
    return {[&to](const std::string& value) {
                to.push_back(value);
                return std::string();
            },
            OptionValue::Count::repeated};
}

OptionValue file_name(std::string& to) {
    return make_text(to, kEmptyName);
}

OptionValue file_names(std::vector<std::string>& to) {
    return {[&to](const std::string& value) {
                to.push_back(value);
                return std::string(value.empty() ? kEmptyName : "");
            },
            OptionValue::Count::rest};
}

OptionValue term_list(std::string& to) {
    return make_text(to, "it names nothing; give all, or leave it out");
}

Option add_threads_option(const Command& command, unsigned& threads, const std::string& help) {
    return command.add("--threads", "T [0]", whole_number(threads, 0, 1024), help);
}

Option add_seed_option(const Command& command, std::uint64_t& seed, const std::string& help) {
    return command.add("--seed", "S [0]",
                       whole_number(seed, 0, std::numeric_limits<std::uint64_t>::max()), help);
}

void add_asset_argument(const Command& command, std::string& path) {
    command.add("file", "FILE.opal", file_name(path), "the .opal file").required();
}

void add_memory_option(const Command& command, std::uint64_t& limit) {
    command.add("--memory-limit", "BYTES",
                whole_number(limit, 1, std::numeric_limits<std::int64_t>::max()),
                "refuse what is predicted to need more; default: what the machine has");
}

}  // namespace opaline::cli
