#include "runtime/view_terms.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace opaline::runtime {
namespace {

using formats::Rgb;
using formats::TermSet;
using formats::Vec3;

// (eta c')^2 = eta^2 - 1 + c^2, with the difference of squares as a product: exact where the index
// is near 1 and the view grazing, where 1 - (1 - c^2) / eta^2 would cancel.
float scaled_cosine_behind_squared(float c, float eta) {
    return (eta - 1) * (eta + 1) + c * c;
}

// Double precision: squares of coordinates near the float limit still fit.
Vec3 direction(Vec3 from, Vec3 to) {
    const double x = static_cast<double>(to.x) - static_cast<double>(from.x);
    const double y = static_cast<double>(to.y) - static_cast<double>(from.y);
    const double z = static_cast<double>(to.z) - static_cast<double>(from.z);
    const double norm = std::sqrt(x * x + y * y + z * z);
    if (!(norm > 0)) return {};
    return {static_cast<float>(x / norm), static_cast<float>(y / norm),
            static_cast<float>(z / norm)};
}

}  // namespace

float fresnel_transmittance(float c, float eta) {
    if (!(c > 0)) return 0;
    c = std::min(c, 1.0f);
    const float squared = scaled_cosine_behind_squared(c, eta);
    if (!(squared > 0)) return 0;
    const float behind = std::sqrt(squared);  // eta c'
    // 1 - r^2 of both polarisations written as products: no cancellation at any angle. The second
    // is 4 eta c c' / (eta c + c')^2, numerator and denominator times eta^2.
    const float s = c + behind, p = eta * eta * c + behind;
    const float transmittance = 2 * c * behind * (1 / (s * s) + eta * eta / (p * p));
    return std::min(transmittance, 1.0f);
}

Vec3 refract_to_eye(Vec3 n, Vec3 w, float c, float eta) {
    Vec3 tangent = w - c * n;
    if (c < 0) {
        const float norm = length(tangent);
        if (!(norm > 0)) return n;
        tangent = (1 / norm) * tangent;
        c = 0;
    }
    const float squared = scaled_cosine_behind_squared(c, eta);
    if (squared > 0) return (1 / eta) * (tangent + std::sqrt(squared) * n);
    const float norm = length(tangent);
    return norm > 0 ? (1 / norm) * tangent : n;
}

ViewOfReceiver view_receiver(const formats::PrimitiveRecord& primitive, Vec3 position, Vec3 normal,
                             const std::optional<Vec3>& eye) {
    ViewOfReceiver view{normal, eye ? direction(position, *eye) : Vec3{}, 0, false};
    if (view.to_eye == Vec3{}) {
        view.to_eye = normal;
    }
    view.cosine = dot(view.normal, view.to_eye);
    if (view.cosine < 0 && (primitive.flags & formats::PrimitiveRecord::kDoubleSided) != 0) {
        view.normal = -1.0f * view.normal;
        view.cosine = -view.cosine;
        view.is_turned = true;
    }
    return view;
}

bool is_seen_from_behind(Vec3 position, Vec3 normal, const std::optional<Vec3>& eye) {
    return eye && dot(normal, direction(position, *eye)) < 0;
}

void eval_view_terms(Vec3 refracted, std::span<float> value) {
    if (value.size() == 1) {
        value[0] = 1;
    } else {
        formats::eval_spherical_harmonics(refracted, value);
    }
}

namespace {

Rgb sum_harmonics(const ViewOfReceiver& view, float eta, std::span<const Rgb> product) {
    if (product.size() == 1) return product[0];
    std::array<float, formats::kMaxHarmonics> terms;
    const std::span<float> h = std::span<float>(terms).first(product.size());
    eval_view_terms(refract_to_eye(view.normal, view.to_eye, view.cosine, eta), h);
    Rgb sum;
    for (std::size_t k = 0; k < h.size(); ++k) {
        sum = sum + h[k] * product[k];
    }
    return sum;
}

}  // namespace

Rgb sum_view_terms(const ViewOfReceiver& view, const formats::PrimitiveRecord& primitive,
                   std::span<const Rgb> product, TermSet terms) {
    const bool multiple = has_any(terms, TermSet::multiple);
    const bool single = has_any(terms, TermSet::single);
    if (!primitive.is_separate()) {
        const bool shows = single && (multiple || primitive.is_single_only());
        return shows ? sum_harmonics(view, primitive.eta, product) : Rgb{};
    }
    Rgb sum = multiple ? product[0] : Rgb{};
    if (single && product.size() > 1) {
        sum = sum + sum_harmonics(view, primitive.eta, product.subspan(1));
    }
    return sum;
}

}  // namespace opaline::runtime
