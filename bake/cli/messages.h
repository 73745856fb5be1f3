#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "formats/opal/result.h"

namespace opaline::cli {

/// Text of unknown origin (file contents, paths, arguments) made safe for a terminal: control
/// characters, bytes that are not UTF-8, and Unicode's invisible and direction-changing characters
/// become visible escapes such as \x1b and \u202e.
std::string printable(std::string_view text);

/// The same, cut after about 40 characters.
std::string shorten(std::string_view text);

/// What the program says on stderr; set once, before the command runs.
struct MessageOptions {
    bool strict = false;  ///< warnings are errors
    bool quiet = false;   ///< errors only
};
void set_message_options(const MessageOptions& options);
const MessageOptions& message_options();

/// "opaline: error: FILE: WHERE: FAULT (REMEDY)"; empty parts are left out. Fit for a terminal,
/// whatever the parts hold.
std::string format_diagnostic(const formats::Diagnostic& diagnostic);

/// The exit code that an error of this kind ends the program with.
int exit_code_of(const formats::Error& error);

/// Prints everything an error says to stderr; returns its exit code.
int report_error(const formats::Error& error);

/// Ends a command: the program reports the error and exits with its code.
struct Refusal {
    formats::Error error;
};
[[noreturn]] inline void refuse(formats::Error error) {
    throw Refusal{std::move(error)};
}
/// What an option asks for cannot be done.
[[noreturn]] void refuse_usage(const std::string& option, std::string fault, std::string remedy);

/// The value. Throws Refusal where there is none.
template <class T>
T require(formats::Result<T> result) {
    if (!result) refuse(std::move(result).error());
    return std::move(result).value();
}
inline void require(formats::Status status) {
    if (!status) refuse(std::move(status).error());
}

/// Prints warnings to stderr, unless quiet. Where warnings are errors: prints nothing and returns
/// them as an error (bad_input); the caller must then write no output.
formats::Status report_warnings(const std::vector<formats::Diagnostic>& warnings);

/// Where it is closed or full nothing is printed: nobody could be told.
void print_to_stderr(const std::string& text);

/// Prints a line to stderr that is neither a warning nor an error, unless quiet.
void print_note(const std::string& line);

/// "3 minutes", "12.4 s", "0.3 ms"; "1.2 GB", "640 bytes".
std::string format_seconds(double seconds);
std::string format_bytes(double bytes);

}  // namespace opaline::cli
