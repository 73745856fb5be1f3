#pragma once

#include <cstdint>
#include <exception>
#include <vector>

#include "formats/opal/environment.h"
#include "formats/opal/read_opal.h"
#include "formats/opal/result.h"
#include "runtime/light_vector.h"
#include "runtime/opaline.h"
#include "runtime/specular.h"

// What the files of the C interface share.

struct opaline_asset {
    opaline::formats::LoadedAsset loaded;
};

struct opaline_light {
    std::uint32_t n = 0;
    unsigned threads = 1;
    opaline::runtime::Rotation rotation;
    opaline::formats::Environment environment;
    std::vector<double> map_integral;  // kept, so that a sun does not cost a map
    opaline::runtime::LightVector vector;
    opaline::runtime::SpecularNeeds needs;  // of its asset
    opaline::runtime::SpecularLight specular;
};

namespace opaline::runtime::api {

/// Notes the text for opaline_last_error of this thread and gives the status back.
opaline_status fail(opaline_status status, const char* text);
opaline_status fail(const formats::Error& error);

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

inline opaline_status null_argument() {
    return fail(OPALINE_INVALID_ARGUMENT, "an argument is NULL");
}

}  // namespace opaline::runtime::api
