#include "runtime/gl/gl_view.h"

#include "runtime/terms.h"
#include "shader_text.h"

namespace opaline::runtime {
namespace {

// Locations of view.comp.glsl.
enum Uniform : GLint {
    kEye,
    kUnit,
    kEta,
    kIsDoubleSided,
    kTerms,
    kVertices,
    kProductOrigin,
    kPointOrigin,
    kIrradianceOrigin,
    kIsSeparate,
    kShows
};

constexpr std::uint32_t kGroupSize = 64;  ///< local_size_x of the shader

}  // namespace

formats::Result<ViewProgram> make_view_program(const GlAsset& asset) {
    ViewProgram program;
    if (!asset.has_translucent) return program;
    const StageSource stage{GL_COMPUTE_SHADER, view_comp_text};
    auto sum = make_program("view terms", "", {&stage, 1});
    if (!sum) return sum.error();
    program.sum = std::move(sum).value();
    return program;
}

formats::Status dispatch_views(const GlAsset& asset, const ViewProgram& program, formats::Vec3 eye,
                               float unit, std::uint32_t terms) {
    if (!asset.has_translucent) return formats::ok_status();
    glUseProgram(program.sum.name());
    glUniform3f(kEye, eye.x, eye.y, eye.z);
    glUniform1f(kUnit, unit);
    glUniform2ui(kShows, terms & kMultipleTerm, terms & kSingleTerm);
    for (const DotBatch& batch : asset.batches) {
        const formats::PrimitiveRecord& primitive = asset.primitives[batch.primitive];
        if (primitive.shading != formats::Shading::translucent) continue;
        glUniform1f(kEta, primitive.eta);
        glUniform1ui(kIsDoubleSided, primitive.flags & formats::PrimitiveRecord::kDoubleSided);
        glUniform1ui(kIsSeparate, primitive.is_separate() ? 1u : 0u);
        glUniform1ui(kTerms, batch.terms);
        glUniform1ui(kVertices, batch.vertices);
        glUniform1ui(kProductOrigin, batch.product.origin);
        glUniform1ui(kPointOrigin, batch.point.origin);
        glUniform1ui(kIrradianceOrigin, batch.irradiance.origin);
        bind_storage(0, asset.product, batch.product);
        bind_storage(1, asset.position, batch.point);
        bind_storage(2, asset.normal, batch.point);
        bind_storage(3, asset.irradiance, batch.irradiance);
        glDispatchCompute((batch.vertices + kGroupSize - 1) / kGroupSize, 1, 1);
    }
    glMemoryBarrier(GL_VERTEX_ATTRIB_ARRAY_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
    return check_gl("adding up view terms");
}

}  // namespace opaline::runtime
