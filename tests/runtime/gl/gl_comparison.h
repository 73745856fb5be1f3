#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "formats/opal/result.h"
#include "formats/opal/rgb.h"
#include "runtime/picture/picture.h"

namespace opaline::test {

/// Skips only where no context can be made: a fault of ours further on must fail.
class Gl : public testing::Test {
  protected:
    void SetUp() override;
};

std::string text_of(const formats::Error& error);

void expect_same_radiance(const std::vector<formats::Rgb>& cpu,
                          const std::vector<formats::Rgb>& gl);

/// Mean absolute difference below 1e-3 of the mean, and all but one pixel in a thousand within
/// 0.5 %: both backends take the same samples, but GL snaps vertices to a subpixel grid, which
/// moves a few samples across an edge.
void expect_same_picture(const runtime::Picture& cpu, const runtime::Picture& gl);

}  // namespace opaline::test
