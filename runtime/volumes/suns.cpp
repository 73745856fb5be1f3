#include "runtime/volumes/suns.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "formats/opal/cubemap.h"
#include "formats/opal/phase_table.h"

namespace opaline::runtime {
namespace {

constexpr double kLeastShare = 1.0 / 128;  // of the light's luminance
constexpr double kLeastMiss = 0.01;        // of the phase function, in units of 1/(4 pi)

// Of texel j, Rec. 709; 0 where it is not a positive number.
double luminance(std::span<const double> integral, std::size_t j) {
    const double y =
        0.2126 * integral[3 * j] + 0.7152 * integral[3 * j + 1] + 0.0722 * integral[3 * j + 2];
    return y > 0 && std::isfinite(y) ? y : 0.0;
}

// sum_l (2 l + 1) m_l P_l(c) over the degrees of the record's terms: 4 pi p(c).
double eval_moments(const formats::VolumeRecord& record, double c) {
    double sum = 0, before = 0, legendre = 1;
    for (std::uint32_t l = 0; l < formats::kMaxVolumeMoments && l * l < record.single_terms; ++l) {
        sum += (2.0 * l + 1) * static_cast<double>(record.moment[l]) * legendre;
        // (l + 1) P_(l+1) = (2 l + 1) c P_l - l P_(l-1)
        const double next = ((2.0 * l + 1) * c * legendre - l * before) / (l + 1);
        before = legendre;
        legendre = next;
    }
    return sum;
}

// Toward what stands around each sun. Weights are 0 where suns begin.
void find_directions(std::vector<Sun>& suns, std::uint32_t n) {
    const float reach = std::cos(3.0f / static_cast<float>(n));  // a texel's diagonal is 2.8 / n
    std::vector<formats::Vec3> centre;
    centre.reserve(suns.size());
    for (const Sun& sun : suns) {
        centre.push_back(
            formats::texel_direction(n, sun.texel / (n * n), sun.texel / n % n, sun.texel % n));
    }
    for (std::size_t s = 0; s < suns.size(); ++s) {
        std::array<double, kMaxSuns> weight{};
        for (std::size_t t = 0; t < suns.size(); ++t) {
            weight[t] = dot(centre[s], centre[t]) > reach ? luminance(suns[t].light, 0) : 0;
        }
        const double most = *std::ranges::max_element(weight);
        formats::Vec3 sum;
        for (std::size_t t = 0; t < suns.size(); ++t) {
            sum = sum + static_cast<float>(weight[t] / most) * centre[t];
        }
        suns[s].direction = most > 0 ? formats::normalize(sum) : centre[s];
    }
}

}  // namespace

SplitLight split_suns(std::span<const double> integral, std::uint32_t n) {
    SplitLight split;
    split.rest.assign(integral.begin(), integral.end());
    std::vector<double> bright;
    double whole = 0;
    for (std::size_t j = 0; j < integral.size() / 3; ++j) {
        bright.push_back(luminance(integral, j));
        whole += bright.back();
    }
    std::vector<double> sorted = bright;
    const auto ninth = sorted.begin() + kMaxSuns;
    std::nth_element(sorted.begin(), ninth, sorted.end(), std::greater<>());
    const double threshold = std::max(kLeastShare * whole, *ninth);
    for (std::uint32_t j = 0; j < bright.size(); ++j) {
        if (!(bright[j] > threshold)) continue;
        const double share = std::min(1.0, bright[j] / threshold - 1);
        Sun sun{j, {}, {}};
        for (std::size_t band = 0; band < 3; ++band) {
            sun.light[band] = share * integral[3 * j + band];
            split.rest[3 * j + band] -= sun.light[band];
        }
        split.sun.push_back(sun);
    }
    find_directions(split.sun, n);
    return split;
}

LightVector make_sun_light(const Sun& sun, std::uint32_t n) {
    std::vector<double> integral(std::size_t{3} * formats::cubemap_texels(n));
    std::ranges::copy(sun.light, integral.begin() + std::ptrdiff_t{3} * sun.texel);
    return make_light_vector(integral, n);
}

bool needs_suns(const formats::VolumeRecord& record, std::span<const float> phase) {
    if (record.single_terms == 0) return false;
    for (std::size_t i = 0; i < phase.size(); ++i) {
        const double exact = 4 * std::numbers::pi * static_cast<double>(phase[i]);
        const double c = formats::phase_cosine(static_cast<double>(i));
        if (std::abs(exact - eval_moments(record, c)) > kLeastMiss) return true;
    }
    return false;
}

}  // namespace opaline::runtime
