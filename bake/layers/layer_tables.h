#pragma once

#include <vector>

#include "bake/base/context.h"
#include "bake/layers/droplet_bands.h"
#include "bake/layers/layer_knobs.h"
#include "bake/slab/slab_medium.h"

namespace opaline::bake {

/// The medium without the forward peak, with moments enough for `streams`.
SlabMedium rest_medium(const PeakSplit& split, int streams);

/// Light of the peak alone as the file holds it (formats/opal/clouds.h, LayerTables::glow), without
/// values below 0. Empty where there is no peak.
std::vector<float> tabulate_glow(const PeakSplit& split, unsigned angles, unsigned events);

/// All tables of one band in the order of the file. `often`: with the radiance of light that
/// was scattered twice or more. Parallel inside, the same bits for any number of threads;
/// incomplete once the context is cancelled.
std::vector<float> make_band_tables(const DropletBand& band, const LayerTableSizes& sizes,
                                    bool often, const Context& context);

}  // namespace opaline::bake
