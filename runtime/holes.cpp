#include "runtime/holes.h"

#include "formats/opal/thin_glass.h"
#include "runtime/texture.h"

namespace opaline::runtime {

float alpha_at(const formats::AssetView& asset, const formats::HoleRecord& hole,
               formats::Float2 texcoord, float vertex_alpha) {
    const float alpha = hole.alpha * vertex_alpha;
    return hole.image == formats::kNoImage
               ? alpha
               : alpha * sample_image_values(asset.images[hole.image], texcoord, hole.wrap_u,
                                             hole.wrap_v)
                             .r;
}

bool sees_surface(const formats::HoleRecord& hole, float alpha, const HoleSample& sample) {
    if (hole.mode == formats::HoleMode::mask) alpha = alpha >= hole.cutoff ? 1.0f : 0.0f;
    if (hole.clear != 0) {
        const formats::ClearShare clear = formats::clear_share_of(hole);
        alpha *= 1 - clear.share * formats::thin_glass_transmittance(sample.cosine, clear.eta);
    }
    // 1 / p and 1 / p^2 times 2^32, p^3 = p + 1; 2^32 over the golden ratio.
    const std::uint32_t place =
        0xc13fa9a9u * sample.column + 0x91e10da6u * sample.row + 0x9e3779b9u * sample.last_vertex;
    return static_cast<float>(place >> 8) < alpha * 0x1p24f;
}

}  // namespace opaline::runtime
