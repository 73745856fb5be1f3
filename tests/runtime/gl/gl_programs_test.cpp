// What shader programs hold, by what the driver says is active in them.
#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <set>
#include <string>

#include "runtime/gl/egl_context.h"
#include "runtime/gl/gl_draw.h"
#include "runtime/gl/gl_relight.h"
#include "tests/runtime/gl/gl_comparison.h"
#include "tests/runtime/picture/synthetic_asset.h"

namespace opaline::runtime {
namespace {

using Names = std::set<std::string>;
using test::text_of;

class GlPrograms : public test::Gl {
  protected:
    void SetUp() override {
        Gl::SetUp();
        if (!IsSkipped()) {
            auto made = EglContext::create();
            ASSERT_TRUE(made) << text_of(made.error());
            context_.emplace(std::move(*made));
            current_.emplace(*context_);
            ASSERT_TRUE(current_->status());
        }
    }

    static GlRelight relight(const formats::Asset& asset) {
        auto made = GlRelight::create(asset.view(), {.lanes_per_row = 8});
        EXPECT_TRUE(made) << text_of(made.error());
        return std::move(*made);
    }

    static GlAsset upload(const formats::Asset& asset) {
        auto uploaded = upload_asset(asset.view(), relight(asset).relight().radiance());
        EXPECT_TRUE(uploaded) << text_of(uploaded.error());
        return std::move(*uploaded);
    }

    static Names active(const GlProgram& program, GLenum kind) {
        return active(program.name(), kind);
    }

    static Names active(GLuint program, GLenum kind) {
        Names names;
        GLint count = 0;
        glGetProgramInterfaceiv(program, kind, GL_ACTIVE_RESOURCES, &count);
        for (GLint i = 0; i < count; ++i) {
            char name[64] = {};
            glGetProgramResourceName(program, kind, static_cast<GLuint>(i), sizeof name, nullptr,
                                     name);
            if (std::string(name).rfind("gl_", 0) != 0) {
                names.insert(name);
            }
        }
        return names;
    }

    static std::size_t made(const auto& programs) {
        return static_cast<std::size_t>(
            std::ranges::count_if(programs, [](const GlProgram& p) { return p.name() != 0; }));
    }

    static std::size_t dots(const GlRelight& relight) {
        const auto& programs = relight.relight().dot_programs();
        return static_cast<std::size_t>(
            std::ranges::count_if(programs, [](GLuint program) { return program != 0; }));
    }

