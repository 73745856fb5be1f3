#pragma once

#include <cstdint>
#include <map>
#include <string>

namespace opaline::bake {

/// How long stages take on this machine over what counts and constants say, by kind of stage
/// (StageCost::kind). Predictions use it; decisions, and so files, do not.
struct StageRates {
    struct Learnt {
        double factor = 1;        ///< > 0: geometric mean over bakes, later ones count more
        std::uint32_t bakes = 0;  ///< that it was learnt from

        bool operator==(const Learnt&) const = default;
    };
    std::map<std::string, Learnt> kinds;

    /// Of a kind that no bake here had: the machine's speed, the geometric mean of all kinds; 1
    /// where nothing was learnt.
    double factor(const std::string& kind) const;
};

}  // namespace opaline::bake
