#include "formats/opal/clouds.h"

namespace opaline::formats {

LayerTables tables_of(const CloudsView& clouds, const LayerRecord& record, std::size_t band) {
    std::span<const float> left = clouds.value.subspan(
        record.first_value + band * record.band_values(), record.band_values());
    const auto take = [&left](std::size_t count) {
        const std::span<const float> part = left.first(count);
        left = left.subspan(count);
        return part;
    };
    LayerTables tables;
    tables.log_phase = take(record.phase_angles);
    tables.glow = take(record.glow_count());
    tables.t1 = take(record.flux_count());
    tables.t_ms = take(record.flux_count());
    tables.r1 = take(record.flux_count());
    tables.mean_t = take(record.flux_depths);
    tables.reflected = take(record.radiance_count());
    tables.transmitted = take(record.radiance_count());
    return tables;
}

}  // namespace opaline::formats
