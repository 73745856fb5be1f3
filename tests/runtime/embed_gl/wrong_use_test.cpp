// Wrong use of Opaline::gl returns a status and touches nothing.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <string>
#include <thread>

#include "tests/runtime/embed_gl/embedded_asset.h"
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
        host_ = std::make_unique<EmbeddedAsset>(asset);
    }
    opaline_gl* make() {
        opaline_gl* gl = nullptr;
        EXPECT_EQ(opaline_gl_create(host_->asset(), load_gl, 0, &gl), OPALINE_OK)
            << opaline_last_error();
        return gl;
    }
    std::unique_ptr<EmbeddedAsset> host_;
};

// Hosts' functions that say something else than the driver's.
const char* version_text = nullptr;
const GLubyte* APIENTRY other_string(GLenum name) {
    return name == GL_VERSION ? reinterpret_cast<const GLubyte*>(version_text) : glGetString(name);
}
void* load_other_version(const char* name) {
    return std::strcmp(name, "glGetString") == 0 ? reinterpret_cast<void*>(other_string)
                                                 : load_gl(name);
}
void* load_without_dispatch(const char* name) {
    return std::strcmp(name, "glDispatchCompute") == 0 ? nullptr : load_gl(name);
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
    return std::strcmp(name, "glGetError") == 0 ? reinterpret_cast<void*>(out_of_memory)
                                                : load_gl(name);
}
void APIENTRY refuse(GLuint, GLenum, GLint* value) {
    *value = GL_FALSE;
}
void* load_refusing(const char* name) {
    return std::strcmp(name, "glGetShaderiv") == 0 ? reinterpret_cast<void*>(refuse)
                                                   : load_gl(name);
}

TEST_P(EmbedGlWrongUse, NullsAndUnknownValuesAreInvalidArguments) {
    opaline_gl* gl = make();
    opaline_gl* none = nullptr;
    const float eye[3] = {0, NAN, 0};
    EXPECT_EQ(opaline_gl_create(nullptr, load_gl, 0, &none), OPALINE_INVALID_ARGUMENT);
    EXPECT_EQ(opaline_gl_create(host_->asset(), load_gl, 0, nullptr), OPALINE_INVALID_ARGUMENT);
    EXPECT_EQ(opaline_gl_create(host_->asset(), load_gl, 1024, &none), OPALINE_INVALID_ARGUMENT);
    EXPECT_EQ(none, nullptr);
    EXPECT_EQ(opaline_gl_relight(nullptr, host_->light()), OPALINE_INVALID_ARGUMENT);
    EXPECT_EQ(opaline_gl_relight(gl, nullptr), OPALINE_INVALID_ARGUMENT);
    EXPECT_EQ(opaline_gl_look_from(nullptr, nullptr), OPALINE_INVALID_ARGUMENT);
    EXPECT_EQ(opaline_gl_look_from(gl, eye), OPALINE_INVALID_ARGUMENT);
    opaline_gl_objects objects{};
    EXPECT_EQ(opaline_gl_get_objects(gl, &objects), OPALINE_INVALID_ARGUMENT);
    EXPECT_EQ(opaline_gl_get_objects(gl, nullptr), OPALINE_INVALID_ARGUMENT);
    EXPECT_EQ(opaline_gl_get_objects(nullptr, &objects), OPALINE_INVALID_ARGUMENT);
    EXPECT_EQ(opaline_gl_release(nullptr), OPALINE_OK);
    EXPECT_EQ(opaline_gl_release(gl), OPALINE_OK);
}

TEST_P(EmbedGlWrongUse, LightsOfOtherAssetsAreRefused) {
    opaline_gl* gl = make();
    formats::Asset finer = make_asset(16, 8), lit = make_asset(8, 8);
    add_primitive(finer, make_sphere({0, 0, 0}, 1, 4, 4), {});
    add_primitive(lit, make_sphere({0, 0, 0}, 1, 4, 4), {});
    append_emitter(lit.emitters, "lamp");
    append_block(lit.emitters, 0, 0,
                 std::vector<formats::Rgb>(lit.primitives[0].vertex_count, {1, 1, 1}));
    EXPECT_EQ(opaline_gl_relight(gl, EmbeddedAsset(finer).light()), OPALINE_INVALID_ARGUMENT);
    EXPECT_EQ(opaline_gl_relight(gl, EmbeddedAsset(lit).light()), OPALINE_INVALID_ARGUMENT);
    EXPECT_EQ(opaline_gl_release(gl), OPALINE_OK);
}

TEST_P(EmbedGlWrongUse, WithoutACurrentContextNothingHappens) {
    opaline_gl* gl = make();
    opaline_gl* none = nullptr;
    HostContext::make_none_current();
    EXPECT_EQ(opaline_gl_create(host_->asset(), load_gl, 0, &none), OPALINE_GL_NO_CONTEXT);
    EXPECT_EQ(opaline_gl_create(host_->asset(), nullptr, 0, &none), OPALINE_GL_NO_CONTEXT);
    EXPECT_EQ(none, nullptr);
    EXPECT_EQ(opaline_gl_relight(gl, host_->light()), OPALINE_GL_NO_CONTEXT);
    EXPECT_EQ(opaline_gl_look_from(gl, nullptr), OPALINE_GL_NO_CONTEXT);
    EXPECT_EQ(opaline_gl_release(gl), OPALINE_GL_NO_CONTEXT);
}