  private:
    std::optional<EglContext> context_;
    std::optional<CurrentContext> current_;
};

formats::Asset make_sheet_of(const test::TestPrimitive& look) {
    formats::Asset asset = test::make_asset(8, 8);
    test::add_primitive(asset, test::make_sheet({0, 0, 0}, {6, 0, 0}, {0, 0, -6}, 3, 1), look);
    return asset;
}

const Names kPlainUniforms{"eye",  "right",      "down", "forward",
                           "unit", "near_plane", "tile", "shown"};

TEST_F(GlPrograms, OpaqueSurfacesHaveNoCodeForMedia) {
    const GlAsset asset = upload(make_sheet_of({}));
    const GlRelight relit = relight(make_sheet_of({}));
    EXPECT_FALSE(relit.relight().needs_eye());
    EXPECT_EQ(asset.normal.name(), 0u);
    EXPECT_EQ(asset.openness.name(), 0u);
    EXPECT_TRUE(relit.relight().sums().empty());
    EXPECT_EQ(dots(relit), 1u);
    const auto draws = make_draw_programs(asset, {});
    ASSERT_EQ(made(draws->surfaces.program), 1u);
    EXPECT_EQ(active(draws->surfaces.program[0], GL_UNIFORM), kPlainUniforms);
    EXPECT_EQ(active(draws->surfaces.program[0], GL_PROGRAM_INPUT),
              (Names{"position", "radiance", "base_color"}));
}

TEST_F(GlPrograms, MediaWithOneTermHaveNoViewMaps) {
    const GlAsset asset = upload(make_sheet_of({.bands = 3, .eta = 1.3f}));
    const GlRelight relit = relight(make_sheet_of({.bands = 3, .eta = 1.3f}));
    EXPECT_FALSE(relit.relight().needs_eye());
    EXPECT_TRUE(relit.relight().sums().empty());
    const auto draws = make_draw_programs(asset, {});
    ASSERT_EQ(made(draws->surfaces.program), 1u);
    Names uniforms = kPlainUniforms;
    uniforms.insert({"eta", "is_double_sided"});
    EXPECT_EQ(active(draws->surfaces.program[2], GL_UNIFORM), uniforms) << "nothing is mirrored";
}

TEST_F(GlPrograms, GreyMediaHaveNoCodeForThreeBands) {
    for (const std::uint32_t terms : {1u, 4u}) {
        const GlRelight grey = relight(make_sheet_of({.bands = 1, .eta = 1.3f, .terms = terms}));
        const GlRelight colour = relight(make_sheet_of({.bands = 3, .eta = 1.3f, .terms = terms}));
        EXPECT_EQ(dots(grey), 1u);
        EXPECT_NE(grey.relight().dot_programs()[2], 0u);
        EXPECT_EQ(dots(colour), 1u);
        EXPECT_NE(colour.relight().dot_programs()[3], 0u);
    }
}

TEST_F(GlPrograms, EachNumberOfTermsHasItsOwnSum) {
    formats::Asset scene = make_sheet_of({});
    const auto sheet = test::make_sheet({0, 0, 0}, {6, 0, 0}, {0, 0, -6}, 3, 1);
    test::add_primitive(scene, sheet, {.bands = 3, .eta = 1.3f, .terms = 4});
    test::add_primitive(scene, sheet, {.bands = 3, .eta = 1.4f, .terms = 4});
    test::add_primitive(scene, sheet, {.bands = 3, .eta = 1.3f, .terms = 2, .is_separate = true});
    const GlRelight relit = relight(scene);
    const auto sums = relit.relight().sums();
    ASSERT_EQ(sums.size(), 2u);
    EXPECT_EQ(active(sums[0].program, GL_UNIFORM).count("eye"), 1u);
    // Two rows that look alike from everywhere.
    EXPECT_EQ(active(sums[1].program, GL_UNIFORM),
              (Names{"vertices", "product_origin", "radiance_origin", "shows"}));
    EXPECT_EQ(dots(relit), 2u);
}

TEST_F(GlPrograms, GlossHasAProgramOfItsOwnAndMattSurfacesNothingOfIt) {
    formats::Asset scene = make_sheet_of({});
    const auto sheet = test::make_sheet({0, 0, 0}, {6, 0, 0}, {0, 0, -6}, 3, 1);
    test::add_primitive(scene, sheet, {});
    scene.roughness.assign(2, formats::kNotGlossy);
    scene.openness.resize(scene.position.size());
    scene.gloss.resize(2);
    scene.gloss[1].roughness = 0.4f;
    const auto draws = make_draw_programs(upload(scene), {});
    ASSERT_EQ(made(draws->surfaces.program), 2u);
    EXPECT_EQ(active(draws->surfaces.program[0], GL_UNIFORM), kPlainUniforms);
    Names uniforms = kPlainUniforms;
    uniforms.insert({"is_double_sided", "light_from_world", "has_specular", "f0_f90",
                     "metallic_roughness", "suns", "light_maps"});
    EXPECT_EQ(active(draws->surfaces.program[8], GL_UNIFORM), uniforms);
}

TEST_F(GlPrograms, ImagesAreReadOnlyWhereThereAreImages) {
    formats::Asset scene = make_sheet_of({.image = 0});
    scene.images.push_back(test::make_noise_image(3, 3));
    const auto draws = make_draw_programs(upload(scene), {});
    ASSERT_EQ(made(draws->surfaces.program), 1u);
    Names uniforms = kPlainUniforms;
    uniforms.insert({"base_color_image", "wrap"});
    EXPECT_EQ(active(draws->surfaces.program[1], GL_UNIFORM), uniforms);
}

}  // namespace
}  // namespace opaline::runtime
