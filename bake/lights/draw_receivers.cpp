#include "bake/lights/draw_receivers.h"

#include <algorithm>

namespace opaline::bake {

std::vector<std::uint32_t> draw_evenly(std::size_t count, std::size_t wanted, RandomStage stage,
                                       std::uint64_t seed) {
    wanted = std::min(count, wanted);
    std::vector<std::uint32_t> drawn;
    for (std::size_t i = 0; i < wanted; ++i) {
        const std::size_t begin = count * i / wanted, end = count * (i + 1) / wanted;
        const auto u = static_cast<double>(random_uniform(seed, stage, i)[0]);
        drawn.push_back(static_cast<std::uint32_t>(
            begin + static_cast<std::size_t>(u * static_cast<double>(end - begin))));
    }
    return drawn;
}

}  // namespace opaline::bake
