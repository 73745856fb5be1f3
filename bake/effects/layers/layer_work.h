#pragma once

#include "bake/effects/layers/bake_layers.h"
#include "bake/effects/layers/layer_knobs.h"
#include "bake/plan/stage_work.h"
#include "formats/scene.h"

namespace opaline::bake {

/// What a bake of one layer does, in counts of all three bands.
struct LayerWork {
    double series_terms = 0;  ///< orders of spheres, times angles of their intensities
    /// The same that tables take without solving for a slab: series of Legendre polynomials,
    /// printed forms. Counted as terms of the same length.
    double table_terms = 0;
    double flux_products = 0;      ///< multiplications of the adding of slabs, for fluxes
    double radiance_products = 0;  ///< the same for radiance
    double bytes = 0;              ///< of tables and pictures in the file
};

/// A pure function of its arguments: milliseconds. `layout`: what is baked of the layer.
LayerWork count_layer_work(const formats::CloudLayer& layer, const LayerLayout& layout,
                           const Knobs& knobs);

/// Orders times angles of one band's droplets; multiplications of one band's tables.
double count_series_terms(const DropletDistribution& droplets, double wavelength,
                          const RadiusSampling& sampling);
double count_flux_products(SlabTableSize size, int streams);
double count_radiance_products(RadianceTableSize size, int streams);

Work droplet_work(const LayerWork& work);
Work table_work(const LayerWork& work);
/// Seconds of a multiplication of the adding of slabs, for radiance.
inline constexpr double kRadianceProduct = 1.2e-9;

/// Memory of one layer [bytes]: its picture, tables and their copies.
double layer_memory(const formats::CloudLayer& layer, const Knobs& knobs);

}  // namespace opaline::bake
