#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace opaline::fuzz {

/// Small sound files for a target, between them something of everything.
std::vector<std::string> make_seeds(std::string_view target);

}  // namespace opaline::fuzz
