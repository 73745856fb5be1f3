#include "runtime/api_support.h"

namespace formats = opaline::formats;
using namespace opaline::runtime::api;

extern "C" {

uint32_t opaline_asset_emitter_count(const opaline_asset* asset) {
    return asset == nullptr ? 0 : asset->loaded.view.emitters.size();
}

opaline_status opaline_asset_emitter(const opaline_asset* asset, uint32_t index,
                                     opaline_emitter_info* info) {
    if (const char* const fault = fault_of_output(asset, info)) return invalid(fault);
    const formats::EmittersView& emitters = asset->loaded.view.emitters;
    if (index >= emitters.size()) return invalid("there is no emitter of that index");
    static_assert(sizeof info->name > formats::kMaxEmitterName);
    *info = {sizeof(opaline_emitter_info), {}};
    emitters.name(index).copy(info->name, formats::kMaxEmitterName);
    return OPALINE_OK;
}

opaline_status opaline_asset_primitive_emission(const opaline_asset* asset, uint32_t index,
                                                opaline_primitive_emission* emission) {
    if (const char* const fault = fault_of_output(asset, emission)) return invalid(fault);
    if (index >= opaline_asset_primitive_count(asset)) {
        return invalid("there is no primitive of that index");
    }
    const formats::OwnLight* const own = asset->loaded.view.emitters.own_of(index);
    const formats::Rgb radiance = own == nullptr ? formats::Rgb{} : own->radiance;
    *emission = {sizeof(opaline_primitive_emission),
                 own == nullptr ? OPALINE_NO_EMITTER : own->emitter,
                 {radiance.r, radiance.g, radiance.b}};
    return OPALINE_OK;
}

opaline_status opaline_light_set_emitter(opaline_light* light, uint32_t index,
                                         const float color[3]) {
    if (light == nullptr || color == nullptr) return null_argument();
    if (index >= light->emitters.size()) {
        return invalid("the light's asset has no emitter of that index");
    }
    if (!is_radiance(color, 3)) return invalid("a colour must be finite and not negative");
    const opaline::runtime::Writing writing(light->users);
    if (!writing) return busy();
    light->emitters[index] = {color[0], color[1], color[2]};
    return OPALINE_OK;
}

}  // extern "C"
