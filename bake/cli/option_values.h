#pragma once

#include <CLI/CLI.hpp>

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "bake/pipeline/predict_memory.h"
#include "formats/opal/result.h"

namespace opaline::cli {

/// `--memory-limit`; 0 where it is not given.
void add_memory_option(CLI::App& command, std::uint64_t& limit);

/// What this process may use [bytes]: the machine's memory, or what its control group allows, or
/// what `ulimit -v` leaves to a program of that many threads.
std::uint64_t available_memory(unsigned threads);

/// Refuses what is predicted to need more than `limit`. Errors: resource, naming `file`.
formats::Status check_memory(const std::string& file, const bake::MemoryPrediction& prediction,
                             std::uint64_t limit);

/// Whether that many threads (0: one per core) can be started. Asked first because TBB, which all
/// stages run on, waits for ever for a thread that could not be. Errors: resource.
formats::Status check_threads(unsigned threads);

/// Checks of option values whose messages say what is accepted. CLI11's own checks let NaN pass,
/// clamp integers, accept numbers for names, and print C++ containers.

/// A finite number from `least` to `most`.
CLI::Validator real_number(double least, double most);

/// The same without its lower bound: above `bound`.
CLI::Validator number_above(double bound, double most);

/// A length from `least` to `most` [m]: a number of micrometres, or one with a unit, nm, um, mm or
/// m. The option's variable gets metres.
CLI::Validator length(double least, double most);

/// The whole text as a finite number; nothing where it is none.
std::optional<double> parse_number(std::string_view text);

/// A whole number from `least` to `most`, decimal digits only.
CLI::Validator whole_number(std::uint64_t least, std::uint64_t most);

/// The path of a file; not empty.
CLI::Validator file_name();

/// `--threads`; 0: one per core.
CLI::Option* add_threads_option(
    CLI::App& command, unsigned& threads,
    const std::string& help = "0: one per core; the result is the same for any number");

/// `--seed`.
CLI::Option* add_seed_option(CLI::App& command, std::uint64_t& seed, const std::string& help);

/// The `.opal` file that a command reads.
void add_asset_argument(CLI::App& command, std::string& path);

/// Components of radiance: not empty, as nothing would stand for all of them.
CLI::Validator term_list();

/// Options under one heading of a command's help.
struct OptionGroup {
    std::string heading;             ///< empty: the first, without a heading of its own
    std::vector<std::string> names;  ///< "--name", of options that the command has
};

/// Puts options under headings in the order of the groups; those in none under `others`.
void group_options(CLI::App& command, const std::vector<OptionGroup>& groups,
                   const std::string& others);

namespace detail {
/// Of a name and the text that CLI11 converts into the option's value.
CLI::Validator one_of(std::vector<std::pair<std::string, std::string>> names);
}  // namespace detail

/// One of the names; the option's variable gets the value beside it (an integer or an enumerator).
template <class T>
CLI::Validator one_of(const std::vector<std::pair<std::string, T>>& names) {
    std::vector<std::pair<std::string, std::string>> texts;
    texts.reserve(names.size());
    for (const auto& [name, value] : names) {
        texts.emplace_back(name, std::to_string(static_cast<std::int64_t>(value)));
    }
    return detail::one_of(std::move(texts));
}

}  // namespace opaline::cli
