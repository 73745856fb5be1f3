#include "bake/check/stored_luminance.h"

#include <array>

#include "runtime/view_terms.h"

namespace opaline::bake {
namespace {

constexpr std::array<float, 3> kLuminance{0.2126f, 0.7152f, 0.0722f};

struct RowSum {
    std::span<float> band;  // of one row, overwritten
    std::span<float> sum;   // of the same size
};

// Adds weight * sum_k h_k luminance of row k.
void add_luminance(const RowSource& source, std::span<const float> h, float weight,
                   const RowSum& to) {
    const formats::RowRange& range = source.range;
    for (std::uint32_t k = 0; k < h.size(); ++k) {
        for (std::uint32_t b = 0; b < range.bands; ++b) {
            formats::decode_row(source.rows, range, source.first_row + k, b, to.band);
            const float share = weight * h[k] * (range.bands == 1 ? 1.0f : kLuminance[b]);
            for (std::size_t j = 0; j < to.sum.size(); ++j) {
                to.sum[j] += share * to.band[j];
            }
        }
    }
}

Luminance relit_by_each(std::span<const float> row, std::span<const TestLight> lights) {
    Luminance luminance;
    for (const TestLight& light : lights) {
        luminance.push_back(relit(row, light.coarse));
    }
    return luminance;
}

formats::Vec3 to_vec3(glm::vec3 v) {
    return {v.x, v.y, v.z};
}

// h_k of a vertex for an eye far away in direction `to_eye`; none where the runtime shows black.
std::vector<float> view_from_far(const RowLayout& layout, float eta, formats::Vec3 normal,
                                 glm::vec3 to_eye) {
    if (normal == formats::Vec3{}) {
        return {};
    }
    const formats::Vec3 w = to_vec3(to_eye);
    const formats::Vec3 inside = runtime::refract_to_eye(normal, w, formats::dot(normal, w), eta);
    return view_of_rows(layout, {inside.x, inside.y, inside.z});
}

}  // namespace

std::vector<float> view_of_rows(const RowLayout& layout, glm::vec3 normal, bool behind) {
    if (layout.sheet) {
        return behind ? std::vector{0.0f, 1.0f} : std::vector{1.0f, 0.0f};
    }
    std::vector<float> h(layout.terms(), 1.0f);
    const std::size_t first = layout.first_harmonic();
    if (layout.all_harmonics() > 0) {
        runtime::eval_view_terms(to_vec3(normal), std::span(h).subspan(first));
    }
    return h;
}

Luminance relight_rows(const RowSource& source, std::span<const float> h,
                       std::span<const TestLight> lights) {
    const std::size_t size = lights.front().coarse.size();
    std::vector<float> band(size), sum(size);
    add_luminance(source, h, 1.0f, {band, sum});
    return relit_by_each(sum, lights);
}

Luminance relight_point(const formats::AssetView& asset, const CheckPoint& point,
                        const RowLayout& layout, std::span<const TestLight> lights) {
    const formats::PrimitiveRecord& primitive = asset.primitives[point.primitive];
    const formats::RowRange range = asset.rows_of(point.primitive);
    const std::size_t size = lights.front().coarse.size();
    std::vector<float> band(size), sum(size);
    for (std::size_t k = 0; k < point.vertex.size(); ++k) {
        if (point.weight[k] == 0) continue;
        const std::uint32_t v = point.vertex[k];
        if (asset.slots.is_mixed(v)) {
            const formats::SlotMix& mix = asset.slots.mix[v];
            const std::vector<float> h = view_of_rows(layout, point.body.normal, point.behind);
            for (std::size_t i = 0; i < std::size(mix.slot); ++i) {
                const std::uint32_t slot = mix.slot[i] - asset.slots.offset[point.primitive];
                const float share = static_cast<float>(mix.weight[i]) / 255;
                if (share == 0) continue;
                add_luminance({asset.transport, range, slot}, h, point.weight[k] * share,
                              {band, sum});
            }
            continue;
        }
        const std::vector<float> h =
            layout.translucent ? view_from_far(layout, primitive.eta, asset.normal[v], point.view())
                               : view_of_rows(layout, point.body.normal, point.behind);
        add_luminance({asset.transport, range, asset.slot_of(point.primitive, v) * primitive.terms},
                      h, point.weight[k], {band, sum});
    }
    return relit_by_each(sum, lights);
}

}  // namespace opaline::bake
