#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <exception>
#include <optional>
#include <utility>
#include <vector>

#include "formats/opal/file_bytes.h"
#include "formats/opal/read_opal.h"
#include "formats/opal/result.h"
#include "formats/opal/vec3.h"
#include "runtime/distant_light.h"
#include "runtime/light_vector.h"
#include "runtime/opaline.h"
#include "runtime/users.h"
#include "runtime/volumes/relight_volumes.h"
#include "runtime/volumes/volume_march.h"

// What the files of the C interface share.

struct opaline_asset {
    opaline::formats::LoadedAsset loaded;
    std::uint64_t id = 0;             // unlike its address, never that of another one
    opaline::formats::Memory memory;  // that the handle itself comes from too
    std::optional<opaline::formats::FileBytes> file;  // of opaline_asset_load_path: holds `loaded`
};

struct opaline_light {
    opaline_light(std::uint32_t size, opaline::runtime::SpecularNeeds needs)
        : n(size), distant(size, std::move(needs)) {}

    std::uint32_t n = 0;
    unsigned threads = 1;
    opaline::runtime::Rotation rotation;
    opaline::runtime::DistantLight distant;
    std::vector<opaline::formats::Rgb> emitters;  // a colour for each of its asset's
    mutable opaline::runtime::Users users;

    const opaline::runtime::LightVector& vector() const { return distant.vector(); }
    const opaline::runtime::SpecularLight& specular() const { return distant.specular(); }
};

struct opaline_volume_light {
    std::uint64_t asset_id = 0;
    opaline::runtime::VolumeLight light;
    // Refers to `light` and to the asset's arrays: to be used with an asset of that id alone.
    opaline::runtime::LitVolumes lit;
    mutable opaline::runtime::Users users;
};

namespace opaline::runtime::api {

/// Notes the text for opaline_last_error of this thread and gives the status back.
opaline_status fail(opaline_status status, const char* text);
opaline_status fail(const formats::Error& error);

/// The direction of three floats of any length; nothing where they are not finite or all zero.
std::optional<formats::Vec3> unit_vector(const float v[3]);

/// Finite and not negative.
bool is_radiance(const float* values, std::size_t count);
/// What is wrong with a sun, or nothing; and the sun where nothing is.
const char* fault_of_sun(const float direction[3], float angular_radius, const float radiance[3]);
formats::DistantDisc sun_of(const float direction[3], float angular_radius,
                            const float radiance[3]);
/// The rotation of nine floats, by columns; nothing, and a note for opaline_last_error, if they are
/// none.
std::optional<Rotation> rotation_of(const float m[9]);

/// Nothing is thrown across the boundary. All work is done on copies that `work` moves into place
/// at its end, so a failure leaves things as they were.
template <class Work>
opaline_status guarded(const Work& work) noexcept {
    try {
        return work();
    } catch (const std::exception&) {  // bad_alloc or length_error: nothing else is thrown here
        return fail(OPALINE_OUT_OF_MEMORY, "not enough memory");
    }
}

inline opaline_status invalid(const char* text) {
    return fail(OPALINE_INVALID_ARGUMENT, text);
}

inline opaline_status null_argument() {
    return invalid("an argument is NULL");
}

/// What is wrong with a call that fills a struct of the caller's, or nothing.
template <class Handle, class Struct>
const char* fault_of_output(const Handle* handle, const Struct* out) {
    if (handle == nullptr || out == nullptr) return "an argument is NULL";
    return out->struct_size == sizeof(Struct) ? nullptr
                                              : "struct_size is not one this library knows";
}

/// Why a light is not of an asset of that cube map size and number of emitters, or nothing.
inline const char* fault_of_light(const opaline_light& light, std::uint32_t n,
                                  std::size_t emitters) {
    if (light.n != n) return "the light was made for an asset of another cube map size";
    return light.emitters.size() == emitters
               ? nullptr
               : "the light was made for an asset of another number of emitters";
}

inline bool is_finite(const float* values, std::size_t count) {
    return std::all_of(values, values + count, [](float x) { return std::isfinite(x); });
}

inline constexpr char kTooManyThreads[] = "there may be 256 threads at most";

inline opaline_status busy() {
    return fail(OPALINE_BUSY,
                "another thread is using the light: one may change it, or any "
                "number read it");
}

}  // namespace opaline::runtime::api
