#include "bake/physics/mie/refractive_index.h"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>

namespace opaline::bake {
namespace {

std::complex<double> index_of(Substance substance, double nm) {
    const auto index = refractive_index(substance, nm * 1e-9);
    EXPECT_TRUE(index.has_value()) << nm;
    return index ? index.value() : 0;
}

TEST(RefractiveIndex, RowsOfThePublishedTablesComeBackAsTheyAre) {
    for (const auto& [nm, real, imaginary] : {std::tuple{450.0, 1.337, 1.02e-9},
                                              {475.0, 1.336, 9.35e-10},
                                              {500.0, 1.335, 1.00e-9},
                                              {525.0, 1.334, 1.32e-9},
                                              {550.0, 1.333, 1.96e-9},
                                              {575.0, 1.333, 3.60e-9},
                                              {600.0, 1.332, 1.09e-8},
                                              {625.0, 1.332, 1.39e-8},
                                              {650.0, 1.331, 1.64e-8},
                                              {675.0, 1.331, 2.23e-8},
                                              {700.0, 1.331, 3.35e-8}}) {
        EXPECT_EQ(index_of(Substance::water, nm).real(), real) << nm;
        EXPECT_NEAR(index_of(Substance::water, nm).imag(), imaginary, 1e-22) << nm;
    }
    EXPECT_EQ(index_of(Substance::ice, 550).real(), 1.3110);
    EXPECT_NEAR(index_of(Substance::ice, 450).imag(), 9.239e-11, 1e-22);
}

TEST(RefractiveIndex, IsLinearBetweenRows) {
    const auto index = index_of(Substance::water, 560);
    EXPECT_NEAR(index.real(), 1.333, 1e-12);
    EXPECT_NEAR(index.imag(), 0.6 * 1.96e-9 + 0.4 * 3.60e-9, 1e-18);
    EXPECT_NEAR(index_of(Substance::ice, 455).real(), (1.3157 + 1.3151) / 2, 1e-9);
}

TEST(RefractiveIndex, NormalDispersionInVisibleLightAndIceIsThinnerThanWater) {
    for (double nm = 405; nm < 795; nm += 5) {
        for (const Substance substance : {Substance::water, Substance::ice}) {
            EXPECT_LE(index_of(substance, nm + 5).real(), index_of(substance, nm).real()) << nm;
            EXPECT_GT(index_of(substance, nm).imag(), 0) << nm;
        }
        EXPECT_LT(index_of(Substance::ice, nm).real(), index_of(Substance::water, nm).real());
    }
}

TEST(RefractiveIndex, WavelengthsOutsideOfTheTableAreRefused) {
    struct Table {
        Substance substance;
        double least, most;
    };
    for (const auto& [substance, least, most] :
         {Table{Substance::water, 300e-9, 1000e-9}, Table{Substance::ice, 400e-9, 800e-9}}) {
        EXPECT_TRUE(refractive_index(substance, least));
        EXPECT_TRUE(refractive_index(substance, most));
        for (const double bad : {least - 1e-9, most + 1e-9, 0.0, -1.0, 550.0,
                                 static_cast<double>(NAN), static_cast<double>(INFINITY)}) {
            const auto index = refractive_index(substance, bad);
            ASSERT_FALSE(index) << bad;
            EXPECT_EQ(index.error().kind, formats::ErrorKind::usage);
        }
    }
}

}  // namespace
}  // namespace opaline::bake
