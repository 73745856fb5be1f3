#include "runtime/volumes/lit_volumes.h"

namespace opaline::runtime {

LitVolumes light_volumes(const formats::VolumesView& volumes, const VolumeLight& light) {
    LitVolumes lit;
    lit.light = &light;
    for (std::size_t v = 0; v < volumes.records.size(); ++v) {
        if (const auto lattice = make_lattice(volumes, volumes.records[v])) {
            lit.entry.push_back({*lattice, v, make_glow(volumes, v)});
        }
    }
    return lit;
}

}  // namespace opaline::runtime
