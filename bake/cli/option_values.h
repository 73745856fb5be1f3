#pragma once

#include <cstdint>
#include <functional>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "bake/cli/command.h"

namespace opaline::cli {

/// `--memory-limit`; 0 where it is not given.
void add_memory_option(const Command& command, std::uint64_t& limit);

/// The whole text as a finite number; nothing where it is none.
std::optional<double> parse_number(std::string_view text);
/// The whole text, decimal digits only, as a number from `least` to `most`; nothing otherwise.
std::optional<std::uint64_t> parse_whole_number(std::string_view text, std::uint64_t least,
                                                std::uint64_t most);

/// Values of options. Their messages say what is accepted: CLI11's own checks let NaN pass, clamp
/// integers, accept numbers for names, and print C++ containers.
namespace detail {
using Put = std::function<void(double)>;
OptionValue real_number(double least, double most, Put put);
OptionValue number_above(double bound, double most, Put put);
OptionValue whole_number(std::uint64_t least, std::uint64_t most,
                         std::function<void(std::uint64_t)> put);
OptionValue one_of(const std::vector<std::string>& names, std::function<void(std::size_t)> put);

template <class T>
struct Plain {
    using Type = T;
};
template <class T>
struct Plain<std::optional<T>> {
    using Type = T;
};
/// Puts a number into a variable of another type, or an optional one.
template <class T>
auto put_into(T& to) {
    return [&to](auto value) { to = static_cast<typename Plain<T>::Type>(value); };
}
}  // namespace detail

/// A finite number from `least` to `most`.
template <class T>
OptionValue real_number(T& to, double least, double most) {
    return detail::real_number(least, most, detail::put_into(to));
}

/// The same without its lower bound: above `bound`.
template <class T>
OptionValue number_above(T& to, double bound, double most) {
    return detail::number_above(bound, most, detail::put_into(to));
}

/// A whole number from `least` to `most`, decimal digits only.
template <class T>
OptionValue whole_number(T& to, std::uint64_t least, std::uint64_t most) {
    return detail::whole_number(least, most, detail::put_into(to));
}

/// A length from `least` to `most` [m]: a number of micrometres, or one with a unit, nm, um, mm or
/// m. `to` gets metres.
OptionValue length(double& to, double least, double most);

/// The same of several, with commas between.
OptionValue lengths(std::vector<double>& to, double least, double most);
OptionValue real_numbers(std::vector<double>& to, double least, double most);

OptionValue text(std::string& to);
/// Of an option that may be given often.
OptionValue texts(std::vector<std::string>& to);

/// The path of a file; not empty.
OptionValue file_name(std::string& to);
/// All arguments that follow.
OptionValue file_names(std::vector<std::string>& to);

/// Components of radiance: not empty, as nothing would stand for all of them.
OptionValue term_list(std::string& to);

/// One of the names: `to` gets the value beside it. The placeholder has them and what `to` is.
template <class T>
OptionValue one_of(T& to,
                   std::initializer_list<std::pair<const char*, std::type_identity_t<T>>> choices) {
    std::vector<std::string> names;
    std::vector<T> values;
    std::string placeholder, otherwise;
    for (const auto& [name, value] : choices) {
        names.emplace_back(name);
        values.push_back(value);
        placeholder += (placeholder.empty() ? "" : "|") + names.back();
        if (value == to) otherwise = " [" + names.back() + "]";
    }
    OptionValue value =
        detail::one_of(names, [&to, values = std::move(values)](std::size_t i) { to = values[i]; });
    value.placeholder = placeholder + otherwise;
    return value;
}

/// `--threads`; 0: one per core.
Option add_threads_option(
    const Command& command, unsigned& threads,
    const std::string& help = "0: one per core; the result is the same for any number");

/// `--seed`.
Option add_seed_option(const Command& command, std::uint64_t& seed, const std::string& help);

/// The `.opal` file that a command reads.
void add_asset_argument(const Command& command, std::string& path);

}  // namespace opaline::cli
