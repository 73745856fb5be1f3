#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "formats/opal/asset.h"
#include "formats/opal/terms.h"
#include "runtime/embed_gl/dot_batches.h"
#include "runtime/embed_gl/gl_names.h"
#include "runtime/embed_gl/spread_batches.h"
#include "runtime/emitter_light.h"
#include "runtime/part_lights.h"

namespace opaline::runtime {

struct RelightOptions {
    /// Invocations that share a row of the dot products: a power of two in [1, 32]. 0: 8 on
    /// software renderers (a SIMD register), 16 on GPUs (half a warp).
    std::uint32_t lanes_per_row = 0;
    /// Upper bound on bytes that one dispatch may see of one buffer; 0: what the driver states.
    std::size_t max_block_bytes = 0;
};

/// An asset's transport in the current context: as it stands in the file, and the compute shaders
/// that evaluate <T_k, L>, specialised for its widths. Every call wants a SavedState around it and
/// leaves GL errors to the caller.
class Relight {
  public:
    /// The program that adds up the rows of a vertex.
    struct Sum {
        std::uint32_t terms = 0;
        bool is_separate = false, is_sheet = false;
        GLuint program = 0;
    };

    explicit Relight(const GlFunctions& gl) : gl_(gl) {}

    /// Errors: OPALINE_GL_REFUSED (a row larger than the driver's limits, a shader).
    opaline_status upload(const formats::AssetView& asset, const RelightOptions& options,
                          GlNames& names);

    /// Copies the lights. Precondition: of the asset's cube map size, one for each primitive.
    void light(const PartLights& lights, GlNames& names);

    /// <T_0, L> of every vertex; <T_k, L> of every row where a vertex has several, which `view`
    /// adds up. Precondition: emitters have a colour each, or none.
    void dot(const EmitterLight& emitters);

    /// What vertices of several rows show `eye` of the components `terms`, without their Fresnel
    /// factor; nothing: each along its own normal.
    void view(const std::optional<formats::Vec3>& eye, formats::TermSet terms);

    std::uint32_t vertices() const { return vertices_; }
    GLuint radiance() const { return radiance_; }
    bool needs_eye() const { return product_ != 0; }
    std::uint32_t cubemap_size() const { return cubemap_size_; }
    std::size_t dispatches() const { return batches_.size(); }  ///< of dot products
    std::uint32_t lanes_per_row() const { return lanes_; }
    /// Of dot products: of one band and three, then those that keep signs; 0 where none is needed.
    const std::array<GLuint, 4>& dot_programs() const { return dot_program_; }
    std::span<const Sum> sums() const { return sums_; }

  private:
    const Sum* sum_of(const formats::PrimitiveRecord& primitive) const;
    opaline_status make_dot_program(std::uint32_t bands, bool keeps_sign, GlNames& names);
    opaline_status make_programs(bool is_mixed, GlNames& names);
    void bind(GLuint binding, GLuint buffer, const BoundRange& range) const;
    void set(GLuint program, std::initializer_list<std::uint32_t> uniforms) const;
    void dispatch_dot(const DotBatch& batch, GLuint light, bool keeps_sign) const;
    void dispatch_emitters(const DotBatch& batch, const EmitterLight& light) const;
    void dispatch_view(const DotBatch& batch, const std::optional<formats::Vec3>& eye,
                       formats::TermSet terms) const;
    void publish(bool are_viewed) const;
    bool is_lit_by(const EmitterLight& light, std::uint32_t primitive) const;

    const GlFunctions& gl_;
    std::uint32_t cubemap_size_ = 0, vertices_ = 0, code_bits_ = 8, index_bytes_ = 2, lanes_ = 1;
    std::size_t alignment_ = 4;
    float farthest_ = 0;  // largest coordinate of the mesh [m]
    std::vector<formats::PrimitiveRecord> primitives_;
    std::vector<DotBatch> batches_;
    std::vector<SpreadBatch> spread_batches_;  // empty where no vertices share rows
    formats::Emitters emitters_;               // without values, which are in a buffer
    // What slots show: radiance_ itself where no vertices share rows.
    GLuint slot_radiance_ = 0, slot_ = 0;
    GLuint transport_ = 0, radiance_ = 0, product_ = 0, position_ = 0, normal_ = 0, values_ = 0;
    std::vector<GLuint> light_;                      // each holds one light vector
    std::vector<std::uint32_t> light_of_primitive_;  // as PartLights::of_primitive
    std::array<GLuint, 4> dot_program_{};
    GLuint emitter_program_ = 0, spread_program_ = 0;
    std::vector<Sum> sums_;
};

}  // namespace opaline::runtime
