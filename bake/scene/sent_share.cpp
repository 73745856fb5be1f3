#include "bake/scene/sent_share.h"

#include <algorithm>

#include "bake/scene/lobe_record.h"
#include "bake/scene/medium_field.h"

namespace opaline::bake {
namespace {

bool is_grey(formats::Rgb c) {
    return c.r == c.g && c.g == c.b;
}

// Whether all that its rows are multiplied by is grey, and what its lobe mirrors.
bool shows_grey(const formats::Scene& scene, std::uint32_t material) {
    const formats::Material& m = scene.materials[material];
    bool grey = is_grey(m.base_color) && m.base_color_image == formats::kNone && !m.marble &&
                (m.medium || m.gloss.is_diffuse() || is_grey(m.gloss.specular_color));
    for (const formats::Primitive& p : scene.primitives) {
        grey = grey && (p.material != material ||
                        std::ranges::all_of(p.color, [](formats::Rgb c) { return is_grey(c); }));
    }
    return grey;
}

// Bound on what the lobe of an opaque or thin-walled material mirrors of even light, whatever its
// textures say: at the ends of its roughness and colour.
float most_mirrored(const formats::Material& material) {
    const formats::GlossRecord record = make_lobe_record(material.gloss);
    float most = 0;
    for (const float rough : {0.0f, 0.5f, 1.0f}) {
        for (const float metallic : {0.0f, material.gloss.metallic}) {
            const formats::Rgb mirrored =
                mean_reflectance(formats::make_gloss_surface(record, {1, 1, 1}, metallic,
                                                             rough * material.gloss.roughness))
                    .mirrored;
            most = std::max({most, mirrored.r, mirrored.g, mirrored.b});
        }
    }
    return most;
}

}  // namespace

SentShare find_sent_share(const formats::Scene& scene, std::uint32_t material,
                          float brightest_vertex) {
    const formats::Material& m = scene.materials[material];
    formats::Rgb c = m.base_color;
    if (m.sheet) {
        c = c * (m.sheet->reflect + m.sheet->transmit);
    }
    const float largest = std::max({c.r, c.g, c.b}) * brightest_vertex *
                          (m.medium ? 1.0f : formats::diffuse_share(m));
    SentShare share;
    share.diffuse = std::min(1.0, static_cast<double>(largest));
    if (m.medium) {
        // A boundary mirrors all light that grazes it.
        share.all = m.medium->eta == 1 ? share.diffuse : 1;
    } else {
        share.all = std::min(1.0, share.diffuse + static_cast<double>(most_mirrored(m)));
    }
    share.is_grey = shows_grey(scene, material) &&
                    ((!m.medium && !m.sheet) || has_grey_numbers(scene, material));
    return share;
}

bool has_grey_numbers(const formats::Scene& scene, std::uint32_t material) {
    const formats::Material& m = scene.materials[material];
    if (m.sheet) return is_grey(m.sheet->reflect) && is_grey(m.sheet->transmit);
    return m.medium && is_grey(m.medium->sigma_s) && is_grey(m.medium->sigma_a) &&
           (!m.medium->variation || is_grey(scene, *m.medium->variation));
}

}  // namespace opaline::bake
