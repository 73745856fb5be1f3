#include "bake/exchange/seen_light.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <numbers>
#include <optional>
#include <vector>

#include "bake/base/ordered_parallel.h"
#include "bake/base/rng.h"
#include "bake/exchange/lamps/onward_ray.h"
#include "bake/exchange/scatterers.h"
#include "bake/exchange/surface_side.h"
#include "bake/scene/base_color.h"
#include "bake/scene/texture_pyramid.h"
#include "formats/opal/cubemap.h"
#include "formats/opal/rgb.h"

namespace opaline::bake {
namespace {

// Radiance of a node in one of `bands` bands, in cells.
std::vector<float> cells_of(const BounceLight& light, std::span<const float> row, std::size_t band,
                            std::size_t bands, std::uint32_t n) {
    const std::uint32_t m = light.cubemap_size;
    const std::size_t texels = formats::cubemap_texels(m);
    std::vector<float> own(texels);
    if (bands == 1 && light.bands == 3) {
        for (std::size_t t = 0; t < texels; ++t) {
            own[t] = formats::luminance({row[t], row[texels + t], row[2 * texels + t]});
        }
    } else {
        std::ranges::copy(row.subspan(light.bands == 1 ? 0 : band * texels, texels), own.begin());
    }
    haar_inverse_cube(own, m);
    std::ranges::for_each(own, [](float& v) { v *= std::numbers::inv_pi_v<float>; });
    if (n <= m) return reduce_cells(own, m, n);
    std::vector<float> fine(formats::cubemap_texels(n));
    for (std::size_t i = 0; i < fine.size(); ++i) {
        fine[i] = own[coarser_texel(i, n, m)];
    }
    return fine;
}

// B of a leaf with what a narrow lobe mirrors there as if diffuse: rays of volumes do not follow
// it.
std::vector<float> sent_to_all_sides(const BounceLight& light, std::uint32_t leaf) {
    std::vector<float> row = light.tree.rows().row(leaf);
    const std::uint32_t irradiance = light.tree.irradiance_node(leaf);
    if (irradiance == formats::kNone) return row;
    const formats::Rgb& c =
        light.transfer.scatterers[light.tree.scatterer_of(leaf)].albedo.mirrored;
    const BandColour mirrored = in_bands({c.r, c.g, c.b}, light.bands);
    const std::size_t plane = row.size() / light.bands;
    for (std::size_t b = 0; b < light.bands; ++b) {
        light.tree.rows().add_part(irradiance, b * plane, mirrored[b],
                                   std::span(row).subspan(b * plane, plane));
    }
    return row;
}

constexpr std::uint32_t kMostPassedOn = 16;
constexpr double kLeastPassedOn = 1e-3;  // of what a view sees

// What a cone of directions [sr] sees of the surface at a hit, to look its texture up over; none
// where that does not vary.
std::optional<TextureView> view_of_cone(const LampLight& light, const Arrival& at,
                                        const glm::vec3& direction, double solid_angle) {
    const formats::Primitive& primitive = light.scene.primitives[at.side.primitive];
    if (light.textures == nullptr ||
        !has_pyramid(*light.textures, light.scene.materials[primitive.material])) {
        return std::nullopt;
    }
    return TextureView{*light.textures,
                       moments_of_cone(uv_gradient(primitive, at.side.first_index), direction,
                                       glm::vec3(at.normal), at.distance, solid_angle)};
}

glm::dvec3 emission_toward(const LampLight& light, const Arrival& at, const TextureView* view) {
    const formats::Primitive& primitive = light.scene.primitives[at.side.primitive];
    const formats::Material& material = light.scene.materials[primitive.material];
    if (!is_emissive(material) || (at.side.is_back && !material.double_sided)) {
        return glm::dvec3(0);
    }
    const std::uint32_t* const corner = &primitive.index[at.side.first_index];
    const glm::vec3 weights(at.weights);
    const formats::Rgb c =
        emission_at(light.scene, at.side.primitive, {corner[0], corner[1], corner[2]},
                    {weights.x, weights.y, weights.z}, view);
    return {c.r, c.g, c.b};
}

// Radiance times pi of each lamp along a view.
class LampView {
  public:
    LampView(const LampBounces& bounces, std::vector<glm::dvec3>& sum)
        : bounces_(bounces), light_(bounces.lamps), sum_(sum) {}

