#include "bake/effects/volumes/volume_work.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "bake/effects/volumes/node_lattice.h"
#include "bake/effects/volumes/place_nodes.h"
#include "bake/effects/volumes/sent_light.h"
#include "bake/effects/volumes/volume_knobs.h"
#include "bake/effects/volumes/volume_paths.h"
#include "bake/effects/volumes/walk_nodes.h"
#include "bake/effects/volumes/walk_parts.h"
#include "bake/exchange/bounce_light.h"
#include "bake/physics/path_integral/quasi_path.h"
#include "bake/trace/density/density_space.h"
#include "formats/opal/cubemap.h"
#include "formats/opal/phase_table.h"

namespace opaline::bake {
namespace {

// Costs in units of the reference's scatterings: a step of an optical depth takes 1/16 of one, a
// cell of light that joins a walk 1/180. A step of a quasi-path, with the light of four directions,
// takes as long as 4 steps of an optical depth (tests/bench/RESULTS.md, "Volumes").
constexpr double kStepScattering = 1.0 / 16, kCellScattering = 1.0 / 180, kStepsOfPathStep = 4;

// Seconds: light of one direction and band that joins a walk; a texel of a node's row, its
// transform, selection and quantising.
constexpr double kScatteredCell = 1.1e-9, kNodeTexel = 1.6e-8;

constexpr float kForever = std::numeric_limits<float>::infinity();

// Steps of an optical depth, as optical_depth takes them.
double count_steps(const DensitySpace& space, glm::vec3 from, glm::vec3 direction) {
    double steps = 0;
    for (const DensityVolume& volume : space.volumes) {
        const float voxels_per_metre = glm::length(volume.to_index * direction);
        visit_cells(
            volume, from, direction, kForever, [&](float, float begin, float end, bool is_even) {
                // A product instead of steps.
                steps +=
                    is_even ? 0 : static_cast<double>(std::ceil((end - begin) * voxels_per_metre));
                return true;
            });
    }
    return steps;
}

// Steps of a quasi-path between two directions, as volume_paths takes them.
double count_path_steps(const DensitySpace& space, const MarchLimits& limits, glm::vec3 from,
                        glm::vec3 onward, glm::vec3 light) {
    VolumeMedium medium(space);
    const auto coefficients = [&](glm::dvec3 x) { return medium(x); };
    const glm::dvec3 view = glm::normalize(glm::dvec3(onward));
    const Turns turns(view, glm::normalize(glm::dvec3(light)));
    const double depth = probe_depth([&](glm::dvec3 x) { return medium(x).scattering; }, limits.box,
                                     from, view, limits.step);
    double steps = 0;
    march_quasi_path({from, turns[0], std::max(depth, kShortestTurn)}, coefficients, limits,
                     [&](const PathStep& step) {
                         ++steps;
                         return step.absorption < -std::log(kLeastSurvival);
                     });
    return steps;
}

// Bytes of rows that keep so many coefficients together.
double bytes_of_rows(double rows, std::uint32_t coefficients, const VolumeWork& work,
                     const Knobs& knobs) {
    const double details = coefficients - 6.0 * rows, code = knobs.code_bits / 8.0;
    return details * (2 + work.bands * code) + rows * (work.bands * (6 * 2 + 8) + 4);
}

// Quasi-paths from a node: one a view, square of four cells, and length of turns.
double path_count(const VolumeLayout& layout, const Knobs& knobs) {
    constexpr double kCellsOfPath = 4;
    return layout.views * static_cast<double>(path_lengths(knobs.quality).size()) *
           static_cast<double>(formats::cubemap_texels(coarse_cells(knobs))) / kCellsOfPath;
}

double texels(std::uint32_t n) {
    return static_cast<double>(formats::cubemap_texels(n));
}

bool takes_walks(const VolumeWork& work) {
    return work.method != VolumeMethod::path_integration || work.sees_surfaces;
}

// Of an optical depth from a surface through all volumes, in the mean over directions: one in five
// meets a volume (measured: a plume over a floor), as long as from within.
double steps_to_light(std::span<const VolumeWork> works) {
    constexpr double kMeets = 0.2;
    double steps = 0;
    for (const VolumeWork& work : works) {
        steps +=
            work.nodes > 0 ? work.depth_steps / (work.nodes * work.cells) : std::cbrt(work.voxels);
    }
    return kMeets * steps;
}

// Steps and collisions, from some nodes of the volume.
void count_by_samples(const DensitySpace& space, const formats::Volume& volume,
                      const NodeLattice& lattice, VolumeWork& work) {
    constexpr std::size_t kNodes = 48, kDirections = 8, kWalks = 4;
    const std::size_t count = lattice.node.size(), drawn = std::min(count, kNodes);
    double steps = 0, path_steps = 0;
    WalkCount walked;
    const MarchLimits limits{box_of(space), path_step_length(volume.density, lattice.spacing)};
    for (std::size_t i = 0; i < drawn; ++i) {
        FlightRandom random(0, RandomStage::volume_costs, i);
        const glm::ivec3 node = lattice.node[(2 * i + 1) * count / (2 * drawn)];
        const glm::vec3 at(volume.density.to_scene * glm::dvec4(glm::dvec3(node), 1.0));
        for (std::size_t d = 0; d < kDirections; ++d) {
            const glm::vec3 direction = draw_direction(random);
            steps += count_steps(space, at, direction);
            path_steps += count_path_steps(space, limits, at, draw_direction(random), direction);
        }
        for (std::size_t w = 0; w < kWalks; ++w) {
            const WalkCount one = count_walk(space, at, random);
            walked.flights += one.flights;
            walked.collisions += one.collisions;
        }
    }
    if (drawn > 0) {
        const auto nodes = static_cast<double>(drawn);
        work.depth_steps = work.nodes * work.cells * steps / (nodes * kDirections);
        work.path_steps = work.nodes * work.paths * path_steps / (nodes * kDirections);
        work.flights = work.nodes * work.walks * walked.flights / (nodes * kWalks);
        work.collisions = work.nodes * work.walks * walked.collisions / (nodes * kWalks);
    }
}

}  // namespace

std::vector<VolumeWork> count_volume_work(const formats::Scene& scene,
                                          std::span<const VolumeLayout> layouts,
                                          const Knobs& knobs) {
    std::vector<VolumeWork> works;
    if (layouts.empty()) return works;
    const DensitySpace space = make_density_space(scene, layouts);
    for (const VolumeLayout& layout : layouts) {
        const formats::Volume& volume = scene.volumes[layout.volume];
        VolumeWork work;
        work.voxels = static_cast<double>(volume.density.value.size());
        const NodeLattice lattice = make_node_lattice(volume.density, layout.spacing);
        work.bricks = static_cast<double>(lattice.brick.size());
        work.spacing = layout.spacing;
        work.bands = static_cast<double>(space.bands());
        work.tracks = static_cast<double>(space.extinction_bands());
        work.cells = texels(fine_cells(knobs));
        work.walk_cells = texels(coarse_cells(knobs)) *
                          (space.is_grey ? work.bands : 1);  // a track of one band has one
        if (layout.has_nodes()) {
            work.nodes = static_cast<double>(lattice.node.size());
            work.terms = layout.often_terms;
            work.walks = layout.walks;
            work.paths = path_count(layout, knobs);
            work.method = layout.method;
            work.sees_surfaces = layout.sees_surfaces;
            count_by_samples(space, volume, lattice, work);
        }
        works.push_back(work);
    }
    return works;
}

double count_walk_scatterings(const VolumeWork& work) {
    return kCellScattering * work.tracks * work.collisions * work.walk_cells;
}

double count_path_scatterings(const VolumeWork& work) {
    return kStepScattering * kStepsOfPathStep * work.path_steps;
}

double count_in_scatterings(std::span<const VolumeWork> works) {
    double sum = 0;
    for (const VolumeWork& work : works) {
        sum += kStepScattering * work.depth_steps;
        if (work.method == VolumeMethod::path_integration) {
            sum += count_path_scatterings(work);
        }
        if (takes_walks(work)) {
            sum += count_walk_scatterings(work);
        }
    }
    return sum;
}

Work attenuation_work(const CostInput& input, const VolumeWork& work) {
    const double texel = texels(input.knobs.cubemap_size) * work.bands;
    return {0, work.depth_steps * kDensityStep + work.nodes * texel * kNodeTexel};
}

Work scattering_work(const CostInput& input, const VolumeWork& work) {
    const double texel = texels(input.knobs.cubemap_size) * work.bands;
    const double rows = work.nodes * work.terms;
    Work sum{0, rows * texel * kNodeTexel};
    if (work.method == VolumeMethod::path_integration) {
        sum.shared += work.path_steps * kStepsOfPathStep * kDensityStep;
    }
    if (takes_walks(work)) {
        sum.shared += work.tracks * (work.flights * kVolumeFlight +
                                     work.collisions * work.walk_cells * kScatteredCell) +
                      rows * work.walks * work.tracks * work.walk_cells * kGatherEntry;
    }
    return sum;
}

Work dimming_work(const CostInput& input, std::span<const VolumeWork> works, double receivers,
                  double rows) {
    constexpr std::uint32_t kFinest = 16;  // complete_rows.cpp
    const double cells = texels(std::min(input.knobs.cubemap_size, kFinest));
    return {0, rows * texels(input.knobs.cubemap_size) * kEncodeGrey +
                   receivers * cells * steps_to_light(works) * kDensityStep};
}

Work seen_surfaces_work(const CostInput& input, std::span<const VolumeWork> works) {
    const double cells = texels(coarse_cells(input.knobs));
    return {
        0, static_cast<double>(count_scatterers(0)) * cells * steps_to_light(works) * kDensityStep};
}

Work surface_light_work(const CostInput& input) {
    return {0, static_cast<double>(count_scatterers(0)) * count_rays(kBounceCubemap) *
                   kCoherentRay.at(input.triangles)};
}

Work sent_light_work(const CostInput& input, const VolumeWork& work, const VolumeLayout& layout,
                     double receivers) {
    if (!layout.lights_surfaces || !(work.nodes > 0)) {
        return {};
    }
    // Of rays that meet the volume, a quarter as a guess: steps all through it, twice as far as
    // from within, and the coefficients of a node's rows at each point.
    constexpr double kShare = 0.25, kThrough = 2;
    const NodeCoefficients most = node_coefficients(input.knobs, layout.often_terms);
    const double steps = kThrough * work.depth_steps / (work.nodes * work.cells);
    const double entries = work.bands * (static_cast<double>(most.attenuated) * layout.once_terms +
                                         static_cast<double>(most.scattered));
    const double ray = kCoherentRay.at(input.triangles) +
                       kShare * (steps * kDensityStep + kPointsOfSentRay * entries * kGatherEntry);
    return {0, receivers * count_sent_light_rays(input.knobs.quality) * ray};
}

double volume_density_bytes(const VolumeWork& work) {
    // Codes of 16 bits, half of which compression saves where bricks are half empty; positions.
    constexpr double kCompressed = 0.5, kNode = 12;
    constexpr double kPhase = 4.0 * formats::kPhaseEntries;
    return kCompressed * 2 * work.voxels + kCompressed * kNode * work.nodes + kPhase;
}

double attenuated_row_bytes(const VolumeWork& work, const Knobs& knobs) {
    const auto most = node_coefficients(knobs, static_cast<std::uint32_t>(work.terms));
    return work.nodes * bytes_of_rows(1, most.attenuated, work, knobs);
}

double scattered_row_bytes(const VolumeWork& work, const Knobs& knobs) {
    const auto most = node_coefficients(knobs, static_cast<std::uint32_t>(work.terms));
    return work.nodes * bytes_of_rows(work.terms, most.scattered, work, knobs);
}

double volume_memory(const VolumeWork& work, const Knobs& knobs) {
    constexpr double kGrowth = 2;  // vectors that double
    constexpr double kScene = 4, kCode = 2, kCorner = 4;
    const double corners = std::pow(8 / work.spacing + 1, 3);
    const double depths = 2 * work.nodes * work.tracks * texels(coarse_cells(knobs));
    const double walked = takes_walks(work)
                              ? walked_row_bytes(knobs.quality, work.nodes, work.terms,
                                                 work.bands * texels(coarse_cells(knobs)))
                              : 0;
    return work.voxels * (2 * kScene + kGrowth * kCode) + 2 * work.bricks * corners * kCorner +
           depths + walked +
           kGrowth * node_candidates(knobs.quality) *
               (attenuated_row_bytes(work, knobs) + scattered_row_bytes(work, knobs));
}

double seen_surfaces_memory(std::span<const VolumeWork> works, const Knobs& knobs) {
    constexpr double kCode = 2, kOwnRows = 4, kBands = 3;  // with nodes, and before they are made
    const double bands = works.empty() ? 0 : works.front().bands;
    return kCode * static_cast<double>(count_scatterers(0)) *
           (bands * texels(coarse_cells(knobs)) + kOwnRows * kBands * texels(kBounceCubemap));
}

}  // namespace opaline::bake
