#include "bake/cli/view/script_words.h"

#include <charconv>

namespace opaline::cli {

std::optional<std::vector<std::string>> words_of(std::string_view line) {
    std::vector<std::string> words;
    bool in_word = false, in_quotes = false;
    for (const char c : line) {
        if (in_quotes) {
            if (c == '"') {
                in_quotes = false;
            } else {
                words.back() += c;
            }
            continue;
        }
        if (c == '#') break;
        if (c == ' ' || c == '\t' || c == '\r') {
            in_word = false;
            continue;
        }
        if (!in_word) words.emplace_back();
        in_word = true;
        if (c == '"') {
            in_quotes = true;
        } else {
            words.back() += c;
        }
    }
    if (in_quotes) return {};
    return words;
}

std::optional<double> number_in(const std::string& text, double least, double most) {
    double value = 0;
    const char* const end = text.data() + text.size();
    const auto [next, error] = std::from_chars(text.data(), end, value);
    if (error != std::errc{} || next != end || !(value >= least && value <= most)) return {};
    return value;
}

std::optional<std::vector<double>> numbers_in(std::span<const std::string> words, std::size_t count,
                                              double least, double most) {
    std::vector<double> values;
    if (words.size() != count) return {};
    for (const std::string& word : words) {
        const auto value = number_in(word, least, most);
        if (!value) return {};
        values.push_back(*value);
    }
    return values;
}

}  // namespace opaline::cli
