#include "bake/effects/layers/layer_work.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "bake/physics/mie/forward_peak.h"
#include "bake/physics/mie/sphere_scattering.h"
#include "bake/physics/slab/radiance_table.h"
#include "bake/physics/slab/solve_slab.h"

namespace opaline::bake {
namespace {

constexpr double kSeriesTerm = 1.1e-9;    // seconds of a term of a sphere's series, at one angle
constexpr double kFluxProduct = 4.1e-10;  // and of a multiplication of the adding, for fluxes

constexpr double kBands = 3;

// Doublings from a thin layer to each row, all rows together.
double count_doublings(std::size_t depths, double least_cosine) {
    constexpr double kThin = 1.0 / 64;
    double sum = 0;
    for (std::size_t i = 1; i < depths; ++i) {
        sum += std::max(
            1.0, std::log2(depth_of_node(i, depths, kMaxSlabDepth) / (least_cosine * kThin)));
    }
    return sum;
}

double table_bytes(const LayerTableSizes& sizes, bool has_radiance) {
    formats::LayerRecord record;
    record.phase_angles = sizes.phase_angles;
    record.glow_angles = sizes.glow_angles;
    record.glow_events = sizes.glow_events;
    record.flux_depths = static_cast<std::uint32_t>(sizes.flux.depths);
    record.flux_cosines = static_cast<std::uint32_t>(sizes.flux.cosines);
    if (has_radiance) {
        record.radiance_depths = static_cast<std::uint32_t>(sizes.radiance.depths);
        record.radiance_cosines = static_cast<std::uint32_t>(sizes.radiance.cosines);
        record.radiance_modes = static_cast<std::uint32_t>(sizes.radiance.modes);
    }
    return sizeof(float) * static_cast<double>(record.value_count());
}

// Of one band. A Legendre polynomial takes as long as five terms of a sphere's series (measured).
double count_glow_terms(const LayerTableSizes& sizes, bool is_paper) {
    constexpr double kTermsOfPolynomial = 5, kConvolutions = 2;  // printed: below and above n
    return kTermsOfPolynomial * (is_paper ? kConvolutions : 1) * sizes.glow_angles *
           sizes.glow_events * kGlowMoments;
}

// Of one band: P * P, then its modes and the printed forms at all nodes (measured).
double count_printed_terms(const RadianceTableSize& size) {
    constexpr double kTermsOfConvolution = 3.6e7, kTermsOfNode = 38, kPlannedAzimuths = 128;
    const auto cosines = static_cast<double>(size.cosines);
    return kTermsOfConvolution + kTermsOfNode * 2 * cosines * cosines *
                                     (kPlannedAzimuths + static_cast<double>(size.depths)) *
                                     static_cast<double>(size.modes);
}

// Of its thickness, in all frames.
double count_texels(const formats::CloudLayer& layer) {
    return static_cast<double>(layer.columns) * layer.rows * layer.frames;
}

}  // namespace

double count_series_terms(const DropletDistribution& droplets, double wavelength,
                          const RadiusSampling& sampling) {
    const double wave_number = 2 * std::numbers::pi / wavelength;
    const double size = wave_number * (droplets.gamma + 4) * characteristic_radius(droplets);
    constexpr double kRadian = std::numbers::pi / 180;  // steps as average_droplets has them
    const auto angles =
        static_cast<double>(make_angle_grid(std::clamp(2.4 / size, 1e-3, 0.5) * kRadian,
                                            std::clamp(12 / size, 0.1, 0.5) * kRadian, 0.01)
                                .size());
    const double steps = wave_number * radius_range(droplets).weighted_length / sampling.size_step;
    const double radii =
        std::clamp(steps, static_cast<double>(sampling.least), static_cast<double>(sampling.most));
    constexpr unsigned kSome = 64;  // radii that the mean number of orders comes from
    double orders = 0;
    for (const RadiusNode& node : place_radii(droplets, kSome)) {
        const double x = wave_number * node.radius;
        orders += (x + 4 * std::cbrt(x) + 2) / kSome;
    }
    return radii * orders * angles;
}

double count_flux_products(SlabTableSize size, int streams) {
    return count_doublings(size.depths, kMinSlabCosine) *
           std::pow(static_cast<double>(size.cosines) + streams, 3);
}

double count_radiance_products(RadianceTableSize size, int streams) {
    return static_cast<double>(size.modes) * count_doublings(size.depths, kLeastTableCosine) *
           std::pow(2 * static_cast<double>(size.cosines) + streams, 3);
}

LayerWork count_layer_work(const formats::CloudLayer& layer, const LayerLayout& layout,
                           const Knobs& knobs) {
    const LayerTableSizes sizes = layer_table_sizes(knobs);
    LayerWork work;
    for (const double wavelength : kBandWavelengths) {
        work.series_terms +=
            count_series_terms(droplets_of(layer), wavelength, radius_sampling(knobs));
    }
    work.table_terms = kBands * count_glow_terms(sizes, layer.paper);
    // Printed forms (fidelity paper) are not solved for.
    if (layer.paper && layout.often) {
        work.table_terms += kBands * count_printed_terms(sizes.radiance);
    }
    if (!layer.paper) {
        work.flux_products = kBands * count_flux_products(sizes.flux, sizes.flux_streams);
    }
    if (layout.often && !layer.paper) {
        work.radiance_products =
            kBands * count_radiance_products(sizes.radiance, sizes.radiance_streams);
    }
    work.bytes = table_bytes(sizes, layout.often) + 2 * count_texels(layer) +
                 4 * static_cast<double>(layer.ground_albedo.size());
    return work;
}

Work droplet_work(const LayerWork& work) {
    return {0, work.series_terms * kSeriesTerm};
}

Work table_work(const LayerWork& work) {
    return {0, work.table_terms * kSeriesTerm + work.flux_products * kFluxProduct +
                   work.radiance_products * kRadianceProduct};
}

double layer_memory(const formats::CloudLayer& layer, const Knobs& knobs) {
    // Tables of a band stand beside the file's, which grow by doubling.
    return 3 * table_bytes(layer_table_sizes(knobs), true) + (4 + 2 * 2) * count_texels(layer) +
           (4 + 2 * 4) * static_cast<double>(layer.ground_albedo.size());
}

}  // namespace opaline::bake
