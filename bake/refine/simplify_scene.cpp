#include "bake/refine/simplify_scene.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "bake/base/ordered_parallel.h"
#include "bake/base/rng.h"
#include "bake/receivers/surface_points.h"
#include "bake/receivers/surface_samples.h"
#include "bake/refine/coarse_mesh.h"
#include "bake/refine/dense_part.h"
#include "bake/refine/interpolation_error.h"
#include "bake/refine/proxy_rows.h"
#include "bake/refine/receiver_spacing.h"
#include "bake/scene/shared_rows.h"
#include "formats/opal/cubemap.h"

namespace opaline::bake {
namespace {

constexpr float kAnywhere = std::numeric_limits<float>::infinity();
// Of the receivers: with more of them, all stay. By normals alone fewer must do: finding where
// shadows are costs as much as a draft's rows of a third of them.
constexpr double kWorthwhile = 0.75, kWorthLooking = 1.0 / 3;

formats::Slots every_place(const formats::Scene& scene) {
    formats::Slots places = find_slots(scene);
    if (!places.empty()) return places;
    places.offset = {0};
    for (const formats::Primitive& p : scene.primitives) {
        places.offset.push_back(places.offset.back() +
                                static_cast<std::uint32_t>(p.position.size()));
    }
    places.slot.resize(places.offset.back());
    std::iota(places.slot.begin(), places.slot.end(), 0u);
    places.vertex = places.slot;
    return places;
}

constexpr std::size_t kFewest = 256, kFewestOfAll = 2048;  // of fewer, nothing is saved

bool is_eligible(const formats::Material& material) {
    return !material.medium && !material.sheet && !formats::is_metal(material);
}

struct SimplifyJob {
    const formats::Scene& scene;
    const RayScene& rays;
    const SimplifyLimits& limits;
    const Context& context;
    std::uint64_t traced = 0;
};

// Squares that a mesh may err by, relative to an open receiver.
struct Tolerance {
    double normals = 0, outlines = 0;
};

void coarsen_all(const Tolerance& tolerance, const Context& context, std::span<DensePart> parts) {
    for_each_block_in_order(
        parts.size(), 1, context,
        [&](Range range) {
            return coarsen(parts[range.begin].mesh,
                           {parts[range.begin].spacing, tolerance.normals});
        },
        [&](Range range, std::vector<CoarseMix> mix) { parts[range.begin].mix = std::move(mix); });
}

// Looks around at vertices that others are interpolated from; how many there were.
std::size_t ask_for_outlines(SimplifyJob& job, std::span<DensePart> parts) {
    const DirectionSet directions = make_texel_directions(8);
    std::vector<std::pair<DensePart*, std::uint32_t>> asked;
    for (DensePart& part : parts) {
        for (std::uint32_t v = 0; v < part.mix.size(); ++v) {
            if (!is_mixed(part, v)) continue;
            for (const std::uint32_t u : part.mix[v].vertex) {
                if (part.is_asked[u]) continue;
                part.is_asked[u] = true;
                asked.emplace_back(&part, u);
            }
        }
    }
    using Found = std::pair<std::vector<std::vector<SkyOutline>>, std::uint64_t>;
    constexpr std::size_t kBlock = 64;
    for_each_block_in_order(
        asked.size(), kBlock, job.context,
        [&](Range range) {
            Found found;
            for (std::size_t i = range.begin; i < range.end; ++i) {
                const auto& [part, v] = asked[i];
                const ProxyPoint& at = part->at[v];
                const SurfaceSample sample = make_surface_sample(
                    job.scene,
                    make_surface_point(job.scene, {at.primitive, at.first_index}, at.barycentric),
                    0);
                found.first.push_back(
                    find_outlines(job.rays, directions, sample.receiver, found.second));
            }
            return found;
        },
        [&](Range range, Found found) {
            for (std::size_t i = range.begin; i < range.end; ++i) {
                asked[i].first->outlines[asked[i].second] = std::move(found.first[i - range.begin]);
            }
            job.traced += found.second;
        });
    return asked.size();
}

// Where nobody looked, spacing grows with the distance from where somebody did.
void set_spacing(const SimplifyJob& job, double square, DensePart& part) {
    constexpr float kGrowth = 0.5f, kWidest = 1.0f / 8;  // of the part
    std::vector<float> asked(part.outlines.size(), kAnywhere);
    for (std::uint32_t v = 0; v < asked.size(); ++v) {
        if (part.is_asked[v]) asked[v] = spacing_for(part.outlines[v], job.limits.angle, square);
    }
    for (std::uint32_t v = 0; v < asked.size(); ++v) {
        float spacing = std::min(asked[v], kWidest * part.size);
        if (!part.is_asked[v] && is_mixed(part, v)) {
            for (const std::uint32_t u : part.mix[v].vertex) {
                spacing =
                    std::min(spacing, asked[u] + kGrowth * glm::distance(part.mesh.position[u],
                                                                         part.mesh.position[v]));
            }
        }
        part.spacing[v] = spacing;
    }
}

// What it takes to know whether vertices may go: rows of proxies, of each vertex once.
class ErrorMeter {
  public:
    ErrorMeter(const formats::Scene& scene, const RayScene& rays,
               std::span<const LampSources> lamps, const SimplifyLimits& limits,
               std::span<const DensePart> parts)
        : tracer_(scene, rays, limits.cubemap_size, lamps),
          rows_(tracer_.no_rows()),
          solid_angle_(formats::texel_solid_angles(limits.cubemap_size)) {
        std::vector<std::uint32_t> primitives, part_of(scene.primitives.size());
        for (std::uint32_t i = 0; i < parts.size(); ++i) {
            primitives.push_back(parts[i].primitive);
            part_of[parts[i].primitive] = i;
            row_.emplace_back(parts[i].at.size(), formats::kNone);
        }
        const AreaTable table = make_area_table(scene, primitives);
        if (!(table.total() > 0)) return;
        for (const SurfacePoint& at : scatter_points(scene, table, limits.points, false,
                                                     limits.seed, RandomStage::refine_probes)) {
            points_.push_back({part_of[at.primitive], at});
        }
    }

