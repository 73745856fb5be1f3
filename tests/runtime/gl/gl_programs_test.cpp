// What shader programs hold, by what the driver says is active in them.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>

#include "runtime/gl/egl_context.h"
#include "runtime/gl/gl_draw.h"
#include "tests/runtime/gl/gl_comparison.h"
#include "tests/runtime/picture/synthetic_asset.h"

namespace opaline::runtime {
namespace {

using Names = std::set<std::string>;
using test::text_of;

class GlPrograms : public test::Gl {
  protected:
    struct Release {
        void operator()(GlAsset* gl) const {
            gl->names.release();
            delete gl;
        }
    };

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

    // With what the renderer uploads.
    static std::unique_ptr<GlAsset, Release> upload(const formats::Asset& asset) {
        std::unique_ptr<GlAsset, Release> gl(new GlAsset);
        EXPECT_EQ(load_gl_functions(EglContext::load_function, gl->gl), OPALINE_OK);
        EXPECT_EQ(gl->upload(asset.view(), OPALINE_GL_WITH_MESH | OPALINE_GL_WITH_IMAGES,
                             {.lanes_per_row = 8}),
                  OPALINE_OK)
            << opaline_last_error();
        return gl;
    }

    static Names active(GLuint program, GLenum kind) {
        Names names;
        GLint count = 0;
        glGetProgramInterfaceiv(program, kind, GL_ACTIVE_RESOURCES, &count);
        for (GLint i = 0; i < count; ++i) {
            char name[64] = {};
            glGetProgramResourceName(program, kind, static_cast<GLuint>(i), sizeof name, nullptr,
                                     name);
            if (std::string(name).rfind("gl_", 0) != 0) names.insert(name);
        }
        return names;
    }

    static std::ptrdiff_t dots(const Relight& relight) {
        return std::ranges::count_if(relight.dot_programs(),
                                     [](GLuint program) { return program != 0; });
    }

    // Of so many kinds of sums; `more`: the numbers of surfaces' programs, and the uniforms that
    // they have beside those of plain ones.
    static void expect_surfaces(const formats::Asset& scene, std::size_t sums,
                                const std::map<std::size_t, Names>& more) {
        const auto gl = upload(scene);
        EXPECT_EQ(gl->relight.sums().size(), sums);
        EXPECT_EQ(gl->relight.needs_eye(), sums > 0);
        const auto draws = make_draw_programs(scene.view(), *gl);
        ASSERT_TRUE(draws) << text_of(draws.error());
        EXPECT_EQ(draws->surfaces.program.size(), more.size());
        for (const auto& [i, program] : draws->surfaces.program) {
            ASSERT_TRUE(more.contains(i)) << i;
            Names uniforms{"eye",  "right",      "down", "forward",
                           "unit", "near_plane", "tile", "shown"};
            uniforms.insert(more.at(i).begin(), more.at(i).end());
            EXPECT_EQ(active(program, GL_UNIFORM), uniforms);
            if (i > 0) continue;
            EXPECT_EQ(active(program, GL_PROGRAM_INPUT),
                      (Names{"position", "radiance", "base_color"}));
        }
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

TEST_F(GlPrograms, SurfacesHaveCodeForWhatTheyAreAlone) {
    expect_surfaces(make_sheet_of({}), 0, {{0, {}}});
    // Media of one term: nothing is mirrored.
    expect_surfaces(make_sheet_of({.bands = 3, .eta = 1.3f}), 0, {{2, {"eta", "is_double_sided"}}});
    formats::Asset textured = make_sheet_of({.image = 0});
    textured.images.push_back(test::make_noise_image(3, 3));
    expect_surfaces(textured, 0, {{1, {"base_color_image", "wrap", "srgb_table"}}});
    // A matt one and a glossy one.
    formats::Asset glossy = make_sheet_of({});
    test::add_primitive(glossy, test::make_sheet({0, 0, 0}, {6, 0, 0}, {0, 0, -6}, 3, 1), {});
    glossy.roughness.assign(2, formats::kNotGlossy);
    glossy.openness.resize(glossy.position.size());
    glossy.gloss.resize(2);
    glossy.gloss[1].roughness = 0.4f;
    expect_surfaces(glossy, 0,
                    {{0, {}},
                     {8,
                      {"is_double_sided", "light_from_world", "has_specular", "f0_f90",
                       "metallic_roughness", "light_maps", "cells", "sun_table", "albedo"}}});
}

TEST_F(GlPrograms, GreyMediaHaveNoCodeForThreeBands) {
    for (const std::uint32_t terms : {1u, 4u}) {
        const auto grey = upload(make_sheet_of({.bands = 1, .eta = 1.3f, .terms = terms}));
        const auto colour = upload(make_sheet_of({.bands = 3, .eta = 1.3f, .terms = terms}));
        EXPECT_EQ(dots(grey->relight), 1);
        EXPECT_NE(grey->relight.dot_programs()[2], 0u);
        EXPECT_EQ(dots(colour->relight), 1);
        EXPECT_NE(colour->relight.dot_programs()[3], 0u);
    }
}

TEST_F(GlPrograms, EachNumberOfTermsHasItsOwnSum) {
    formats::Asset scene = make_sheet_of({});
    const auto sheet = test::make_sheet({0, 0, 0}, {6, 0, 0}, {0, 0, -6}, 3, 1);
    test::add_primitive(scene, sheet, {.bands = 3, .eta = 1.3f, .terms = 4});
    test::add_primitive(scene, sheet, {.bands = 3, .eta = 1.4f, .terms = 4});
    test::add_primitive(scene, sheet, {.bands = 3, .eta = 1.3f, .terms = 2, .is_separate = true});
    const auto gl = upload(scene);
    const auto sums = gl->relight.sums();
    ASSERT_EQ(sums.size(), 2u);
    EXPECT_EQ(active(sums[0].program, GL_UNIFORM).count("eye"), 1u);
    // Two rows that look alike from everywhere.
    EXPECT_EQ(active(sums[1].program, GL_UNIFORM),
              (Names{"vertices", "product_origin", "radiance_origin", "shows"}));
    EXPECT_EQ(dots(gl->relight), 2);
}

}  // namespace
}  // namespace opaline::runtime
