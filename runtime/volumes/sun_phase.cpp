#include "runtime/volumes/sun_phase.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "formats/opal/phase_table.h"

namespace opaline::runtime {
namespace {

using formats::kPhaseEntries;
using formats::Rgb;

constexpr unsigned kDegrees = formats::kMaxVolumeMoments;      // those below it the file holds
constexpr std::array<double, kMaxSunTerms> kRate{0, 0.35, 1};  // times f: e^(-rate L)
constexpr std::size_t kDepths = 40;                            // at which moments are fitted

constexpr float kLargestEntry = 1e20f;

// Of a Henyey-Greenstein function and its peak, g^5.
struct Forward {
    double g = 0, f = 0;
};

double eval_forward(double g, double c) {
    const double d = (1 - g) * (1 - g) + 2 * g * (1 - c);
    return (1 - g * g) / (4 * std::numbers::pi * d * std::sqrt(d));
}

double scaled_moment(double g, unsigned k) {
    const double f = std::pow(g, kDegrees);
    return (std::pow(g, k) - f) / (1 - f);
}

std::optional<Forward> find_forward(const formats::VolumeRecord& record,
                                    std::span<const float> phase) {
    if (record.single_terms != kDegrees * kDegrees) return std::nullopt;
    // The first moment grows with g.
    double low = 0, high = 1;
    for (int i = 0; i < 60; ++i) {
        const double middle = 0.5 * (low + high);
        (scaled_moment(middle, 1) < static_cast<double>(record.moment[1]) ? low : high) = middle;
    }
    constexpr double kLargest = 0.995;  // a file's is 0.99 at most
    constexpr double kMomentMiss = 1e-4, kPhaseMiss = 0.05, kFarFromPeak = 0.5;
    if (!(low > 0) || low > kLargest) return std::nullopt;
    for (unsigned k = 1; k < kDegrees; ++k) {
        const double miss = scaled_moment(low, k) - static_cast<double>(record.moment[k]);
        if (!(std::abs(miss) < kMomentMiss)) return std::nullopt;
    }
    const Forward found{low, std::pow(low, kDegrees)};
    for (std::size_t i = 0; i < phase.size(); ++i) {
        const double c = formats::phase_cosine(static_cast<double>(i));
        if (c > kFarFromPeak) break;
        const double expected = eval_forward(found.g, c) / (1 - found.f);
        if (!(std::abs(static_cast<double>(phase[i]) / expected - 1) < kPhaseMiss)) {
            return std::nullopt;
        }
    }
    return found;
}

// The moment of degree k of (1 - f) q after L scatterings.
double moment_of(const Forward& forward, unsigned k, double scatterings) {
    const double lambda = std::pow(forward.g, k), f = forward.f;
    const double l = std::max(scatterings, 1e-9);
    if (k < kDegrees) return -std::expm1(-f * l) / l + lambda - f;
    return std::exp(-f * l) * std::expm1(lambda * l) / l;
}

using Terms = std::array<double, kMaxSunTerms>;

// Least squares over depths, as light that comes through weighs them.
class Fit {
  public:
    explicit Fit(const Forward& forward) {
        constexpr double kDeepest = 5;  // mean free paths of light beside the peak
        for (std::size_t i = 0; i <= kDepths; ++i) {
            const double u = static_cast<double>(i) / static_cast<double>(kDepths);
            const double l = kDeepest * u * u / (1 - forward.f);
            depth_[i] = l;
            weight_[i] = u * std::exp(-(1 - forward.f) * l);  // dl is 2 u du; the first one is 0
            for (std::size_t j = 0; j < kMaxSunTerms; ++j) {
                basis_[i][j] = std::exp(-kRate[j] * forward.f * l);
            }
        }
    }

    template <typename Function>
    Terms operator()(const Function& of_depth) const {
        std::array<std::array<double, kMaxSunTerms + 1>, kMaxSunTerms> m{};
        for (std::size_t i = 0; i <= kDepths; ++i) {
            const double value = of_depth(depth_[i]);
            for (std::size_t a = 0; a < kMaxSunTerms; ++a) {
                const double w = weight_[i] * basis_[i][a];
                for (std::size_t b = 0; b < kMaxSunTerms; ++b) {
                    m[a][b] += w * basis_[i][b];
                }
                m[a][kMaxSunTerms] += w * value;
            }
        }
        // Positive definite: no pivots needed.
        for (std::size_t a = 0; a < kMaxSunTerms; ++a) {
            for (std::size_t b = 0; b < kMaxSunTerms; ++b) {
                if (b == a) continue;
                const double factor = m[b][a] / m[a][a];
                for (std::size_t c = a; c <= kMaxSunTerms; ++c) {
                    m[b][c] -= factor * m[a][c];
                }
            }
        }
        Terms terms{};
        for (std::size_t a = 0; a < kMaxSunTerms; ++a) {
            terms[a] = m[a][kMaxSunTerms] / m[a][a];
        }
        return terms;
    }

