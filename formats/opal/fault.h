#pragma once

#include <string>

namespace opaline::formats {

/// What is wrong with an asset; `what` is empty where nothing is.
struct Fault {
    std::string where, what;
};

/// A number in such a text.
std::string number_in_fault(auto value) {
    return std::to_string(value);
}

}  // namespace opaline::formats
