#include "runtime/gl/gl_volumes.h"

#include "runtime/gl/gl_objects.h"
#include "runtime/volumes/relight_volumes.h"

namespace opaline::runtime {
namespace {

using formats::TermSet;

TermSet of_volumes(TermSet terms) {
    return terms & (TermSet::volume_single | TermSet::volume_multiple);
}

}  // namespace

formats::Status relight_gl_volumes(GlVolumeLight& lit, VolumeTextures& textures,
                                   const LightVector& light, const EmitterLight& emitters) {
    if (textures.size() == 0) return formats::ok_status();
    lit.light = light;
    lit.emitters.assign(emitters.color.begin(), emitters.color.end());
    lit.shows_own = emitters.shows_own;
    lit.terms = TermSet::none;
    return show_volume_terms(lit, textures, TermSet::all);
}

formats::Status show_volume_terms(GlVolumeLight& lit, VolumeTextures& textures, TermSet terms) {
    if (textures.size() == 0 || lit.terms == of_volumes(terms)) return formats::ok_status();
    lit.terms = of_volumes(terms);
    if (lit.light.n == 0) return formats::ok_status();  // uploaded without light
    return as_status(textures.upload(relight_volumes(
        lit.volumes, lit.light, {.terms = lit.terms, .emitters = {lit.emitters, lit.shows_own}})));
}

}  // namespace opaline::runtime
