#include "bake/cli/messages.h"

#include <fmt/core.h>

#include <cstdio>

#include "bake/cli/exit_codes.h"

namespace opaline::cli {

using formats::Diagnostic;
using formats::ErrorKind;

namespace {

MessageOptions message_settings;

}  // namespace

void set_message_options(const MessageOptions& options) {
    message_settings = options;
}

const MessageOptions& message_options() {
    return message_settings;
}

std::string format_diagnostic(const Diagnostic& diagnostic) {
    std::string text = diagnostic.severity == Diagnostic::Severity::error ? "opaline: error: "
                                                                          : "opaline: warning: ";
    for (const std::string* part : {&diagnostic.file, &diagnostic.where}) {
        if (!part->empty()) {
            text += printable(*part) + ": ";
        }
    }
    text += printable(diagnostic.fault);
    if (!diagnostic.remedy.empty()) {
        text += " (" + printable(diagnostic.remedy) + ")";
    }
    return text;
}

int exit_code_of(const formats::Error& error) {
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

int report_error(const formats::Error& error) {
    for (const Diagnostic& diagnostic : error.diagnostics) {
        fmt::print(stderr, "{}\n", format_diagnostic(diagnostic));
    }
    return exit_code_of(error);
}

void refuse_usage(const std::string& option, std::string fault, std::string remedy) {
    refuse(formats::make_error(ErrorKind::usage, "", option, std::move(fault), std::move(remedy)));
}

formats::Status report_warnings(const std::vector<Diagnostic>& warnings) {
    if (message_settings.strict && !warnings.empty()) {
        formats::Error error{ErrorKind::bad_input, warnings};
        for (Diagnostic& diagnostic : error.diagnostics) {
            diagnostic.severity = Diagnostic::Severity::error;
        }
        return error;
    }
    for (const Diagnostic& warning : warnings) {
        print_note(format_diagnostic(warning));
    }
    return formats::ok_status();
}

void print_note(const std::string& line) {
    if (!message_settings.quiet) {
        fmt::print(stderr, "{}\n", line);
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
