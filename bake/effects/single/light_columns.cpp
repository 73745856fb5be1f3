#include "bake/effects/single/light_columns.h"

#include <algorithm>
#include <cmath>

#include "bake/base/vector8.h"

namespace opaline::bake {

struct ColumnJob {
    LightFrame frame;
    float last;  // pixel
    std::int32_t size;
    float bend, faint, least_sigma_t;
    std::int32_t count;
    const float *x, *y, *z, *importance;
    const float *front_z, *obstacle_z;
    const std::uint32_t *front_id, *obstacle_id;
    const glm::vec2* slope;
    Interface<float> boundary;
    std::int32_t* state;
    std::uint32_t* triangle;
    float *distance, *throughput, *path_ratio;
};

namespace {

// Deviation of a layer from the plane of the nearest pixel.
struct Bend {
    Float8 most;  // sum over the three other pixels: a bound between them
    Float8 here;  // expected deviation in the column, downward
};
// `x`, `y`: distances of the column from the nearest pixel toward the others, in [0, 1/2]; `slope`:
// along them.
OPALINE_INLINE Bend bend8(Float8 z0, Float8 z1, Float8 z2, Float8 z3, Float8 slope_x,
                          Float8 slope_y, Float8 x, Float8 y) {
    const Float8 d1 = z0 + slope_x - z1, d2 = z0 + slope_y - z2, d3 = z0 + slope_x + slope_y - z3;
    const Float8 most = greater8(d1, -d1) + greater8(d2, -d2) + greater8(d3, -d3);
    // At a crease, bilinear interpolation cuts the corner and the plane overshoots it. For a crease
    // at a uniformly random position between two pixels, the mean lies x of the way from the plane
    // to the interpolation.
    const Float8 here =
        x * (x * (1.0f - y)) * d1 + y * (y * (1.0f - x)) * d2 + greater8(x, y) * (x * y) * d3;
    return {most, here};
}

// enter (entry.h) in each lane; cosines are positive.
OPALINE_INLINE void enter8(Float8 cosine, const Interface<float>& side, Float8& throughput,
                           Float8& path_ratio) {
    const float eta = side.eta, inverse = 1.0f / eta;
    const Float8 one = all8(1.0f);
    const Float8 inside = cosine * cosine + (eta - 1.0f) * (eta + 1.0f);
    const Int8 enters = inside > 1e-12f;
    const Float8 positive = enters ? inside : one;
    const Float8 refracted = lesser8(positive * inverse_root8(positive) * inverse, one);
    const Float8 s = cosine + eta * refracted, p = eta * cosine + refracted;
    const Float8 ss = s * s, pp = p * p;
    const Float8 factor = side.jacobian ? cosine * inverse : eta * refracted;
    throughput = enters ? 2.0f * cosine * factor * ((ss + pp) / (ss * pp)) : Float8{};
    path_ratio = enters ? cosine / refracted : one;
}

}  // namespace

OPALINE_VECTOR_CLONES
void find_columns(const ColumnJob& job);
OPALINE_VECTOR_CLONES
void attenuate(std::int32_t count, float sigma_t, const float* weight, const float* distance,
               const float* path_ratio, const float* throughput, float* light);

void find_columns(const ColumnJob& given) {
    const ColumnJob job = given;  // a copy that stores through other pointers cannot change
    constexpr auto kColumns = static_cast<std::int32_t>(kStrip);
    const float scale = job.frame.pixels_per_metre;
    const glm::vec3 &u = job.frame.u, &v = job.frame.v, &w = job.frame.w;
    const float ux = scale * u.x, uy = scale * u.y, uz = scale * u.z;
    const float vx = scale * v.x, vy = scale * v.y, vz = scale * v.z;
    const float wx = w.x, wy = w.y, wz = w.z;
    const float x0 = job.frame.offset.x - 0.5f, y0 = job.frame.offset.y - 0.5f;
    const Float8 zero{}, last = all8(job.last), nothing = all8(-__builtin_inff());
    const Int8 dark = Int8{} + static_cast<std::int32_t>(ColumnAnswers::dark);
    const Int8 lit = Int8{} + static_cast<std::int32_t>(ColumnAnswers::lit);
    const Int8 unclear = Int8{} + static_cast<std::int32_t>(ColumnAnswers::unclear);
    const std::int32_t size = job.size;
    const float* const slopes = &job.slope->x;
    for (std::int32_t k = 0; k < job.count; k += static_cast<std::int32_t>(kVector)) {
        const Float8 px = load8(job.x + k), py = load8(job.y + k), pz = load8(job.z + k);
        const Float8 x = lesser8(greater8(px * ux + py * uy + pz * uz + x0, zero), last);
        const Float8 y = lesser8(greater8(px * vx + py * vy + pz * vz + y0, zero), last);
        const Float8 height = px * wx + py * wy + pz * wz;
        // The nearest pixel, and the steps to the three others around the point.
        const Int8 i = __builtin_convertvector(x + 0.5f, Int8);
        const Int8 j = __builtin_convertvector(y + 0.5f, Int8);
        const Float8 dx = x - __builtin_convertvector(i, Float8);
        const Float8 dy = y - __builtin_convertvector(j, Float8);
        const Int8 before_x = dx < 0.0f, before_y = dy < 0.0f;  // -1 or 0
        const Int8 beside = i + (before_x * 2 + 1), up = (before_y * 2 + 1) * kColumns;
        const Int8 at = (i & -kColumns) * size + (i & (kColumns - 1)) + j * kColumns;
        const Int8 aside = (beside & -kColumns) * size + (beside & (kColumns - 1)) + j * kColumns;
        const Int8 above = at + up, across = aside + up;
        const Float8 b0 = gather8(job.obstacle_z, at), b1 = gather8(job.obstacle_z, aside);
        const Float8 b2 = gather8(job.obstacle_z, above), b3 = gather8(job.obstacle_z, across);
        const Float8 low = lesser8(lesser8(b0, b1), lesser8(b2, b3));
        const Float8 high = greater8(greater8(b0, b1), greater8(b2, b3));
        const Float8 spread = low > nothing ? high - low : zero;
        const Int8 below = low > height + spread;
        if (all_of8(below)) {  // e.g. all nodes of a receiver that faces away from the light
            store8(dark, job.state + k);
            store8(zero, job.distance + k);
            store8(zero, job.throughput + k);
            store8(zero, job.path_ratio + k);
            continue;
        }
        const Float8 z0 = gather8(job.front_z, at), z1 = gather8(job.front_z, aside);
        const Float8 z2 = gather8(job.front_z, above), z3 = gather8(job.front_z, across);
        Int8 id;
        Float8 slope_x, slope_y, under_x, under_y;
        for (std::uint32_t l = 0; l < kVector; ++l) {
            id[l] = static_cast<std::int32_t>(job.front_id[at[l]]);
            const float* const slope = slopes + 2 * std::int64_t{id[l]};
            slope_x[l] = slope[0];
            slope_y[l] = slope[1];
            const float* const under = slopes + 2 * std::int64_t{job.obstacle_id[at[l]]};
            under_x[l] = under[0];
            under_y[l] = under[1];
        }
        const Float8 sx = scale * slope_x, sy = scale * slope_y;
        Float8 throughput, path_ratio;
        enter8(inverse_root8(1.0f + (sx * sx + sy * sy)), job.boundary, throughput, path_ratio);
        // An empty pixel makes the bends infinite or NaN, which fails every comparison below.
        const Float8 x_off = before_x ? -dx : dx, y_off = before_y ? -dy : dy;
        const Bend under = bend8(b0, b1, b2, b3, before_x ? -under_x : under_x,
                                 before_y ? -under_y : under_y, x_off, y_off);
        const Float8 floor = b0 + (dx * under_x + dy * under_y) - height;
        const Bend over = bend8(z0, z1, z2, z3, before_x ? -slope_x : slope_x,
                                before_y ? -slope_y : slope_y, x_off, y_off);
        // Largest possible light of the point, as a share of its receiver's.
        const Float8 least = greater8(lesser8(lesser8(z0, z1), lesser8(z2, z3)) - height, zero);
        const Float8 bright =
            load8(job.importance + k) * exp_of_negative8(-job.least_sigma_t * (least * path_ratio));
        const Int8 faint = bright <= job.faint, plane = bright * over.most <= job.bend;
        const Float8 way = z0 + (dx * slope_x + dy * slope_y) - height - (plane ? over.here : zero);
        const Int8 blocked =
            below | (floor > under.most) | (faint & ((b0 > height) | ~(way > 0.0f)));
        const Int8 open = (high < height - spread) | (floor < -under.most) | faint;
        const Int8 is_lit = open & (plane | faint) & (way > 0.0f);
        store8(blocked ? dark : (is_lit ? lit : unclear), job.state + k);
        store8(id, job.triangle + k);
        store8(is_lit & ~blocked ? way : zero, job.distance + k);
        store8(is_lit & ~blocked ? throughput : zero, job.throughput + k);
        store8(path_ratio, job.path_ratio + k);
    }
}

void attenuate(std::int32_t count, float sigma_t, const float* weight, const float* distance,
               const float* path_ratio, const float* throughput, float* light) {
    for (std::int32_t k = 0; k < count; k += static_cast<std::int32_t>(kVector)) {
        const Float8 enters = load8(throughput + k);
        if (all_of8(enters == 0.0f)) {
            store8(enters, light + k);
            continue;
        }
        const Float8 length = load8(distance + k) * load8(path_ratio + k);
        store8(enters * exp_of_negative8(-sigma_t * length) * load8(weight + k), light + k);
    }
}

void ColumnAnswers::resize(std::size_t points, std::size_t channels) {
    const std::size_t count = points + kColumnPadding;
    state.resize(count);
    triangle.resize(count);
    for (std::size_t c = 0; c < channels; ++c) {
        light[c].resize(count);
    }
    distance.resize(count);
    throughput.resize(count);
    path_ratio.resize(count);
}

void look_up_columns(const LightView& view, const ColumnPoints& points, std::size_t begin,
                     std::size_t count, const ColumnMedium& medium, ColumnAnswers& answers) {
    if (view.slope.empty()) {
        std::fill_n(answers.state.begin(), count, ColumnAnswers::dark);
        for (std::size_t c = 0; c < medium.channels; ++c) {
            std::fill_n(answers.light[c].begin(), count, 0.0f);
        }
        return;
    }
    const auto [least, largest] = std::minmax_element(medium.sigma_t.begin(), medium.sigma_t.end());
    ColumnJob job{};
    job.frame = view.frame;
    job.last = static_cast<float>(view.size) - 2.0f;
    job.size = static_cast<std::int32_t>(view.size);
    // Both as shares of the receiver's largest possible light.
    constexpr float kFaint = 0.02f, kBend = 0.04f;
    job.faint = kFaint;
    job.bend = kBend / std::max(*largest, 1e-30f);
    job.least_sigma_t = *least;
    job.count = static_cast<std::int32_t>(count);
    job.x = &points.x[begin];
    job.y = &points.y[begin];
    job.z = &points.z[begin];
    job.importance = &points.importance[begin];
    job.front_z = view.front.z.data();
    job.obstacle_z = view.obstacle.z.data();
    job.front_id = view.front.triangle.data();
    job.obstacle_id = view.obstacle.triangle.data();
    job.slope = view.slope.data();
    job.boundary = medium.boundary;
    job.state = answers.state.data();
    job.triangle = answers.triangle.data();
    job.distance = answers.distance.data();
    job.throughput = answers.throughput.data();
    job.path_ratio = answers.path_ratio.data();
    find_columns(job);
    for (std::size_t c = 0; c < medium.channels; ++c) {
        attenuate(job.count, medium.sigma_t[c], &points.weight[c][begin], job.distance,
                  job.path_ratio, job.throughput, answers.light[c].data());
    }
}

}  // namespace opaline::bake
