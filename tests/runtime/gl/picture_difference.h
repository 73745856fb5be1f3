#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <utility>

#include "formats/opal/rgb.h"

namespace opaline::test {

/// How two pictures of one size, of the CPU and of GL, differ.
struct PictureDifference {
    double mean = 0;  ///< absolute, as a share of the mean; infinite where the first is black
    std::size_t off = 0, pixels = 0;  ///< pixels that differ by more than 0.5 % in a band

    /// Both backends take the same samples, but GPUs snap vertices to 1/256 of a pixel: a pixel on
    /// an edge may show what is behind it.
    bool is_small() const { return mean < 1e-3 && off <= pixels / 500; }
};

inline PictureDifference picture_difference(std::span<const formats::Rgb> cpu,
                                            std::span<const formats::Rgb> gl) {
    PictureDifference found;
    found.pixels = cpu.size();
    double sum = 0, difference = 0;
    for (std::size_t i = 0; i < cpu.size(); ++i) {
        const formats::Rgb a = cpu[i], b = gl[i];
        bool is_off = false;
        for (const auto& [x, y] : {std::pair{a.r, b.r}, std::pair{a.g, b.g}, std::pair{a.b, b.b}}) {
            sum += std::abs(static_cast<double>(x));
            difference += std::abs(static_cast<double>(x) - static_cast<double>(y));
            is_off |= !(std::abs(x - y) <= 0.005f * std::max(x, 1e-3f));
        }
        found.off += is_off ? 1u : 0u;
    }
    found.mean = sum > 0 && std::isfinite(difference) ? difference / sum
                                                      : std::numeric_limits<double>::infinity();
    return found;
}

}  // namespace opaline::test
