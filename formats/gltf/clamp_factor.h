#pragma once

#include <algorithm>
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "formats/opal/rgb.h"

namespace opaline::formats::gltf {

/// `value` in its range; a remark where it was not. NaN becomes the least.
inline double clamp_factor(double value, double least, double greatest, const char* name,
                           std::vector<std::string>& remarks) {
    if (value >= least && value <= greatest) return value;
    remarks.push_back(std::string(name) + " is out of its range and is clamped");
    return value > least ? greatest : least;
}

/// The same of a colour in [0, 1].
inline glm::dvec3 clamp_color(glm::dvec3 color, const char* name,
                              std::vector<std::string>& remarks) {
    const glm::dvec3 inside = glm::clamp(color, 0.0, 1.0);
    if (inside != color) {
        remarks.push_back(std::string(name) + " is outside [0, 1] and is clamped");
    }
    return inside;
}

inline Rgb to_rgb(glm::dvec3 color) {
    const glm::vec3 c(color);
    return {c.x, c.y, c.z};
}

inline bool is_black(glm::dvec3 color) {
    return !(std::max({color.x, color.y, color.z}) > 0.0);
}

}  // namespace opaline::formats::gltf
