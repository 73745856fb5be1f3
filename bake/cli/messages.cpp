#include "bake/cli/messages.h"

#include <fmt/core.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <iterator>

#include "bake/cli/command.h"

namespace opaline::cli {
namespace {

struct Decoded {
    char32_t code = 0;
    std::size_t length = 0;  ///< bytes; 0: not UTF-8
};

// The first character. Refuses overlong forms, surrogates and everything above U+10FFFF.
Decoded decode_utf8(std::string_view text) {
    const auto lead = static_cast<unsigned char>(text[0]);
    if (lead < 0x80) {
        return {lead, 1};
    }
    const std::size_t length = lead >= 0xf0 ? 4 : lead >= 0xe0 ? 3 : 2;
    if (lead < 0xc2 || lead > 0xf4 || text.size() < length) {
        return {};
    }
    char32_t code = lead & (0x7fu >> length);
    for (std::size_t i = 1; i < length; ++i) {
        const auto next = static_cast<unsigned char>(text[i]);
        if ((next & 0xc0) != 0x80) {
            return {};
        }
        code = code << 6 | (next & 0x3fu);
    }
    constexpr char32_t kLeast[] = {0, 0, 0x80, 0x800, 0x10000};
    const bool is_surrogate = code >= 0xd800 && code <= 0xdfff;
    return code < kLeast[length] || is_surrogate || code > 0x10ffff ? Decoded{}
                                                                    : Decoded{code, length};
}

// Changes what a terminal does or the order it shows text in, or is seen by nobody.
bool is_hidden(char32_t code) {
    struct Range {
        char32_t first, last;
    };
    constexpr Range kHidden[] = {
        {0x00, 0x1f},     {0x7f, 0x9f},       // C0, DEL, C1
        {0xad, 0xad},     {0x61c, 0x61c},     // soft hyphen, Arabic letter mark
        {0x180e, 0x180e}, {0x200b, 0x200b},   // zero-width
        {0x200e, 0x200f}, {0x2028, 0x202e},   // marks, separators, embeddings, overrides
        {0x2060, 0x206f}, {0xfeff, 0xfeff},   // isolates and other format characters
        {0xfff9, 0xfffb}, {0xe0000, 0xe0fff}  // annotations, tags
    };
    return std::any_of(std::begin(kHidden), std::end(kHidden),
                       [=](Range range) { return code >= range.first && code <= range.last; });
}

std::string escape(char32_t code) {
    const auto number = static_cast<std::uint32_t>(code);
    return number <= 0xff     ? fmt::format("\\x{:02x}", number)
           : number <= 0xffff ? fmt::format("\\u{:04x}", number)
                              : fmt::format("\\U{:08x}", number);
}

}  // namespace

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
        print_to_stderr(format_diagnostic(diagnostic) + "\n");
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

void print_to_stderr(const std::string& text) {
    [[maybe_unused]] const std::size_t written = std::fwrite(text.data(), 1, text.size(), stderr);
}

void print_note(const std::string& line) {
    if (!message_settings.quiet) {
        print_to_stderr(line + "\n");
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

std::string printable(std::string_view text) {
    std::string safe;
    while (!text.empty()) {
        const Decoded next = decode_utf8(text);
        const std::size_t length = std::max<std::size_t>(next.length, 1);
        if (next.length == 0) {
            safe += escape(static_cast<unsigned char>(text[0]));
        } else if (is_hidden(next.code)) {
            safe += escape(next.code);
        } else {
            safe += text.substr(0, length);
        }
        text.remove_prefix(length);
    }
    return safe;
}

std::string shorten(std::string_view text) {
    constexpr std::size_t kMost = 40;
    if (text.size() <= kMost) return printable(text);
    std::size_t end = kMost;
    while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xc0) == 0x80) {
        --end;  // not within a character
    }
    return printable(text.substr(0, end)) + "...";
}

}  // namespace opaline::cli
