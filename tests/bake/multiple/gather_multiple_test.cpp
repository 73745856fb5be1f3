#include "bake/effects/multiple/gather_multiple.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "bake/physics/fresnel.h"
#include "bake/receivers/kd_order.h"
#include "tests/support/reference_table.h"

namespace opaline::bake {
namespace {

using std::numbers::pi;

// Samples with one number each as "transport", in the first of six entries: tree and gather do not
// interpret the entries.
struct Samples {
    std::vector<SurfaceSample> samples;
    std::vector<float> irradiance;

    void add(glm::dvec3 position, glm::dvec3 normal, double area, double entering) {
        SurfaceSample s{};
        s.position = position;
        s.geometric_normal = s.normal = normal;
        s.area = static_cast<float>(area);
        samples.push_back(s);
        irradiance.push_back(static_cast<float>(entering));
    }
    ClusterTree tree(const Context& context = {}) const {
        std::vector<SurfaceSample> sorted;
        SampleTransport transport;
        for (const std::uint32_t i : kd_order(samples)) {
            if (sorted.size() % SparseVectors::kPerBlock == 0) {
                transport.rows.blocks.emplace_back();
            }
            sorted.push_back(samples[i]);
            const std::vector<float> dense{irradiance[i], 0, 0, 0, 0, 0};
            append_truncated(transport.rows.blocks.back(), dense, 6, samples[i].area);
            transport.mean.push_back(irradiance[i]);
            transport.norm.push_back(irradiance[i]);
        }
        return build_cluster_tree(sorted, std::move(transport), 1, 6, context);
    }
};

// A spherical Fibonacci lattice: nearly uniform, deterministic.
template <class Irradiance>
Samples make_sphere(double radius, int count, Irradiance&& irradiance) {
    Samples set;
    for (int i = 0; i < count; ++i) {
        const double z = 1 - (2 * i + 1.0) / count;
        const double phi = i * pi * (3 - std::sqrt(5.0));
        const double s = std::sqrt(1 - z * z);
        const glm::dvec3 n(s * std::cos(phi), s * std::sin(phi), z);
        set.add(radius * n, n, 4 * pi * radius * radius / count, irradiance(n));
    }
    return set;
}

template <class Irradiance>
Samples make_plane(double side, int count, Irradiance&& irradiance) {
    Samples set;
    const double h = side / count;
    for (int i = 0; i < count; ++i) {
        for (int j = 0; j < count; ++j) {
            const double x = (i + 0.5) * h - side / 2, z = (j + 0.5) * h - side / 2;
            set.add({x, 0, z}, {0, 1, 0}, h * h, irradiance(x, z));
        }
    }
    return set;
}

MediumProfile classic_profile(double sigma_s, double sigma_a, double eta) {
    formats::Medium medium;
    const auto s = static_cast<float>(sigma_s), a = static_cast<float>(sigma_a);
    medium.sigma_s = {s, s, s};
    medium.sigma_a = {a, a, a};
    medium.eta = static_cast<float>(eta);
    medium.profile = formats::Medium::Profile::classic;
    return make_medium_profile(medium);
}

double gather(const ClusterTree& tree, const MediumProfile& profile, glm::vec3 x, glm::vec3 n,
              double tolerance, std::size_t* count = nullptr) {
    std::vector<ClusterWeight> weights;
    const double spacing = std::sqrt(
        tree.total_area / static_cast<double>(std::max<std::size_t>(1, tree.position.size())));
    collect_weights(tree, make_gather_profile(profile, spacing, 1e4), x, n, {tolerance}, weights);
    std::vector<float> rgbx(24);
    accumulate(tree, weights, rgbx);
    if (count != nullptr) *count = weights.size();
    return static_cast<double>(rgbx[0]);
}

// `entering`: of a row and a normal.
template <class Entering>
void expect_sphere_rows(const char* check, int count, double tolerance, double error,
                        Entering&& entering) {
    OPALINE_REFERENCE_ROWS(rows, "translucency.csv", check);
    for (const auto& row : rows) {
        const double radius = row.number("radius");
        const auto profile =
            classic_profile(row.number("sigma_s_prime"), row.number("sigma_a"), row.number("eta"));
        const Samples set =
            make_sphere(radius, count, [&](glm::dvec3 n) { return entering(row, n); });
        const double found =
            gather(set.tree(), profile, {0, static_cast<float>(radius), 0}, {0, 1, 0}, tolerance);
        EXPECT_NEAR(found, row.expected, row.tolerance_or(error)) << row.name();
    }
}

TEST(GatherMultiple, SphereUnderEvenAndDirectionalLightIsThatOfTheTable) {
    expect_sphere_rows("sphere_int_Rd", 40000, 1e-4, 2e-3,
                       [](const auto&, glm::dvec3) { return 1.0; });
    // <E, 1> over the hemisphere: all entering white light.
    expect_sphere_rows("sphere_Td_dot_one", 40000, 1e-4, 2e-3, [](const auto& row, glm::dvec3) {
        return pi * (1 - fresnel_moments(row.number("eta")).external);
    });
    expect_sphere_rows("sphere_Td", 60000, 1e-5, 3e-3, [](const auto& row, glm::dvec3 n) {
        const double c = row.number("cos_light"), s = std::sqrt(1 - c * c);
        const double cosine = s * n.x + c * n.y;
        return cosine > 0 ? fresnel_transmittance(cosine, row.number("eta")) * cosine : 0.0;
    });
}

// The bound that GatherOptions::tolerance states, node by node: what enters through its samples
// times how far the profile varies among them, which is more than the error of weighting them once.
TEST(GatherMultiple, NodeTakenWholeErrsByNoMoreThanTheTolerance) {
    const Samples set = make_sphere(
        1, 20000, [](glm::dvec3 n) { return std::max(0.0, n.x) * (1 + 0.5 * std::sin(5 * n.z)); });
    const ClusterTree tree = set.tree();
    const auto medium = classic_profile(20, 0.5, 1.3);
    const GatherProfile profile =
        make_gather_profile(medium, std::sqrt(tree.total_area / 20000), 10);
    const auto nodes = static_cast<std::uint32_t>(tree.nodes.size());
    for (const double tolerance : {3e-2, 3e-3, 3e-4}) {
        const double bound = tolerance * profile.total[0] * tree.mean_norm;
        std::size_t whole = 0;
        double worst = 0;
        for (const glm::vec3 x : {glm::vec3(0, 1, 0), {1, 0, 0}, {-0.6f, 0.8f, 0}, {0, 0, -1}}) {
            std::vector<ClusterWeight> weights;
            collect_weights(tree, profile, x, x, {tolerance}, weights);
            for (const ClusterWeight& taken : weights) {
                if (taken.id >= nodes) continue;
                const ClusterNode& node = tree.nodes[taken.id];
                double exact = 0, sum = 0, least = 1e300, most = 0;
                for (std::uint32_t s = node.first; s < node.first + node.count; ++s) {
                    const glm::vec3 d = tree.position[s] - x;
                    const double weight = eval_far(profile, glm::dot(d, d))[0];
                    const SparseVector entering = tree.samples[s];
                    const double value = entering.value.empty() ? 0 : entering.value[0];
                    exact += value * weight;
                    sum += value;
                    least = std::min(least, weight);
                    most = std::max(most, weight);
                }
                const double rounding = 1e-6 * exact;
                EXPECT_LE(sum * (most - least), bound + rounding) << taken.id;
                EXPECT_LE(std::abs(taken.weight[0] * sum - exact), sum * (most - least) + rounding)
                    << taken.id;
                worst = std::max(worst, sum * (most - least) / bound);
                ++whole;
            }
        }
        EXPECT_GT(whole, 20u) << tolerance;
        EXPECT_GT(worst, 0.5) << "more nodes are opened than must be at " << tolerance;
    }
}

TEST(GatherMultiple, SamplesFartherApartThanTheSourceIsDeepStillConserveEnergy) {
    // Plain sums at these spacings err by tens to thousands of per cent.
    for (const double spacing : {1.5, 3.0, 10.0, 100.0}) {
        const auto profile = classic_profile(1, 0.05, 1.3);
        const double side = 40 * spacing * profile.smallest;
        const Samples set = make_plane(side, 40, [](double, double) { return 1.0; });
        const ClusterTree tree = set.tree();
        for (const double shift : {0.0, 0.25, 0.5}) {
            const auto x = static_cast<float>(shift * spacing * profile.smallest);
            const double found = gather(tree, profile, {x, 0, x}, {0, 1, 0}, 1e-4);
            EXPECT_NEAR(found, profile.total(0), 0.02 * profile.total(0)) << spacing << shift;
        }
    }
}

TEST(GatherMultiple, OpticallyThickBodyOfAnyShapeReflectsWhatFallsOnIt) {
    // The limit of a diffuse surface: T_d = R E (multiple/README.md, "Sampling"). A sphere is no
    // flat disc within the samples' reach, and at the poles of a needle the surface turns fastest.
    for (const double stretch : {1.0, 4.0}) {
        Samples set = make_sphere(1, 20000, [](glm::dvec3 n) { return 1 + n.x; });
        for (SurfaceSample& sample : set.samples) {
            const glm::dvec3 n(sample.normal);
            sample.position.x *= static_cast<float>(stretch);
            sample.normal = glm::normalize(glm::dvec3(n.x / stretch, n.y, n.z));
            // Area of the stretched patch: stretch |M^-T n|.
            sample.area *=
                static_cast<float>(stretch * glm::length(glm::dvec3(n.x / stretch, n.y, n.z)));
        }
        const auto profile = classic_profile(1e5, 10, 1.3);
        const ClusterTree tree = set.tree();
        const auto s = static_cast<float>(stretch);
        EXPECT_NEAR(gather(tree, profile, {0, 0, 1}, {0, 0, 1}, 1e-4) / profile.total(0), 1, 0.01);
        EXPECT_NEAR(gather(tree, profile, {s, 0, 0}, {1, 0, 0}, 1e-4) / profile.total(0), 2, 0.02);
    }
}

TEST(GatherMultiple, SidesOfAThinOpaqueSheetDoNotMix) {
    // Two faces a tenth of the spacing apart, lit from above.
    Samples set = make_plane(10, 50, [](double, double) { return 1.0; });
    for (int i = 0; i < 50; ++i) {
        for (int j = 0; j < 50; ++j) {
            set.add({(i + 0.5) * 0.2 - 5, -0.02, (j + 0.5) * 0.2 - 5}, {0, -1, 0}, 0.04, 0.0);
        }
    }
    const auto profile = classic_profile(1e5, 10, 1.3);
    const ClusterTree tree = set.tree();
    EXPECT_NEAR(gather(tree, profile, {0.05f, 0, 0}, {0, 1, 0}, 1e-4) / profile.total(0), 1, 0.01);
    EXPECT_LT(gather(tree, profile, {0.05f, -0.02f, 0}, {0, -1, 0}, 1e-4), 0.01);
}

TEST(GatherMultiple, PartWithoutASampleOfItsOwnTakesTheNearest) {
    const Samples set = make_plane(1, 10, [](double, double) { return 1.0; });
    const auto profile = classic_profile(1e5, 10, 1.3);
    EXPECT_NEAR(gather(set.tree(), profile, {5, 0, 0}, {0, 1, 0}, 1e-4) / profile.total(0), 1,
                0.01);
}

TEST(GatherMultiple, TransportIsReciprocal) {
    const auto profile = classic_profile(30, 1, 1.4);
    const auto f = [](glm::dvec3 n) { return 1 + n.x * n.y; };
    const auto g = [](glm::dvec3 n) { return std::max(0.0, n.z); };
    const Samples f_set = make_sphere(1, 3000, f), g_set = make_sphere(1, 3000, g);
    const ClusterTree f_tree = f_set.tree(), g_tree = g_set.tree();
    double g_of_f = 0, f_of_g = 0;
    for (std::size_t i = 0; i < f_set.samples.size(); ++i) {
        const glm::vec3 x = f_set.samples[i].position;
        const auto area = static_cast<double>(f_set.samples[i].area);
        g_of_f += area * g(glm::dvec3(x)) * gather(f_tree, profile, x, x, 0);
        f_of_g += area * f(glm::dvec3(x)) * gather(g_tree, profile, x, x, 0);
    }
    EXPECT_NEAR(g_of_f / f_of_g, 1, 1e-4);
}

TEST(GatherMultiple, CoincidentUnlitAndNoSamplesAreHarmless) {
    Samples same;
    for (int i = 0; i < 100; ++i) {
        same.add({0, 0, 0}, {0, 1, 0}, 0.01, 1);
    }
    const auto profile = classic_profile(1, 0.1, 1.3);
    EXPECT_TRUE(std::isfinite(gather(same.tree(), profile, {0, 0, 0}, {0, 1, 0}, 1e-3)));
    const Samples dark = make_sphere(1, 1000, [](glm::dvec3) { return 0.0; });
    EXPECT_EQ(gather(dark.tree(), profile, {0, 1, 0}, {0, 1, 0}, 1e-3), 0);
    EXPECT_EQ(gather(Samples{}.tree(), profile, {0, 0, 0}, {0, 1, 0}, 1e-3), 0);
}

}  // namespace
}  // namespace opaline::bake
