#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "bake/physics/slab/even_light.h"
#include "tests/bake/reference/reference_support.h"
#include "tests/bake/reference/transport_rows.h"

namespace opaline::tests {
namespace {

std::unique_ptr<ReferenceFixture> make_slab_fixture(const TransportRow& row,
                                                    formats::Environment sky) {
    return make_fixture(make_slab(make_medium(row.sigma_t, row.albedo, row.g, 1), row.size),
                        std::move(sky));
}

// What a slab reflects of light from a direction is what it sends there under uniform light from
// that side, by reciprocity; the same for what it transmits, with light from the other side.
std::vector<bake::Moments> measure_total(const TransportRow& row, std::uint32_t samples) {
    const auto slab = make_slab_fixture(row, make_half_sky(row.quantity[0] == 'R'));
    const float cosine = row.quantity.ends_with("normal") ? 1.0f : 0.0f;
    return look_down_in_parts(slab->space(), 0.5f * row.size, cosine, samples);
}

// Radiance along a ray from where the table says.
bake::Moments march_slab(const ReferenceFixture& slab, const TransportRow& row,
                         bake::PathOptions options, std::uint32_t samples) {
    // Not in the slab's middle, where its triangles meet.
    const glm::vec3 start =
        row.size * glm::vec3(9, row.march.y < 0 ? 0.6f : -0.6f, 31) - 0.1f * row.march;
    return look(slab.space(options), start, row.march, samples);
}

#define OPALINE_SLAB_ROWS(rows, group)                                               \
    OPALINE_NEEDS_REFERENCE("volumes.csv");                                          \
    std::vector<TransportRow> rows = read_transport_rows(group);                     \
    std::erase_if(rows, [](const TransportRow& r) { return r.geometry != "slab"; }); \
    ASSERT_FALSE(rows.empty())

// Differences of the means of independent parts from the truth, in their standard errors. The mean
// square is 1 if the stated errors are right: it detects a bias below each limit, and variances
// that are too small or too large.
class ChiSquare {
  public:
    void add(const bake::Moments& part, double truth, double truth_error) {
        const double z = (part.mean.x - truth) / std::hypot(standard_error(part), truth_error);
        sum_ += z * z;
        count_ += 1;
    }
    void expect_one() const { EXPECT_NEAR(sum_ / count_, 1, 4 * std::sqrt(2 / count_)); }

