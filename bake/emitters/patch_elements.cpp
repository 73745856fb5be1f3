#include "bake/emitters/patch_elements.h"

#include <algorithm>
#include <cassert>
#include <utility>

namespace opaline::bake {
namespace {

std::size_t side(int level) {
    return std::size_t{1} << level;
}

double elements(int level) {
    const auto along = static_cast<double>(side(level));
    return along * along;
}

}  // namespace

PatchElements make_patch_elements(double area, int levels) {
    assert(levels >= 1 && levels <= 14);
    PatchElements patch{area, {}};
    for (int level = 0; level < levels; ++level) {
        patch.power.emplace_back(side(level) * side(level), 0.0);
    }
    return patch;
}

int element_level(const PatchElements& patch, double footprint) {
    int level = 0;
    while (level < patch.finest() && patch.area / elements(level) > footprint) {
        ++level;
    }
    return level;
}

void deposit(PatchElements& patch, int level, double s, double t, double power) {
    const std::size_t n = side(level);
    const auto cell = [n](double x) {
        const double scaled = std::clamp(x, 0.0, 1.0) * static_cast<double>(n);
        return std::min(static_cast<std::size_t>(scaled), n - 1);
    };
    patch.power[static_cast<std::size_t>(level)][cell(t) * n + cell(s)] += power;
}

std::vector<double> push_down(const PatchElements& patch) {
    std::vector<double> coarse;
    for (int level = 0; level <= patch.finest(); ++level) {
        const std::size_t n = side(level);
        const double per_area = elements(level) / patch.area;
        std::vector<double> fine(patch.power[static_cast<std::size_t>(level)]);
        for (std::size_t i = 0; i < fine.size(); ++i) {
            fine[i] *= per_area;
            if (level > 0) {
                fine[i] += coarse[i / n / 2 * (n / 2) + i % n / 2];
            }
        }
        coarse = std::move(fine);
    }
    return coarse;
}

}  // namespace opaline::bake
