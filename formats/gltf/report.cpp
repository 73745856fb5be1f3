#include "formats/gltf/report.h"

#include <algorithm>
#include <new>
#include <stdexcept>
#include <utility>

namespace opaline::formats::gltf {

void Report::error(std::string where, std::string fault, std::string remedy) {
    if (errors.size() >= kMaxDiagnostics) {
        ++errors_left_out;
        return;
    }
    errors.push_back(
        {Diagnostic::Severity::error, file, std::move(where), std::move(fault), std::move(remedy)});
}

std::nullopt_t Report::fail(std::string where, std::string fault, std::string remedy) {
    error(std::move(where), std::move(fault), std::move(remedy));
    return std::nullopt;
}

void Report::warn(std::string where, std::string fault, std::string remedy) {
    if (warnings.size() >= kMaxDiagnostics) {
        ++warnings_left_out;
        return;
    }
    warnings.push_back(make_warning(file, std::move(where), std::move(fault), std::move(remedy)));
}

void Report::over_limit(std::string where, std::string fault, std::string remedy) {
    if (errors.empty()) {
        kind = ErrorKind::resource;  // the first fault decides the exit code
    }
    error(std::move(where), std::move(fault), std::move(remedy));
}

Error Report::take_error() {
    if (errors_left_out > 0) {
        errors.push_back({Diagnostic::Severity::error, file, "",
                          std::to_string(errors_left_out) + " more errors are left out", ""});
    }
    return {kind, std::move(errors)};
}

Error Report::take_exception(const char* if_large, const char* otherwise) const {
    std::string what;
    try {
        throw;
    } catch (const std::bad_alloc&) {
    } catch (const std::length_error&) {
    } catch (const std::exception& problem) {
        what = "it cannot be read: " + json_fault(problem.what());
    }
    return what.empty()
               ? make_error(ErrorKind::resource, file, "", "it does not fit into memory", if_large)
               : make_error(ErrorKind::bad_input, file, "", what, otherwise);
}

std::vector<Diagnostic> Report::take_warnings() {
    if (warnings_left_out > 0) {
        warnings.push_back(make_warning(
            file, "", std::to_string(warnings_left_out) + " more warnings are left out"));
    }
    return std::move(warnings);
}

std::string in_quotes(std::string_view name) {
    constexpr std::size_t kLongest = 80;
    std::string text = "'";
    for (const char c : name.substr(0, kLongest)) {
        const auto byte = static_cast<unsigned char>(c);
        text += byte < 0x20 || byte == 0x7f ? '?' : c;
    }
    return text + (name.size() > kLongest ? "...'" : "'");
}

std::string json_fault(std::string_view what) {
    if (what.starts_with("[json.exception.")) {
        what.remove_prefix(std::min(what.find("] "), what.size() - 2) + 2);
    }
    constexpr std::string_view kParse = "parse error ";
    if (what.starts_with(kParse)) {
        what.remove_prefix(kParse.size());
    }
    constexpr std::size_t kLongest = 200;
    std::string text;
    for (const char c : what.substr(0, kLongest)) {
        const auto byte = static_cast<unsigned char>(c);
        text += byte < 0x20 || byte == 0x7f ? '?' : c;
    }
    return text + (what.size() > kLongest ? "..." : "");
}

std::string label(std::string_view kind, std::size_t index, std::string_view name) {
    std::string text(kind);
    text += ' ';
    return text + (name.empty() ? std::to_string(index) : in_quotes(name));
}

}  // namespace opaline::formats::gltf
