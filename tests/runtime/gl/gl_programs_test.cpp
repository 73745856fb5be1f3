// What shader programs hold, by what the driver says is active in them.
#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <set>
#include <string>

#include "runtime/gl/egl_context.h"
#include "runtime/gl/gl_dot.h"
#include "runtime/gl/gl_draw.h"
#include "runtime/gl/gl_view.h"
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

    static GlAsset upload(const formats::Asset& asset) {
        auto uploaded = upload_asset(asset.view(), query_dot_limits(0, 8));
        EXPECT_TRUE(uploaded) << text_of(uploaded.error());
        return std::move(*uploaded);
    }

    static Names active(const GlProgram& program, GLenum kind) {
        Names names;
        GLint count = 0;
        glGetProgramInterfaceiv(program.name(), kind, GL_ACTIVE_RESOURCES, &count);
        for (GLint i = 0; i < count; ++i) {
            char name[64] = {};
            glGetProgramResourceName(program.name(), kind, static_cast<GLuint>(i), sizeof name,
                                     nullptr, name);
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
    EXPECT_EQ(asset.product.name(), 0u);
    EXPECT_EQ(asset.normal.name(), 0u);
    EXPECT_EQ(asset.openness.name(), 0u);
    EXPECT_TRUE(make_view_programs(asset)->sums.empty());
    const auto dots = make_dot_programs(asset, 8);
    EXPECT_EQ(made(dots->program), 1u);
    const auto draws = make_draw_programs(asset, {});
    ASSERT_EQ(made(draws->surfaces.program), 1u);
    EXPECT_EQ(active(draws->surfaces.program[0], GL_UNIFORM), kPlainUniforms);
    EXPECT_EQ(active(draws->surfaces.program[0], GL_PROGRAM_INPUT),
              (Names{"position", "radiance", "base_color"}));
}

TEST_F(GlPrograms, MediaWithOneTermHaveNoViewMaps) {
    const GlAsset asset = upload(make_sheet_of({.bands = 3, .eta = 1.3f}));
    EXPECT_EQ(asset.product.name(), 0u);
    EXPECT_TRUE(make_view_programs(asset)->sums.empty());
    const auto draws = make_draw_programs(asset, {});
    ASSERT_EQ(made(draws->surfaces.program), 1u);
    Names uniforms = kPlainUniforms;
    uniforms.insert({"eta", "is_double_sided"});
    EXPECT_EQ(active(draws->surfaces.program[2], GL_UNIFORM), uniforms) << "nothing is mirrored";
}

TEST_F(GlPrograms, GreyMediaHaveNoCodeForThreeBands) {
    for (const std::uint32_t terms : {1u, 4u}) {
        const GlAsset grey = upload(make_sheet_of({.bands = 1, .eta = 1.3f, .terms = terms}));
        const GlAsset colour = upload(make_sheet_of({.bands = 3, .eta = 1.3f, .terms = terms}));
        const auto one = make_dot_programs(grey, 8), three = make_dot_programs(colour, 8);
        EXPECT_EQ(made(one->program), 1u);
        EXPECT_NE(one->program[1].name(), 0u);
        EXPECT_EQ(made(three->program), 1u);
        EXPECT_NE(three->program[3].name(), 0u);
    }
}

TEST_F(GlPrograms, EachNumberOfTermsHasItsOwnSum) {
    formats::Asset scene = make_sheet_of({});
    const auto sheet = test::make_sheet({0, 0, 0}, {6, 0, 0}, {0, 0, -6}, 3, 1);
    test::add_primitive(scene, sheet, {.bands = 3, .eta = 1.3f, .terms = 4});
    test::add_primitive(scene, sheet, {.bands = 3, .eta = 1.4f, .terms = 4});
    test::add_primitive(scene, sheet, {.bands = 3, .eta = 1.3f, .terms = 2, .is_separate = true});
    const GlAsset asset = upload(scene);
    const auto views = make_view_programs(asset);
    ASSERT_EQ(views->sums.size(), 2u);
    EXPECT_EQ(active(views->sums[0].program, GL_UNIFORM).count("eye"), 1u);
    // Two rows that look alike from everywhere.
    EXPECT_EQ(active(views->sums[1].program, GL_UNIFORM),
              (Names{"vertices", "product_origin", "radiance_origin", "shows"}));
    EXPECT_EQ(made(make_dot_programs(asset, 8)->program), 2u);
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
