#include "formats/opal/check_normal_maps.h"

#include <cmath>

#include "formats/opal/sheet_shares.h"

namespace opaline::formats {
namespace {

// Halves in 0 ... 1, and 0 where nothing is thin-walled.
bool are_shares_sound(const NormalMapRecord& map, bool is_sheet) {
    for (const std::uint32_t pair : map.reserved) {
        if ((pair & 0xffffu) > (is_sheet ? kHalfOfOne : 0u) ||
            (pair >> 16) > (is_sheet ? kHalfOfOne : 0u)) {
            return false;
        }
    }
    return true;
}

const char* find_map_fault(const AssetView& asset) {
    const NormalMapsView& maps = asset.normal_maps;
    if (!maps.empty() && maps.tangent.size() != asset.position.size()) {
        return "it does not have a tangent for each vertex";
    }
    std::uint64_t next = 0;
    for (const NormalMapRecord& map : maps.record) {
        if (map.primitive < next || map.primitive >= asset.primitives.size()) {
            return "a primitive does not exist, is out of order, or stands twice";
        }
        next = std::uint64_t{map.primitive} + 1;
        if (map.image >= asset.images.size() || asset.texcoord.empty()) {
            return "it uses an image or texture coordinates that are not there";
        }
        if (!is_known(map.wrap_u) || !is_known(map.wrap_v) ||
            !(std::abs(map.scale) <= kMostNormalScale) ||
            !are_shares_sound(map, asset.primitives[map.primitive].shading == Shading::sheet)) {
            return "a texture wrap mode, a scale or a value is not one of this version";
        }
    }
    return nullptr;
}

}  // namespace

Fault find_normal_maps_fault(const AssetView& asset) {
    const char* const fault = find_map_fault(asset);
    return fault == nullptr ? Fault{} : Fault{"section NORM", fault};
}

}  // namespace opaline::formats