TEST_P(EmbedGlWrongUse, OnAnotherThreadThanTheContextsThereIsNone) {
    opaline_gl* gl = make();
    opaline_status status = OPALINE_OK;
    std::thread([&] { status = opaline_gl_relight(gl, host_->light()); }).join();
    EXPECT_EQ(status, OPALINE_GL_NO_CONTEXT);
    EXPECT_EQ(opaline_gl_relight(gl, host_->light()), OPALINE_OK);
    EXPECT_EQ(opaline_gl_release(gl), OPALINE_OK);
}

TEST_P(EmbedGlWrongUse, AnotherContextIsRefusedEvenWithObjectsOfTheSameNames) {
    opaline_gl* gl = make();
    const auto other = HostContext::create(GetParam());  // current from here on
    ASSERT_TRUE(other);
    opaline_gl* same_names = make();
    EXPECT_EQ(opaline_gl_relight(gl, host_->light()), OPALINE_GL_WRONG_CONTEXT);
    EXPECT_EQ(opaline_gl_look_from(gl, nullptr), OPALINE_GL_WRONG_CONTEXT);
    EXPECT_EQ(opaline_gl_relight(same_names, host_->light()), OPALINE_OK);
    context_->make_current();
    EXPECT_EQ(opaline_gl_relight(gl, host_->light()), OPALINE_OK);
    EXPECT_EQ(opaline_gl_release(same_names), OPALINE_GL_WRONG_CONTEXT);
    EXPECT_EQ(opaline_gl_relight(gl, host_->light()), OPALINE_OK);  // nothing of it was deleted
    EXPECT_EQ(opaline_gl_release(gl), OPALINE_OK);
}

TEST_P(EmbedGlWrongUse, AContextThatSharesObjectsIsTheSame) {
    opaline_gl* gl = make();
    const auto other = HostContext::create(GetParam(), &*context_);
    ASSERT_TRUE(other);
    EXPECT_EQ(opaline_gl_relight(gl, host_->light()), OPALINE_OK) << opaline_last_error();
    EXPECT_EQ(opaline_gl_release(gl), OPALINE_OK);
}

TEST_P(EmbedGlWrongUse, TheContextIsFoundWithoutALoader) {
    opaline_gl* gl = nullptr;
    EXPECT_EQ(opaline_gl_create(host_->asset(), nullptr, 0, &gl), OPALINE_OK)
        << opaline_last_error();
    EXPECT_EQ(opaline_gl_release(gl), OPALINE_OK);
}

TEST_P(EmbedGlWrongUse, OldContextsAreRefusedByTheirVersion) {
    opaline_gl* gl = nullptr;
    for (const char* old : {"4.2.0 Driver", "OpenGL ES 3.0 Driver", "2.1", "nonsense"}) {
        version_text = old;
        EXPECT_EQ(opaline_gl_create(host_->asset(), load_other_version, 0, &gl),
                  OPALINE_GL_TOO_OLD);
        EXPECT_NE(std::string(opaline_last_error()).find(old), std::string::npos);
    }
    EXPECT_EQ(opaline_gl_create(host_->asset(), load_without_dispatch, 0, &gl), OPALINE_GL_TOO_OLD);
    EXPECT_NE(std::string(opaline_last_error()).find("glDispatchCompute"), std::string::npos);
    EXPECT_EQ(opaline_gl_create(host_->asset(), load_nothing, 0, &gl), OPALINE_GL_NO_CONTEXT);
    EXPECT_EQ(gl, nullptr);
}

TEST_P(EmbedGlWrongUse, LostContextsAreSaidToBeLost) {
    version_text = GetParam() == HostApi::es_31 ? "OpenGL ES 3.2 Driver" : "4.6 Driver";
    opaline_gl *gl = nullptr, *other = nullptr;
    reset_status = GL_NO_ERROR;
    ASSERT_EQ(opaline_gl_create(host_->asset(), load_reset, 0, &gl), OPALINE_OK)
        << opaline_last_error();
    reset_status = GL_INNOCENT_CONTEXT_RESET;
    EXPECT_EQ(opaline_gl_relight(gl, host_->light()), OPALINE_GL_CONTEXT_LOST);
    EXPECT_EQ(opaline_gl_look_from(gl, nullptr), OPALINE_GL_CONTEXT_LOST);
    EXPECT_EQ(opaline_gl_create(host_->asset(), load_reset, 0, &other), OPALINE_GL_CONTEXT_LOST);
    EXPECT_EQ(opaline_gl_release(gl), OPALINE_GL_CONTEXT_LOST);
    reset_status = GL_NO_ERROR;
}

TEST_P(EmbedGlWrongUse, WhatTheDriverRefusesIsReported) {
    opaline_gl* gl = nullptr;
    EXPECT_EQ(opaline_gl_create(host_->asset(), load_full, 0, &gl), OPALINE_OUT_OF_MEMORY);
    EXPECT_EQ(opaline_gl_create(host_->asset(), load_refusing, 0, &gl), OPALINE_GL_REFUSED);
    EXPECT_EQ(gl, nullptr);
    EXPECT_STREQ(opaline_status_string(OPALINE_GL_REFUSED), "refused by OpenGL");
}

TEST_P(EmbedGlWrongUse, ErrorsThatTheHostLeftAreNotTakenForTheLibrarys) {
    opaline_gl* gl = make();
    glEnable(0xffff);
    EXPECT_EQ(opaline_gl_relight(gl, host_->light()), OPALINE_OK) << opaline_last_error();
    glEnable(0xffff);
    EXPECT_EQ(opaline_gl_look_from(gl, nullptr), OPALINE_OK);
    EXPECT_EQ(opaline_gl_release(gl), OPALINE_OK);
}

INSTANTIATE_TEST_SUITE_P(On, EmbedGlWrongUse, testing::Values(HostApi::desktop_43, HostApi::es_31),
                         api_name);

}  // namespace
}  // namespace opaline::test
