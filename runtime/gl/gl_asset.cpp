#include "runtime/gl/gl_asset.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <string>

#include "runtime/specular.h"
#include "runtime/texture.h"

namespace opaline::runtime {
namespace {

using formats::AssetView;
using formats::PreviewImage;

GlTexture upload_image(const PreviewImage& image, std::size_t& resident) {
    GLuint name = 0;
    glCreateTextures(GL_TEXTURE_2D, 1, &name);
    GlTexture texture(name);
    const auto width = static_cast<GLsizei>(image.width),
               height = static_cast<GLsizei>(image.height);
    glTextureStorage2D(name, 1, GL_RGBA8UI, width, height);
    glTextureParameteri(name, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTextureParameteri(name, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glTextureSubImage2D(name, 0, 0, 0, width, height, GL_RGB_INTEGER, GL_UNSIGNED_BYTE,
                        image.rgb.data());
    resident += std::size_t{4} * image.width * image.height;
    return texture;
}

formats::Status upload_images(const AssetView& asset, GlAsset& gl) {
    GLint limit = 0;
    glGetIntegerv(GL_MAX_TEXTURE_SIZE, &limit);
    for (std::size_t i = 0; i < asset.images.size(); ++i) {
        const PreviewImage& image = asset.images[i];
        if (image.width > static_cast<std::uint32_t>(limit) ||
            image.height > static_cast<std::uint32_t>(limit)) {
            return formats::make_error(
                formats::ErrorKind::resource, {}, "image " + std::to_string(i),
                "found " + std::to_string(image.width) + "x" + std::to_string(image.height) +
                    " pixels, the OpenGL driver takes at most " + std::to_string(limit),
                std::string(kRenderOnCpu) + ", or bake with a smaller texture");
        }
        gl.images.push_back(upload_image(image, gl.resident));
    }
    return formats::ok_status();
}

void bind_attribute(GLuint array, GLuint attribute, GLuint buffer, GLint floats, GLsizei stride) {
    glVertexArrayVertexBuffer(array, attribute, buffer, 0, stride);
    glVertexArrayAttribFormat(array, attribute, floats, GL_FLOAT, GL_FALSE, 0);
    glVertexArrayAttribBinding(array, attribute, attribute);
    glEnableVertexArrayAttrib(array, attribute);
}

void make_vertex_array(const AssetView& asset, GLuint radiance, GlAsset& gl) {
    GLuint name = 0;
    glCreateVertexArrays(1, &name);
    gl.vertex_array = GlVertexArray(name);
    bind_attribute(name, 0, gl.position.name(), 3, sizeof(formats::Vec3));
    bind_attribute(name, 1, radiance, 3, kRadianceBytes);
    bind_attribute(name, 2, gl.base_color.name(), 3, sizeof(formats::Rgb));
    if (!asset.texcoord.empty()) {
        bind_attribute(name, 3, gl.texcoord.name(), 2, sizeof(formats::Float2));
    }
    if (gl.normal.name() != 0) {
        bind_attribute(name, 4, gl.normal.name(), 3, sizeof(formats::Vec3));
    }
    if (!gl.roughness.empty() || !gl.gloss.empty()) {
        // Openness: the octahedral axis and the fraction, scaled to [-1, 1] and [0, 1] on the way.
        for (const GLuint attribute : {5u, 6u}) {
            glVertexArrayVertexBuffer(name, attribute, gl.openness.name(), 0,
                                      sizeof(formats::Openness));
            glVertexArrayAttribBinding(name, attribute, attribute);
            glEnableVertexArrayAttrib(name, attribute);
        }
        glVertexArrayAttribFormat(name, 5, 2, GL_BYTE, GL_TRUE, 0);
        glVertexArrayAttribFormat(name, 6, 1, GL_UNSIGNED_BYTE, GL_TRUE,
                                  offsetof(formats::Openness, fraction));
    }
    if (!asset.holes.vertex_alpha.empty()) {
        bind_attribute(name, 7, gl.vertex_alpha.name(), 1, sizeof(float));
    }
    if (!gl.normal_maps.empty()) {
        glVertexArrayVertexBuffer(name, 8, gl.tangent.name(), 0, sizeof(formats::Tangent));
        glVertexArrayAttribFormat(name, 8, 3, GL_SHORT, GL_TRUE, 0);
        glVertexArrayAttribBinding(name, 8, 8);
        glEnableVertexArrayAttrib(name, 8);
    }
    glVertexArrayElementBuffer(name, gl.triangle.name());
}

}  // namespace

formats::Result<GlAsset> upload_asset(const AssetView& asset, GLuint radiance) {
    GlAsset gl;
    gl.vertices = asset.receivers();
    gl.primitives.assign(asset.primitives.begin(), asset.primitives.end());
    gl.emitters.name_end.assign(asset.emitters.name_end.begin(), asset.emitters.name_end.end());
    gl.emitters.block.assign(asset.emitters.block.begin(), asset.emitters.block.end());
    gl.emitters.own.assign(asset.emitters.own.begin(), asset.emitters.own.end());
    if (asset.texcoord.empty()) {  // nowhere to look up images: the CPU leaves them out too
        for (formats::PrimitiveRecord& primitive : gl.primitives) {
            primitive.base_color_image = formats::kNoImage;
        }
    }

    gl.has_translucent = std::ranges::any_of(gl.primitives, [](const auto& primitive) {
        return primitive.shading == formats::Shading::translucent;
    });
    const SpecularNeeds needs = specular_needs(asset);
    gl.normal_maps.assign(asset.normal_maps.record.begin(), asset.normal_maps.record.end());
    if (!gl.normal_maps.empty()) {
        gl.tangent = make_buffer_of(asset.normal_maps.tangent, gl.resident);
    }
    const bool has_glass = std::ranges::any_of(
        asset.holes.record, [](const formats::HoleRecord& hole) { return hole.clear != 0; });
    if (gl.has_translucent || needs.gloss || !gl.normal_maps.empty() || has_glass) {
        gl.normal = make_buffer_of(asset.normal, gl.resident);
    }
    if (!needs.levels.empty()) {
        gl.roughness.assign(asset.roughness.begin(), asset.roughness.end());
    }
    if (needs.gloss) {
        gl.gloss.assign(asset.gloss.begin(), asset.gloss.end());
    }
    if (needs.any()) {
        gl.openness = make_buffer_of(asset.openness, gl.resident);
    }
    gl.holes.assign(asset.holes.record.begin(), asset.holes.record.end());
    if (!asset.holes.vertex_alpha.empty()) {
        gl.vertex_alpha = make_buffer_of(asset.holes.vertex_alpha, gl.resident);
    }
    gl.position = make_buffer_of(asset.position, gl.resident);
    gl.base_color = make_buffer_of(asset.base_color, gl.resident);
    gl.texcoord = make_buffer_of(asset.texcoord, gl.resident);
    gl.triangle = make_buffer_of(asset.index, gl.resident);

    std::array<float, 256> linear{};
    for (std::size_t code = 0; code < linear.size(); ++code) {
        linear[code] = linear_from_srgb(static_cast<std::uint8_t>(code));
    }
    gl.srgb_table = make_buffer_of(std::span<const float>(linear), gl.resident);
    make_vertex_array(asset, radiance, gl);
    if (const auto status = upload_images(asset, gl); !status) return status.error();
    if (const auto status = check_gl("uploading the asset"); !status) return status.error();
    return gl;
}

}  // namespace opaline::runtime
