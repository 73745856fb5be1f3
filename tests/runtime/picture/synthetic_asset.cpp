#include "tests/runtime/picture/synthetic_asset.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "formats/opal/cubemap.h"
#include "formats/opal/haar.h"

namespace opaline::test {
namespace {

using formats::Rgb;
using formats::Vec3;

constexpr float kPi = std::numbers::pi_v<float>;

formats::SparseRow cosine_row(Vec3 normal, std::uint32_t n, std::uint32_t bands,
                              std::uint32_t details) {
    const std::uint32_t texels = formats::cubemap_texels(n);
    std::vector<std::vector<float>> dense(bands, std::vector<float>(texels));
    for (std::uint32_t j = 0; j < texels; ++j) {
        const Vec3 w = formats::texel_direction(n, j / (n * n), j / n % n, j % n);
        const float cosine = std::max(0.0f, dot(normal, w));
        const float band_value[3] = {cosine, std::sqrt(cosine), cosine * cosine};
        for (std::uint32_t band = 0; band < bands; ++band) {
            dense[band][j] = band_value[band] / kPi;
        }
    }
    formats::SparseRow row;
    row.bands = bands;
    for (std::vector<float>& values : dense) {
        formats::haar_forward_cube(std::span<float>(values), n);
        for (std::uint32_t face = 0; face < formats::kCubeFaces; ++face) {
            row.average.push_back(values[face * n * n]);
            values[face * n * n] = 0;
        }
    }
    std::vector<std::uint32_t> order(texels);
    std::iota(order.begin(), order.end(), 0u);
    details = std::min(details, texels - formats::kCubeFaces);
    std::nth_element(order.begin(), order.begin() + details, order.end(),
                     [&](std::uint32_t a, std::uint32_t b) {
                         return std::abs(dense[0][a]) > std::abs(dense[0][b]);
                     });
    row.index.assign(order.begin(), order.begin() + details);
    std::erase_if(row.index, [&](std::uint32_t j) { return j % (n * n) == 0; });
    std::sort(row.index.begin(), row.index.end());
    for (const std::vector<float>& values : dense) {
        for (const std::uint32_t j : row.index) {
            row.value.push_back(values[j]);
        }
    }
    return row;
}

void scale_row(formats::SparseRow& row, float factor) {
    for (std::vector<float>* values : {&row.value, &row.average}) {
        for (float& value : *values) {
            value *= factor;
        }
    }
}

template <class T>
void append(std::vector<T>& to, const std::vector<T>& from) {
    to.insert(to.end(), from.begin(), from.end());
}

formats::PrimitiveRecord& append_mesh(formats::Asset& asset, const TestMesh& mesh,
                                      std::uint32_t bands) {
    formats::PrimitiveRecord primitive;
    primitive.first_vertex = static_cast<std::uint32_t>(asset.position.size());
    primitive.vertex_count = static_cast<std::uint32_t>(mesh.position.size());
    primitive.first_index = static_cast<std::uint32_t>(asset.index.size());
    primitive.index_count = static_cast<std::uint32_t>(mesh.index.size());
    primitive.bands = bands;
    primitive.first_row = static_cast<std::uint32_t>(asset.transport.row_offset.size() - 1);
    primitive.first_band_row = static_cast<std::uint32_t>(asset.transport.detail_scale.size());
    primitive.first_code = std::max(asset.transport.code8.size(), asset.transport.code16.size());
    append(asset.position, mesh.position);
    append(asset.normal, mesh.normal);
    append(asset.base_color, mesh.base_color);
    append(asset.texcoord, mesh.texcoord);
    append(asset.index, mesh.index);
    asset.primitives.push_back(primitive);
    return asset.primitives.back();
}

}  // namespace

TestMesh make_sphere(Vec3 centre, float radius, std::uint32_t slices, std::uint32_t stacks) {
    TestMesh mesh;
    for (std::uint32_t j = 0; j <= stacks; ++j) {
        const float v = static_cast<float>(j) / static_cast<float>(stacks);
        for (std::uint32_t i = 0; i <= slices; ++i) {
            const float u = static_cast<float>(i) / static_cast<float>(slices);
            const Vec3 n{std::sin(kPi * v) * std::sin(2 * kPi * u), std::cos(kPi * v),
                         std::sin(kPi * v) * std::cos(2 * kPi * u)};
            mesh.position.push_back(centre + radius * n);
            mesh.normal.push_back(n);
            mesh.base_color.push_back({1.0f - 0.8f * v, 0.5f, 0.2f + 0.7f * v});
            mesh.texcoord.push_back({4 * u, 2 * v});
        }
    }
    const std::uint32_t row = slices + 1;
    for (std::uint32_t j = 0; j < stacks; ++j) {
        for (std::uint32_t i = 0; i < slices; ++i) {
            const std::uint32_t a = j * row + i;
            mesh.index.insert(mesh.index.end(), {a, a + row, a + 1, a + 1, a + row, a + row + 1});
        }
    }
    return mesh;
}

TestMesh make_sheet(Vec3 centre, Vec3 a, Vec3 b, std::uint32_t cells, float repeats) {
    TestMesh mesh;
    const Vec3 normal = normalize(cross(a, b));
    for (std::uint32_t j = 0; j <= cells; ++j) {
        for (std::uint32_t i = 0; i <= cells; ++i) {
            const float s = static_cast<float>(i) / static_cast<float>(cells);
            const float t = static_cast<float>(j) / static_cast<float>(cells);
            mesh.position.push_back(centre + (2 * s - 1) * a + (2 * t - 1) * b);
            mesh.normal.push_back(normal);
            mesh.base_color.push_back({0.8f, 0.8f, 0.8f});
            mesh.texcoord.push_back({repeats * s, repeats * t});
        }
    }
    const std::uint32_t row = cells + 1;
    for (std::uint32_t j = 0; j < cells; ++j) {
        for (std::uint32_t i = 0; i < cells; ++i) {
            const std::uint32_t v = j * row + i;
            mesh.index.insert(mesh.index.end(), {v, v + 1, v + row, v + row, v + 1, v + row + 1});
        }
    }
    return mesh;
}

formats::Asset make_asset(std::uint32_t n, std::uint32_t code_bits) {
    formats::Asset asset;
    asset.transport = formats::make_sparse_rows(n, code_bits);
    return asset;
}

void add_primitive(formats::Asset& asset, const TestMesh& mesh, const TestPrimitive& options) {
    formats::PrimitiveRecord& primitive = append_mesh(asset, mesh, options.bands);
    primitive.base_color_image = options.image;
    primitive.wrap_u = options.wrap_u;
    primitive.wrap_v = options.wrap_v;
    primitive.flags = options.is_double_sided ? formats::PrimitiveRecord::kDoubleSided : 0;
    if (options.eta > 0) {
        primitive.shading = formats::Shading::translucent;
        primitive.eta = options.eta;
        primitive.terms = options.terms;
        primitive.flags |= options.is_separate ? formats::PrimitiveRecord::kSeparate : 0;
    }
    if (options.is_sheet) {
        primitive.shading = formats::Shading::sheet;
        primitive.terms = 2;
    }
    for (const Vec3 normal : mesh.normal) {
        for (std::uint32_t k = 0; k < primitive.terms; ++k) {
            const float t = static_cast<float>(k);
            const Vec3 tilt{std::sin(3 * t), std::sin(5 * t), std::sin(7 * t)};
            formats::SparseRow row =
                cosine_row(normalize(normal + 0.5f * tilt), asset.transport.cubemap_size,
                           options.bands, options.details);
            if (k > 0) {
                scale_row(row, options.is_separate && k == 1 ? 0.4f : 0.8f * std::cos(2 * t));
            }
            append_row(asset.transport, row);
        }
    }
}

void add_bare_primitive(formats::Asset& asset, const TestMesh& mesh) {
    append_mesh(asset, mesh, 1);
    formats::SparseRow row;
    row.average.assign(6, 0.0f);
    for (std::size_t v = 0; v < mesh.position.size(); ++v) {
        append_row(asset.transport, row);
    }
}

void add_normal_map(formats::Asset& asset, formats::NormalMapRecord map, Vec3 along, float sign) {
    asset.normal_maps.record.push_back(map);
    asset.normal_maps.tangent.resize(asset.position.size());
    const formats::PrimitiveRecord& primitive = asset.primitives[map.primitive];
    for (std::uint32_t i = 0; i < primitive.vertex_count; ++i) {
        const Vec3 normal = asset.normal[primitive.first_vertex + i];
        const Vec3 flat = along - dot(along, normal) * normal;
        asset.normal_maps.tangent[primitive.first_vertex + i] = formats::encode_tangent(flat, sign);
    }
}

formats::PreviewImageData make_even_normals(Vec3 normal) {
    formats::PreviewImageData image{1, 1, {}};
    for (const float x : {normal.x, normal.y, normal.z}) {
        image.rgb.push_back(static_cast<std::uint8_t>(std::lround(128 + 127 * x)));
    }
    return image;
}

Vec3 coded_normal(const formats::PreviewImageData& even) {
    const auto value = [&](std::size_t i) { return (static_cast<float>(even.rgb[i]) - 128) / 127; };
    return formats::normalize({value(0), value(1), value(2)});
}

formats::PreviewImageData make_noise_image(std::uint32_t width, std::uint32_t height) {
    formats::PreviewImageData image{width, height, {}};
    std::uint32_t state = 12345;
    for (std::uint32_t i = 0; i < 3 * width * height; ++i) {
        state = state * 1664525u + 1013904223u;
        image.rgb.push_back(static_cast<std::uint8_t>(state >> 24));
    }
    return image;
}

Rgb two_lights(Vec3 d) {
    const float warm = std::pow(std::max(0.0f, d.x), 8.0f);
    const float cool = std::pow(std::max(0.0f, -d.z), 4.0f);
    const float sky = 0.5f + 0.4f * d.y;
    return {0.6f * sky + 4.0f * warm, 0.7f * sky + 2.5f * warm + 0.3f * cool,
            sky + warm + 1.5f * cool};
}

}  // namespace opaline::test
