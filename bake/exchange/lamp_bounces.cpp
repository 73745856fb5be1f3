#include "bake/exchange/lamp_bounces.h"

#include <algorithm>
#include <array>
#include <utility>

#include "bake/base/ordered_parallel.h"
#include "bake/exchange/bounce_gather.h"
#include "bake/exchange/lamps/glow_light.h"
#include "bake/exchange/medium_answer.h"
#include "bake/exchange/scatterers.h"
#include "bake/exchange/solve_bounces.h"
#include "bake/physics/fresnel.h"
#include "bake/trace/touching_triangles.h"

namespace opaline::bake {
namespace {

constexpr std::uint32_t kColourBands = 3;

// Irradiance of all scatterers by one lamp, on their side and beyond it.
struct LampIrradiance {
    std::vector<glm::dvec3> front, beyond;
    std::vector<glm::dvec3> leaving{};  // exitance, of media around the lamp; empty: none
};

glm::dvec3 colour_of(const BandColour& c) {
    return {c[0], c[1], c[2]};
}

glm::dvec3 row_of(const CodedRows& rows, std::size_t node) {
    return {rows.value(node, 0), rows.value(node, 1), rows.value(node, 2)};
}

void set_row(CodedRows& rows, std::size_t i, const glm::vec3& value) {
    const std::array<float, kColourBands> row{value.x, value.y, value.z};
    rows.set(i, row);
}

// Rays end at edges, too: a place within rounding of another wall may be behind it.
Receiver place_outside(const BounceLight& surfaces, const Scatterer& s) {
    return surfaces.scene.materials[s.material].sheet || s.behind
               ? s.outside
               : leave_touching_triangles(surfaces.rays.hierarchy(), surfaces.scene, s.position,
                                          s.outside);
}

// Irradiance of each lamp at all scatterers, as `receive` has it at one place.
template <class Receive>
std::vector<LampIrradiance> light_scatterers(const LampLight& lamps, const BounceLight& surfaces,
                                             const Context& context, std::uint64_t& rays,
                                             Receive&& receive) {
    const std::vector<Scatterer>& scatterers = surfaces.transfer.scatterers;
    LampLight straight = lamps;
    straight.samples = std::min(lamps.samples, kRaysOfScatterer);
    straight.caustics = {};  // a cell has all that arrives in it
    const std::vector<glm::dvec3> dark(scatterers.size(), glm::dvec3(0));
    std::vector<LampIrradiance> lit(lamps.sources.size(), {dark, dark});
    for_each_block_in_order(
        scatterers.size(), 16, context,
        [&](Range range) {
            std::uint64_t traced = 0;
            for (std::size_t i = range.begin; i < range.end; ++i) {
                const Scatterer& s = scatterers[i];
                const Receiver outside = place_outside(surfaces, s);
                const auto front = receive(straight, outside, traced);
                for (std::size_t e = 0; e < lit.size(); ++e) {
                    lit[e].front[i] = front[e];
                }
                if (!lamps.scene.materials[s.material].sheet) continue;
                const auto beyond = receive(straight, s.beyond, traced);
                for (std::size_t e = 0; e < lit.size(); ++e) {
                    lit[e].beyond[i] = beyond[e];
                }
            }
            return traced;
        },
        [&](Range, std::uint64_t traced) { rays += traced; });
    return lit;
}

std::vector<LampIrradiance> light_straight(const LampLight& lamps, const BounceLight& surfaces,
                                           const Context& context, std::uint64_t& rays) {
    return light_scatterers(
        lamps, surfaces, context, rays,
        [](const LampLight& straight, const Receiver& at, std::uint64_t& traced) {
            return receive_straight(straight, at, traced);
        });
}

// Particles know nothing of it.
void add_light_of_volumes(const LampLight& lamps, const BounceLight& surfaces,
                          const Context& context, std::vector<LampIrradiance>& lit,
                          std::uint64_t& rays) {
    if (std::ranges::all_of(lamps.glow, [](const auto& own) { return !own; })) return;
    const auto scattered =
        light_scatterers(lamps, surfaces, context, rays,
                         [](const LampLight& light, const Receiver& at, std::uint64_t& traced) {
                             std::vector<glm::dvec3> sum(light.sources.size(), glm::dvec3(0));
                             add_from_volumes(light, at, key_of(at), sum, traced);
                             return sum;
                         });
    for (std::size_t e = 0; e < lit.size(); ++e) {
        for (std::size_t i = 0; i < lit[e].front.size(); ++i) {
            lit[e].front[i] += scattered[e].front[i];
            lit[e].beyond[i] += scattered[e].beyond[i];
        }
    }
}

void add_caustic(std::span<const ParticleCell> cells, std::span<glm::dvec3> irradiance) {
    for (std::size_t i = 0; i < cells.size(); ++i) {
        if (cells[i].area > 0) irradiance[i] += cells[i].power / cells[i].area;
    }
}

// B_0 of one lamp. Irradiances, which the last of several mirrors shows, are 0: what comes straight
// is in B_0 or a caustic.
CodedRows light_at_once(const LampLight& lamps, const Transfer& transfer, const LampIrradiance& lit,
                        const Context& context) {
    const std::size_t lobes = count_lobes(number_lobes(transfer.scatterers));
    CodedRows emitted(lit.front.size() + lobes, kColourBands);
    for (std::size_t i = 0; i < lit.front.size(); ++i) {
        const Scatterer& s = transfer.scatterers[i];
        const formats::Material& material = lamps.scene.materials[s.material];
        glm::dvec3 reflect = colour_of(transfer.answers.reflect[i]);
        // Particles have what metals mirror of a lamp; of what coats mirror rays follow what comes
        // from surfaces.
        if (!material.sheet && !material.medium && material.gloss.metallic > 0) {
            reflect = {s.albedo.diffuse.r, s.albedo.diffuse.g, s.albedo.diffuse.b};
        } else if (s.albedo.is_narrow) {
            const formats::Rgb& coat = s.albedo.mirrored;
            reflect += glm::dvec3(coat.r, coat.g, coat.b);
        }
        set_row(emitted, i,
                glm::vec3(reflect * lit.front[i] +
                          colour_of(transfer.answers.transmit[i]) * lit.beyond[i]));
    }
    if (transfer.answers.media.empty()) return emitted;
    CodedRows irradiance(lit.front.size(), kColourBands);
    for (const MediumAnswer& answer : transfer.answers.media) {
        for (const std::uint32_t i : answer.members) {
            const std::uint32_t material = transfer.scatterers[i].material;
            const double eta{lamps.scene.materials[material].medium->eta};
            const double mirrored = fresnel_moments(eta).external;
            set_row(irradiance, i, glm::vec3(lit.front[i]));
            set_row(emitted, i, glm::vec3(mirrored * lit.front[i]));
        }
        add_answer(answer, transfer.scatterers, irradiance, kColourBands, context, emitted);
        for (const std::uint32_t i : answer.members) {
            if (lit.leaving.empty()) continue;
            set_row(emitted, i, glm::vec3(row_of(emitted, i) + lit.leaving[i]));
        }
    }
    return emitted;
}

// What volumes leave of light of a node on its way to a place.
glm::dvec3 volume_share(const BounceTree& tree, std::uint32_t node, const glm::dvec3& to,
                        const DensitySpace& volumes) {
    // Of the sky, which has no lamps, or behind several mirrors.
    if (node >= tree.size()) return glm::dvec3(1);
    const glm::dvec3 way = glm::dvec3(tree.centre(node)) - to;
    const double distance = glm::length(way);
    return distance > 0 ? volume_transmittance(&volumes, to, way / distance, distance)
                        : glm::dvec3(1);
}

// With what volumes leave of light on its way, as the mean of the bands.
Transfer dim_arrivals(Transfer transfer, const BounceTree& tree, const DensitySpace& volumes,
                      const Context& context) {
    for_each_block_in_order(
        transfer.arrivals.size(), 16, context,
        [&](Range range) {
            for (std::size_t i = range.begin; i < range.end; ++i) {
                const glm::dvec3 to(transfer.scatterers[i].position);
                Arrivals& own = transfer.arrivals[i];
                for (std::vector<NodeWeight>* const all : {&own.front, &own.back}) {
                    for (NodeWeight& w : *all) {
                        const glm::dvec3 left = volume_share(tree, w.node, to, volumes);
                        w.weight *= static_cast<float>((left.x + left.y + left.z) / 3);
                    }
                }
            }
            return 0;
        },
        [](Range, int) {});
    return transfer;
}

}  // namespace

bool LampBounces::empty() const {
    return std::ranges::all_of(sent, [](const CodedRows& rows) { return rows.count() == 0; });
}

LampBounces find_lamp_bounces(const LampLight& lamps, const BounceLight* surfaces,
                              std::span<const ArrivedParticles> arrived, const Context& context,
                              std::uint64_t& rays) {
    LampBounces light{lamps};
    light.sent.resize(lamps.sources.size());
    if (surfaces == nullptr) return light;
    light.surfaces = surfaces;
    light.of_receiver = make_cut_grid(count_bounce_rays(lamps.samples));
    light.of_averaged = make_bounce_grid(kRaysOfAveraged);
    auto lit = light_straight(lamps, *surfaces, context, rays);
    for (std::size_t e = 0; e < arrived.size(); ++e) {
        if (const ParticleCells& cells = arrived[e].straight; !cells.empty()) {
            correct_by_particles(surfaces->tree, cells.front, lit[e].front);
            correct_by_particles(surfaces->tree, cells.beyond, lit[e].beyond);
        }
        add_caustic(arrived[e].caustic.front, lit[e].front);
        add_caustic(arrived[e].caustic.beyond, lit[e].beyond);
        if (!arrived[e].leaving.empty()) {
            lit[e].leaving.resize(lit[e].front.size());
            add_caustic(arrived[e].leaving.front, lit[e].leaving);
        }
    }
    add_light_of_volumes(lamps, *surfaces, context, lit, rays);
    BounceTree tree(surfaces->transfer.scatterers, lamps.scene.materials.size(), kColourBands);
    const Transfer dimmed = lamps.volumes == nullptr
                                ? Transfer{}
                                : dim_arrivals(surfaces->transfer, tree, *lamps.volumes, context);
    const Transfer& transfer = lamps.volumes == nullptr ? surfaces->transfer : dimmed;
    for (std::size_t e = 0; e < lit.size() && !context.cancelled(); ++e) {
        const CodedRows emitted = light_at_once(lamps, transfer, lit[e], context);
        bool is_dark = true;
        for (std::size_t i = 0; i < emitted.count() && is_dark; ++i) {
            is_dark = row_of(emitted, i) == glm::dvec3(0);
        }
        if (is_dark) continue;
        add_bounces(transfer, emitted, kColourBands, tree, context);
        light.sent[e] = tree.rows();
    }
    return light;
}

std::vector<glm::dvec3> receive_light(const LampBounces& light, const LitPoint& point,
                                      std::uint64_t key, std::uint64_t& rays) {
    LampLight straight = light.lamps;
    if (point.is_averaged) straight.samples = std::min(straight.samples, kRaysOfAveraged);
    std::vector<glm::dvec3> total = receive_straight(straight, point.receiver, rays);
    add_from_volumes(straight, point.receiver, key, total, rays);
    if (light.empty() || point.receiver.normal == glm::vec3(0)) return total;
    const BounceLight& surfaces = *light.surfaces;
    std::vector<NodeWeight> weights;
    // What volumes leave of a node's light is looked up for each.
    const LookUp look_up = straight.volumes != nullptr ? LookUp::node : LookUp::kernel;
    rays += weigh_bounces(surfaces.space(), surfaces.tree, point.receiver,
                          point.is_averaged ? light.of_averaged : light.of_receiver, surfaces.seed,
                          weights, look_up)
                .rays;
    for (const NodeWeight& w : weights) {
        glm::dvec3 share(w.weight);
        if (w.band != NodeWeight::kAllBands) {
            share = glm::dvec3(0);
            share[static_cast<glm::length_t>(w.band)] = static_cast<double>(w.weight);
        }
        if (straight.volumes != nullptr) {
            share *= volume_share(surfaces.tree, w.node, glm::dvec3(point.receiver.origin),
                                  *straight.volumes);
        }
        for (std::size_t e = 0; e < total.size(); ++e) {
            total[e] += share * sent_by(light, e, w.node);
        }
    }
    return total;
}

glm::dvec3 sent_by(const LampBounces& light, std::size_t lamp, std::size_t node) {
    const CodedRows& rows = light.sent[lamp];
    return rows.count() > 0 ? row_of(rows, node) : glm::dvec3(0);
}

glm::dvec3 find_sent(const LampBounces& light, const glm::vec3& position, const SurfaceSide& side) {
    glm::dvec3 sum(0);
    if (light.empty()) return sum;
    const std::uint32_t node = light.surfaces->tree.find(position, side, 0);
    if (node == formats::kNone) return sum;
    for (std::size_t lamp = 0; lamp < light.sent.size(); ++lamp) {
        sum += sent_by(light, lamp, node);
    }
    return sum;
}

}  // namespace opaline::bake
