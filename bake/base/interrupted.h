#pragma once

#include "formats/opal/result.h"

namespace opaline::bake {

/// Of a stage that was cancelled before it was done.
inline formats::Error interrupted() {
    return formats::make_error(formats::ErrorKind::interrupted, "", "", "interrupted",
                               "nothing was written");
}

}  // namespace opaline::bake
