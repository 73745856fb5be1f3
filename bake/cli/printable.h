#pragma once

#include <string>
#include <string_view>

namespace opaline::cli {

/// Text of unknown origin (file contents, paths, arguments) made safe for a terminal: control
/// characters, bytes that are not UTF-8, and Unicode's invisible and direction-changing characters
/// become visible escapes such as \x1b and \u202e.
std::string printable(std::string_view text);

/// The same, cut after about 40 characters.
std::string shorten(std::string_view text);

}  // namespace opaline::cli
