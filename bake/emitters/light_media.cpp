#include "bake/emitters/light_media.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "bake/emitters/media_patches.h"
#include "bake/exchange/other_light.h"
#include "bake/lamps/trace_particles.h"
#include "bake/receivers/receiver.h"
#include "bake/transport/packet_lane.h"
#include "formats/opal/cubemap.h"
#include "formats/opal/emitters.h"

namespace opaline::bake {
namespace {

constexpr std::uint32_t kMostPasses = 24;
constexpr double kLeastChange = 0.01;

MediaLight no_light(const MediaJob& job) {
    return {std::vector<std::vector<glm::vec3>>(job.primitives.size())};
}

// The values of a medium's receivers, [lamp][receiver], as those of its primitives.
template <class Value>
void add_medium(const MediaJob& job, const LitMedium& medium, std::size_t lamps, Value&& value,
                MediaLight& to) {
    for (std::size_t i = 0; i < medium.primitives.size(); ++i) {
        const std::uint32_t p = medium.primitives[i];
        const std::size_t size = job.receivers[p].size();
        to.exitance[p].resize(lamps * size);
        for (std::size_t e = 0; e < lamps; ++e) {
            for (std::size_t v = 0; v < size; ++v) {
                to.exitance[p][e * size + v] = value(e, medium.first[i] + v);
            }
        }
    }
}

// One more pass: the exitance of media under the irradiance in `light`.
MediaLight pass(const MediaJob& job, std::span<const LitMedium> media,
                std::span<const MediumPatches> patches, const LampLight& light,
                const Context& context, std::uint64_t& rays) {
    MediaLight next = no_light(job);
    for (std::size_t m = 0; m < media.size(); ++m) {
        if (patches[m].answer.empty()) continue;
        const std::size_t size = patches[m].size();
        const std::vector<glm::vec3> exitance =
            answer_patches(patches[m], light_patches(patches[m], light, media[m], context, rays));
        add_medium(
            job, media[m], light.sources.size(),
            [&](std::size_t e, std::size_t receiver) {
                return exitance[e * size + patches[m].of_receiver[receiver]];
            },
            next);
    }
    return next;
}

// Brings light of media to surfaces that reflect it: `elements` = `of_surfaces` and that.
void send(const MediaJob& job, const LampLight& light, const MediaLight& exitance,
          std::span<const ElementLight> of_surfaces, std::span<ElementLight> elements,
          const Context& context, std::uint64_t& rays) {
    for (std::uint32_t e = 0; e < elements.size() && !context.cancelled(); ++e) {
        const LampSources sources =
            media_sources(light.scene, exitance, e, light.sources[e], light.textures);
        // Lamps have the numbers below.
        const auto key = static_cast<std::uint32_t>(formats::kMaxEmitters) + e;
        // Rays of receivers find media by themselves, mirrored too.
        ParticleRun run{job.particles, key, light.seed, 0, light.textures};
        run.volumes = light.volumes;
        const auto deposits =
            trace_particles(light.scene, light.rays, sources, light.layout, run, context, rays).all;
        elements[e] = of_surfaces[e];
        if (!has_light(deposits)) continue;
        elements[e] = light.layout.join(deposits, kGatheredElements);
        for (std::size_t i = 0; i < of_surfaces[e].irradiance.size(); ++i) {
            elements[e].irradiance[i] += of_surfaces[e].irradiance[i];
        }
    }
}

// The rows of a medium's receivers as rows and exitance of its primitives.
void read_columns(const MediaJob& job, const LampLight& light, const LitMedium& medium,
                  std::size_t columns, const std::vector<std::vector<float>>& rows,
                  MediaRows& result, MediaLight& exitance) {
    const std::size_t lamps = light.sources.size();
    const std::size_t terms = job.media.layouts[medium.material].terms();
    for (std::size_t i = 0; i < medium.primitives.size(); ++i) {
        const std::uint32_t p = medium.primitives[i];
        const std::size_t receivers = job.receivers[p].size();
        result[p].assign(lamps, std::vector<formats::Rgb>(receivers * terms));
        exitance.exitance[p].resize(lamps * receivers);
        for (std::size_t v = 0; v < receivers; ++v) {
            const std::size_t receiver = medium.first[i] + v;
            const std::vector<float>& row = rows[receiver];
            const std::vector<glm::vec3> out =
                exitance_of_row(weigh_rows_at(job.media, light.scene, medium, receiver),
                                medium.color[receiver], row, columns);
            for (std::size_t e = 0; e < lamps; ++e) {
                exitance.exitance[p][e * receivers + v] = out[e];
                for (std::size_t k = 0; k < terms; ++k) {
                    const auto band = [&](std::size_t b) { return row[(3 * k + b) * columns + e]; };
                    result[p][e][v * terms + k] = {band(0), band(1), band(2)};
                }
            }
        }
    }
}

// Light that the surface of a medium mirrors reaches other surfaces, but is in no rows.
void add_mirrored(const MediaJob& job, const LitMedium& medium, const MediumPatches& patches,
                  std::span<const glm::vec3> irradiance, MediaLight& exitance) {
    for (std::size_t i = 0; i < medium.primitives.size(); ++i) {
        std::vector<glm::vec3>& values = exitance.exitance[medium.primitives[i]];
        const std::size_t receivers = job.receivers[medium.primitives[i]].size();
        for (std::size_t k = 0; k < values.size(); ++k) {
            const std::size_t lamp = k / receivers;
            const std::size_t patch = patches.of_receiver[medium.first[i] + k % receivers];
            values[k] += patches.mirrored * irradiance[lamp * patches.size() + patch];
        }
    }
}

// A ratio of two passes above this is taken for it: media are open somewhere.
constexpr double kLargestRatio = 0.95;

// Sums of what changed by lamp; of all where `before` has nothing.
std::vector<glm::dvec3> sum_change(const MediaLight& before, const MediaLight& after,
                                   std::size_t lamps) {
    std::vector<glm::dvec3> sums(lamps, glm::dvec3(0));
    for (std::size_t p = 0; p < after.exitance.size(); ++p) {
        const std::vector<glm::vec3>& values = after.exitance[p];
        const bool has_before = p < before.exitance.size() && !before.exitance[p].empty();
        for (std::size_t i = 0; i < values.size(); ++i) {
            const glm::vec3 from = has_before ? before.exitance[p][i] : glm::vec3(0);
            sums[i / (values.size() / lamps)] += glm::dvec3(glm::abs(values[i] - from));
        }
    }
    return sums;
}

constexpr std::size_t kMostPlaces = 64;  // of a lamp's triangles

// Evenly spread over the sphere, one for each lane: a spiral of the golden angle.
glm::vec3 spiral_direction(std::size_t i, std::size_t count) {
    const double z = 1 - (2 * static_cast<double>(i) + 1) / static_cast<double>(count);
    const double turn = static_cast<double>(i) * std::numbers::pi * (3 - std::sqrt(5.0));
    const double radius = std::sqrt(1 - z * z);
    return {radius * std::cos(turn), radius * std::sin(turn), z};
}

// `normal`: rays start on that side of it alone; 0: on all sides.
bool is_inside_medium(const formats::Scene& scene, const RayScene& rays, const glm::vec3& from,
                      const glm::vec3& normal) {
    RayPacket packet = rays_from(from);
    LaneMask lanes{};
    std::size_t started = 0, backs = 0;
    for (std::size_t i = 0; i < RayPacket::kSize; ++i) {
        const glm::vec3 direction = spiral_direction(i, RayPacket::kSize);
        set_lane(packet, lanes, i, direction);
        lanes[i] = glm::dot(direction, normal) >= 0 ? -1 : 0;
        started += lanes[i] != 0 ? 1 : 0;
    }
    const PacketHits hits = rays.closest(lanes, packet);
    for (std::size_t i = 0; i < RayPacket::kSize; ++i) {
        if (lanes[i] == 0 || hits.hit[i] == 0 || !(hits.cosine[i] > 0)) continue;
        const auto& medium = scene.materials[hits.material[i]].medium;
        backs += medium && medium->sigma_s != formats::Rgb{} ? 1 : 0;
    }
    return 2 * backs > started;
}

}  // namespace

std::uint32_t lamp_basis(std::size_t lamps) {
    std::uint32_t n = 1;
    while (formats::cubemap_texels(n) < lamps)
        n *= 2;
    return n;
}

MediaRows light_media(const MediaJob& job, const LampLight& light, std::span<ElementLight> elements,
                      MediaLight& exitance, const Context& context, std::uint64_t& rays) {
    const std::vector<LitMedium> media = list_lit_media(job.media, job.receivers, job.primitives);
    exitance = no_light(job);
    MediaRows result(job.primitives.size());
    if (media.empty()) return result;
    const std::vector<ElementLight> of_surfaces(elements.begin(), elements.end());
    LampLight lit = light;
    lit.elements = elements;
    lit.media = &exitance;
    std::vector<MediumPatches> patches;
    patches.reserve(media.size());
    for (const LitMedium& medium : media) {
        patches.push_back(find_patches(job.media, lit, medium, context, rays));
    }
    SeriesSum series(light.sources.size(), kLeastChange);
    for (std::uint32_t i = 0; i < kMostPasses && !context.cancelled(); ++i) {
        MediaLight next = pass(job, media, patches, lit, context, rays);
        const bool is_last = series.is_last(exitance, next, i + 1 == kMostPasses);
        exitance = std::move(next);
        send(job, light, exitance, of_surfaces, elements, context, rays);
        if (is_last) break;
    }
    const OtherLight columns{.lamps = &lit, .environment = false};
    const std::uint32_t n = lamp_basis(light.sources.size());
    MediaLight final_exitance = no_light(job);
    for (std::size_t m = 0; m < media.size(); ++m) {
        const LitMedium& medium = media[m];
        if (context.cancelled()) break;
        const std::vector<std::vector<float>> rows = light_medium(
            *job.media.finished,
            {medium.material, medium.outside, medium.inside, columns, n, false}, context, rays);
        if (rows.size() == medium.outside.size() && !patches[m].answer.empty()) {
            read_columns(job, light, medium, formats::cubemap_texels(n), rows, result,
                         final_exitance);
            add_mirrored(job, medium, patches[m],
                         light_patches(patches[m], lit, medium, context, rays), final_exitance);
        }
    }
    exitance = std::move(final_exitance);
    return result;
}

bool SeriesSum::is_last(const MediaLight& before, MediaLight& after, bool gets_none) {
    std::vector<glm::dvec3> change = sum_change(before, after, lamps_);
    const std::vector<glm::dvec3> all = sum_change({}, after, lamps_);
    bool is_settled = true;
    for (std::size_t e = 0; e < lamps_; ++e) {
        is_settled = is_settled && !glm::any(glm::greaterThan(change[e], least_ * all[e]));
    }
    std::swap(change, last_);  // last_: of this pass; change: of the one before
    if (!is_settled && !gets_none) return false;
    if (change.empty()) return true;
    for (std::size_t p = 0; p < after.exitance.size(); ++p) {
        std::vector<glm::vec3>& values = after.exitance[p];
        for (std::size_t i = 0; i < values.size(); ++i) {
            const std::size_t e = i / (values.size() / lamps_);
            for (int b = 0; b < 3; ++b) {
                const double ratio =
                    change[e][b] > 0 ? std::min(last_[e][b] / change[e][b], kLargestRatio) : 0;
                const float more = static_cast<float>(ratio / (1 - ratio)) *
                                   (values[i][b] - before.exitance[p][i][b]);
                values[i][b] = std::max(0.0f, values[i][b] + more);
            }
        }
    }
    return true;
}

bool is_immersed(const formats::Scene& scene, const RayScene& rays, const LampSources& lamp) {
    if (rays.is_empty()) return false;
    double inside = 0, all = 0;
    const auto count = [&](const glm::dvec3& from, const glm::dvec3& normal,
                           const glm::dvec3& power) {
        const double weight = power.x + power.y + power.z;
        all += weight;
        inside += is_inside_medium(scene, rays, glm::vec3(from), glm::vec3(normal)) ? weight : 0;
    };
    const std::size_t step = 1 + lamp.triangles.size() / kMostPlaces;
    for (std::size_t t = 0; t < lamp.triangles.size(); t += step) {
        const GlowingTriangle& triangle = lamp.triangles[t];
        const glm::dvec3 middle =
            (triangle.corner[0] + triangle.corner[1] + triangle.corner[2]) / 3.0;
        count(middle + 1e-4 * std::sqrt(triangle.area) * triangle.normal, triangle.normal,
              triangle.power());
    }
    for (const formats::Light& light : lamp.lights) {
        if (light.type == formats::Light::Type::directional) continue;
        count(glm::dvec3(light.position), glm::dvec3(0), light_power(lamp, light));
    }
    return all > 0 && 2 * inside > all;
}

}  // namespace opaline::bake
