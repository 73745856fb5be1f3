#pragma once

namespace opaline::bake {

/// Seconds of one thread for one scattering of the reference's paths through a volume, the light
/// that joins there included: what the self-check of volumes spends its time on.
double measure_traced_collision();

}  // namespace opaline::bake
