// What is installed for hosts that draw volumes, in a host's fragment shader, beside the functions
// of opaline.h and the picture that the renderer makes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <random>
#include <string>

#include "runtime/api_support.h"
#include "runtime/picture/software_renderer.h"
#include "tests/runtime/embed_gl/embedded_asset.h"
#include "tests/runtime/embed_gl/host_picture.h"
#include "tests/runtime/volumes/glow_support.h"
#include "tests/runtime/volumes/synthetic_volume.h"
#include "tests/support/cut_phase.h"

namespace opaline::test {
namespace {

const char* const kSeeVolumes = R"(
uniform bool is_point;
void see(vec3 from, float begin, vec3 direction, float end, out vec4 a, out vec4 b) {
    if (is_point) {
        OpalineVolumeSample found = opaline_sample_volumes(from, direction);
        a = vec4(found.extinction, 1.0);
        b = vec4(found.scattered, 1.0);
        return;
    }
    OpalineSeen seen = opaline_march_volumes(from, direction, begin, end);
    a = vec4(seen.radiance, 1.0);
    b = vec4(seen.transmittance, 1.0);
}
)";

// Of density 1 somewhere in each brick: else the codes of a brick are rounded to steps of the
// densest neighbour's, 1.5e-5 of that density.
TestVolume puff(float x, std::uint32_t terms, float forward) {
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
    if (forward > 0) {
        const tests::CutPhase phase = tests::make_cut_phase(static_cast<double>(forward));
        volume.moment = phase.moments();
        volume.phase = phase;
    }
    volume.density = [](float i, float j, float k) {
        const float r2 = i * i + (j - 12) * (j - 12) + (k - 24) * (k - 24);
        return std::min(1.0f, std::max(0.0f, 1.8f - 1.8f * r2 / 60));
    };
    volume.rows = [terms](formats::NodeVoxel node) {
        std::vector<formats::SparseRow> rows;
        rows.push_back(constant_row(8, 0.05f * static_cast<float>(4 + node[1] % 5), 3));
        for (std::uint32_t k = 0; k < (terms > 4 ? 4u : 1u); ++k) {
            rows.push_back(constant_row(8, 0.01f * static_cast<float>(node[0] % 7) / (1 + k), 3));
        }
        return rows;
    };
    return volume;
}

// Two that overlap, one with a phase function that suns meet as it is; far from the origin too.
formats::Asset make_puffs(float far) {
    formats::Asset asset = make_asset(8, 8);
    asset.volumes = make_volumes(8);
    add_volume(asset.volumes, puff(far, 4, 0));
    add_volume(asset.volumes, puff(far + 0.7f, 25, 0.8f));
    return asset;
}

// The second is fire, also where there is no smoke.
formats::Asset make_burning_puffs() {
    formats::Asset asset = make_asset(8, 8);
    formats::append_emitter(asset.emitters, "fire");
    asset.volumes = make_volumes(8);
    add_volume(asset.volumes, puff(0, 4, 0));
    const TestVolume burning = puff(0.7f, 4, 0);
    add_volume(asset.volumes, burning);
    add_glow(asset.volumes, burning,
             [](float i, float j, float k) {
                 const float r2 = i * i + (j - 16) * (j - 16) + (k - 24) * (k - 24);
                 return std::exp(-r2 / 25) * formats::Rgb{6, 3, 1};
             },
             {0.5f, 0.3f, 0.1f});
    return asset;
}

class EmbedGlVolumes : public EmbedGl {
  protected:
    void make(const formats::Asset& asset) {
        host_ = std::make_unique<EmbeddedAsset>(asset);
        ASSERT_EQ(opaline_gl_create(host_->asset(), load_gl, OPALINE_GL_WITH_VOLUMES, &gl_),
                  OPALINE_OK)
            << opaline_last_error();
        ASSERT_EQ(opaline_volume_light_create(host_->asset(), &volume_light_), OPALINE_OK);
    }
    void TearDown() override {
        opaline_volume_light_release(volume_light_);
        EXPECT_EQ(opaline_gl_release(gl_), OPALINE_OK);
    }
    void light(std::uint32_t flags = 0) {
        ASSERT_EQ(
            opaline_volume_light_update(volume_light_, host_->asset(), host_->light(), flags, 0),
            OPALINE_OK)
            << opaline_last_error();
        ASSERT_EQ(opaline_gl_light_volumes(gl_, volume_light_), OPALINE_OK) << opaline_last_error();
    }
    opaline_gl_volumes objects() const {
        opaline_gl_volumes volumes{};
        volumes.struct_size = sizeof volumes;
        EXPECT_EQ(opaline_gl_get_volumes(gl_, &volumes), OPALINE_OK);
        return volumes;
    }
    HostPicture picture() const {
        const opaline_gl_volumes volumes = objects();
        return HostPicture(GetParam(), {"opaline_volumes.glsl"},
                           "#define OPALINE_VOLUMES " + std::to_string(volumes.count) +
                               "\n#define OPALINE_VOLUME_TERMS " + std::to_string(volumes.terms) +
                               (volumes.glows != 0 ? "\n#define OPALINE_VOLUME_GLOW 1\n" : "\n"),
                           kSeeVolumes);
    }
    void bind(HostPicture& picture) const {
        const opaline_gl_volumes volumes = objects();
        picture.bind_texture("opaline_brick_numbers", volumes.brick_numbers);
        picture.bind_texture("opaline_density_codes", volumes.density_codes);
        picture.bind_texture("opaline_corner_numbers", volumes.corner_numbers);
        picture.bind_texture("opaline_node_light", volumes.node_light);
        picture.bind_texture("opaline_phase_entries", volumes.phase_entries);
        picture.bind_block("OpalineVolumeRecords", volumes.block);
        EXPECT_EQ(volumes.glows != 0, volumes.glow_words != 0);
        if (volumes.glows != 0) picture.bind_texture("opaline_glow_words", volumes.glow_words);
    }
    // What the CPU sees of rays from the eye.
    std::vector<opaline_march_result> march(const std::vector<HostRay>& rays,
                                            const float (&eye)[3]) const {
        std::vector<opaline_march_ray> march;
        for (const HostRay& ray : rays) {
            march.push_back({{eye[0] + ray.from[0], eye[1] + ray.from[1], eye[2] + ray.from[2]},
                             {ray.direction[0], ray.direction[1], ray.direction[2]},
                             ray.begin,
                             ray.end});
        }
        std::vector<opaline_march_result> seen(march.size());
        EXPECT_EQ(opaline_volumes_march(host_->asset(), volume_light_, nullptr, march.data(),
                                        static_cast<std::uint32_t>(march.size()), seen.data()),
                  OPALINE_OK);
        return seen;
    }
    std::unique_ptr<EmbeddedAsset> host_;
    opaline_gl* gl_ = nullptr;
    opaline_volume_light* volume_light_ = nullptr;
};

// Some begin inside, some end there, some miss.
std::vector<HostRay> scattered_rays(std::size_t count) {
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

TEST_P(EmbedGlVolumes, RaysSeeWhatTheCpuMarches) {
    for (const float far : {0.0f, 3000.0f}) {
        if (gl_ != nullptr) TearDown();
        make(make_puffs(far));
        HostPicture host = picture();
        bind(host);
        std::vector<HostRay> rays = scattered_rays(600);
        // There, world coordinates of floats have 0.2 mm at best: all rays from the eye itself.
        for (HostRay& ray : rays) {
            if (far > 0) ray.from[0] = ray.from[1] = 0;
        }
        for (int step = 0; step < 3; ++step) {  // black; lit; lit by fewer coefficients a node
            const float eye[3] = {far + 0.4f, 1, step == 2 ? -1.2f : -2};
            const float sky[3] = {2, 3, 4};
            if (step == 2) {
                ASSERT_EQ(opaline_light_clear(host_->light()), OPALINE_OK);
                ASSERT_EQ(opaline_light_set_lat_long(host_->light(), sky, 1, 1), OPALINE_OK);
            }
            if (step > 0) light();
            ASSERT_EQ(opaline_gl_look_from(gl_, eye), OPALINE_OK);
            const std::vector<opaline_march_result> cpu = march(rays, eye);
            const std::vector<float> drawn = host.draw(rays);
            float brightest = 1e-30f, largest = 0, largest_left = 0, darkest = 1;
            for (const opaline_march_result& result : cpu) {
                brightest = std::max(brightest, result.radiance[0]);
            }
            for (std::size_t i = 0; i < cpu.size(); ++i) {
                for (std::size_t b = 0; b < 3; ++b) {
                    largest = std::max(largest, std::abs(drawn[8 * i + b] - cpu[i].radiance[b]));
                    const float left = drawn[8 * i + 4 + b] - cpu[i].transmittance[b];
                    largest_left = std::max(largest_left, std::abs(left));
                    darkest = std::min(darkest, cpu[i].transmittance[b]);
                }
            }
            std::cout << "[ agreement] " << largest / brightest << ", " << largest_left << "\n";
            EXPECT_LT(darkest, 0.2f);
            EXPECT_EQ(brightest > 0.01f, step > 0);
            // Suns count by what a ray has left where it comes among eight nodes, and rounding may
            // make that a step earlier or later: evaluated at every step, both agree to 2e-6.
            EXPECT_LE(largest, 1e-4f * std::max(brightest, 1e-3f));
            EXPECT_LE(largest_left, 1e-5f);
        }
    }
}

TEST_P(EmbedGlVolumes, PointsHaveTheCpusExtinctionAndScattering) {
    make(make_puffs(0));
    light();
    const float eye[3] = {0.4f, 1, 0};
    ASSERT_EQ(opaline_gl_look_from(gl_, eye), OPALINE_OK);
    std::mt19937 generator(3);
    std::uniform_real_distribution<float> value(-1, 1);
    std::vector<HostRay> places;
    std::vector<opaline_sample_point> points;
    for (int i = 0; i < 500; ++i) {
        HostRay place{{1.2f * value(generator), 1.2f * value(generator), 1 + value(generator)},
                      0,
                      {0.6f, 0, 0.8f},
                      0};
        places.push_back(place);
        points.push_back({{eye[0] + place.from[0], eye[1] + place.from[1], eye[2] + place.from[2]},
                          {0.6f, 0, 0.8f}});
    }
    std::vector<opaline_sample_result> cpu(points.size());
    ASSERT_EQ(opaline_volumes_sample(host_->asset(), volume_light_, points.data(),
                                     static_cast<std::uint32_t>(points.size()), cpu.data()),
              OPALINE_OK);
    HostPicture host = picture();
    bind(host);
    host.set_flag("is_point", true);
    const std::vector<float> drawn = host.draw(places);
    float thickest = 0, brightest = 0;
    for (const opaline_sample_result& result : cpu) {
        thickest = std::max(thickest, result.extinction[2]);
        brightest = std::max(brightest, result.scattered[2]);
    }
    EXPECT_GT(thickest, 1);
    EXPECT_GT(brightest, 0.1f);
    for (std::size_t i = 0; i < cpu.size(); ++i) {
        for (std::size_t b = 0; b < 3; ++b) {
            EXPECT_NEAR(drawn[8 * i + b], cpu[i].extinction[b], 1e-5f * thickest) << i;
            EXPECT_NEAR(drawn[8 * i + 4 + b], cpu[i].scattered[b], 1e-5f * brightest) << i;
        }
    }
}

float brightest_of(const std::vector<opaline_march_result>& seen) {
    float brightest = 0;
    for (const opaline_march_result& result : seen) {
        brightest = std::max(brightest, result.radiance[0]);
    }
    return brightest;
}

TEST_P(EmbedGlVolumes, FireShinesAlongRaysAndAtPointsAsOnTheCpuInItsEmittersColour) {
    make(make_burning_puffs());
    EXPECT_EQ(objects().glows, 1u);
    HostPicture host = picture();
    bind(host);
    const float eye[3] = {0.4f, 1.2f, -2};
    ASSERT_EQ(opaline_gl_look_from(gl_, eye), OPALINE_OK);
    const std::vector<HostRay> rays = scattered_rays(300);
    const float color[3] = {1, 0.5f, 3};
    ASSERT_EQ(opaline_light_set_emitter(host_->light(), 0, color), OPALINE_OK);
    float scattered_alone = 0;
    for (const std::uint32_t flags : {std::uint32_t{OPALINE_SHADE_WITHOUT_EMISSION}, 0u}) {
        light(flags);
        const std::vector<opaline_march_result> cpu = march(rays, eye);
        const std::vector<float> drawn = host.draw(rays);
        const float brightest = brightest_of(cpu);
        for (std::size_t i = 0; i < cpu.size(); ++i) {
            for (std::size_t b = 0; b < 3; ++b) {
                EXPECT_NEAR(drawn[8 * i + b], cpu[i].radiance[b], 1e-5f * brightest) << i;
            }
        }
        EXPECT_GT(brightest, 1.5f * scattered_alone);
        scattered_alone = brightest;
    }
    std::vector<HostRay> places;
    std::vector<opaline_sample_point> points;
    for (int i = 0; i < 200; ++i) {
        const float at = 0.01f * static_cast<float>(i);
        places.push_back({{0.5f * at, 0.7f - 0.3f * at, 2 + at}, 0, {0, 0, -1}, 0});
        const float* from = places.back().from;
        points.push_back({{eye[0] + from[0], eye[1] + from[1], eye[2] + from[2]}, {0, 0, -1}});
    }
    std::vector<opaline_sample_result> cpu(points.size());
    ASSERT_EQ(opaline_volumes_sample(host_->asset(), volume_light_, points.data(),
                                     static_cast<std::uint32_t>(points.size()), cpu.data()),
              OPALINE_OK);
    host.set_flag("is_point", true);
    const std::vector<float> drawn = host.draw(places);
    bool glows_without_smoke = false;
    for (std::size_t i = 0; i < cpu.size(); ++i) {
        glows_without_smoke =
            glows_without_smoke || (cpu[i].extinction[0] == 0 && cpu[i].scattered[0] > 0.1f);
        for (std::size_t b = 0; b < 3; ++b) {
            EXPECT_NEAR(drawn[8 * i + 4 + b], cpu[i].scattered[b], 5e-5f) << i;  // of 6
        }
    }
    EXPECT_TRUE(glows_without_smoke);
}

// One that was built before volumes had light of their own.
TEST_P(EmbedGlVolumes, AnEarlierHostSeesFireWithoutItsOwnLight) {
    make(make_burning_puffs());
    light();
    opaline_gl_volumes early{};
    early.struct_size = offsetof(opaline_gl_volumes, glows);
    early.glows = 7;
    ASSERT_EQ(opaline_gl_get_volumes(gl_, &early), OPALINE_OK) << opaline_last_error();
    EXPECT_EQ(early.struct_size, offsetof(opaline_gl_volumes, glows));
    EXPECT_EQ(early.glows, 7u);  // behind what it knows
    EXPECT_EQ(early.block, objects().block);
    HostPicture host(GetParam(), {"opaline_volumes.glsl"},
                     "#define OPALINE_VOLUMES 2\n#define OPALINE_VOLUME_TERMS " +
                         std::to_string(early.terms) + "\n",
                     kSeeVolumes);
    host.bind_texture("opaline_brick_numbers", early.brick_numbers);
    host.bind_texture("opaline_density_codes", early.density_codes);
    host.bind_texture("opaline_corner_numbers", early.corner_numbers);
    host.bind_texture("opaline_node_light", early.node_light);
    host.bind_texture("opaline_phase_entries", early.phase_entries);
    host.bind_block("OpalineVolumeRecords", early.block);
    const float eye[3] = {0.4f, 1.2f, -2};
    ASSERT_EQ(opaline_gl_look_from(gl_, eye), OPALINE_OK);
    const std::vector<HostRay> rays = scattered_rays(100);
    const std::vector<float> drawn = host.draw(rays);
    ASSERT_EQ(opaline_volume_light_update(volume_light_, host_->asset(), host_->light(),
                                          OPALINE_SHADE_WITHOUT_EMISSION, 0),
              OPALINE_OK);
    const std::vector<opaline_march_result> cpu = march(rays, eye);
    const float brightest = brightest_of(cpu);
    EXPECT_GT(brightest, 0.01f);
    for (std::size_t i = 0; i < cpu.size(); ++i) {
        EXPECT_NEAR(drawn[8 * i], cpu[i].radiance[0], 1e-5f * brightest) << i;
    }
}

TEST_P(EmbedGlVolumes, PixelsAreThoseOfTheRenderedPicture) {
    const formats::Asset asset = make_puffs(0);
    make(asset);
    light();
    runtime::Camera camera;
    camera.eye = {0.4f, 1.1f, -3};
    camera.target = {0.5f, 1, 1};
    camera.width = 24;
    camera.height = 20;
    runtime::SoftwareOptions options;
    options.supersampling = 1;
    options.background = false;
    options.volumes = &volume_light_->light;
    const auto rendered = runtime::render_software(asset.view(), {}, {}, {}, camera, options);
    ASSERT_TRUE(rendered.has_value());
    const float eye[3] = {camera.eye.x, camera.eye.y, camera.eye.z};
    ASSERT_EQ(opaline_gl_look_from(gl_, eye), OPALINE_OK);
    const runtime::CameraFrame frame = runtime::camera_frame(camera);
    std::vector<HostRay> rays;
    for (std::uint32_t i = 0; i < camera.width * camera.height; ++i) {
        const formats::Vec3 d =
            runtime::view_ray(camera, frame, i % camera.width + 0.5, i / camera.width + 0.5);
        rays.push_back({{0, 0, 0}, camera.near_plane, {d.x, d.y, d.z}, 1e30f});
    }
    HostPicture host = picture();
    bind(host);
    const std::vector<float> drawn = host.draw(rays);
    float brightest = 0;
    for (const formats::Rgb& pixel : rendered->pixel)
        brightest = std::max(brightest, pixel.g);
    EXPECT_GT(brightest, 0.01f);
    for (std::size_t i = 0; i < rays.size(); ++i) {
        EXPECT_NEAR(drawn[8 * i + 1], rendered->pixel[i].g, 1e-4f * brightest) << i;
    }
}

TEST_P(EmbedGlVolumes, WrongUseIsToldByStatus) {
    make(make_puffs(0));
    opaline_gl_volumes volumes{};
    EXPECT_EQ(opaline_gl_get_volumes(gl_, &volumes), OPALINE_INVALID_ARGUMENT);
    EXPECT_EQ(opaline_gl_get_volumes(gl_, nullptr), OPALINE_INVALID_ARGUMENT);
    EXPECT_EQ(opaline_gl_get_volumes(nullptr, &volumes), OPALINE_INVALID_ARGUMENT);
    EXPECT_EQ(opaline_gl_light_volumes(nullptr, volume_light_), OPALINE_INVALID_ARGUMENT);
    EXPECT_EQ(opaline_gl_light_volumes(gl_, nullptr), OPALINE_INVALID_ARGUMENT);
    const EmbeddedAsset other(make_puffs(0));
    opaline_volume_light* others = nullptr;
    ASSERT_EQ(opaline_volume_light_create(other.asset(), &others), OPALINE_OK);
    EXPECT_EQ(opaline_gl_light_volumes(gl_, others), OPALINE_INVALID_ARGUMENT);
    opaline_volume_light_release(others);
    // Without the flag there are none, with five there is no handle.
    opaline_gl* without = nullptr;
    ASSERT_EQ(opaline_gl_create(host_->asset(), load_gl, 0, &without), OPALINE_OK);
    EXPECT_EQ(opaline_gl_light_volumes(without, volume_light_), OPALINE_OK);
    volumes.struct_size = sizeof volumes;
    EXPECT_EQ(opaline_gl_get_volumes(without, &volumes), OPALINE_OK);
    EXPECT_EQ(volumes.count + volumes.block + volumes.node_light, 0u);
    EXPECT_EQ(opaline_gl_release(without), OPALINE_OK);
    formats::Asset many = make_asset(8, 8);
    many.volumes = make_volumes(8);
    for (int i = 0; i < 5; ++i)
        add_volume(many.volumes, puff(static_cast<float>(i), 4, 0));
    const EmbeddedAsset five(many);
    opaline_gl* none = nullptr;
    EXPECT_EQ(opaline_gl_create(five.asset(), load_gl, OPALINE_GL_WITH_VOLUMES, &none),
              OPALINE_GL_REFUSED);
    EXPECT_EQ(none, nullptr);
    EXPECT_EQ(opaline_gl_create(five.asset(), load_gl, 0, &none), OPALINE_OK);
    EXPECT_EQ(opaline_gl_release(none), OPALINE_OK);
    HostContext::make_none_current();
    EXPECT_EQ(opaline_gl_light_volumes(gl_, volume_light_), OPALINE_GL_NO_CONTEXT);
    context_->make_current();
}

INSTANTIATE_TEST_SUITE_P(On, EmbedGlVolumes, testing::Values(HostApi::desktop_43, HostApi::es_31),
                         api_name);

}  // namespace
}  // namespace opaline::test
