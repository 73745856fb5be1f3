#include "formats/opal/check_holes.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "formats/opal/check_opal.h"

namespace opaline::formats {
namespace {

bool is_alpha(float x) {
    return x >= 0 && x <= 1;
}

bool is_clear_share(const HoleRecord& hole) {
    const ClearShare clear = clear_share_of(hole);
    return is_alpha(clear.share) &&
           (clear.eta == 0 || (clear.eta >= 1 && std::isfinite(clear.eta)));
}

std::string find_hole_fault(const AssetView& asset, std::size_t i) {
    const HoleRecord& hole = asset.holes.record[i];
    if (hole.primitive >= asset.primitives.size() ||
        !asset.primitives[hole.primitive].is_opaque()) {
        return "its primitive does not exist, or is translucent";
    }
    if (i > 0 && hole.primitive <= asset.holes.record[i - 1].primitive) {
        return "it is out of order, or stands twice";
    }
    if (hole.mode != HoleMode::mask && hole.mode != HoleMode::blend) {
        return "it is neither a mask nor a blend";
    }
    if (!is_alpha(hole.alpha) || !(hole.cutoff >= 0) || !std::isfinite(hole.cutoff) ||
        !is_clear_share(hole)) {
        return "its alpha is not in 0 ... 1, its cutoff is below zero or not finite, or what "
               "passes it as glass is not in 0 ... 1 or of an index below 1";
    }
    return find_image_fault(asset, hole.image, hole.wrap_u, hole.wrap_v);
}

}  // namespace

Fault find_holes_fault(const AssetView& asset) {
    const std::size_t alphas = asset.holes.vertex_alpha.size();
    if (alphas != 0 && alphas != asset.position.size()) {
        return {"section HOLE", "it has alpha of " + number_in_fault(alphas) +
                                    " vertices; expected none, or " +
                                    number_in_fault(asset.position.size())};
    }
    return find_fault_in("section HOLE, record", asset.holes.record.size(),
                         [&](std::size_t i) { return find_hole_fault(asset, i); });
}

Fault find_hole_value_fault(const HolesView& holes) {
    const auto bad = std::ranges::find_if_not(holes.vertex_alpha, is_alpha);
    if (bad == holes.vertex_alpha.end()) return {};
    return {"section HOLE, vertex " + number_in_fault(bad - holes.vertex_alpha.begin()),
            "its alpha is not in 0 ... 1"};
}

}  // namespace opaline::formats
