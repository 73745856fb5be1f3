#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "formats/gltf/resources.h"
#include "formats/media/fields.h"
#include "formats/scene.h"

namespace opaline::formats::media {

/// The object `phase` of a material: {"type": "hg", "g": 0.3}, "isotropic", "rayleigh",
/// {"type": "gaussian", "rms_angle": radians} or {"type": "table", "file": NAME}. A table is read
/// through `resources`. Nothing and errors in the report where it is faulty.
std::optional<PhaseFunction> read_phase(const Fields& fields, gltf::Resources& resources);

/// A measured phase function as text: a cosine between propagation directions and a value in each
/// line, divided by blanks, commas or semicolons; `#` begins a comment and the first line may name
/// the columns. Cosines ascend from -1 to 1; values are >= 0 and relative: the result is scaled to
/// integrate to 1 over the sphere, linear between the rows. Mean cosines beyond 0.99 are refused.
std::optional<PhaseFunction> parse_phase_table(std::string_view text, const std::string& where,
                                               gltf::Report& report);

}  // namespace opaline::formats::media
