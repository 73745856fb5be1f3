// Whether directions of most probable paths are worth drawing walks through volumes by
// ([Premoze2003], section 6). Light of a sun that is scattered twice or more, along one view ray
// through a homogeneous ball or a Gaussian blob, by random walks with the light sampled at each
// collision. Directions are drawn from the phase function, or a share of them, with weights to
// match, by it around another axis: the direction that the quasi-path from the eye to the sun has
// at the scattering depth that the walk has reached ("path"), the walk's own direction turned
// toward the sun as far as such a path would turn over one mean free path ("turn"), or the sun
// ("light"). Prints variance times collisions of plain walks over that of guided ones: above 1,
// guiding pays.
//
// usage: opaline_bench guided-walk-table [WALKS]     default 400000. Fixed seeds.
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numbers>
#include <random>

#include "bake/path_integral/turn.h"
#include "bake/scattering/phase.h"
#include "tests/bake/path_integral/path_support.h"
#include "tests/bench/bench.h"

namespace {

using namespace opaline::bake;
using glm::dvec3;
using opaline::tests::Ball;
using opaline::tests::Blob;

using std::numbers::pi;

enum class Guide { none, path, turn, light };

struct Query {
    double g = 0, albedo = 1;
    dvec3 start{0}, onward{0, 0, 1}, light{0, 0, 1};
    double majorant = 1;  // [1/m]
    double depth = 1;     // scattering depth of the view ray
    double reach = 1;     // [m] around the origin, beyond which there is nothing
};

struct Estimate {
    double mean = 0, variance = 0, collisions = 0;  // of a walk
};

dvec3 around(dvec3 axis, double cosine, double angle) {
    const dvec3 other = std::abs(axis.x) < 0.9 ? dvec3(1, 0, 0) : dvec3(0, 1, 0);
    const dvec3 x = glm::normalize(glm::cross(axis, other)), y = glm::cross(axis, x);
    const double sine = std::sqrt(std::max(0.0, 1 - cosine * cosine));
    return glm::normalize(cosine * axis + sine * (std::cos(angle) * x + std::sin(angle) * y));
}

double draw_cosine(double g, double u) {
    if (std::abs(g) < 1e-3) {
        return 1 - 2 * u;
    }
    const double s = (1 - g * g) / (1 - g + 2 * g * u);
    return (1 + g * g - s * s) / (2 * g);
}

dvec3 turned(const Turn& turn, double share) {
    const double angle = turn.angle * std::min(share, 1.0);
    return std::cos(angle) * turn.from + std::sin(angle) * turn.aside;
}

// `share` of the draws go by the guide, whose lobe is as wide as the phase function.
template <class Medium>
Estimate estimate(const Medium& medium, const Query& query, Guide guide, double share, int walks) {
    std::mt19937_64 generator(7);
    std::uniform_real_distribution<double> uniform(0, 1);
    const Turn whole = Turns(query.onward, query.light)[0];
    double sum = 0, squares = 0, collisions = 0;
    for (int walk = 0; walk < walks; ++walk) {
        dvec3 x = query.start, direction = query.onward;
        double weight = 1, light = 0, ell = 0;
        for (int order = 1;; ++order) {
            double density = 0;
            do {
                const double step = -std::log(1 - uniform(generator)) / query.majorant;
                x += step * direction;
                if (glm::dot(x, x) > query.reach * query.reach && glm::dot(x, direction) > 0) {
                    density = -1;
                    break;
                }
                collisions += 1;
                const Coefficients here = medium(x);
                density = (here.scattering + here.absorption) / query.majorant;
            } while (uniform(generator) >= density);
            if (density < 0) {
                break;
            }
            ell += 1;  // a mean free path on the mean
            weight *= query.albedo;
            if (order > 1) {
                light += weight * henyey_greenstein(glm::dot(direction, query.light), query.g) *
                         medium.visibility(x, query.light);
            }
            if (weight < 0.1) {
                if (uniform(generator) > weight / 0.1) {
                    break;
                }
                weight = 0.1;
            }
            dvec3 axis = direction;
            if (guide == Guide::path) {
                axis = turned(whole, ell / query.depth);
            } else if (guide == Guide::turn) {
                axis = turned(Turns(direction, query.light)[0], 1 / query.depth);
            } else if (guide == Guide::light) {
                axis = query.light;
            }
            const bool guided = guide != Guide::none && uniform(generator) < share;
            const dvec3 next =
                around(guided ? axis : direction, draw_cosine(query.g, uniform(generator)),
                       2 * pi * uniform(generator));
            if (guide != Guide::none) {
                const double p = henyey_greenstein(glm::dot(direction, next), query.g);
                const double q = henyey_greenstein(glm::dot(axis, next), query.g);
                weight *= p / ((1 - share) * p + share * q);
            }
            direction = next;
        }
        sum += light;
        squares += light * light;
    }
    const double mean = sum / walks;
    return {mean, squares / walks - mean * mean, collisions / walks};
}

template <class Medium>
void print_rows(const char* name, const Medium& medium, Query query, int walks) {
    struct Sun {
        const char* name;
        double cosine;
    };
    for (const Sun sun : {Sun{"ahead", 0.9}, {"side", 0.2}, {"behind the eye", -0.95}}) {
        query.light = {std::sqrt(1 - sun.cosine * sun.cosine), 0, sun.cosine};
        const Estimate plain = estimate(medium, query, Guide::none, 0, walks);
        std::printf("| %s, g %.2f, albedo %.2f, depth %.0f, %s |", name, query.g, query.albedo,
                    query.depth / query.albedo, sun.name);
        double worst = 0;
        for (const Guide guide : {Guide::path, Guide::turn, Guide::light}) {
            for (const double share : {0.1, 0.25}) {
                const Estimate guided = estimate(medium, query, guide, share, walks);
                std::printf(" %.2f |", plain.variance * plain.collisions /
                                           (guided.variance * guided.collisions));
                worst = std::max(worst, std::abs(guided.mean - plain.mean) /
                                            std::sqrt((guided.variance + plain.variance) / walks));
            }
        }
        std::printf(" %.1f |\n", worst);
    }
}

}  // namespace

int opaline::tests::guided_walk_table(int count, char** arguments) {
    const int walks = count > 1 ? std::atoi(arguments[1]) : 400000;
    std::puts(
        "| body, sun | path, 0.1 | 0.25 | turn, 0.1 | 0.25 | light, 0.1 | 0.25 | sigmas apart |");
    std::puts("|---|---:|---:|---:|---:|---:|---:|---:|");
    for (const double g : {0.5, 0.75, 0.9}) {
        for (const double depth : {2.0, 10.0, 40.0}) {
            Query query;
            query.g = g;
            query.albedo = 0.99;
            query.start = {0.2, 0, -1};
            query.majorant = depth / 2;
            query.reach = 1;
            query.depth = depth * query.albedo;
            print_rows("ball", Ball{depth / 2, 1, query.albedo}, query, walks);
        }
    }
    Query query;
    query.g = 0.85;
    query.albedo = 0.99;
    query.start = {0.2, 0, -2};
    query.majorant = 6;
    query.reach = 2;
    query.depth = 6 * 0.5 * std::sqrt(2 * pi) * std::exp(-0.08) * query.albedo;
    print_rows("blob", Blob{6, 0.5, query.albedo, 2}, query, walks);
    return 0;
}
