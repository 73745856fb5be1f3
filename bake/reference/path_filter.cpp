#include "bake/reference/path_filter.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "bake/base/frame.h"

namespace opaline::bake {
namespace {

constexpr float kPi = std::numbers::pi_v<float>;
constexpr float kLeastCosine = 1e-4f;  // where it divides: path_differentials/bounded_change.h

float square(float x) {
    return x * x;
}

// Refraction of D at N, by eta, with the secant of bounded_refraction where c_t is small.
struct Refracted {
    glm::vec3 D, N, T{0};
    float eta, k, c_t = 0;

    Refracted(glm::vec3 direction, glm::vec3 normal, float ratio)
        : D(direction), N(normal), eta(1 / ratio), k(glm::dot(direction, normal)) {
        const float squared = 1 - square(eta) * (1 - square(k));
        if (squared > 0) {
            c_t = std::sqrt(squared);
            T = eta * D - (eta * k + c_t) * N;
        }
    }
    bool is_total_reflection() const { return !(c_t > 0); }
    glm::vec3 change(glm::vec3 dD, glm::vec3 dN) const {
        const float dk = glm::dot(dD, N) + glm::dot(D, dN);
        const float z = square(c_t), d = 2 * square(eta) * k * dk, half = 0.5f * std::abs(d);
        const float upper = std::sqrt(z + half);
        const float dc_t = half > z ? std::copysign(upper, d) : d / (upper + std::sqrt(z - half));
        const glm::vec3 dT = eta * dD - (eta * k + c_t) * dN - (eta * dk + dc_t) * N;
        return dT - T * glm::dot(T, dT);
    }
};

// What the normal that a point c of the sphere belongs to [Dupuy2023] makes of light, in the frame
// of the surface's normal; w: the centre of the cap.
struct FacetLight {
    glm::vec3 direction;
    float spread;  ///< t of the density of normals, 1 / (pi alpha^2 t^2)
    bool passes;   ///< false: refraction was asked for, but the facet reflects totally
};
inline FacetLight light_of_facet(glm::vec3 c, glm::vec3 w, glm::vec3 to_eye, float alpha,
                                 float ratio) {
    const glm::vec3 h = c + w;
    const glm::vec3 m(alpha * h.x, alpha * h.y, std::max(h.z, 1e-6f));
    const float inverse = 1 / glm::dot(m, m);
    const float spread = inverse * (square(h.x) + square(h.y) + square(m.z));
    if (ratio > 0) {
        const Refracted refracted(-to_eye, std::sqrt(inverse) * m, ratio);
        return {refracted.T, spread, !refracted.is_total_reflection()};
    }
    return {2 * inverse * glm::dot(to_eye, m) * m - to_eye, spread, true};
}

}  // namespace

PathFilter::PathFilter(const TextureFiltering& filtering, glm::vec3 dD_dx, glm::vec3 dD_dy)
    : filtering_(&filtering) {
    column_[0].dD = filtering.step * dD_dx;
    column_[1].dD = filtering.step * dD_dy;
}

void PathFilter::apply_pending() {
    if (pending_.kind == Scattering::diffuse) {
        add_diffuse_cell(pending_);
    } else if (pending_.kind == Scattering::facets) {
        add_facet_cell(pending_);
    }
    pending_.kind = Scattering::none;
}

bool PathFilter::arrive(const formats::Scene& scene, glm::vec3 direction, const SurfaceHit& hit) {
    apply_pending();
    flat_ = hit.flat;
    const float cosine = glm::dot(direction, flat_);
    const float divisor = std::copysign(std::max(std::abs(cosine), kLeastCosine), cosine);
    const glm::vec3 along = direction / divisor;
    const float longest = square(filtering_->extent / 4);
    for (Column& column : columns()) {
        // dP' = w - D (N_g.w) / (N_g.D), w = dP + t dD
        const glm::vec3 w = column.dP + hit.distance * column.dD;
        glm::vec3 moved = w - glm::dot(flat_, w) * along;
        const float length = glm::dot(moved, moved);
        column.dP = length > longest ? std::sqrt(longest / length) * moved : moved;
    }
    const formats::Primitive& p = scene.primitives[hit.primitive];
    const std::uint32_t* corner = &p.index[3 * std::size_t{hit.triangle}];
    const glm::vec3 a = p.position[corner[0]];
    const glm::vec3 v = p.position[corner[1]] - a, w = p.position[corner[2]] - a;
    const glm::vec3 n = glm::cross(v, w);
    const float area = glm::dot(n, n);
    smooth_ = hit.smooth;
    if (!(area > 1e-12f * glm::dot(v, v) * glm::dot(w, w))) {
        gradient_v_ = gradient_w_ = normal_v_ = normal_w_ = glm::vec3(0);
        moments_ = {};
        return false;
    }
    gradient_v_ = glm::cross(w, n) / area;
    gradient_w_ = glm::cross(n, v) / area;
    if (hit.smooth == hit.flat) {
        normal_v_ = normal_w_ = glm::vec3(0);
    } else {
        const glm::vec3 at_a = p.normal[corner[0]];
        const glm::vec3 at_v = p.normal[corner[1]] - at_a, at_w = p.normal[corner[2]] - at_a;
        const float scale = 1 / glm::length(at_a + hit.u * at_v + hit.v * at_w);
        normal_v_ = scale * at_v;
        normal_w_ = scale * at_w;
    }
    if (!has_pyramid(filtering_->pyramids, scene.materials[p.material]) || p.texcoord.empty()) {
        return false;
    }
    const glm::vec2 uv = p.texcoord[corner[0]];
    const glm::vec2 uv_v = p.texcoord[corner[1]] - uv, uv_w = p.texcoord[corner[2]] - uv;
    moments_ = {};
    for (const Column& column : columns()) {
        const glm::vec2 d =
            glm::dot(gradient_v_, column.dP) * uv_v + glm::dot(gradient_w_, column.dP) * uv_w;
        moments_.add(d);
    }
    return true;
}

// Of the interpolated normal, turned as `normal` is.
glm::vec3 PathFilter::normal_change(const Column& column, glm::vec3 normal) const {
    const glm::vec3 dm =
        glm::dot(gradient_v_, column.dP) * normal_v_ + glm::dot(gradient_w_, column.dP) * normal_w_;
    const glm::vec3 dN = dm - smooth_ * glm::dot(smooth_, dm);
    return glm::dot(normal, smooth_) < 0 ? -dN : dN;
}

void PathFilter::mirror(glm::vec3 direction, glm::vec3 normal) {
    const float k = glm::dot(direction, normal);
    for (Column& column : columns()) {
        const glm::vec3 dN = normal_change(column, normal);
        const float dk = glm::dot(column.dD, normal) + glm::dot(direction, dN);
        column.dD -= 2.0f * (k * dN + dk * normal);
    }
}

void PathFilter::refract(glm::vec3 direction, glm::vec3 normal, float ratio) {
    const Refracted event(direction, normal, ratio);
    if (event.is_total_reflection()) {
        return;
    }
    for (Column& column : columns()) {
        column.dD = event.change(column.dD, normal_change(column, normal));
    }
}

void PathFilter::add_diffuse_cell(const Pending& event) {
    const glm::vec3 normal = event.normal, drawn = event.drawn;
    for (Column& column : columns()) {
        column.dD = glm::cross(glm::cross(normal, normal_change(column, normal)), drawn);
    }
    // Of the sphere pi step^2 / cosine, by its chord; wider than high where it is seen flat.
    const float cosine = std::max(glm::dot(normal, drawn), 1e-3f);
    const float side = filtering_->step * std::sqrt(kPi / cosine);
    const float chord = std::min(side, std::numbers::sqrt2_v<float>);
    const Frame frame = make_frame(drawn);
    std::array<Column, 2> own;
    const std::array<glm::vec3, 2> axis{frame.u, frame.v};
    for (std::size_t i = 0; i < 2; ++i) {
        own[i].dD = chord * axis[i];
        // ln of the density, the cosine.
        const float change = std::abs(chord * glm::dot(axis[i], normal)) / cosine;
        if (std::isfinite(filtering_->gradient_limit)) {
            own[i].limit = std::min(1.0f, filtering_->gradient_limit / std::max(change, 1e-6f));
        }
    }
    add_cell(drawn, own);
}

void PathFilter::add_facet_cell(const Pending& event) {
    const glm::vec3 direction = event.direction, normal = event.normal, drawn = event.drawn;
    const float alpha = event.alpha;
    const bool refracts = event.ratio > 0;
    glm::vec3 facet =
        glm::normalize(refracts ? direction - event.ratio * drawn : drawn - direction);
    facet = refracts && glm::dot(facet, normal) < 0 ? -facet : facet;
    const Refracted refracted(direction, facet, refracts ? event.ratio : 1);
    const float k = glm::dot(direction, facet);
    for (Column& column : columns()) {
        // The facet turns with the normal.
        const glm::vec3 turn = glm::cross(normal, normal_change(column, normal));
        const glm::vec3 dm = glm::cross(turn, facet);
        if (refracts) {
            column.dD = refracted.change(column.dD, dm);
        } else {
            const float dk = glm::dot(column.dD, facet) + glm::dot(direction, dm);
            column.dD -= 2.0f * (k * dm + dk * facet);
        }
    }
    const Frame frame = make_frame(normal);
    const auto to_frame = [&](glm::vec3 d) {
        return glm::vec3(glm::dot(frame.u, d), glm::dot(frame.v, d), glm::dot(frame.normal, d));
    };
    const glm::vec3 to_eye = to_frame(-direction), m = to_frame(facet);
    const glm::vec3 w = glm::normalize(glm::vec3(alpha * to_eye.x, alpha * to_eye.y, to_eye.z));
    const glm::vec3 h(m.x / alpha, m.y / alpha, m.z);
    const glm::vec3 c = 2 * glm::dot(h, w) / glm::dot(h, h) * h - w;
    // Normals are uniform on the cap of height 1 + w.z. A cell of it: differences between points at
    // 1 / sqrt 3 of its half, where two points have the second moments of the whole.
    constexpr float kRoot = std::numbers::sqrt3_v<float>;
    const float side = filtering_->step * std::sqrt(2 * kPi * (1 + w.z));
    const float half = std::min(0.5f * side / kRoot, 1.0f);
    const Frame around = make_frame(c);
    std::array<Column, 2> own;
    const std::array<glm::vec3, 2> axis{around.u, around.v};
    const float rest = std::sqrt(1 - square(half));
    for (std::size_t i = 0; i < 2; ++i) {
        const auto light_at = [&](float way) {
            return light_of_facet(rest * c + way * axis[i], w, to_eye, alpha, event.ratio);
        };
        const FacetLight more = light_at(half), less = light_at(-half);
        // Beside total reflection, twice the way to the other side.
        const glm::vec3 to = more.passes ? frame.to_world(more.direction) : drawn;
        const glm::vec3 from = less.passes ? frame.to_world(less.direction) : drawn;
        own[i].dD = (more.passes && less.passes ? kRoot : 2 * kRoot) * (to - from);
        own[i].dD -= drawn * glm::dot(drawn, own[i].dD);
        if (std::isfinite(filtering_->gradient_limit)) {
            const float change = 2 * kRoot * std::abs(std::log(more.spread / less.spread));
            own[i].limit = std::min(1.0f, filtering_->gradient_limit / std::max(change, 1e-6f));
        }
    }
    add_cell(drawn, own);
}

void PathFilter::add_cell(glm::vec3 drawn, const std::array<Column, 2>& own) {
    if (count_ > kMerged) {
        merge(drawn);
    }
    column_[count_++] = own[0];
    column_[count_++] = own[1];
    if (++scatterings_ >= 2) {
        for (Column& column : columns()) {
            column.dP *= column.limit;
            column.dD *= column.limit;
            column.limit = 1;
        }
    }
}

// To four columns with the same second moments, so that later footprints are the same: the Cholesky
// factor of the moments of place and direction.
void PathFilter::merge(glm::vec3 direction) {
    const Frame place = make_frame(flat_), way = make_frame(direction);
    using Row = std::array<float, kMerged>;
    std::array<Row, kMerged> g{};
    for (const Column& column : columns()) {
        const Row x{glm::dot(place.u, column.dP), glm::dot(place.v, column.dP),
                    glm::dot(way.u, column.dD), glm::dot(way.v, column.dD)};
        for (std::size_t i = 0; i < kMerged; ++i) {
            for (std::size_t j = 0; j <= i; ++j) {
                g[i][j] += x[i] * x[j];
            }
        }
    }
    for (std::size_t j = 0; j < kMerged; ++j) {
        const float whole = g[j][j];
        float pivot = whole;
        for (std::size_t k = 0; k < j; ++k) {
            pivot -= square(g[j][k]);
        }
        const float root = pivot > 1e-6f * whole ? std::sqrt(pivot) : 0;
        for (std::size_t i = j + 1; i < kMerged; ++i) {
            float rest = g[i][j];
            for (std::size_t k = 0; k < j; ++k) {
                rest -= g[i][k] * g[j][k];
            }
            g[i][j] = root > 0 ? rest / root : 0;
        }
        g[j][j] = root;
    }
    for (std::size_t j = 0; j < kMerged; ++j) {
        const auto at = [&](std::size_t i) { return i < j ? 0.0f : g[i][j]; };
        column_[j] = {at(0) * place.u + at(1) * place.v, at(2) * way.u + at(3) * way.v, 1};
    }
    count_ = kMerged;
}

}  // namespace opaline::bake
