#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include "tests/runtime/embed_gl/gl_fixture.h"
#include "tests/runtime/embed_gl/host/host_volumes.h"
#include "tests/runtime/volumes/synthetic_volume.h"

namespace opaline::test {

// Of density 1 somewhere in each brick: else the codes of a brick are rounded to steps of the
// densest neighbour's, 1.5e-5 of that density.
inline TestVolume puff(float x, std::uint32_t terms, float forward) {
    TestVolume volume;
    volume.extent = {2, 3, 2};
    volume.first_brick = {-1, 0, 2};
    volume.to_world = {0.1f, 0.01f, 0, x, -0.01f, 0.1f, 0.02f, 0, 0, 0, 0.11f, -1.6f};
    volume.spacing = 4;
    volume.single_terms = terms;
    volume.multiple_terms = terms > 4 ? 4 : 1;
    volume.bands = 3;
    volume.moment = {1, 0.6f, 0.3f, 0.2f, 0.1f};
    volume.sigma_t = {1, 2, 4};
    volume.albedo = {0.9f, 0.8f, 0.7f};
    if (forward > 0) scatter_forward(volume, static_cast<double>(forward));
    volume.density = [](float i, float j, float k) {
        const float r2 = i * i + (j - 12) * (j - 12) + (k - 24) * (k - 24);
        return std::min(1.0f, std::max(0.0f, 1.8f - 1.8f * r2 / 60));
    };
    volume.rows = [terms](formats::NodeVoxel node) {
        std::vector<formats::SparseRow> rows;
        rows.push_back(constant_row(8, 0.05f * static_cast<float>(4 + node[1] % 5), 3));
        for (std::uint32_t k = 0; k < (terms > 4 ? 4u : 1u); ++k) {
            rows.push_back(constant_row(
                8, 0.01f * static_cast<float>(node[0] % 7) / static_cast<float>(1 + k), 3));
        }
        return rows;
    };
    return volume;
}

/// A host that draws volumes, and what the CPU sees of them.
class EmbedGlVolumes : public EmbedGl {
  protected:
    void make(const formats::Asset& asset) {
        opaline_volume_light_release(volume_light_);
        EmbedGl::make(asset, OPALINE_GL_WITH_VOLUMES);
        ASSERT_EQ(opaline_volume_light_create(host_->asset(), &volume_light_), OPALINE_OK);
    }
    void TearDown() override {
        opaline_volume_light_release(volume_light_);
        EmbedGl::TearDown();
    }
    void light(std::uint32_t flags = 0) {
        ASSERT_EQ(
            opaline_volume_light_update(volume_light_, host_->asset(), host_->light(), flags, 0),
            OPALINE_OK)
            << opaline_last_error();
        ASSERT_EQ(opaline_gl_light_volumes(gl_, volume_light_), OPALINE_OK) << opaline_last_error();
    }
    opaline_gl_volumes objects() const {
        const auto volumes = filled<opaline_gl_volumes>(opaline_gl_get_volumes, gl_);
        EXPECT_EQ(volumes.glows != 0, volumes.glow_words != 0);
        return volumes;
    }
    HostPicture picture() const { return make_volume_picture(GetParam(), objects()); }
    // What the CPU sees of rays from the eye.
    std::vector<opaline_march_result> march(const std::vector<HostRay>& rays,
                                            formats::Vec3 eye) const {
        return march_rays(host_->asset(), volume_light_, rays, eye);
    }
    opaline_volume_light* volume_light_ = nullptr;
};

/// The largest of three values of each result.
template <class Result>
float largest_of(const std::vector<Result>& cpu, const float (Result::*values)[3]) {
    float largest = 0;
    for (const Result& result : cpu) {
        largest =
            std::max({largest, (result.*values)[0], (result.*values)[1], (result.*values)[2]});
    }
    return largest;
}

/// Three of the eight floats drawn of each ray, from `first` on, are the CPU's.
template <class Result>
void expect_drawn(const std::vector<float>& drawn, std::size_t first,
                  const std::vector<Result>& cpu, const float (Result::*values)[3],
                  float tolerance) {
    for (std::size_t i = 0; i < cpu.size(); ++i) {
        for (std::size_t b = 0; b < 3; ++b) {
            EXPECT_NEAR(drawn[8 * i + first + b], (cpu[i].*values)[b], tolerance) << i;
        }
    }
}

// Some begin inside, some end there, some miss.
inline std::vector<HostRay> scattered_rays(std::size_t count) {
    std::mt19937 generator(5);
    std::uniform_real_distribution<float> value(-1, 1);
    std::vector<HostRay> rays;
    for (std::size_t i = 0; i < count; ++i) {
        HostRay ray{{0.3f * value(generator), 0.3f * value(generator), 0},
                    i % 3 == 0 ? 1.8f : 0.0f,
                    {0.5f * value(generator), 0.4f * value(generator), 1},
                    i % 4 == 0 ? 2.0f + value(generator) : 1e30f};
        const float size = std::hypot(ray.direction[0], ray.direction[1], ray.direction[2]);
        for (float& d : ray.direction)
            d /= size;
        rays.push_back(ray);
    }
    return rays;
}

}  // namespace opaline::test
