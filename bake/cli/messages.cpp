#include "bake/cli/messages.h"

#include <fmt/core.h>

#include <cstdio>

#include "bake/cli/command.h"

namespace opaline::cli {

using formats::Diagnostic;
using formats::ErrorKind;

std::string format_diagnostic(const Diagnostic& diagnostic) {
    std::string text = diagnostic.severity == Diagnostic::Severity::error ? "opaline: error: "
                                                                          : "opaline: warning: ";
    for (const std::string* part : {&diagnostic.file, &diagnostic.where}) {
        if (!part->empty()) {
            text += *part + ": ";
        }
    }
    text += diagnostic.fault;
    if (!diagnostic.remedy.empty()) {
        text += " (" + diagnostic.remedy + ")";
    }
    return text;
}

int report_error(const formats::Error& error) {
    for (const Diagnostic& diagnostic : error.diagnostics) {
        fmt::print(stderr, "{}\n", format_diagnostic(diagnostic));
    }
    switch (error.kind) {
        case ErrorKind::usage:
            return kExitUsage;
        case ErrorKind::resource:
            return kExitResource;
        case ErrorKind::interrupted:
            return kExitInterrupted;
        default:
            return kExitBadInput;
    }
}

void print_warnings(const std::vector<Diagnostic>& warnings) {
    for (const Diagnostic& warning : warnings) {
        fmt::print(stderr, "{}\n", format_diagnostic(warning));
    }
}

std::string format_seconds(double seconds) {
    if (seconds >= 120) {
        return fmt::format("{:.1f} min", seconds / 60);
    }
    return seconds >= 1 ? fmt::format("{:.1f} s", seconds)
                        : fmt::format("{:.1f} ms", seconds * 1e3);
}

std::string format_bytes(double bytes) {
    if (bytes >= 1e9) {
        return fmt::format("{:.2f} GB", bytes * 1e-9);
    }
    if (bytes >= 1e6) {
        return fmt::format("{:.1f} MB", bytes * 1e-6);
    }
    return bytes >= 1e3 ? fmt::format("{:.1f} kB", bytes * 1e-3) : fmt::format("{} bytes", bytes);
}

}  // namespace opaline::cli
