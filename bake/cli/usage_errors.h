#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace CLI {
class App;
class ParseError;
}  // namespace CLI

namespace opaline::cli {

/// What is wrong with a command line that CLI11 refused, in plain words, with the nearest command
/// or option where a name is unknown, and where help is: everything after "opaline: error: ".
std::string describe_usage_error(const CLI::App& app, const CLI::ParseError& error);

/// "there is no command 'rendr'; did you mean 'render'?"
std::string describe_unknown_command(const CLI::App& app, const std::string& name);

/// The name nearest to `wanted` by edits of one character; empty where none is near.
std::string find_nearest(std::string_view wanted, const std::vector<std::string>& names);

}  // namespace opaline::cli
