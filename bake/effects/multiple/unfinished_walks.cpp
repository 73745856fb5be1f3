#include "bake/effects/multiple/unfinished_walks.h"

#include <utility>

#include "bake/effects/multiple/choose_model.h"

namespace opaline::bake {

std::optional<formats::Diagnostic> describe_unfinished(const std::string& material,
                                                       const WalkCounts& counts) {
    constexpr double kNoticed = 1e-3;
    if (counts.walks == 0) return std::nullopt;
    const double share = counts.unfinished() / static_cast<double>(counts.walks);
    if (share < kNoticed) return std::nullopt;
    std::string ends;
    for (const auto& [count, end] :
         {std::pair{counts.lost, "leave through holes of its mesh"},
          {counts.endless, "scatter too often to be followed"},
          {counts.buried, "pass through too many media in each other"}}) {
        if (count > 0) {
            ends += (ends.empty() ? "" : ", ") + std::to_string(count) + " " + end;
        }
    }
    return formats::make_warning(
        "", "material '" + material + "'",
        "of " + std::to_string(counts.walks) + " random walks " + ends + ": " + percent(share) +
            " of their light" +
            (counts.correction() != 1 ? ", which counts as bright as the rest"
                                      : ", too much to be made up for by the rest, is missing"),
        counts.lost > 0 ? "close the surface" : "--check-model measures what that errs by");
}

}  // namespace opaline::bake
