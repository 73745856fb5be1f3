#pragma once

#include <cstdio>
#include <string>

namespace opaline::bake {

/// Six significant digits, for messages: 5.5e-07, 20000, nan.
inline std::string number_text(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%g", value);
    return text;
}

}  // namespace opaline::bake
