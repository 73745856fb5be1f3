// Wrong use of Opaline::gl returns a status and touches nothing.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <thread>
#include <utility>

#include "tests/runtime/embed_gl/gl_fixture.h"
#define GL_GLEXT_PROTOTYPES
#include <GL/glcorearb.h>

namespace opaline::test {
namespace {

class EmbedGlWrongUse : public EmbedGl {
  protected:
    void SetUp() override {
        EmbedGl::SetUp();
        if (!context_) return;
        formats::Asset asset = make_asset(8, 8);
        add_primitive(asset, make_sphere({0, 0, 0}, 1, 7, 6),
                      {.bands = 3, .details = 20, .eta = 1.3f, .terms = 9});
        make(asset);
    }
    opaline_status create(opaline_gl_loader loader, opaline_gl** out) const {
        return opaline_gl_create(host_->asset(), loader, 0, out);
    }
};

// Hosts' functions that say something else than the driver's.
template <class Function>
void* instead_of(const char* own, Function function, const char* name) {
    return std::strcmp(name, own) == 0 ? reinterpret_cast<void*>(function) : load_gl(name);
}
const char* version_text = nullptr;
const GLubyte* APIENTRY other_string(GLenum name) {
    return name == GL_VERSION ? reinterpret_cast<const GLubyte*>(version_text) : glGetString(name);
}
void* load_other_version(const char* name) {
    return instead_of("glGetString", other_string, name);
}
void* load_without_dispatch(const char* name) {
    return instead_of("glDispatchCompute", static_cast<void*>(nullptr), name);
}
void* load_nothing(const char*) {
    return nullptr;
}
GLenum reset_status = GL_NO_ERROR;
GLenum APIENTRY other_reset_status() {
    return reset_status;
}
void* load_reset(const char* name) {
    return std::strcmp(name, "glGetGraphicsResetStatus") == 0
               ? reinterpret_cast<void*>(other_reset_status)
               : load_other_version(name);
}
GLenum APIENTRY out_of_memory() {
    static int asked = 0;
    return ++asked % 20 == 0 ? GL_NO_ERROR : GL_OUT_OF_MEMORY;
}
void* load_full(const char* name) {
    return instead_of("glGetError", out_of_memory, name);
}
void APIENTRY refuse(GLuint, GLenum, GLint* value) {
    *value = GL_FALSE;
}
void* load_refusing(const char* name) {
    return instead_of("glGetShaderiv", refuse, name);
}

TEST_P(EmbedGlWrongUse, NullsAndUnknownValuesAreInvalidArguments) {
    opaline_gl* none = nullptr;
    opaline_gl_objects objects{};
    const float eye[3] = {0, NAN, 0};
    EXPECT_THAT(
        (Statuses{opaline_gl_create(nullptr, load_gl, 0, &none), create(load_gl, nullptr),
                  opaline_gl_create(host_->asset(), load_gl, 1024, &none),
                  opaline_gl_relight(nullptr, host_->light()), opaline_gl_relight(gl_, nullptr),
                  opaline_gl_look_from(nullptr, nullptr), opaline_gl_look_from(gl_, eye),
                  opaline_gl_get_objects(gl_, &objects), opaline_gl_get_objects(gl_, nullptr),
                  opaline_gl_get_objects(nullptr, &objects)}),
        testing::Each(OPALINE_INVALID_ARGUMENT));
    EXPECT_EQ(none, nullptr);
    EXPECT_EQ(opaline_gl_release(nullptr), OPALINE_OK);
}

TEST_P(EmbedGlWrongUse, LightsOfOtherAssetsAreRefused) {
    formats::Asset finer = make_asset(16, 8), lit = make_asset(8, 8);
    add_primitive(finer, make_sphere({0, 0, 0}, 1, 4, 4), {});
    add_primitive(lit, make_sphere({0, 0, 0}, 1, 4, 4), {});
    append_emitter(lit.emitters, "lamp");
    append_block(lit.emitters, 0, 0,
                 std::vector<formats::Rgb>(lit.primitives[0].vertex_count, {1, 1, 1}));
    EXPECT_EQ(opaline_gl_relight(gl_, EmbeddedAsset(finer).light()), OPALINE_INVALID_ARGUMENT);
    EXPECT_EQ(opaline_gl_relight(gl_, EmbeddedAsset(lit).light()), OPALINE_INVALID_ARGUMENT);
}

TEST_P(EmbedGlWrongUse, WithoutACurrentContextNothingHappens) {
    opaline_gl* none = nullptr;
    HostContext::make_none_current();
    EXPECT_THAT(
        (Statuses{create(load_gl, &none), create(nullptr, &none),
                  opaline_gl_relight(gl_, host_->light()), opaline_gl_look_from(gl_, nullptr),
                  opaline_gl_release(std::exchange(gl_, nullptr))}),
        testing::Each(OPALINE_GL_NO_CONTEXT));
    EXPECT_EQ(none, nullptr);
}

TEST_P(EmbedGlWrongUse, OnAnotherThreadThanTheContextsThereIsNone) {
    opaline_status status = OPALINE_OK;
    std::thread([&] { status = opaline_gl_relight(gl_, host_->light()); }).join();
    EXPECT_EQ(status, OPALINE_GL_NO_CONTEXT);
    relight();
}

TEST_P(EmbedGlWrongUse, AnotherContextIsRefusedEvenWithObjectsOfTheSameNames) {
    const auto other = HostContext::create(GetParam());  // current from here on
    ASSERT_TRUE(other);
    opaline_gl* same_names = nullptr;
    ASSERT_EQ(create(load_gl, &same_names), OPALINE_OK);
    EXPECT_EQ(opaline_gl_relight(gl_, host_->light()), OPALINE_GL_WRONG_CONTEXT);
    EXPECT_EQ(opaline_gl_look_from(gl_, nullptr), OPALINE_GL_WRONG_CONTEXT);
    EXPECT_EQ(opaline_gl_relight(same_names, host_->light()), OPALINE_OK);
    context_->make_current();
    relight();
    EXPECT_EQ(opaline_gl_release(same_names), OPALINE_GL_WRONG_CONTEXT);
    relight();  // nothing of it was deleted
}

TEST_P(EmbedGlWrongUse, AContextThatSharesObjectsIsTheSame) {
    const auto other = HostContext::create(GetParam(), &*context_);
    ASSERT_TRUE(other);
    relight();
    EXPECT_EQ(opaline_gl_release(std::exchange(gl_, nullptr)), OPALINE_OK);
}

TEST_P(EmbedGlWrongUse, TheContextIsFoundWithoutALoader) {
    opaline_gl* gl = nullptr;
    EXPECT_EQ(create(nullptr, &gl), OPALINE_OK) << opaline_last_error();
    EXPECT_EQ(opaline_gl_release(gl), OPALINE_OK);
}

TEST_P(EmbedGlWrongUse, OldContextsAreRefusedByTheirVersion) {
    opaline_gl* gl = nullptr;
    for (const char* old : {"4.2.0 Driver", "OpenGL ES 3.0 Driver", "2.1", "nonsense"}) {
        version_text = old;
        EXPECT_EQ(create(load_other_version, &gl), OPALINE_GL_TOO_OLD);
        EXPECT_THAT(opaline_last_error(), testing::HasSubstr(old));
    }
    EXPECT_EQ(create(load_without_dispatch, &gl), OPALINE_GL_TOO_OLD);
    EXPECT_THAT(opaline_last_error(), testing::HasSubstr("glDispatchCompute"));
    EXPECT_EQ(create(load_nothing, &gl), OPALINE_GL_NO_CONTEXT);
    EXPECT_EQ(gl, nullptr);
}

TEST_P(EmbedGlWrongUse, LostContextsAreSaidToBeLost) {
    version_text = GetParam() == HostApi::es_31 ? "OpenGL ES 3.2 Driver" : "4.6 Driver";
    opaline_gl *gl = nullptr, *other = nullptr;
    reset_status = GL_NO_ERROR;
    ASSERT_EQ(create(load_reset, &gl), OPALINE_OK) << opaline_last_error();
    reset_status = GL_INNOCENT_CONTEXT_RESET;
    EXPECT_THAT((Statuses{opaline_gl_relight(gl, host_->light()), opaline_gl_look_from(gl, nullptr),
                          create(load_reset, &other), opaline_gl_release(gl)}),
                testing::Each(OPALINE_GL_CONTEXT_LOST));
    reset_status = GL_NO_ERROR;
}

TEST_P(EmbedGlWrongUse, WhatTheDriverRefusesIsReported) {
    opaline_gl* gl = nullptr;
    EXPECT_EQ(create(load_full, &gl), OPALINE_OUT_OF_MEMORY);
    EXPECT_EQ(create(load_refusing, &gl), OPALINE_GL_REFUSED);
    EXPECT_EQ(gl, nullptr);
    EXPECT_STREQ(opaline_status_string(OPALINE_GL_REFUSED), "refused by OpenGL");
}

TEST_P(EmbedGlWrongUse, ErrorsThatTheHostLeftAreNotTakenForTheLibrarys) {
    glEnable(0xffff);
    relight();
    glEnable(0xffff);
    EXPECT_EQ(opaline_gl_look_from(gl_, nullptr), OPALINE_OK);
}

INSTANTIATE_TEST_SUITE_P(On, EmbedGlWrongUse, kBothContexts, api_name);

}  // namespace
}  // namespace opaline::test
