#pragma once

#include <memory>

#include "formats/opal/result.h"
#include "runtime/embed_gl/relight.h"

namespace opaline::runtime {

/// The compute half, that of Opaline::gl, in the renderer's own context; must be destroyed while it
/// is current.
class GlRelight {
  public:
    /// Errors: resource (memory, a row larger than the driver's limits, a shader).
    static formats::Result<GlRelight> create(const formats::AssetView& asset,
                                             const RelightOptions& options);
    GlRelight(GlRelight&& other) noexcept;
    GlRelight& operator=(GlRelight&& other) noexcept;
    ~GlRelight();

    /// As Relight::light. Errors: usage (another cube map size than the asset's, not one light for
    /// each primitive), resource.
    formats::Status light(const PartLights& lights);
    /// As Relight::dot. Errors: resource.
    formats::Status dot(const EmitterLight& emitters);
    /// As Relight::view. Errors: resource.
    formats::Status view(formats::Vec3 eye, formats::TermSet terms);

    const Relight& relight() const;
    std::size_t resident() const;  ///< [bytes]

  private:
    struct State;
    explicit GlRelight(std::unique_ptr<State> state);
    std::unique_ptr<State> state_;
};

}  // namespace opaline::runtime