  private:
    std::array<double, kDepths + 1> depth_{}, weight_{};
    std::array<Terms, kDepths + 1> basis_{};
};

SunPhase tabulate(const Forward& forward) {
    const Fit fit(forward);
    // Moments of high degree are g^k e^(-f L), which is the last term with p, and beyond it a
    // series in the square of g^k.
    constexpr std::size_t kLast = kMaxSunTerms - 1;
    static_assert(kRate[kLast] == 1);
    std::vector<Terms> rest;
    constexpr double kLeast = 1e-5;
    for (unsigned k = 0; k < kDegrees || std::pow(forward.g, 2 * k) * (2 * k + 1) > kLeast; ++k) {
        Terms terms = fit([&](double l) { return moment_of(forward, k, l); });
        terms[kLast] -= std::pow(forward.g, k);
        rest.push_back(terms);
    }
    SunPhase made;
    made.terms = kMaxSunTerms;
    made.table.resize(kMaxSunTerms * kPhaseEntries);
    const double share = 1 / (1 - forward.f);
    for (std::size_t j = 0; j < kMaxSunTerms; ++j) {
        made.power[j] = static_cast<float>(kRate[j] * forward.f * share);
        const double whole = rest[0][j] + (j == kLast ? 1 : 0);
        made.mean[j] = static_cast<float>(share * whole / (4 * std::numbers::pi));
    }
    for (std::size_t i = 0; i < kPhaseEntries; ++i) {
        const double c = formats::phase_cosine(static_cast<double>(i));
        Terms sum{};
        sum[kLast] = eval_forward(forward.g, c);
        double before = 0, legendre = 1;
        for (std::size_t k = 0; k < rest.size(); ++k) {
            const auto degree = static_cast<double>(k);
            const double weight = (2 * degree + 1) / (4 * std::numbers::pi) * legendre;
            for (std::size_t j = 0; j < kMaxSunTerms; ++j) {
                sum[j] += weight * rest[k][j];
            }
            const double next = ((2 * degree + 1) * c * legendre - degree * before) / (degree + 1);
            before = legendre;
            legendre = next;
        }
        for (std::size_t j = 0; j < kMaxSunTerms; ++j) {
            made.table[j * kPhaseEntries + i] = static_cast<float>(share * sum[j]);
        }
    }
    return made;
}

float raise(float share, float power) {
    if (power == 0) return 1;
    return share > 0 ? std::pow(std::min(share, 1.0f), power) : 0.0f;
}

}  // namespace

SunPhase make_sun_phase(const formats::VolumeRecord& record, std::span<const float> phase) {
    if (const auto forward = find_forward(record, phase)) return tabulate(*forward);
    SunPhase made;
    made.mean[0] = 1 / (4 * std::numbers::pi_v<float>);
    made.table.assign(phase.begin(), phase.end());
    return made;
}

std::vector<float> pack_sun_tables(const formats::VolumesView& volumes) {
    std::vector<float> packed(volumes.records.size() * kMaxSunTerms * kPhaseEntries);
    for (std::size_t v = 0; v < volumes.records.size(); ++v) {
        const SunPhase phase = make_sun_phase(volumes.records[v], volumes.phase_of(v));
        std::ranges::transform(
            phase.table,
            packed.begin() + static_cast<std::ptrdiff_t>(v * kMaxSunTerms * kPhaseEntries),
            [&](float q) {
                // Terms of a sum may be negative, a phase function not.
                const float least = phase.terms > 1 ? -kLargestEntry : 0;
                return std::isnan(q) ? 0.0f : std::clamp(q, least, kLargestEntry);
            });
    }
    return packed;
}

SunThrough find_sun_through(const SunPhase& phase, Rgb albedo, Rgb share) {
    SunThrough through{};
    // Powers are dear, and most smoke is grey.
    const bool is_grey =
        share.r == share.g && share.g == share.b && albedo.r == albedo.g && albedo.g == albedo.b;
    for (std::size_t j = 0; j < phase.terms; ++j) {
        const float power = phase.power[j];
        if (is_grey) {
            const float grey = raise(share.r, power * albedo.r);
            through[j] = {grey, grey, grey};
            continue;
        }
        through[j] = {raise(share.r, power * albedo.r), raise(share.g, power * albedo.g),
                      raise(share.b, power * albedo.b)};
    }
    return through;
}

}  // namespace opaline::runtime
