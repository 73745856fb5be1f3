#include "runtime/gl/gl_dot.h"

#include <algorithm>
#include <array>
#include <string>

#include "shader_text.h"

namespace opaline::runtime {
namespace {

// Locations of dot.comp.glsl.
enum Uniform : GLint {
    kResults,
    kFaceTexels,
    kFirstDetail,
    kIndexOrigin,
    kCodeOrigin,
    kAverageScaleOrigin,
    kDetailScaleOrigin,
    kAverageOrigin,
    kResultOrigin
};

constexpr std::uint32_t kGroupSize = 64;  ///< threads: two warps, one wave

// What a batch's program has to do.
struct DotKind {
    std::uint32_t bands = 1;
    bool is_translucent = false;

    std::size_t number() const {  // in DotPrograms
        return (bands == 3 ? 2u : 0u) + (is_translucent ? 1u : 0u);
    }
};

DotKind dot_kind(const GlAsset& asset, const DotBatch& batch) {
    return {batch.bands,
            asset.primitives[batch.primitive].shading == formats::Shading::translucent};
}

formats::Result<GlProgram> make_dot_program(const GlAsset& asset, std::uint32_t lanes,
                                            DotKind kind) {
    const auto define = [](const char* name, std::uint32_t value) {
        return std::string("#define ") + name + " " + std::to_string(value) + "\n";
    };
    const StageSource stage{GL_COMPUTE_SHADER, dot_comp_text};
    return make_program("dot products",
                        define("LANES", lanes) + define("ROWS", rows_per_group(lanes)) +
                            define("BANDS", kind.bands) + define("CODE_BITS", asset.code_bits) +
                            define("INDEX_BYTES", asset.index_bytes) +
                            (kind.is_translucent ? "#define KEEPS_SIGN\n" : ""),
                        {&stage, 1});
}

}  // namespace

std::uint32_t rows_per_group(std::uint32_t lanes_per_row) {
    return kGroupSize / lanes_per_row;
}

DotLimits query_dot_limits(std::size_t max_block_bytes, std::uint32_t lanes_per_row) {
    GLint64 block = 0;
    GLint alignment = 4, groups = 1;
    glGetInteger64v(GL_MAX_SHADER_STORAGE_BLOCK_SIZE, &block);
    glGetIntegerv(GL_SHADER_STORAGE_BUFFER_OFFSET_ALIGNMENT, &alignment);
    glGetIntegeri_v(GL_MAX_COMPUTE_WORK_GROUP_COUNT, 1, &groups);
    // Shaders count elements in 32 bits; a gigabyte stays clear of signed arithmetic in drivers.
    const auto stated = static_cast<std::size_t>(std::clamp<GLint64>(block, 0, GLint64{1} << 30));
    DotLimits limits;
    limits.max_block_bytes = max_block_bytes == 0 ? stated : std::min(max_block_bytes, stated);
    limits.alignment = static_cast<std::size_t>(std::max(alignment, 4));
    limits.max_vertices =
        static_cast<std::uint32_t>(std::clamp(groups, 1, 65535)) * rows_per_group(lanes_per_row);
    return limits;
}

formats::Result<DotPrograms> make_dot_programs(const GlAsset& asset, std::uint32_t lanes_per_row) {
    DotPrograms programs;
    programs.lanes_per_row = lanes_per_row;
    programs.rows_per_group = rows_per_group(lanes_per_row);
    for (const DotBatch& batch : asset.batches) {
        const DotKind kind = dot_kind(asset, batch);
        if (programs.program[kind.number()].name() != 0) continue;
        auto program = make_dot_program(asset, lanes_per_row, kind);
        if (!program) return program.error();
        programs.program[kind.number()] = std::move(program).value();
    }
    return programs;
}

formats::Status check_lights(const PartLights& lights, const GlAsset& asset) {
    const std::size_t texels = std::size_t{6} * asset.cubemap_size * asset.cubemap_size;
    for (const LightVector& light : lights.light) {
        if (light.n == asset.cubemap_size && light.rgba.size() == 4 * texels) continue;
        return formats::make_error(formats::ErrorKind::usage, {}, "light vector",
                                   "found a cube map of " + std::to_string(light.n) +
                                       " texels and " + std::to_string(light.rgba.size()) +
                                       " floats, expected " + std::to_string(asset.cubemap_size) +
                                       " texels as the asset",
                                   "project the environment at the asset's cube map size");
    }
    const std::size_t primitives = asset.primitives.size(), lit = lights.of_primitive.size();
    if (lit != 0 && lit != primitives) {
        return formats::make_error(formats::ErrorKind::usage, {}, "lights of primitives",
                                   "found " + std::to_string(lit) + ", expected one for each of " +
                                       std::to_string(primitives));
    }
    const auto is_one = [&](std::uint32_t number) { return number < lights.light.size(); };
    if (!is_one(lights.of_volumes) || !std::ranges::all_of(lights.of_primitive, is_one)) {
        return formats::make_error(
            formats::ErrorKind::usage, {}, "lights of primitives",
            "found one beyond the last of " + std::to_string(lights.light.size()) + " lights");
    }
    return formats::ok_status();
}

formats::Status dispatch_dots(const GlAsset& asset, const DotPrograms& programs,
                              const DotLights& lights) {
    for (const DotBatch& batch : asset.batches) {
        const std::size_t light =
            lights.of_primitive.empty() ? 0 : lights.of_primitive[batch.primitive];
        glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 1, lights.light[light].name());
        glUseProgram(programs.program[dot_kind(asset, batch).number()].name());
        // A result for each row: that of a vertex, or one of those to be added up toward an eye.
        const bool is_added = needs_view(asset.primitives[batch.primitive]);
        const std::uint32_t results = batch.vertices * batch.terms;
        const BoundRange& result = is_added ? batch.product : batch.radiance;
        const std::array<std::pair<Uniform, std::uint32_t>, 9> uniforms{
            {{kResults, results},
             {kFaceTexels, asset.cubemap_size * asset.cubemap_size},
             {kFirstDetail, batch.first_detail},
             {kIndexOrigin, batch.index},
             {kCodeOrigin, batch.code},
             {kAverageScaleOrigin, batch.average_scale},
             {kDetailScaleOrigin, batch.detail_scale},
             {kAverageOrigin, batch.average_code},
             {kResultOrigin, result.origin}}};
        for (const auto& [location, value] : uniforms) {
            glUniform1ui(location, value);
        }
        bind_storage(0, asset.transport, batch.transport);
        bind_storage(2, is_added ? asset.product : asset.radiance, result);
        glDispatchCompute(1, (results + programs.rows_per_group - 1) / programs.rows_per_group, 1);
    }
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_VERTEX_ATTRIB_ARRAY_BARRIER_BIT |
                    GL_BUFFER_UPDATE_BARRIER_BIT);
    return check_gl("computing dot products");
}

}  // namespace opaline::runtime
