#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace opaline::cli {

/// JSON as it is printed and reported, with a line feed at its end. ASCII only: names from files
/// can neither break it, where they are not UTF-8, nor steer a terminal.
inline std::string json_text(const nlohmann::ordered_json& json) {
    return json.dump(2, ' ', true, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace opaline::cli
