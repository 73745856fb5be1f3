#include "runtime/gl/gl_emitters.h"

#include <cstdint>

namespace opaline::runtime {
namespace {

using formats::Rgb;

// Results from `first` on of a buffer of four floats a result.
void add_to_results(const GlBuffer& buffer, std::size_t first, std::size_t count,
                    const formats::EmittersView& emitters, const EmitterLight& light,
                    std::uint32_t primitive) {
    const auto offset = static_cast<GLintptr>(first * kRadianceBytes);
    const auto size = static_cast<GLsizeiptr>(count * kRadianceBytes);
    std::vector<float> padded(4 * count);
    glGetNamedBufferSubData(buffer.name(), offset, size, padded.data());
    std::vector<Rgb> results(count);
    for (std::size_t i = 0; i < count; ++i) {
        results[i] = {padded[4 * i], padded[4 * i + 1], padded[4 * i + 2]};
    }
    add_emitters(emitters, light, primitive, 0, results);
    for (std::size_t i = 0; i < count; ++i) {
        padded[4 * i] = results[i].r;
        padded[4 * i + 1] = results[i].g;
        padded[4 * i + 2] = results[i].b;
    }
    glNamedBufferSubData(buffer.name(), offset, size, padded.data());
}

}  // namespace

void add_gl_emitters(const GlAsset& asset, const EmitterLight& light) {
    const formats::EmittersView emitters = asset.emitters.view();
    for (std::uint32_t p = 0; p < asset.primitives.size(); ++p) {
        const formats::PrimitiveRecord& primitive = asset.primitives[p];
        if (primitive.vertex_count == 0 || emitters.blocks_of(p).empty()) continue;
        if (needs_view(primitive)) {
            add_to_results(asset.product, primitive.first_row,
                           std::size_t{primitive.vertex_count} * primitive.terms, emitters, light,
                           p);
        } else {
            add_to_results(asset.radiance, primitive.first_vertex, primitive.vertex_count, emitters,
                           light, p);
        }
    }
}

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
