#include "formats/opal/holes.h"

#include <algorithm>

namespace opaline::formats {

const HoleRecord* HolesView::of(std::uint32_t primitive) const {
    const auto found = std::ranges::lower_bound(record, primitive, {}, &HoleRecord::primitive);
    return found != record.end() && found->primitive == primitive ? &*found : nullptr;
}

}  // namespace opaline::formats
