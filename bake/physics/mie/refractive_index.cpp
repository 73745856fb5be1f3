#include "bake/physics/mie/refractive_index.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <string>

#include "bake/physics/mie/droplets.h"

namespace opaline::bake {
namespace {

struct IndexRow {
    double nm, real, imaginary;
};

/// [HaleQuerry1973], table 1.
constexpr IndexRow kWater[] = {
    {300, 1.349, 1.60e-8},  {325, 1.346, 1.08e-8}, {350, 1.343, 6.50e-9}, {375, 1.341, 3.50e-9},
    {400, 1.339, 1.86e-9},  {425, 1.338, 1.30e-9}, {450, 1.337, 1.02e-9}, {475, 1.336, 9.35e-10},
    {500, 1.335, 1.00e-9},  {525, 1.334, 1.32e-9}, {550, 1.333, 1.96e-9}, {575, 1.333, 3.60e-9},
    {600, 1.332, 1.09e-8},  {625, 1.332, 1.39e-8}, {650, 1.331, 1.64e-8}, {675, 1.331, 2.23e-8},
    {700, 1.331, 3.35e-8},  {725, 1.330, 9.15e-8}, {750, 1.330, 1.56e-7}, {775, 1.330, 1.48e-7},
    {800, 1.329, 1.25e-7},  {825, 1.329, 1.82e-7}, {850, 1.329, 2.93e-7}, {875, 1.328, 3.91e-7},
    {900, 1.328, 4.86e-7},  {925, 1.328, 1.06e-6}, {950, 1.327, 2.93e-6}, {975, 1.327, 3.48e-6},
    {1000, 1.327, 2.89e-6},
};

/// [WarrenBrandt2008], the table that the authors distribute.
constexpr IndexRow kIce[] = {
    {400, 1.3194, 2.365e-11}, {410, 1.3185, 2.669e-11}, {420, 1.3177, 3.135e-11},
    {430, 1.3170, 4.140e-11}, {440, 1.3163, 6.268e-11}, {450, 1.3157, 9.239e-11},
    {460, 1.3151, 1.325e-10}, {470, 1.3145, 1.956e-10}, {480, 1.3140, 2.861e-10},
    {490, 1.3135, 4.172e-10}, {500, 1.3130, 5.889e-10}, {510, 1.3126, 8.036e-10},
    {520, 1.3121, 1.076e-9},  {530, 1.3117, 1.409e-9},  {540, 1.3114, 1.813e-9},
    {550, 1.3110, 2.289e-9},  {560, 1.3106, 2.839e-9},  {570, 1.3103, 3.461e-9},
    {580, 1.3100, 4.159e-9},  {590, 1.3097, 4.930e-9},  {600, 1.3094, 5.730e-9},
    {610, 1.3091, 6.890e-9},  {620, 1.3088, 8.580e-9},  {630, 1.3085, 1.040e-8},
    {640, 1.3083, 1.220e-8},  {650, 1.3080, 1.430e-8},  {660, 1.3078, 1.660e-8},
    {670, 1.3076, 1.890e-8},  {680, 1.3073, 2.090e-8},  {690, 1.3071, 2.400e-8},
    {700, 1.3069, 2.900e-8},  {710, 1.3067, 3.440e-8},  {720, 1.3065, 4.030e-8},
    {730, 1.3062, 4.300e-8},  {740, 1.3060, 4.920e-8},  {750, 1.3059, 5.870e-8},
    {760, 1.3057, 7.080e-8},  {770, 1.3055, 8.580e-8},  {780, 1.3053, 1.020e-7},
    {790, 1.3051, 1.180e-7},  {800, 1.3049, 1.340e-7},
};

std::span<const IndexRow> rows_of(Substance substance) {
    if (substance == Substance::ice) return kIce;
    return kWater;
}

constexpr double kMetresPerNm = 1e-9;

}  // namespace

formats::Result<std::complex<double>> refractive_index(Substance substance, double wavelength) {
    const auto rows = rows_of(substance);
    // 550e-9 / 1e-9 is not exactly 550.
    const double nm = std::round(wavelength / kMetresPerNm * 1e9) / 1e9;
    if (!(nm >= rows.front().nm && nm <= rows.back().nm)) {
        return formats::make_error(formats::ErrorKind::usage, "", "wavelength",
                                   number_text(nm) + " nm is outside of the table of " +
                                       (substance == Substance::ice ? "ice" : "water") +
                                       ", which goes from " + number_text(rows.front().nm) +
                                       " to " + number_text(rows.back().nm) + " nm",
                                   "give a wavelength inside, or the index of refraction itself");
    }
    const auto above = std::find_if(rows.begin() + 1, rows.end() - 1,
                                    [&](const IndexRow& r) { return r.nm > nm; });
    const IndexRow &a = *(above - 1), &b = *above;
    const double t = (nm - a.nm) / (b.nm - a.nm);
    return std::complex<double>(std::lerp(a.real, b.real, t),
                                std::lerp(a.imaginary, b.imaginary, t));
}

}  // namespace opaline::bake
