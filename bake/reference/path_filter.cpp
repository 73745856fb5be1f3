#include "bake/reference/path_filter.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "bake/base/frame.h"

namespace opaline::bake {
namespace {

constexpr float kLeastCosine =
    1e-4f;  // where it divides: physics/path_differentials/bounded_change.h

float square(float x) {
    return x * x;
}

// What the four points of a cell make of light: normals that the points c of the sphere belong to
// [Dupuy2023], in the frame of the surface's normal; w: the centre of the cap.
struct FacetLight {
    Vectors4 direction;
    Float4 spread;  ///< t of the density of normals, 1 / (pi alpha^2 t^2)
    Int4 passes;    ///< false: refraction was asked for, but the facet reflects totally
};
FacetLight light_of_facets(const Vectors4& c, glm::vec3 w, glm::vec3 to_eye, float alpha,
                           float ratio) {
    const Vectors4 h{c.x + w.x, c.y + w.y, c.z + w.z};
    const Float4 least{1e-6f, 1e-6f, 1e-6f, 1e-6f};
    const Vectors4 m{alpha * h.x, alpha * h.y, h.z > least ? h.z : least};
    const Float4 inverse = 1.0f / dot(m, m);
    FacetLight light;
    light.spread = inverse * (h.x * h.x + h.y * h.y + m.z * m.z);
    light.passes = Int4{-1, -1, -1, -1};
    const Float4 along = dot(to_eye, m);
    Float4 share = 2.0f * inverse * along;
    float back = 1;
    if (ratio > 0) {
        const float eta = 1 / ratio;
        const Float4 squared = 1.0f - eta * eta * (1.0f - along * along * inverse);
        const Float4 none{};
        light.passes = squared > none;
        share = eta * along * inverse - sqrt4((squared > none ? squared : none) * inverse);
        back = eta;
    }
    light.direction = share * m - Float4{back, back, back, back} * to_eye;
    return light;
}

}  // namespace

// Refraction of D at N, by eta, with the secant of bounded_refraction where c_t is small.
struct PathFilter::Refracted {
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
    Vectors4 change(const Vectors4& dD, const Vectors4& dN) const {
        const Float4 dk = dot(N, dD) + dot(D, dN), none{};
        const float z = square(c_t);
        const Float4 d = 2 * square(eta) * k * dk, half = 0.5f * (d < none ? -d : d);
        const Float4 upper = sqrt4(z + half), left = z - half;
        const Float4 beyond = d < none ? -upper : upper;
        const Float4 dc_t = left < none ? beyond : d / (upper + sqrt4(left < none ? none : left));
        const Vectors4 dT = eta * dD - (eta * k + c_t) * dN - (eta * dk + dc_t) * N;
        return dT - dot(T, dT) * T;
    }
};

PathFilter::PathFilter(const TextureFiltering& filtering, glm::vec3 dD_dx, glm::vec3 dD_dy)
    : filtering_(&filtering) {
    block_[0].dD.set_lane(0, filtering.step * dD_dx);
    block_[0].dD.set_lane(1, filtering.step * dD_dy);
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
    move_columns(direction, hit.distance);
    const formats::Primitive& p = scene.primitives[hit.primitive];
    const std::uint32_t* corner = &p.index[3 * std::size_t{hit.triangle}];
    const glm::vec3 normal_a = p.normal[corner[0]];
    const glm::vec3 to_v = p.normal[corner[1]] - normal_a, to_w = p.normal[corner[2]] - normal_a;
    is_curved_ = to_v != glm::vec3(0) || to_w != glm::vec3(0);
    const bool has_texture =
        has_pyramid(filtering_->pyramids, scene.materials[p.material]) && !p.texcoord.empty();
    if (!is_curved_ && !has_texture) return false;
    const glm::vec3 a = p.position[corner[0]];
    const glm::vec3 v = p.position[corner[1]] - a, w = p.position[corner[2]] - a;
    const glm::vec3 n = glm::cross(v, w);
    const float area = glm::dot(n, n);
    if (!(area > 1e-12f * glm::dot(v, v) * glm::dot(w, w))) {
        is_curved_ = false;
        return false;
    }
    const float inverse = 1 / area;
    gradient_v_ = inverse * glm::cross(w, n);
    gradient_w_ = inverse * glm::cross(n, v);
    if (is_curved_) {
        smooth_ = hit.smooth;
        const float scale = 1 / glm::length(normal_a + hit.u * to_v + hit.v * to_w);
        normal_v_ = scale * to_v;
        normal_w_ = scale * to_w;
    }
    if (has_texture) {
        const glm::vec2 uv = p.texcoord[corner[0]];
        find_moments(p.texcoord[corner[1]] - uv, p.texcoord[corner[2]] - uv);
    }
    return has_texture;
}

void PathFilter::move_columns(glm::vec3 direction, float distance) {
    const float cosine = glm::dot(direction, flat_);
    const float divisor = std::copysign(std::max(std::abs(cosine), kLeastCosine), cosine);
    const glm::vec3 along = direction / divisor;
    const float longest = square(filtering_->extent / 4);
    for (Block& block : blocks()) {
        // dP' = w - D (N_g.w) / (N_g.D), w = dP + t dD
        const Vectors4 w = block.dP + distance * block.dD;
        block.dP = w - dot(flat_, w) * along;
        const Float4 length = dot(block.dP, block.dP), one{1, 1, 1, 1};
        const Int4 is_long = length > longest;
        if (any4(is_long)) {
            block.dP = sqrt4(is_long ? longest / length : one) * block.dP;
        }
    }
}

void PathFilter::find_moments(glm::vec2 uv_v, glm::vec2 uv_w) {
    Float4 uu{}, uv{}, vv{};
    for (const Block& block : blocks()) {
        const Float4 v = dot(gradient_v_, block.dP), w = dot(gradient_w_, block.dP);
        const Float4 x = v * uv_v.x + w * uv_w.x, y = v * uv_v.y + w * uv_w.y;
        uu += x * x;
        uv += x * y;
        vv += y * y;
    }
    moments_ = {sum4(uu), sum4(uv), sum4(vv)};
}

// Of the interpolated normal, turned as `normal` is.
Vectors4 PathFilter::normal_change(const Block& block, glm::vec3 normal) const {
    if (!is_curved_) {
        return {};
    }
    const Vectors4 dm =
        dot(gradient_v_, block.dP) * normal_v_ + dot(gradient_w_, block.dP) * normal_w_;
    const Vectors4 dN = dm - dot(smooth_, dm) * smooth_;
    return glm::dot(normal, smooth_) < 0 ? -1.0f * dN : dN;
}

void PathFilter::mirror(glm::vec3 direction, glm::vec3 normal) {
    const float k = glm::dot(direction, normal);
    for (Block& block : blocks()) {
        const Vectors4 dN = normal_change(block, normal);
        const Float4 dk = dot(normal, block.dD) + dot(direction, dN);
        block.dD = block.dD - 2 * k * dN - 2.0f * dk * normal;
    }
}

void PathFilter::refract(glm::vec3 direction, glm::vec3 normal, float ratio) {
    const Refracted event(direction, normal, ratio);
    if (event.is_total_reflection()) return;
    for (Block& block : blocks()) {
        block.dD = event.change(block.dD, normal_change(block, normal));
    }
}

void PathFilter::add_diffuse_cell(const Pending& event) {
    const glm::vec3 normal = event.normal, drawn = event.drawn;
    for (Block& block : blocks()) {
        block.dD = cross(cross(normal, normal_change(block, normal)), drawn);
    }
    // Of the sphere pi step^2 / cosine, by its chord; wider than high where it is seen flat.
    const float cosine = std::max(glm::dot(normal, drawn), 1e-3f);
    const float side = filtering_->step * std::sqrt(std::numbers::pi_v<float> / cosine);
    const float chord = std::min(side, std::numbers::sqrt2_v<float>);
    const Frame frame = make_frame(drawn);
    Cell cell{{chord * frame.u, chord * frame.v}};
    if (is_limited()) {
        for (std::size_t i = 0; i < 2; ++i) {
            // ln of the density, the cosine.
            const float change = std::abs(glm::dot(cell.dD[i], normal)) / cosine;
            cell.limit[i] = std::min(1.0f, filtering_->gradient_limit / std::max(change, 1e-6f));
        }
    }
    add_cell(drawn, cell);
}

// Older columns: the facet turns with the normal.
void PathFilter::turn_facet(const Pending& event, glm::vec3 facet) {
    const glm::vec3 direction = event.direction, normal = event.normal;
    const auto change_of_facet = [&](const Block& block) {
        return cross(cross(normal, normal_change(block, normal)), facet);
    };
    if (event.ratio > 0) {
        const Refracted refracted(direction, facet, event.ratio);
        for (Block& block : blocks()) {
            block.dD = refracted.change(block.dD, change_of_facet(block));
        }
        return;
    }
    if (!is_curved_) {
        for (Block& block : blocks()) {
            block.dD = block.dD - 2.0f * dot(facet, block.dD) * facet;
        }
        return;
    }
    const float k = glm::dot(direction, facet);
    for (Block& block : blocks()) {
        const Vectors4 dm = change_of_facet(block);
        const Float4 dk = dot(facet, block.dD) + dot(direction, dm);
        block.dD = block.dD - 2 * k * dm - 2.0f * dk * facet;
    }
}

void PathFilter::add_facet_cell(const Pending& event) {
    const glm::vec3 drawn = event.drawn, normal = event.normal;
    const float alpha = event.alpha;
    glm::vec3 facet =
        event.ratio > 0 ? event.direction - event.ratio * drawn : drawn - event.direction;
    facet = glm::normalize(glm::dot(facet, normal) < 0 ? -facet : facet);
    turn_facet(event, facet);
    const Frame frame = make_frame(normal);
    const auto to_frame = [&](glm::vec3 d) {
        return glm::vec3(glm::dot(frame.u, d), glm::dot(frame.v, d), glm::dot(frame.normal, d));
    };
    const glm::vec3 to_eye = to_frame(-event.direction), m = to_frame(facet);
    const glm::vec3 w = glm::normalize(glm::vec3(alpha * to_eye.x, alpha * to_eye.y, to_eye.z));
    const float inverse = 1 / alpha;
    const glm::vec3 h(inverse * m.x, inverse * m.y, m.z);
    const glm::vec3 c = 2 * glm::dot(h, w) / glm::dot(h, h) * h - w;
    // Normals are uniform on the cap of height 1 + w.z. A cell of it: differences between points at
    // 1 / sqrt 3 of its half, where two points have the second moments of the whole.
    constexpr float kRoot = std::numbers::sqrt3_v<float>;
    const float side = filtering_->step * std::sqrt(2 * std::numbers::pi_v<float> * (1 + w.z));
    const float half = std::min(0.5f * side / kRoot, 1.0f);
    const Frame around = make_frame(c);
    const Float4 along_u{half, -half, 0, 0}, along_v{0, 0, half, -half};
    const float rest = std::sqrt(1 - square(half));
    const FacetLight light = light_of_facets(
        Float4{rest, rest, rest, rest} * c + along_u * around.u + along_v * around.v, w, to_eye,
        alpha, event.ratio);
    Cell cell;
    for (std::size_t i = 0; i < 2; ++i) {
        const std::size_t more = 2 * i, less = more + 1;
        glm::vec3 change = kRoot * (light.direction.lane(more) - light.direction.lane(less));
        if (light.passes[more] == 0 || light.passes[less] == 0) {
            // Beside total reflection, twice the way to the other side.
            const glm::vec3 own = to_frame(drawn);
            change = light.passes[more] != 0   ? 2 * kRoot * (light.direction.lane(more) - own)
                     : light.passes[less] != 0 ? 2 * kRoot * (own - light.direction.lane(less))
                                               : glm::vec3(0);
        }
        cell.dD[i] = frame.to_world(change);
        cell.dD[i] -= drawn * glm::dot(drawn, cell.dD[i]);
        if (is_limited()) {
            const float log = std::abs(std::log(light.spread[more] / light.spread[less]));
            cell.limit[i] =
                std::min(1.0f, filtering_->gradient_limit / std::max(2 * kRoot * log, 1e-6f));
        }
    }
    add_cell(drawn, cell);
}

void PathFilter::add_cell(glm::vec3 drawn, const Cell& cell) {
    if (count_ > kMerged) {
        merge(drawn);
    }
    Block& block = block_[count_ / 4];
    if (count_ % 4 == 0) {
        block = {};
    }
    for (std::size_t i = 0; i < 2; ++i) {
        block.dD.set_lane(count_ % 4 + i, cell.dD[i]);
        block.limit[count_ % 4 + i] = cell.limit[i];
    }
    count_ += 2;
    if (++scatterings_ >= 2 && is_limited()) {
        for (Block& each : blocks()) {
            each.dP = each.limit * each.dP;
            each.dD = each.limit * each.dD;
            each.limit = Float4{1, 1, 1, 1};
        }
    }
}

// To four columns with the same second moments, so that later footprints are the same: the Cholesky
// factor of the moments of place and direction.
void PathFilter::merge(glm::vec3 direction) {
    const Frame place = make_frame(flat_), way = make_frame(direction);
    using Row = std::array<float, kMerged>;
    std::array<Row, kMerged> g{};
    for (const Block& block : blocks()) {
        const std::array<Float4, kMerged> x{dot(place.u, block.dP), dot(place.v, block.dP),
                                            dot(way.u, block.dD), dot(way.v, block.dD)};
        for (std::size_t i = 0; i < kMerged; ++i) {
            for (std::size_t j = 0; j <= i; ++j) {
                g[i][j] += sum4(x[i] * x[j]);
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
    block_[0].limit = Float4{1, 1, 1, 1};
    for (std::size_t j = 0; j < kMerged; ++j) {
        const auto at = [&](std::size_t i) { return i < j ? 0.0f : g[i][j]; };
        block_[0].dP.set_lane(j, at(0) * place.u + at(1) * place.v);
        block_[0].dD.set_lane(j, at(2) * way.u + at(3) * way.v);
    }
    count_ = kMerged;
}

}  // namespace opaline::bake
