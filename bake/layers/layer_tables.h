#pragma once

#include <vector>

#include "bake/base/context.h"
#include "bake/layers/droplet_bands.h"
#include "bake/layers/layer_knobs.h"
#include "bake/slab/slab_medium.h"

namespace opaline::bake {

/// The medium without the forward peak, with moments enough for `streams`.
SlabMedium rest_medium(const PeakSplit& split, int streams);

/// Angles [rad] of a row of the glow's table, and the events u of row `row` of `events`.
std::vector<double> glow_angles(const PeakSplit& split, unsigned angles);
double glow_events(unsigned row, unsigned events);

/// Light of the peak alone as the file holds it (formats/opal/clouds.h, LayerTables::glow), without
/// values below 0. Empty where there is no peak.
std::vector<float> tabulate_glow(const PeakSplit& split, unsigned angles, unsigned events);

/// What the tables of a band hold.
struct BandContent {
    bool often = true;   ///< radiance of light that was scattered twice or more
    bool paper = false;  ///< printed forms (paper_tables.h) instead of the solver's results
};

/// All tables of one band in the order of the file. Parallel inside, the same bits for any number
/// of threads; incomplete once the context is cancelled.
std::vector<float> make_band_tables(const DropletBand& band, const LayerTableSizes& sizes,
                                    const BandContent& content, const Context& context);

}  // namespace opaline::bake
