#include "bake/lab/compare/compare_files.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "bake/lab/compare/relight_table.h"
#include "formats/image/exr.h"
#include "formats/image/hdr.h"
#include "formats/image/image_kind.h"
#include "formats/image/png.h"
#include "formats/image/srgb.h"
#include "formats/opal/file_bytes.h"

namespace opaline::bake {
namespace {

using formats::Error;
using formats::ErrorKind;
using formats::FileBytes;
using formats::Image;
using formats::ImageKind;
using formats::Result;
using formats::Rgb;

Error fault(const std::filesystem::path& file, std::string where, std::string what,
            std::string remedy) {
    return formats::make_error(ErrorKind::bad_input, file.string(), std::move(where),
                               std::move(what), std::move(remedy));
}

Result<Image> decode_image(const FileBytes& file, ImageKind kind, const std::string& name) {
    if (kind == ImageKind::exr) {
        Result<formats::ExrImage> exr = formats::decode_exr(file.bytes(), name);
        if (!exr) return std::move(exr).error();
        return std::move(exr->image);
    }
    if (kind == ImageKind::hdr) {
        Result<formats::HdrImage> hdr = formats::decode_hdr(file.bytes(), name);
        if (!hdr) return std::move(hdr).error();
        return std::move(hdr->image);
    }
    Result<formats::Image8> png = formats::decode_png(file.bytes(), name);
    if (!png) return std::move(png).error();
    return formats::to_linear(*png);
}

/// The image, once every value is known to be finite.
Result<Image> finite_image(const FileBytes& file, ImageKind kind,
                           const std::filesystem::path& path) {
    Result<Image> image = decode_image(file, kind, path.string());
    if (!image) return image;
    for (std::size_t i = 0; i < image->pixel.size(); ++i) {
        const Rgb c = image->pixel[i];
        if (!std::isfinite(c.r) || !std::isfinite(c.g) || !std::isfinite(c.b)) {
            return fault(path,
                         "pixel (" + std::to_string(i % image->width) + ", " +
                             std::to_string(i / image->width) + ")",
                         "is NaN or infinite", "render it again");
        }
    }
    return image;
}

Result<Comparison> compare_images(const FileBytes& file_a, ImageKind kind_a,
                                  const std::filesystem::path& a, const FileBytes& file_b,
                                  ImageKind kind_b, const std::filesystem::path& b) {
    Result<Image> image_a = finite_image(file_a, kind_a, a);
    if (!image_a) return std::move(image_a).error();
    Result<Image> image_b = finite_image(file_b, kind_b, b);
    if (!image_b) return std::move(image_b).error();
    const auto size = [](const Image& image) {
        return std::to_string(image.width) + " x " + std::to_string(image.height);
    };
    if (image_a->width != image_b->width || image_a->height != image_b->height) {
        return fault(
            a, "", "has " + size(*image_a) + " pixels but " + b.string() + " has " + size(*image_b),
            "compare images of the same size");
    }
    return compare_values(image_a->pixel, image_b->pixel);
}

/// Rows by receiver, each receiver once.
Result<std::vector<RelightRow>> sorted_rows(const FileBytes& file,
                                            const std::filesystem::path& path) {
    Result<std::vector<RelightRow>> rows = decode_relight_csv(file.bytes(), path.string());
    if (!rows) return rows;
    const auto key = [](const RelightRow& row) { return std::tuple(row.primitive, row.vertex); };
    std::sort(rows->begin(), rows->end(),
              [&](const RelightRow& p, const RelightRow& q) { return key(p) < key(q); });
    const auto twin = std::adjacent_find(
        rows->begin(), rows->end(),
        [&](const RelightRow& p, const RelightRow& q) { return key(p) == key(q); });
    if (twin != rows->end()) {
        return fault(path,
                     "primitive " + std::to_string(twin->primitive) + " > vertex " +
                         std::to_string(twin->vertex),
                     "has more than one row", "keep one row per receiver");
    }
    if (rows->empty()) return fault(path, "", "has no rows", "write the table again with relight");
    return rows;
}

/// True for a table that `opaline reference` wrote.
bool has_standard_errors(const FileBytes& file) {
    const std::string_view text(reinterpret_cast<const char*>(file.bytes().data()),
                                file.bytes().size());
    return text.substr(0, text.find('\n')).find(",se_r") != std::string_view::npos;
}

Result<Comparison> compare_tables(const FileBytes& file_a, const std::filesystem::path& a,
                                  const FileBytes& file_b, const std::filesystem::path& b) {
    Result<std::vector<RelightRow>> rows_a = sorted_rows(file_a, a);
    if (!rows_a) return std::move(rows_a).error();
    Result<std::vector<RelightRow>> rows_b = sorted_rows(file_b, b);
    if (!rows_b) return std::move(rows_b).error();
    std::vector<Rgb> values_a, values_b;
    const auto key = [](const RelightRow& row) { return std::tuple(row.primitive, row.vertex); };
    if (has_standard_errors(file_b)) {
        // A table of `reference` has rows for some receivers only. The other receivers are skipped.
        std::erase_if(*rows_a, [&](const RelightRow& row) {
            return !std::binary_search(
                rows_b->begin(), rows_b->end(), row,
                [&](const RelightRow& p, const RelightRow& q) { return key(p) < key(q); });
        });
    }
    const std::size_t common = std::min(rows_a->size(), rows_b->size());
    std::size_t i = 0;
    for (; i < common && key((*rows_a)[i]) == key((*rows_b)[i]); ++i) {
        values_a.push_back((*rows_a)[i].radiance);
        values_b.push_back((*rows_b)[i].radiance);
    }
    if (i < rows_a->size() || i < rows_b->size()) {
        // The smaller key at the first difference is the one that the other table lacks.
        const bool is_in_a =
            i < rows_a->size() && (i >= rows_b->size() || key((*rows_a)[i]) < key((*rows_b)[i]));
        const RelightRow& row = is_in_a ? (*rows_a)[i] : (*rows_b)[i];
        return fault(is_in_a ? b : a,
                     "primitive " + std::to_string(row.primitive) + " > vertex " +
                         std::to_string(row.vertex),
                     "has no row, but " + (is_in_a ? a : b).string() + " has one",
                     "compare tables of the same receivers");
    }
    return compare_values(values_a, values_b);
}

}  // namespace

Comparison compare_values(std::span<const Rgb> a, std::span<const Rgb> b) {
    std::vector<double> errors(a.size());
    double error_sum = 0, reference_sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        const double dr = double{a[i].r} - double{b[i].r}, dg = double{a[i].g} - double{b[i].g},
                     db = double{a[i].b} - double{b[i].b};
        const double squared = (dr * dr + dg * dg + db * db) / 3;
        errors[i] = std::sqrt(squared);
        error_sum += squared;
        reference_sum += (double{b[i].r} * double{b[i].r} + double{b[i].g} * double{b[i].g} +
                          double{b[i].b} * double{b[i].b}) /
                         3;
    }
    const auto count = static_cast<double>(a.size());
    Comparison result;
    result.count = a.size();
    result.rmse = std::sqrt(error_sum / count);
    const double reference = std::sqrt(reference_sum / count);
    result.relative_rmse = result.rmse == 0 ? 0
                           : reference > 0  ? result.rmse / reference
                                            : std::numeric_limits<double>::infinity();
    const auto rank = static_cast<std::ptrdiff_t>((a.size() * 95 + 99) / 100) - 1;
    std::nth_element(errors.begin(), errors.begin() + rank, errors.end());
    result.p95 = errors[static_cast<std::size_t>(rank)];
    result.maximum = *std::max_element(errors.begin(), errors.end());
    return result;
}

Result<Comparison> compare_files(const std::filesystem::path& a, const std::filesystem::path& b) {
    Result<FileBytes> file_a = FileBytes::open(a);
    if (!file_a) return std::move(file_a).error();
    Result<FileBytes> file_b = FileBytes::open(b);
    if (!file_b) return std::move(file_b).error();
    const ImageKind kind_a = formats::image_kind(file_a->bytes());
    const ImageKind kind_b = formats::image_kind(file_b->bytes());
    if ((kind_a == ImageKind::unknown) != (kind_b == ImageKind::unknown)) {
        const auto& odd = kind_a == ImageKind::unknown ? a : b;
        return fault(odd, "", "is not an image, but the other file is one",
                     "compare two images or two relight tables");
    }
    if (kind_a == ImageKind::unknown) return compare_tables(*file_a, a, *file_b, b);
    return compare_images(*file_a, kind_a, a, *file_b, kind_b, b);
}

}  // namespace opaline::bake