    std::uint64_t follow(const SurfaceView& look, double solid_angle, std::uint64_t key,
                         std::uint32_t number) {
        glm::dvec3 from(look.origin), direction(look.direction), weight(1);
        std::uint64_t rays = 0;
        PathDifferential unused;
        for (std::uint32_t flight = 0; flight < kMostPassedOn; ++flight) {
            ++rays;
            const auto at = light_.rays.is_empty()
                                ? std::nullopt
                                : find_arrival(light_.rays, glm::vec3(from), glm::vec3(direction));
            const double reach = at ? at->distance : std::numeric_limits<double>::infinity();
            add_glow(from, direction, reach, weight);
            if (!at) return rays;
            weight *= straight_transmittance(light_.scene, *at) *
                      volume_transmittance(light_.volumes, from, direction, reach);
            const auto view =
                flight == 0 ? view_of_cone(light_, *at, look.direction, solid_angle) : std::nullopt;
            add_surface(from + reach * direction, *at, weight, view ? &*view : nullptr);
            const bool is_medium = lets_through(light_.scene, *at);
            if (!is_medium && mirror_chance(light_.scene, *at, direction) == 0) return rays;
            const auto x = random_uniform(light_.seed, RandomStage::gather_rays, key,
                                          1 + number * kMostPassedOn + flight);
            unused.count = 0;
            const auto onward =
                is_medium ? cross_boundary(light_.scene, *at, direction, first_three(x), {}, unused)
                          : mirror_ray(light_.scene, *at, direction,
                                       {static_cast<double>(x[0]), static_cast<double>(x[1])}, {},
                                       unused);
            if (!onward) return rays;
            weight *= onward->weight;
            if (!(largest_band(weight) > kLeastPassedOn)) return rays;
            from = leave_surface(from, direction, *at, onward->crosses);
            direction = onward->direction;
        }
        return rays;
    }

  private:
    void add_surface(const glm::dvec3& position, const Arrival& at, const glm::dvec3& weight,
                     const TextureView* view) {
        add_sent(position, at, weight);
        const glm::dvec3 glow = emission_toward(light_, at, view);
        if (glow == glm::dvec3(0)) return;
        for (std::size_t lamp = 0; lamp < sum_.size(); ++lamp) {
            const auto& own = light_.sources[lamp].primitives;
            if (std::ranges::find(own, at.side.primitive) != own.end()) {
                sum_[lamp] += std::numbers::pi * weight * glow;
            }
        }
    }

    // Of the scatterer nearest to the hit.
    void add_sent(const glm::dvec3& position, const Arrival& at, const glm::dvec3& weight) {
        if (bounces_.empty()) return;
        const formats::Primitive& primitive = light_.scene.primitives[at.side.primitive];
        const std::uint32_t node = bounces_.surfaces->tree.find(
            glm::vec3(position), {primitive.material, at.side.is_back, glm::vec3(at.normal)}, 0);
        if (node == formats::kNone) return;
        for (std::size_t lamp = 0; lamp < sum_.size(); ++lamp) {
            sum_[lamp] += weight * sent_by(bounces_, lamp, node);
        }
        // What a coat mirrors of surfaces; metals go on.
        const std::uint32_t irradiance = bounces_.surfaces->tree.irradiance_node(node);
        if (irradiance == formats::kNone ||
            light_.scene.materials[primitive.material].gloss.metallic > 0) {
            return;
        }
        const std::uint32_t i = bounces_.surfaces->tree.scatterer_of(node);
        const formats::Rgb& coat = bounces_.surfaces->transfer.scatterers[i].albedo.mirrored;
        for (std::size_t lamp = 0; lamp < sum_.size(); ++lamp) {
            sum_[lamp] +=
                weight * glm::dvec3(coat.r, coat.g, coat.b) * sent_by(bounces_, lamp, irradiance);
        }
    }

