#include "runtime/api_support.h"

namespace formats = opaline::formats;
using namespace opaline::runtime::api;

namespace {

static_assert(sizeof(formats::Vec3) == 3 * sizeof(float));
static_assert(sizeof(formats::Rgb) == 3 * sizeof(float));
static_assert(sizeof(formats::Float2) == 2 * sizeof(float));
static_assert(sizeof(formats::AddedVertex) == sizeof(opaline_added_vertex));
static_assert(offsetof(formats::AddedVertex, weight) == offsetof(opaline_added_vertex, weight));

}  // namespace

extern "C" {

opaline_status opaline_asset_primitive_mesh(const opaline_asset* asset, uint32_t index,
                                            opaline_primitive_mesh* mesh) {
    if (const char* const fault = fault_of_output(asset, mesh)) return invalid(fault);
    if (index >= opaline_asset_primitive_count(asset)) {
        return invalid("there is no primitive of that index");
    }
    const formats::AssetView& view = asset->loaded.view;
    const formats::PrimitiveRecord& p = view.primitives[index];
    std::size_t first_added = 0;
    for (std::uint32_t i = 0; i < index; ++i) {
        first_added += view.added.of(i);
    }
    const std::size_t v = p.first_vertex;
    *mesh = {
        sizeof(opaline_primitive_mesh),
        reinterpret_cast<const float*>(view.position.data() + v),
        reinterpret_cast<const float*>(view.normal.data() + v),
        reinterpret_cast<const float*>(view.base_color.data() + v),
        view.texcoord.empty() ? nullptr : reinterpret_cast<const float*>(view.texcoord.data() + v),
        view.index.data() + p.first_index,
        p.index_count,
        view.added.of(index),
        view.added.of(index) == 0 ? nullptr
                                  : reinterpret_cast<const opaline_added_vertex*>(
                                        view.added.vertex.data() + first_added)};
    return OPALINE_OK;
}

}  // extern "C"
