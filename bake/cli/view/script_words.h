#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace opaline::cli {

/// A line of a script as words, up to a #; what stands "in quotes" is one. Nothing where a quote is
/// not closed.
std::optional<std::vector<std::string>> words_of(std::string_view line);

/// A number within the bounds; nothing where the text is none.
std::optional<double> number_in(const std::string& text, double least, double most);
/// `count` of them; nothing where a word is none, or there are more or fewer.
std::optional<std::vector<double>> numbers_in(std::span<const std::string> words, std::size_t count,
                                              double least, double most);

}  // namespace opaline::cli
