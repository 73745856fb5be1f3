#pragma once

#include "bake/layers/droplet_bands.h"
#include "bake/mie/phase_texture.h"
#include "bake/slab/radiance_table.h"
#include "bake/slab/slab_table.h"
#include "formats/opal/clouds.h"

namespace opaline::bake {

/// The tables of one band of a file as the rooms that made them read them.
struct StoredTables {
    formats::LayerBand band;
    double peak_angle = 0;
    PhaseTexture phase;
    SlabTable flux;          ///< without orders 2, which no file holds
    RadianceTable radiance;  ///< size.depths 0 where it is left out
};
StoredTables read_tables(const formats::CloudsView& clouds, const formats::LayerRecord& record,
                         std::size_t band);

/// Radiance of light that the rest scattered once or more, over that of a beam of irradiance 1 on a
/// plane facing it [1/sr]; arguments as eval_radiance_table.
double eval_scattered(const StoredTables& tables, double depth, double light, double view,
                      double azimuth, bool transmitted);

/// Angle [rad] between the directions that light and view ray propagate in, in [0, pi].
double scattering_angle(double light, double view, double azimuth, bool transmitted);

}  // namespace opaline::bake
