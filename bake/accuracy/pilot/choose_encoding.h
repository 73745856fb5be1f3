#pragma once

#include <cstddef>
#include <span>

#include "bake/accuracy/measure_error.h"

namespace opaline::bake {

/// The pilot's error plus one standard error.
double likely_error(const ErrorBounds& bounds);

/// An upper bound for the self-check, which uses other receivers: the pilot's error plus two
/// standard errors of the difference.
double sure_error(const ErrorBounds& bounds);

/// Index of the encoding to take, given the errors of all, cheapest first. Takes the first that
/// meets the target with a margin of two standard errors. If none does, takes the first that is
/// close to the most accurate; if that does not even meet the target with one standard error, the
/// first that is likely to. (More coefficients cost bytes only; other knobs cost time.)
/// Precondition: not empty.
std::size_t choose_encoding(std::span<const ErrorBounds> errors, double target);

}  // namespace opaline::bake
