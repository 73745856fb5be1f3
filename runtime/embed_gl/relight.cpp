#include "runtime/embed_gl/relight.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string>

#include "runtime/api_support.h"
#include "shader_text.h"

namespace opaline::runtime {
namespace {

using formats::PrimitiveRecord;
using formats::Rgb;
using formats::TermSet;

constexpr std::uint32_t kGroupSize = 64;  // invocations: two warps, one wave

bool is_software(const GlFunctions& gl) {
    const auto* const renderer = reinterpret_cast<const char*>(gl.GetString(GL_RENDERER));
    if (renderer == nullptr) return false;
    return std::ranges::any_of(
        std::array{"llvmpipe", "softpipe", "SwiftShader"},
        [&](const char* name) { return std::strstr(renderer, name) != nullptr; });
}

DotLimits query_limits(const GlFunctions& gl, std::size_t max_block_bytes, std::uint32_t lanes) {
    GLint64 block = 0;
    GLint alignment = 4, groups = 1;
    gl.GetInteger64v(GL_MAX_SHADER_STORAGE_BLOCK_SIZE, &block);
    gl.GetIntegerv(GL_SHADER_STORAGE_BUFFER_OFFSET_ALIGNMENT, &alignment);
    gl.GetIntegeri_v(GL_MAX_COMPUTE_WORK_GROUP_COUNT, 1, &groups);
    // Shaders count elements in 32 bits; a gigabyte stays clear of signed arithmetic in drivers.
    const auto stated = static_cast<std::size_t>(std::clamp<GLint64>(block, 0, GLint64{1} << 30));
    DotLimits limits;
    limits.max_block_bytes = max_block_bytes == 0 ? stated : std::min(max_block_bytes, stated);
    limits.alignment = static_cast<std::size_t>(std::max(alignment, 4));
    limits.max_vertices =
        static_cast<std::uint32_t>(std::clamp(groups, 1, 65535)) * (kGroupSize / lanes);
    return limits;
}

bool is_sheet(const PrimitiveRecord& primitive) {
    return primitive.shading == formats::Shading::sheet;
}

// Whether one of its results may be negative: where several make a radiance.
bool keeps_sign(const PrimitiveRecord& primitive) {
    return primitive.shading == formats::Shading::translucent;
}

float farthest_coordinate(const formats::AssetView& asset) {
    float farthest = 0;
    for (const formats::Vec3 p : asset.position) {
        farthest = std::max({farthest, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
    }
    return farthest;
}

// About 1 / the distances in a scene of that size, within floats.
float unit_of(float farthest) {
    return 1 / std::clamp(farthest, 1e-30f, 1e30f);
}

GLuint make_buffer_of_slots(std::span<const formats::Vec3> of_vertices,
                            const formats::SlotsView& slots, GlNames& names) {
    if (slots.empty()) return names.make_buffer_of(of_vertices);
    std::vector<formats::Vec3> picked;
    picked.reserve(slots.vertex.size());
    for (const std::uint32_t vertex : slots.vertex) {
        picked.push_back(of_vertices[vertex]);
    }
    return names.make_buffer_of(std::span<const formats::Vec3>(picked));
}

}  // namespace

opaline_status Relight::upload(const formats::AssetView& asset, const RelightOptions& options,
                               GlNames& names) {
    lanes_ = options.lanes_per_row != 0 ? options.lanes_per_row : is_software(gl_) ? 8 : 16;
    const DotLimits limits = query_limits(gl_, options.max_block_bytes, lanes_);
    auto batches = plan_dot_batches(asset, limits);
    if (!batches) {
        const formats::Diagnostic& main = batches.error().diagnostics.front();
        return api::fail(OPALINE_GL_REFUSED, (main.where + ": " + main.fault).c_str());
    }
    batches_ = std::move(batches).value();
    spread_batches_ = plan_spread_batches(asset, limits);
    alignment_ = limits.alignment;
    cubemap_size_ = asset.cubemap_size;
    vertices_ = asset.receivers();
    code_bits_ = asset.transport.code_bits;
    index_bytes_ = asset.transport.index_bytes;
    primitives_.assign(asset.primitives.begin(), asset.primitives.end());
    emitters_.name_end.assign(asset.emitters.name_end.begin(), asset.emitters.name_end.end());
    emitters_.block.assign(asset.emitters.block.begin(), asset.emitters.block.end());
    farthest_ = farthest_coordinate(asset);

    transport_ = names.make_buffer(transport_bytes(batches_), GL_STATIC_DRAW);
    for (const DotBatch& batch : batches_) {
        for (const PackedArray& array : packed_arrays(asset, batch)) {
            fill_buffer(gl_, transport_, array.offset, array.bytes);
        }
    }
    const std::size_t radiance_bytes = vertices_ * kRadianceBytes;
    radiance_ = names.make_buffer(radiance_bytes, GL_DYNAMIC_COPY);
    clear_buffer(gl_, radiance_, radiance_bytes);
    slot_radiance_ = radiance_;
    const formats::SlotsView& slots = asset.slots;
    if (!slots.empty()) {
        slot_ =
            slots.mix.empty() ? names.make_buffer_of(slots.slot) : names.make_buffer_of(slots.mix);
        slot_radiance_ = names.make_buffer(slots.vertex.size() * kRadianceBytes, GL_DYNAMIC_COPY);
    }
    if (std::ranges::any_of(primitives_, needs_view)) {
        product_ = names.make_buffer(asset.transport.rows() * kRadianceBytes, GL_DYNAMIC_COPY);
        position_ = make_buffer_of_slots(asset.position, slots, names);
        normal_ = make_buffer_of_slots(asset.normal, slots, names);
    }
    if (!emitters_.block.empty()) values_ = names.make_buffer_of(asset.emitters.value);
    return make_programs(!slots.mix.empty(), names);
}

opaline_status Relight::make_dot_program(std::uint32_t bands, bool keeps_sign, GlNames& names) {
    GLuint& program = dot_program_[(bands == 3 ? 1u : 0u) + (keeps_sign ? 2u : 0u)];
    if (program != 0) return OPALINE_OK;
    program = names.make_program("dot products",
                                 define("LANES", lanes_) + define("ROWS", kGroupSize / lanes_) +
                                     define("BANDS", bands) + define("CODE_BITS", code_bits_) +
                                     define("INDEX_BYTES", index_bytes_) +
                                     (keeps_sign ? define("KEEPS_SIGN") : ""),
                                 {{GL_COMPUTE_SHADER, dot_comp_text}});
    return program != 0 ? OPALINE_OK : OPALINE_GL_REFUSED;
}

opaline_status Relight::make_programs(bool is_mixed, GlNames& names) {
    const std::string view_text = std::string(view_terms_text) + view_comp_text;
    for (std::uint32_t p = 0; p < primitives_.size(); ++p) {
        const PrimitiveRecord& primitive = primitives_[p];
        if (primitive.vertex_count == 0) continue;
        const bool keeps = keeps_sign(primitive);
        opaline_status status = make_dot_program(primitive.bands, keeps, names);
        if (status == OPALINE_OK && !keeps && !emitters_.view().blocks_of(p).empty()) {
            status = make_dot_program(primitive.bands, true, names);
        }
        if (status != OPALINE_OK) return status;
        if (!needs_view(primitive) || sum_of(primitive) != nullptr) continue;
        Sum sum{primitive.terms, primitive.is_separate(), is_sheet(primitive), 0};
        const std::uint32_t harmonics = sum.is_sheet ? 0 : sum.terms - (sum.is_separate ? 1 : 0);
        sum.program = names.make_program("view terms",
                                         define("HARMONICS", harmonics) +
                                             (sum.is_separate ? define("SEPARATE") : "") +
                                             (sum.is_sheet ? define("SHEET") : ""),
                                         {{GL_COMPUTE_SHADER, view_text.c_str()}});
        if (sum.program == 0) return OPALINE_GL_REFUSED;
        sums_.push_back(sum);
    }
    if (values_ != 0) {
        emitter_program_ =
            names.make_program("emitters", "", {{GL_COMPUTE_SHADER, emitters_comp_text}});
        if (emitter_program_ == 0) return OPALINE_GL_REFUSED;
    }
    if (!spread_batches_.empty()) {
        spread_program_ = names.make_program("shared rows", is_mixed ? define("MIXED") : "",
                                             {{GL_COMPUTE_SHADER, spread_comp_text}});
        if (spread_program_ == 0) return OPALINE_GL_REFUSED;
    }
    return OPALINE_OK;
}

const Relight::Sum* Relight::sum_of(const PrimitiveRecord& primitive) const {
    const auto sum = std::ranges::find_if(sums_, [&](const Sum& s) {
        return s.terms == primitive.terms && s.is_separate == primitive.is_separate() &&
               s.is_sheet == is_sheet(primitive);
    });
    return sum == sums_.end() ? nullptr : &*sum;
}

void Relight::bind(GLuint binding, GLuint buffer, const BoundRange& range) const {
    gl_.BindBufferRange(GL_SHADER_STORAGE_BUFFER, binding, buffer,
                        static_cast<GLintptr>(range.offset), static_cast<GLsizeiptr>(range.size));
}

// Those of the locations 0, 1, ...
void Relight::set(GLuint program, std::initializer_list<std::uint32_t> uniforms) const {
    GLint location = 0;
    for (const std::uint32_t value : uniforms)
        gl_.ProgramUniform1ui(program, location++, value);
}

bool Relight::is_lit_by(const EmitterLight& light, std::uint32_t primitive) const {
    return std::ranges::any_of(emitters_.view().blocks_of(primitive), [&](const auto& block) {
        return block.scale * light.color_of(block.emitter) != Rgb{};
    });
}

void Relight::dispatch_dot(const DotBatch& batch, GLuint light, bool keeps_sign) const {
    const GLuint program = dot_program_[(batch.bands == 3 ? 1u : 0u) + (keeps_sign ? 2u : 0u)];
    const bool is_added = needs_view(primitives_[batch.primitive]);
    const std::uint32_t results = batch.slots * batch.terms;
    const BoundRange& result = is_added ? batch.product : batch.radiance;
    gl_.UseProgram(program);
    set(program,
        {results, cubemap_size_ * cubemap_size_, batch.first_detail, batch.index, batch.code,
         batch.average_scale, batch.detail_scale, batch.average_code, result.origin});
    bind(0, transport_, batch.transport);
    gl_.BindBufferBase(GL_SHADER_STORAGE_BUFFER, 1, light);
    bind(2, is_added ? product_ : slot_radiance_, result);
    const std::uint32_t rows = kGroupSize / lanes_;
    gl_.DispatchCompute(1, (results + rows - 1) / rows, 1);
}

void Relight::dispatch_emitters(const DotBatch& batch, const EmitterLight& light) const {
    const PrimitiveRecord& primitive = primitives_[batch.primitive];
    const auto blocks = emitters_.view().blocks_of(batch.primitive);
    const auto color_of = [&](const formats::EmitterBlock& block) {
        return block.scale * light.color_of(block.emitter);
    };
    std::size_t last = 0;
    for (std::size_t b = 0; b < blocks.size(); ++b) {
        if (color_of(blocks[b]) != Rgb{}) last = b;
    }
    const bool is_added = needs_view(primitive);
    const std::uint32_t results = batch.slots * batch.terms;
    const BoundRange& result = is_added ? batch.product : batch.radiance;
    for (std::size_t b = 0; b <= last; ++b) {
        const Rgb color = color_of(blocks[b]);
        if (color == Rgb{}) continue;
        gl_.MemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
        const BoundRange value =
            bind_elements(blocks[b].first_value + std::uint64_t{3} * batch.first_row,
                          std::uint64_t{3} * results, 2, alignment_);
        gl_.UseProgram(emitter_program_);
        const bool is_last = b == last && !keeps_sign(primitive);
        set(emitter_program_, {results, value.origin, result.origin});
        gl_.ProgramUniform3f(emitter_program_, 3, color.r, color.g, color.b);
        gl_.ProgramUniform1ui(emitter_program_, 4, is_last ? 1 : 0);
        bind(0, values_, value);
        bind(1, is_added ? product_ : slot_radiance_, result);
        gl_.DispatchCompute((results + kGroupSize - 1) / kGroupSize, 1, 1);
    }
}

void Relight::light(const PartLights& lights, GlNames& names) {
    light_of_primitive_.assign(lights.of_primitive.begin(), lights.of_primitive.end());
    while (light_.size() < lights.light.size()) {
        light_.push_back(names.make_buffer(0, GL_DYNAMIC_DRAW));
    }
    for (std::size_t i = 0; i < lights.light.size(); ++i) {
        // New storage: work in flight keeps the old one.
        const auto bytes = std::as_bytes(std::span(lights.light[i].rgba));
        gl_.BindBuffer(GL_COPY_WRITE_BUFFER, light_[i]);
        gl_.BufferData(GL_COPY_WRITE_BUFFER, static_cast<GLsizeiptr>(bytes.size()), bytes.data(),
                       GL_DYNAMIC_DRAW);
    }
}

// Makes what slots show seen by whatever comes after, and by the vertices that have them: of
// primitives whose rows are added up toward an eye, or of the others.
void Relight::publish(bool are_viewed) const {
    const auto wait = [&] {
        gl_.MemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_VERTEX_ATTRIB_ARRAY_BARRIER_BIT |
                          GL_BUFFER_UPDATE_BARRIER_BIT | GL_PIXEL_BUFFER_BARRIER_BIT);
    };
    wait();
    if (spread_batches_.empty()) return;
    gl_.UseProgram(spread_program_);
    for (const SpreadBatch& batch : spread_batches_) {
        if (needs_view(primitives_[batch.primitive]) != are_viewed) continue;
        set(spread_program_, {batch.vertices, batch.slot.origin,
                              batch.shown.origin - batch.least_slot, batch.radiance.origin});
        bind(0, slot_, batch.slot);
        bind(1, slot_radiance_, batch.shown);
        bind(2, radiance_, batch.radiance);
        gl_.DispatchCompute((batch.vertices + kGroupSize - 1) / kGroupSize, 1, 1);
    }
    wait();
}

void Relight::dot(const EmitterLight& emitters) {
    for (const DotBatch& batch : batches_) {
        const bool is_lit = is_lit_by(emitters, batch.primitive);
        const std::size_t light =
            light_of_primitive_.empty() ? 0 : light_of_primitive_[batch.primitive];
        dispatch_dot(batch, light_[light], is_lit || keeps_sign(primitives_[batch.primitive]));
        if (is_lit) dispatch_emitters(batch, emitters);
    }
    publish(false);
}

void Relight::dispatch_view(const DotBatch& batch, const std::optional<formats::Vec3>& eye,
                            TermSet terms) const {
    const PrimitiveRecord& primitive = primitives_[batch.primitive];
    const Sum& sum = *sum_of(primitive);
    gl_.UseProgram(sum.program);
    // Rows of single scattering alone need no multiple scattering beside them.
    const bool single = has_any(terms, TermSet::single);
    const bool multiple = primitive.is_single_only() ? single : has_any(terms, TermSet::multiple);
    set(sum.program, {batch.slots, batch.product.origin, batch.radiance.origin});
    gl_.ProgramUniform2ui(sum.program, 3, multiple ? 1 : 0, single ? 1 : 0);
    bind(0, product_, batch.product);
    bind(3, slot_radiance_, batch.radiance);
    const bool is_directed = !sum.is_sheet && sum.terms - (sum.is_separate ? 1 : 0) > 1;
    if (is_directed || sum.is_sheet) {
        const formats::Vec3 at = eye.value_or(formats::Vec3{});
        const float farthest =
            std::max({farthest_, std::abs(at.x), std::abs(at.y), std::abs(at.z)});
        gl_.ProgramUniform3f(sum.program, 4, at.x, at.y, at.z);
        // Of no length, the direction to the eye counts as the normal.
        gl_.ProgramUniform1f(sum.program, 5, eye ? unit_of(farthest) : 0.0f);
        gl_.ProgramUniform1ui(sum.program, 8, batch.point.origin);
        bind(1, position_, batch.point);
        bind(2, normal_, batch.point);
    }
    if (is_directed) {
        gl_.ProgramUniform1f(sum.program, 6, primitive.eta);
        gl_.ProgramUniform1ui(sum.program, 7, primitive.flags & PrimitiveRecord::kDoubleSided);
    }
    gl_.DispatchCompute((batch.slots + kGroupSize - 1) / kGroupSize, 1, 1);
}

void Relight::view(const std::optional<formats::Vec3>& eye, TermSet terms) {
    for (const DotBatch& batch : batches_) {
        if (needs_view(primitives_[batch.primitive])) dispatch_view(batch, eye, terms);
    }
    publish(true);
}

}  // namespace opaline::runtime
