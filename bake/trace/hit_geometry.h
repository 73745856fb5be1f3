#pragma once

#include <embree3/rtcore.h>

#include <cstddef>

namespace opaline::bake {

// The number by which EmbreeScene::geometry knows what was hit: a primitive that is repeated is
// an instance of its triangles, and so are its copies.

inline unsigned geometry_of(unsigned geometry, unsigned instance) {
    return instance != RTC_INVALID_GEOMETRY_ID ? instance : geometry;
}
inline unsigned geometry_of(const RTCHit& hit) {
    return geometry_of(hit.geomID, hit.instID[0]);
}
/// Of a packet of rays: RTCRayHit8, RTCRayHit16.
template <class Hits>
unsigned geometry_of_lane(const Hits& hits, std::size_t lane) {
    return geometry_of(hits.geomID[lane], hits.instID[0][lane]);
}
/// In a filter, of ray `i` of `n`.
inline unsigned geometry_of(RTCHitN* hit, unsigned n, unsigned i) {
    return geometry_of(RTCHitN_geomID(hit, n, i), RTCHitN_instID(hit, n, i, 0));
}
/// In a point query.
inline unsigned geometry_of(const RTCPointQueryFunctionArguments& arguments) {
    return geometry_of(arguments.geomID, arguments.context->instStackSize > 0
                                             ? arguments.context->instID[0]
                                             : RTC_INVALID_GEOMETRY_ID);
}

}  // namespace opaline::bake