    /// Relative mean square at mixed vertices, of the kind of light that errs most.
    double measure(SimplifyJob& job, const formats::Slots& places,
                   std::span<const DensePart> parts) {
        std::vector<std::pair<std::uint32_t, std::uint32_t>> checked;
        std::vector<ProxyPoint> wanted;
        const auto want = [&](std::uint32_t part, std::uint32_t v) {
            if (row_[part][v] != formats::kNone) return;
            row_[part][v] = static_cast<std::uint32_t>(rows_.size() + wanted.size());
            wanted.push_back(parts[part].at[v]);
        };
        for (const auto& [part, at] : points_) {
            const std::uint32_t v = nearest_vertex(job.scene, places, parts[part], at);
            if (!is_mixed(parts[part], v)) continue;
            checked.emplace_back(part, v);
            want(part, v);
            for (const std::uint32_t u : parts[part].mix[v].vertex) {
                want(part, u);
            }
        }
        job.traced += tracer_.append(wanted, job.context, rows_);
        if (job.context.cancelled()) return 0;
        ErrorColumns error{}, light{};
        for (const auto& [part, v] : checked) {
            add_square(part, v, parts[part].mix[v], error, light);
        }
        double worst = 0;
        for (std::size_t c = 0; c < error.size(); ++c) {
            if (light[c] > 0) worst = std::max(worst, error[c] / light[c]);
        }
        return worst;
    }

  private:
    static std::uint32_t nearest_vertex(const formats::Scene& scene, const formats::Slots& places,
                                        const DensePart& part, const SurfacePoint& at) {
        const glm::vec3 b = at.barycentric;
        const std::uint32_t k = b.x >= b.y && b.x >= b.z ? 0 : b.y >= b.z ? 1 : 2;
        const std::uint32_t v = scene.primitives[part.primitive].index[at.first_index + k];
        return places.slot[part.first_vertex + v] - part.first_place;
    }

    // Hidden vertices get rows beside visible ones.
    void add_square(std::uint32_t part, std::uint32_t v, const CoarseMix& mix, ErrorColumns& error,
                    ErrorColumns& light) const {
        const std::uint32_t own = row_[part][v];
        if (rows_.hidden[own] != 0) return;
        std::array<MixedRow, 3> others{};
        std::size_t count = 0;
        float sum = 0;
        for (std::size_t k = 0; k < mix.vertex.size(); ++k) {
            const std::uint32_t row = row_[part][mix.vertex[k]];
            if (rows_.hidden[row] != 0 || !(mix.weight[k] > 0)) continue;
            others[count++] = {row, mix.weight[k]};
            sum += mix.weight[k];
        }
        for (std::size_t k = 0; k < count; ++k) {
            others[k].weight /= sum;
        }
        const ErrorColumns e =
            square_beyond(rows_, solid_angle_, own, std::span(others).first(count));
        const ErrorColumns whole = square_beyond(rows_, solid_angle_, own, {});
        for (std::size_t c = 0; c < error.size(); ++c) {
            error[c] += e[c];
            light[c] += whole[c];
        }
    }

