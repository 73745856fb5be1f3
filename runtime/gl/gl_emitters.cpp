#include "runtime/gl/gl_emitters.h"

#include <cstdint>

namespace opaline::runtime {
using formats::Rgb;

std::vector<Rgb> own_radiances(const GlAsset& asset, const EmitterLight& light) {
    std::vector<Rgb> own;
    if (asset.emitters.own.empty()) return own;
    own.reserve(asset.primitives.size());
    for (std::uint32_t p = 0; p < asset.primitives.size(); ++p) {
        own.push_back(own_radiance(asset.emitters.view(), light, p));
    }
    return own;
}

}  // namespace opaline::runtime
