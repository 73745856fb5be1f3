#include "bake/effects/layers/layer_error.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "bake/base/rng.h"
#include "bake/effects/layers/layer_tables.h"
#include "bake/physics/slab/low_orders.h"
#include "bake/physics/slab/solve_radiance.h"
#include "bake/physics/slab/solve_slab.h"

namespace opaline::bake {
namespace {

constexpr unsigned kCosines = 6;   // of light, and of view, of each band
constexpr unsigned kAzimuths = 6;  // of each pair
constexpr unsigned kHalvings = 5;  // depths of one chain of doublings are those of one solution
constexpr int kStreams = 32;
constexpr unsigned kModes = 16;
constexpr double kLeastLight = 0.1736;  // 80 degrees
constexpr double kLeastView = 0.1045;   // 84 degrees

// Numbers in [0, 1) of one band.
struct Random {
    std::uint64_t seed = 0, band = 0;
    std::uint32_t drawn = 0;

    double next() {
        return static_cast<double>(
            random_uniform(seed, RandomStage::layer_check, band, drawn++)[0]);
    }
};

std::vector<double> draw_cosines(Random& random, double least) {
    std::vector<double> cosines;
    for (unsigned i = 0; i < kCosines; ++i) {
        cosines.push_back(std::lerp(least, 1.0, (i + random.next()) / kCosines));
    }
    return cosines;
}

// Squares of relative errors of one depth, light, side and band.
struct Square {
    double tables = 0, droplets = 0;
};
struct Squares {
    std::vector<Square> relative;
    std::uint32_t radiances = 0;
};

// One depth of the chain: both sides, all lights, views and azimuths. `overstated`: the stored
// depth over the true one.
void compare_radiance(const StoredTables& stored, double overstated, const DropletBand& droplets,
                      const SlabRadianceRequest& request, const SlabRadiance& truth, Random& random,
                      Squares& squares) {
    const PeakSplit& split = droplets.split;
    for (const bool transmitted : {false, true}) {
        const std::vector<double>& modes = transmitted ? truth.transmitted : truth.reflected;
        for (std::size_t l = 0; l < kCosines; ++l) {
            double errors = 0, noise = 0, references = 0;
            for (std::size_t v = 0; v < kCosines; ++v) {
                const double light = request.lights[l], view = request.view[v];
                const double once = transmitted ? transmitted_once(truth.optical_depth, light, view)
                                                : reflected_once(truth.optical_depth, light, view);
                for (unsigned a = 0; a < kAzimuths; ++a) {
                    const double azimuth = std::numbers::pi * random.next();
                    const double angle = scattering_angle(light, view, azimuth, transmitted);
                    const double expected =
                        once * eval_table(split.rest, angle) +
                        light / std::numbers::pi * eval_slab_radiance(truth, modes, v, l, azimuth);
                    const double error = eval_scattered(stored, overstated * truth.optical_depth,
                                                        light, view, azimuth, transmitted) -
                                         expected;
                    errors += error * error;
                    if (angle >= split.angle) {
                        const double off = once * eval_table(droplets.optics.phase_error, angle) /
                                           (1 - split.weight);
                        noise += off * off;
                    }
                    references += expected * expected;
                    ++squares.radiances;
                }
            }
            squares.relative.push_back(
                references > 0 ? Square{errors / references, noise / references} : Square{});
        }
    }
}

double compare_flux(const StoredTables& stored, double overstated, const SlabMedium& medium,
                    double depth, const std::vector<double>& cosines) {
    SlabRequest request;
    request.optical_depth = depth;
    request.halvings = kHalvings;
    request.cosine = cosines;
    request.streams = kStreams;
    double worst = 0;
    for (const SlabSolution& slab : solve_slab(medium, request)) {
        const OnceFluxes once =
            scatter_once(medium, {&slab.optical_depth, 1}, cosines, kStreams).front();
        for (std::size_t i = 0; i < cosines.size(); ++i) {
            const OrderShares shares =
                eval_slab_table(stored.flux, overstated * slab.optical_depth, cosines[i]);
            const double all = 1 - shares.reflected[1] - shares.reflected[2] - shares.reflected[3];
            worst = std::max({worst, std::abs(all - slab.total.transmittance[i]),
                              std::abs(shares.transmitted[1] - once.transmitted[i]),
                              std::abs(shares.reflected[1] - once.reflected[i])});
        }
    }
    return worst;
}

// Of one band and light, over depths and sides: what was drawn for them is shared, so that these
// means alone vary independently.
std::vector<double> mean_squares_by_light(const std::vector<Square>& squares) {
    const std::size_t cases = std::size_t{2} * (kHalvings + 1) * kCosines;  // of a band
    std::vector<double> means(squares.size() / cases * kCosines, 0.0);
    for (std::size_t i = 0; i < squares.size(); ++i) {
        means[i / cases * kCosines + i % kCosines] +=
            (squares[i].tables + squares[i].droplets) / (2.0 * (kHalvings + 1));
    }
    return means;
}

// Fills in what is computed from the squares.
void summarise(const Squares& squares, LayerErrorReport& report) {
    const auto count = static_cast<double>(squares.relative.size());
    double tables = 0, droplets = 0;
    for (const Square& square : squares.relative) {
        tables += square.tables / count;
        droplets += square.droplets / count;
        report.worst = std::max(report.worst, std::sqrt(square.tables));
    }
    const double mean = tables + droplets;
    const std::vector<double> drawn = mean_squares_by_light(squares.relative);
    const auto draws = static_cast<double>(drawn.size());
    double spread = 0;
    for (const double square : drawn) {
        spread += (square - mean) * (square - mean) / (draws - 1);
    }
    const double margin = 1.96 * std::sqrt(spread / draws);
    report.tables = std::sqrt(tables);
    report.droplets = std::sqrt(droplets);
    report.rms_relative = std::sqrt(mean);
    report.ci95[0] = std::sqrt(std::max(0.0, mean - margin));
    report.ci95[1] = std::sqrt(mean + margin);
    report.radiances_checked = squares.radiances;
}

}  // namespace

double check_products() {
    constexpr double kBands = 3, kDoublings = 22;
    return kBands * kDoublings * kModes * std::pow(2.0 * kCosines + kStreams, 3);
}

LayerErrorReport check_layer(const formats::CloudsView& clouds, const formats::LayerRecord& record,
                             const DropletBands& droplets, std::uint64_t seed,
                             const Context& context) {
    LayerErrorReport report;
    report.reference =
        record.is_paper()
            ? "adding and doubling with the extinction of Mie theory: what the printed forms of "
              "[Bouthors2006] err by"
            : "adding and doubling with more streams and modes; droplets: even against odd radii";
    Squares squares;
    for (std::size_t band = 0; band < droplets.size() && !context.cancelled(); ++band) {
        Random random{seed, band};
        const PeakSplit& split = droplets[band].split;
        const SlabMedium medium = rest_medium(split, kStreams);
        const StoredTables stored = read_tables(clouds, record, band);
        SlabRadianceRequest request;
        const double thickest = static_cast<double>(record.band[band].rest_kappa()) *
                                static_cast<double>(record.highest);
        // 1 but with fidelity paper.
        const double overstated = droplets[band].kappa / droplets[band].mie_kappa;
        request.optical_depth =
            std::min(kMaxSlabDepth, thickest / overstated) * std::exp2(-random.next());
        request.halvings = kHalvings;
        request.lights = draw_cosines(random, kLeastLight);
        request.view = draw_cosines(random, kLeastView);
        request.streams = kStreams;
        request.modes = kModes;
        request.first_order = 2;
        for (const SlabRadiance& truth : solve_slab_radiance(medium, request)) {
            compare_radiance(stored, overstated, droplets[band], request, truth, random, squares);
        }
        report.phase_rms = std::max(report.phase_rms, droplets[band].optics.error.phase_rms);
        report.flux = std::max(report.flux, compare_flux(stored, overstated, medium,
                                                         request.optical_depth, request.lights));
    }
    if (!squares.relative.empty()) {
        summarise(squares, report);
    }
    return report;
}

}  // namespace opaline::bake
