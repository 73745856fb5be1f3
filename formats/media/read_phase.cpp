#include "formats/media/read_phase.h"

#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <vector>

#include "formats/media/limits.h"
#include "formats/media/mean_cosine.h"

namespace opaline::formats::media {

namespace {

using gltf::in_quotes;
using gltf::Report;

struct Row {
    double cosine = 0, value = 0;
};

bool is_divider(char c) {
    return c == ' ' || c == '\t' || c == ',' || c == ';' || c == '\r';
}

std::vector<std::string_view> split(std::string_view line) {
    std::vector<std::string_view> words;
    for (std::size_t at = 0; at < line.size();) {
        if (is_divider(line[at])) {
            ++at;
            continue;
        }
        std::size_t end = at;
        while (end < line.size() && !is_divider(line[end])) {
            ++end;
        }
        words.push_back(line.substr(at, end - at));
        at = end;
    }
    return words;
}

std::optional<double> finite(std::string_view word) {
    double value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    const bool whole = error == std::errc{} && end == word.data() + word.size();
    return whole && std::isfinite(value) ? std::optional(value) : std::nullopt;
}

std::optional<Row> read_row(const std::vector<std::string_view>& words) {
    const auto cosine = words.size() == 2 ? finite(words[0]) : std::nullopt;
    const auto value = words.size() == 2 ? finite(words[1]) : std::nullopt;
    return cosine && value ? std::optional(Row{*cosine, *value}) : std::nullopt;
}

constexpr const char* kRemedy = "give two columns: cosines ascending from -1 to 1, values >= 0";

std::optional<std::vector<Row>> read_rows(std::string_view text, const std::string& where,
                                          Report& report) {
    std::vector<Row> rows;
    bool may_be_heading = true;
    std::size_t number = 0;
    while (!text.empty()) {
        const std::size_t end = std::min(text.find('\n'), text.size());
        const std::string_view line = text.substr(0, end);
        text.remove_prefix(std::min(end + 1, text.size()));
        ++number;
        const auto words = split(line.substr(0, line.find('#')));
        if (words.empty()) continue;
        const auto row = read_row(words);
        const std::string at = where + " > line " + std::to_string(number);
        if (!row && may_be_heading && !finite(words[0])) {
            may_be_heading = false;
            continue;
        }
        may_be_heading = false;
        if (!row || row->value < 0 || row->value > kMaxTableValue) {
            return report.fail(
                at, "it is " + in_quotes(line) + ", expected a cosine and a value >= 0", kRemedy);
        }
        if (rows.size() == kMaxTableRows) {
            return report.fail(where, "it has more than " + std::to_string(kMaxTableRows) + " rows",
                               "give fewer rows");
        }
        if (!rows.empty() &&
            !(static_cast<float>(row->cosine) > static_cast<float>(rows.back().cosine))) {
            return report.fail(at, "the cosine " + in_quotes(words[0]) + " does not ascend",
                               kRemedy);
        }
        rows.push_back(*row);
    }
    return rows;
}

}  // namespace

std::optional<PhaseFunction> parse_phase_table(std::string_view text, const std::string& where,
                                               Report& report) {
    auto rows = read_rows(text, where, report);
    if (!rows) return std::nullopt;
    constexpr double kRounding = 1e-6;  // of an end written with few digits
    if (rows->size() < 2 || std::abs(rows->front().cosine + 1) > kRounding ||
        std::abs(rows->back().cosine - 1) > kRounding) {
        return report.fail(where, "its cosines do not reach from -1 to 1", kRemedy);
    }
    rows->front().cosine = -1;
    rows->back().cosine = 1;
    double sum = 0;
    for (std::size_t i = 1; i < rows->size(); ++i) {
        const Row &a = (*rows)[i - 1], &b = (*rows)[i];
        sum += (a.value + b.value) / 2 * (b.cosine - a.cosine);
    }
    const double integral = 2 * std::numbers::pi * sum;
    if (!(integral > kMinTableIntegral)) {
        return report.fail(where, "its values are all zero", kRemedy);
    }
    PhaseFunction phase;
    phase.type = PhaseFunction::Type::tabulated;
    for (const Row& row : *rows) {
        phase.cosine.push_back(static_cast<float>(row.cosine));
        phase.value.push_back(static_cast<float>(row.value / integral));
    }
    if (const double g = mean_cosine(phase); !(std::abs(g) <= kMaxMeanCosine)) {
        return report.fail(
            where,
            "its mean cosine is " + nlohmann::json(g).dump() + ", expected one from -0.99 to 0.99",
            "leave out the forward peak and reduce sigma_s by its share");
    }
    return phase;
}

std::optional<PhaseFunction> read_phase(const Fields& fields, gltf::Resources& resources) {
    PhaseFunction phase;
    if (!has(fields, "type")) {
        return fields.report.fail(fields.where, "type is missing",
                                  "give isotropic, hg, rayleigh, gaussian or table");
    }
    const auto type = choice(fields, "type", {"isotropic", "hg", "rayleigh", "gaussian", "table"});
    if (!type) return std::nullopt;
    const auto needs = [&](const char* key, const char* remedy) {
        if (!has(fields, key)) {
            fields.report.error(fields.where, std::string(key) + " is missing", remedy);
        }
    };
    switch (*type) {
        case 1:
            phase.type = PhaseFunction::Type::henyey_greenstein;
            refuse_unknown_keys(fields, {"type", "g"});
            needs("g", "give the mean cosine, from -0.99 to 0.99");
            number(fields, "g", -kMaxMeanCosine, kMaxMeanCosine, phase.g);
            return phase;
        case 3:
            phase.type = PhaseFunction::Type::gaussian;
            refuse_unknown_keys(fields, {"type", "rms_angle"});
            needs("rms_angle", "give the root mean square angle in radians, at most 1");
            phase.rms_angle = 1;
            number(fields, "rms_angle", kMinRmsAngle, 1.0, phase.rms_angle);
            return phase;
        case 4: {
            refuse_unknown_keys(fields, {"type", "file"});
            needs("file", "give the name of a table beside this file");
            const auto bytes = read_named_file(fields, "file", resources);
            if (!bytes) return std::nullopt;
            const std::string_view table(reinterpret_cast<const char*>(bytes->data()),
                                         bytes->size());
            return parse_phase_table(table, place(fields.where, "file"), fields.report);
        }
        default:
            phase.type =
                *type == 2 ? PhaseFunction::Type::rayleigh : PhaseFunction::Type::isotropic;
            refuse_unknown_keys(fields, {"type"});
            return phase;
    }
}

}  // namespace opaline::formats::media
