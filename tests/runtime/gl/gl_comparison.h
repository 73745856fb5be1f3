#pragma once

#include <gtest/gtest.h>

#include <optional>
#include <string>

#include "runtime/gl/gl_renderer.h"
#include "runtime/picture/software_renderer.h"

namespace opaline::test {

/// Skips only where no context can be made: a fault of ours further on must fail.
class Gl : public testing::Test {
  protected:
    void SetUp() override;
};

std::string text_of(const formats::Error& error);

/// Mean absolute difference below 1e-3 of the mean, and all but one pixel in a thousand within
/// 0.5 %: both backends take the same samples, but GL snaps vertices to a subpixel grid, which
/// moves a few samples across an edge.
void expect_same_picture(const runtime::Picture& cpu, const runtime::Picture& gl);

/// All values are finite and not negative.
void expect_displayable(const runtime::Picture& picture);

/// An asset in front of a sky that lights it, in both renderers. Refers to the asset.
class BothRenderers {
  public:
    BothRenderers(const formats::Asset& asset, const formats::Environment& sky,
                  const runtime::Rotation& rotation = {}, const runtime::GlOptions& options = {});

    void set_emitters(const runtime::EmitterLight& emitters);
    void set_layers(const runtime::LayerLightOptions& options = {});

    runtime::Picture on_cpu(const runtime::Camera& camera,
                            const runtime::GlRenderOptions& options = {}) const;
    runtime::Picture on_gl(const runtime::Camera& camera,
                           const runtime::GlRenderOptions& options = {});
    /// Of pictures, and where all components are shown of what receivers send to the camera's eye:
    /// there to float sums of a few hundred products in another order.
    void expect_agreement(const runtime::Camera& camera,
                          const runtime::GlRenderOptions& options = {});

  private:
    const formats::Asset& asset_;
    formats::Environment sky_;
    runtime::Rotation rotation_;
    runtime::LightVector light_;
    runtime::SpecularLight specular_;
    runtime::EmitterLight emitters_;
    std::optional<runtime::LayerLight> layers_;

  public:
    runtime::GlRenderer renderer;
};

}  // namespace opaline::test