    void add_glow(const glm::dvec3& from, const glm::dvec3& direction, double reach,
                  const glm::dvec3& weight) {
        for (std::size_t lamp = 0; lamp < light_.glow.size(); ++lamp) {
            if (!light_.glow[lamp]) continue;
            sum_[lamp] += std::numbers::pi * weight *
                          glow_radiance(*light_.glow[lamp], from, direction, reach);
        }
    }

    const LampBounces& bounces_;
    const LampLight& light_;
    std::vector<glm::dvec3>& sum_;
};

}  // namespace

SeenLight see_surfaces(const BounceLight& light, const DensitySpace& space, const LightCells& cells,
                       std::size_t bands, const Context& context) {
    constexpr std::size_t kSeenAtOnce = 16;
    const std::vector<std::uint32_t> leaves = light.tree.leaves();
    SeenLight seen{light, bands, CodedRows(leaves.size() * bands, cells.size())};
    for_each_block_in_order(
        leaves.size(), kSeenAtOnce, context,
        [&](Range range) {
            std::vector<float> through(space.extinction_bands() * cells.size());
            for (std::size_t i = range.begin; i < range.end; ++i) {
                const std::uint32_t node = leaves[i];
                gather_transmittance(space, cells, light.tree.centre(node), through);
                const std::vector<float> sent = sent_to_all_sides(light, node);
                for (std::size_t band = 0; band < bands; ++band) {
                    std::vector<float> row = cells_of(light, sent, band, bands, cells.n);
                    const std::size_t own = space.is_grey ? 0 : band * cells.size();
                    for (std::size_t k = 0; k < row.size(); ++k) {
                        row[k] *= through[own + k];
                    }
                    seen.rows.set(light.tree.scatterer_of(node) * bands + band, row);
                }
            }
            return true;
        },
        [&](Range range, bool) {
            if (context.on_progress) {
                context.on_progress({"surfaces that volumes see", range.end, leaves.size()});
            }
        });
    return seen;
}

void add_seen(const SeenLight& seen, const MetPlace& met, const std::array<float, 3>& weight,
              std::size_t first, std::size_t end, std::span<float> sum) {
    const formats::Material& material = seen.light.scene.materials[met.material];
    const SeenSide side = side_of(material, met.normal, met.cosine);
    if (!side.is_seen) return;
    const std::uint32_t node =
        seen.light.tree.find(met.position, {met.material, side.behind, side.normal}, 0);
    if (node == formats::kNone) return;
    const std::size_t row = seen.light.tree.scatterer_of(node) * seen.bands;
    const std::size_t cells = seen.rows.size();
    for (std::size_t band = first; band < end; ++band) {
        seen.rows.add(row + band, weight[band], sum.subspan(band * cells, cells));
    }
}

std::uint64_t add_seen_lamps(const LampBounces& light, std::span<const SurfaceView> views,
                             double solid_angle, std::uint64_t key, const DenseRow& row) {
    std::uint64_t rays = 0;
    std::vector<glm::dvec3> seen(light.lamps.sources.size());
    for (std::uint32_t i = 0; i < views.size(); ++i) {
        const SurfaceView& view = views[i];
        std::ranges::fill(seen, glm::dvec3(0));
        rays += LampView(light, seen).follow(view, solid_angle, key, i);
        for (std::uint32_t k = 0; k < view.factor.size(); ++k) {
            for (std::uint32_t b = 0; b < row.bands; ++b) {
                const std::span<float> to = row.plane(k, b);
                const float share = std::numbers::inv_pi_v<float> * view.factor[k] * view.weight[b];
                for (std::size_t lamp = 0; lamp < seen.size(); ++lamp) {
                    to[lamp] += share * static_cast<float>(seen[lamp][static_cast<int>(b)]);
                }
            }
        }
    }
    return rays;
}

}  // namespace opaline::bake
