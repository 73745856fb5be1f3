#pragma once

#include <cstddef>
#include <span>

#include "bake/accuracy/measure_error.h"

namespace opaline::bake {

/// An error to within one standard error of what a pilot found: what is likely.
double likely_error(const ErrorBounds& bounds);

/// What a self-check, which looks at about as many other receivers, hardly ever finds more than:
/// two standard errors of the difference above what the pilot found.
double sure_error(const ErrorBounds& bounds);

/// Index of the cheapest encoding to take, given what each errs by, cheapest first. The first that
/// is sure to meet the target; where none is, the first that is hardly less sure than the surest,
/// or, if that is not even likely to meet it, the first that is likely. (More coefficients make
/// sure at the price of bytes alone; all else that lowers an error costs time.)
/// Precondition: not empty.
std::size_t choose_encoding(std::span<const ErrorBounds> errors, double target);

}  // namespace opaline::bake