  private:
    double sum_ = 0, count_ = 0;
};

TEST(ReferenceSlab, ReflectsAndTransmitsWhatIsPublished) {
    OPALINE_SLAB_ROWS(rows, "slab_total");
    ChiSquare chi_square;
    for (const TransportRow& row : rows) {
        const bool published = row.method == "published";
        bake::Moments all;
        for (const bake::Moments& part : measure_total(row, published ? 160000 : 32000)) {
            all.merge(part);
            // Parts in which hardly any path was scattered are not normally distributed.
            if (row.sigma_t * row.size > 0.05f) {
                chi_square.add(part, row.value, row.error);
            }
        }
        expect_within(row, all, published ? 3 : limit_for(rows.size()));
    }
    chi_square.expect_one();
}

// One scattering, two, and two or more, of a distant light.
TEST(ReferenceSlab, ScattersADistantLightOnceTwiceAndOften) {
    OPALINE_SLAB_ROWS(rows, "radiance");
    for (const TransportRow& row : rows) {
        const auto slab = make_slab_fixture(row, make_distant_light(row.light));
        bake::PathOptions options;
        options.terms =
            row.quantity == "order1" ? formats::TermSet::single : formats::TermSet::multiple;
        options.max_depth = row.quantity == "order2" ? 2 : options.max_depth;
        expect_within(row, march_slab(*slab, row, options, 64000), limit_for(rows.size()));
    }
}

TEST(ReferenceSlab, LetsABeamOutWhereItIsKnownTo) {
    OPALINE_SLAB_ROWS(rows, "escape");
    for (const TransportRow& row : rows) {
        expect_escape(
            row, limit_for(rows.size()), 64000, [&](formats::Environment sky, std::uint32_t depth) {
                bake::PathOptions options;
                if (depth == 0) options.terms = formats::TermSet::unscattered;
                return march_slab(*make_slab_fixture(row, std::move(sky)), row, options, 64000);
            });
    }
}

TEST(ReferenceSlab, TransmitsByBeersLawAtAnyDepth) {
    OPALINE_SLAB_ROWS(rows, "transmittance");
    for (const TransportRow& row : rows) {
        TransportRow down = row;
        down.march = {0, -1, 0};
        const auto slab = make_slab_fixture(row, make_white_sky());
        bake::PathOptions options;
        options.terms = formats::TermSet::unscattered;
        // The only randomness is whether a path passes.
        const bake::Moments m = march_slab(*slab, down, options, 160000);
        EXPECT_NEAR(m.mean.x, row.value, 3 * std::sqrt(row.value / 160000) + 2e-6 * row.value)
            << row.name() << " sigma_t " << row.sigma_t;
    }
}

// Half space of index 1.5, albedo .9, isotropic: total reflectance at normal incidence, specular
// included, .2600 by [Giovanelli1955] (to 4 digits), as quoted by [Wang1995].
TEST(ReferenceSlab, ReflectsAsGiovanellisHalfSpaceOfIndexOneAndAHalf) {
    const auto slab =
        make_fixture(make_slab(make_medium(1, 0.9f, 0, 1.5f), 60), make_half_sky(true));
    const bake::Moments m = look_down(slab->space(), 30, 1, 320000);
    EXPECT_NEAR(m.mean.x, 0.2600, 3 * std::hypot(standard_error(m), 5e-5));
    EXPECT_LT(standard_error(m), 0.001);
}

TEST(ReferenceSlab, WithoutScatteringObeysBeersLaw) {
    formats::Medium medium = make_medium(0.7f, 0, 0, 1);
    medium.sigma_a = {0.1f, 0.7f, 2.0f};
    const auto slab = make_fixture(make_slab(medium, 1.5f), make_half_sky(false));
    const bake::Moments m = look_down(slab->space(), 0.75f, 0.6f, 160);
    // Only the channel is random, and every channel passes with the same sum of weights.
    const glm::dvec3 error = glm::sqrt(m.variance_of_mean());
    for (const int c : {0, 1, 2}) {
        const double sigma = glm::dvec3(0.1, 0.7, 2.0)[c];
        EXPECT_NEAR(m.mean[c], std::exp(-sigma * 1.5 / 0.6), 3 * error[c] + 1e-5);
    }
}

// A half space: nothing comes back from 150 mean free paths.
constexpr float kDepth = 150;

bake::Moments look_at_half_space(float albedo, float g, float eta, formats::TermSet terms,
                                 float cosine, std::uint32_t samples) {
    const auto half_space =
        make_fixture(make_slab(make_medium(1, albedo, g, eta), kDepth), make_half_sky(true));
    bake::PathOptions options;
    options.terms = terms;
    return look_down(half_space->space(options), 0.5f * kDepth, cosine, samples);
}

TEST(ReferenceHalfSpace, SingleAndMultipleScatteringAgreeWithThePublishedWalk) {
    struct Row {
        float eta, albedo;
        double single, multiple;
    };
    // physics/README.md, "Half space", the columns of the walk: standard error about 0.001.
    for (const Row& row : {Row{1.0f, 0.80f, 0.164, 0.178},
                           {1.3f, 0.30f, 0.0235, 0.0072},
                           {1.3f, 0.80f, 0.0629, 0.1188},
                           {1.3f, 0.95f, 0.0740, 0.3263},
                           {1.3f, 0.99f, 0.0777, 0.5540},
                           {1.5f, 0.80f, 0.0411, 0.0893},
                           {1.5f, 0.99f, 0.0509, 0.4909}}) {
        const auto expect_term = [&](formats::TermSet term, double expected, std::uint32_t count) {
            const bake::Moments m = look_at_half_space(row.albedo, 0, row.eta, term, 0, count);
            EXPECT_NEAR(m.mean.x, expected, 3 * std::hypot(standard_error(m), 0.001))
                << "eta " << row.eta << " albedo " << row.albedo;
        };
        expect_term(formats::TermSet::single, row.single, 48000);
        expect_term(formats::TermSet::multiple, row.multiple, 24000);
    }
}

TEST(ReferenceHalfSpace, AgreesWithTheBakesOwnForForwardScattering) {
    const bake::HalfSpaceReflectance half = bake::half_space_reflectance(0.95, 0.6, 1.4);
    const bake::Moments single =
        look_at_half_space(0.95f, 0.6f, 1.4f, formats::TermSet::single, 0, 80000);
    const bake::Moments multiple =
        look_at_half_space(0.95f, 0.6f, 1.4f, formats::TermSet::multiple, 0, 40000);
    EXPECT_NEAR(single.mean.x, half.once, 3 * standard_error(single) + 0.001);
    EXPECT_NEAR(multiple.mean.x, half.rest, 3 * std::hypot(standard_error(multiple), 0.0007));
}

TEST(ReferenceHalfSpace, TermsAddUpToEverything) {
    double sum = 0, variance = 0;
    for (const formats::TermSet term :
         {formats::TermSet::single, formats::TermSet::multiple, formats::TermSet::specular,
          formats::TermSet::unscattered, formats::TermSet::interreflection,
          formats::TermSet::diffuse}) {
        const bake::Moments m = look_at_half_space(0.9f, 0.3f, 1.4f, term, 0.7f, 32000);
        sum += m.mean.x;
        variance += m.variance_of_mean().x;
    }
    const bake::Moments all =
        look_at_half_space(0.9f, 0.3f, 1.4f, formats::TermSet::all, 0.7f, 32000);
    EXPECT_NEAR(sum, all.mean.x, 3 * std::sqrt(variance + all.variance_of_mean().x));
}

}  // namespace

}  // namespace opaline::tests
