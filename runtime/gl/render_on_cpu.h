#pragma once

namespace opaline::runtime {

/// What errors of OpenGL advise.
inline constexpr const char* kRenderOnCpu = "render on the CPU: `opaline render --backend cpu`";

}  // namespace opaline::runtime