    struct DrawnPoint {
        std::uint32_t part;
        SurfacePoint at;
    };

    ProxyTracer tracer_;
    ProxyRows rows_;
    std::vector<double> solid_angle_;
    std::vector<std::vector<std::uint32_t>> row_;  // of each vertex of each part
    std::vector<DrawnPoint> points_;
};

void tell_rounds(const Context& context, std::uint64_t done, std::uint64_t all) {
    if (context.on_progress) context.on_progress({"simplification", done, all});
}

// Takes away all that the tolerances allow: the first time in rounds, until those that stay, where
// outlines are known, are close enough to each other.
void take_away(SimplifyJob& job, const Tolerance& tolerance, std::span<DensePart> parts) {
    constexpr int kMostLooks = 6;
    constexpr double kFew = 0.01;
    for (int round = 0; round < kMostLooks && !job.context.cancelled(); ++round) {
        const std::size_t asked = ask_for_outlines(job, parts);
        for (DensePart& part : parts) {
            set_spacing(job, tolerance.outlines, part);
        }
        coarsen_all(tolerance, job.context, parts);
        if (static_cast<double>(asked) < kFew * static_cast<double>(count_kept(parts))) return;
    }
}

}  // namespace

bool has_dense_meshes(const formats::Scene& scene) {
    std::size_t vertices = 0;
    for (const formats::Primitive& p : scene.primitives) {
        const bool counts =
            p.position.size() >= kFewest && is_eligible(scene.materials[p.material]);
        vertices += counts ? p.position.size() : 0;
    }
    return vertices >= kFewestOfAll;
}

SimplifiedScene simplify_scene(const formats::Scene& scene, const RayScene& rays,
                               std::span<const LampSources> lamps, const SimplifyLimits& limits,
                               const Context& context) {
    SimplifiedScene result;
    formats::Slots places = every_place(scene);
    result.report.given = result.report.kept = places.vertex.size();
    const auto all_stay = [&] {
        result.slots = find_slots(scene);
        return std::move(result);
    };
    std::vector<DensePart> parts;
    std::uint32_t next_vertex = 0;
    for (std::uint32_t p = 0; p < scene.primitives.size(); ++p) {
        const std::uint32_t first_vertex = next_vertex;
        next_vertex += static_cast<std::uint32_t>(scene.primitives[p].position.size());
        if (places.offset[p + 1] - places.offset[p] < kFewest ||
            !is_eligible(scene.materials[scene.primitives[p].material])) {
            continue;
        }
        parts.push_back(make_dense_part(scene, places, p, first_vertex));
    }
    SimplifyJob job{scene, rays, limits, context, 0};
    const double given =
        std::accumulate(parts.begin(), parts.end(), 0.0, [](double sum, const DensePart& part) {
            return sum + static_cast<double>(part.at.size());
        });
    if (given < kFewestOfAll) return all_stay();
    const auto are_fewer = [&](double share) {
        return static_cast<double>(count_kept(parts)) <= share * given;
    };
    // Where measuring begins: normals err by their bound at the worst vertices alone. The bound of
    // outlines is hardly ever reached in the mean, but where it is, shadows of suns fade.
    const double square = limits.error * limits.error;
    Tolerance tolerance{2 * square, square};
    constexpr float kFirst = 1.0f / 16;
    for (DensePart& part : parts) {
        part.spacing.assign(part.at.size(), kFirst * part.size);
    }
    coarsen_all(tolerance, context, parts);
    if (!are_fewer(kWorthLooking)) return all_stay();
    tell_rounds(context, 0, 1);
    ErrorMeter meter(scene, rays, lamps, limits, parts);
    constexpr int kMostTries = 4;
    for (int attempt = 0; attempt < kMostTries; ++attempt) {
        take_away(job, tolerance, parts);
        if (context.cancelled() || !are_fewer(kWorthwhile)) break;
        const double found = meter.measure(job, places, parts);
        if (context.cancelled()) break;
        if (found <= square) {
            result.report.kept -= static_cast<std::uint64_t>(given) - count_kept(parts);
            result.report.error = std::sqrt(std::max(0.0, found));
            result.report.rays = job.traced;
            tell_rounds(context, 1, 1);
            result.slots = make_slots(std::move(places), parts);
            return result;
        }
        const double tighter = std::clamp(0.7 * square / found, 0.05, 0.5);
        tolerance = {tighter * tolerance.normals, tighter * tolerance.outlines};
    }
    result.report.rays = job.traced;
    tell_rounds(context, 1, 1);
    return all_stay();
}

}  // namespace opaline::bake
