#pragma once

#include <string>

namespace opaline::formats {

/// What is wrong with an asset; `what` is empty where nothing is.
struct Fault {
    std::string where, what;
};

}  // namespace opaline::formats
