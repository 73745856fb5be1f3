#include "runtime/gl/gl_view.h"

#include <algorithm>
#include <string>
#include <utility>

#include "shader_text.h"

namespace opaline::runtime {
namespace {

// Locations of view.comp.glsl; those from kEye on exist where the sum depends on the eye.
enum Uniform : GLint {
    kVertices,
    kProductOrigin,
    kRadianceOrigin,
    kShows,
    kEye,
    kUnit,
    kEta,
    kIsDoubleSided,
    kPointOrigin
};

constexpr std::uint32_t kGroupSize = 64;  ///< local_size_x of the shader

std::uint32_t harmonics(const ViewPrograms::Sum& sum) {
    return sum.is_sheet ? 0 : sum.terms - (sum.is_separate ? 1 : 0);
}

bool is_sheet(const formats::PrimitiveRecord& primitive) {
    return primitive.shading == formats::Shading::sheet;
}

const ViewPrograms::Sum* find_sum(const ViewPrograms& programs,
                                  const formats::PrimitiveRecord& primitive) {
    const auto sum = std::ranges::find_if(programs.sums, [&](const ViewPrograms::Sum& s) {
        return s.terms == primitive.terms && s.is_separate == primitive.is_separate() &&
               s.is_sheet == is_sheet(primitive);
    });
    return sum == programs.sums.end() ? nullptr : &*sum;
}

}  // namespace

formats::Result<ViewPrograms> make_view_programs(const GlAsset& asset) {
    ViewPrograms programs;
    const std::string text = std::string(view_terms_text) + view_comp_text;
    const StageSource stage{GL_COMPUTE_SHADER, text.c_str()};
    for (const formats::PrimitiveRecord& primitive : asset.primitives) {
        if (!needs_view(primitive) || find_sum(programs, primitive) != nullptr) continue;
        ViewPrograms::Sum sum{primitive.terms, primitive.is_separate(), is_sheet(primitive), {}};
        auto program = make_program("view terms",
                                    "#define HARMONICS " + std::to_string(harmonics(sum)) + "\n" +
                                        (sum.is_separate ? "#define SEPARATE\n" : "") +
                                        (sum.is_sheet ? "#define SHEET\n" : ""),
                                    {&stage, 1});
        if (!program) return program.error();
        sum.program = std::move(program).value();
        programs.sums.push_back(std::move(sum));
    }
    return programs;
}

formats::Status dispatch_views(const GlAsset& asset, const ViewPrograms& programs,
                               formats::Vec3 eye, float unit, formats::TermSet terms) {
    if (programs.sums.empty()) return formats::ok_status();
    for (const DotBatch& batch : asset.batches) {
        const formats::PrimitiveRecord& primitive = asset.primitives[batch.primitive];
        if (!needs_view(primitive)) continue;
        const ViewPrograms::Sum& sum = *find_sum(programs, primitive);
        glUseProgram(sum.program.name());
        glUniform1ui(kVertices, batch.vertices);
        glUniform1ui(kProductOrigin, batch.product.origin);
        glUniform1ui(kRadianceOrigin, batch.radiance.origin);
        // Rows of single scattering alone need no multiple scattering beside them.
        const bool single = has_any(terms, formats::TermSet::single);
        const bool multiple =
            primitive.is_single_only() ? single : has_any(terms, formats::TermSet::multiple);
        glUniform2ui(kShows, multiple ? 1u : 0u, single ? 1u : 0u);
        bind_storage(0, asset.product, batch.product);
        bind_storage(3, asset.radiance, batch.radiance);
        if (harmonics(sum) > 1) {
            glUniform1f(kEta, primitive.eta);
            glUniform1ui(kIsDoubleSided, primitive.flags & formats::PrimitiveRecord::kDoubleSided);
        }
        if (harmonics(sum) > 1 || sum.is_sheet) {
            glUniform3f(kEye, eye.x, eye.y, eye.z);
            glUniform1f(kUnit, unit);
            glUniform1ui(kPointOrigin, batch.point.origin);
            bind_storage(1, asset.position, batch.point);
            bind_storage(2, asset.normal, batch.point);
        }
        glDispatchCompute((batch.vertices + kGroupSize - 1) / kGroupSize, 1, 1);
    }
    glMemoryBarrier(GL_VERTEX_ATTRIB_ARRAY_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
    return check_gl("adding up view terms");
}

}  // namespace opaline::runtime
