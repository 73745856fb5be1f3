#include "runtime/clouds/layer_sheet.h"

namespace opaline::runtime {

LayerSheet mean_sheet(std::span<const LayerSheet> sheets) {
    LayerSheet mean{{}, {}, 0};
    float weights = 0;
    for (const LayerSheet& sheet : sheets) {
        const float weight = 1 - sheet.transmittance.g;
        mean.radiance = mean.radiance + sheet.radiance;
        mean.transmittance = mean.transmittance + sheet.transmittance;
        mean.distance += weight * sheet.distance;
        weights += weight;
    }
    const float share = 1 / static_cast<float>(sheets.size());
    mean.radiance = share * mean.radiance;
    mean.transmittance = share * mean.transmittance;
    mean.distance = weights > 0 ? mean.distance / weights : 0;
    return mean;
}

}  // namespace opaline::runtime
